"""Playback: a clock that can be stopped, stepped and sped up, with its row of speeds and its keys."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Final

import pygame

from game.core import texts
from game.core.clock import TimeScale
from game.drawing.tokens import SMALL
from game.input.controls import Command
from game.ui.actions import Action
from game.ui.rows import ChoiceRow

_WORDS: Final = {0.25: "×¼", 0.5: "×½", 1.0: "×1", 2.0: "×2", 4.0: "×4"}


class Playback:
    """Clock of a scene that the player controls.

    Args:
        clock: how many steps are due in an update.
        speeds: rates to choose from; 1 is the first.
        advance: takes one step, as the player means it.

    Attributes:
        stopped: whether time stands still.

    """

    def __init__(self, clock: TimeScale, speeds: Sequence[float], advance: Callable[[], None]) -> None:
        self._clock, self._speeds, self._advance = clock, speeds, advance
        self.stopped = False
        self._row: ChoiceRow | None = None

    def choice(self) -> ChoiceRow:
        """Return a row to choose the speed from."""
        words, now = [_WORDS[speed] for speed in self._speeds], self._speeds.index(self._clock.rate)
        self._row = ChoiceRow(texts.WATCH_SPEED, words, now, self._choose, SMALL)
        return self._row

    def actions(
        self, step_hint: str, *, stop: Callable[[], None] | None = None, gamepad: Command = Command.HANDOVER
    ) -> list[Action]:
        """Return the actions: stop or go, and step, with hints; slower and faster without.

        Args:
            step_hint: what a step is called.
            stop: stops or goes, where that takes more than `toggle`.
            gamepad: command that stops or goes from a gamepad.

        """
        go = texts.HINT_GO if self.stopped else texts.HINT_STOP
        return [
            Action(pygame.K_SPACE, stop or self.toggle, go, gamepad=gamepad),
            Action(Command.STEP, self.step, step_hint),
            Action(Command.SLOWER, lambda: self.shift(-1)),
            Action(Command.FASTER, lambda: self.shift(1)),
        ]

    def shift(self, direction: int) -> None:
        """Choose the next lower speed, or the next higher."""
        at = self._speeds.index(self._clock.rate) + direction
        self._choose(min(max(at, 0), len(self._speeds) - 1))
        if self._row:
            self._row.index = self._speeds.index(self._clock.rate)

    def toggle(self) -> None:
        self.stopped = not self.stopped

    def step(self) -> None:
        self.stopped = True
        self._advance()

    def steps(self) -> int:
        """Count one update, and return the number of steps due in it."""
        return 0 if self.stopped else self._clock.steps()

    def between(self, alpha: float) -> float:
        """Interpolation between the last two steps, 0 to 1, once the fraction `alpha` of an update has passed."""
        return 1.0 if self.stopped else self._clock.between(alpha)

    def _choose(self, index: int) -> None:
        self._clock.begin()
        self._clock.rate = self._speeds[index]
