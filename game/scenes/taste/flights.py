"""Two flights from one start, side by side, three times as fast as life."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np
import pygame

from ai.lander.environment import Outcome
from ai.training.messages import SwarmState
from ai.training.upbringing import Flight, Question
from game.core import texts
from game.drawing.canvas import Canvas
from game.drawing.cursor import Cursor
from game.drawing.tokens import INK, LINE, MUTE, NIGHT0, SMALL
from game.ui.widget import RowWidget
from game.world.swarm import LearningSwarm

PACE: Final = 45.0  # decisions a second: three times as fast as life
_GAP: Final = 12.0  # points between them


class Small:
    """A picture of landers in a box of a panel's row."""

    def __init__(self) -> None:
        self.swarm = LearningSwarm()
        self.box = pygame.FRect(0, 0, 1, 1)
        self._picture: Canvas | None = None

    def place(self, box: pygame.FRect) -> None:
        """Move to a box, in points."""
        if box.size != self.box.size:
            self.swarm.place(pygame.FRect(0, 0, *box.size))
            self._picture = None
        self.box = box.copy()

    def draw(self, canvas: Canvas) -> None:
        """Draw it where it is."""
        if self._picture is None or self._picture.scale != canvas.scale:
            self._picture = canvas.picture(*self.box.size)
        self.swarm.draw(self._picture, 1.0)
        canvas.surface.blit(self._picture.surface, canvas.rect(*self.box))


class Pair:
    """The two flights of a question, and where they are in the course of it.

    Attributes:
        question: what is asked; None while nothing is.
        halves: the picture of each flight.

    """

    def __init__(self) -> None:
        self.question: Question | None = None
        self.halves = Small(), Small()
        self._at = 0.0  # decisions since they began

    def ask(self, question: Question | None) -> None:
        """Show another question, from its beginning."""
        self.question = question
        self.again()

    def again(self) -> None:
        """Fly both again."""
        self._at = 0.0
        for half in self.halves:
            half.swarm.clear()

    def update(self, still: bool) -> None:
        """Advance by 1/60 s."""
        for half, flight in zip(self.halves, self.question or (), strict=False):
            seen, at = half.swarm.swarm_state, min(int(self._at), len(flight.actions))
            if seen is None or seen.decisions != at:
                half.swarm.take(_seen(flight, at))
            half.swarm.update(still)
        self._at += PACE / 60

    def over(self, side: int) -> bool:
        """Whether a flight has come to its end."""
        return self.question is not None and self._at >= len(self.question[side].actions)


class PairRow(RowWidget):
    """The two flights as a row; a click on one of them is an answer, and a press without a mouse flies both again."""

    acts = True

    def __init__(
        self, pair: Pair, answer: Callable[[int], None], height: Callable[[float], float], waits: Callable[[], str]
    ) -> None:
        super().__init__((0, 0, 1, 1), texts.TASTE_AGAIN)
        self._pair, self._answer, self._height, self._waits = pair, answer, height, waits

    def press(self) -> None:
        if self.ringed:
            self._pair.again()
            return
        mouse = self.ui_manager.get_mouse_position()
        for side, half in enumerate(self._pair.halves):
            if half.box.collidepoint(mouse):
                self._answer(side)

    def write(self, cursor: Cursor) -> None:
        wide = (cursor.width - _GAP) / 2
        box = cursor.take(self._height(wide))
        for side, half in enumerate(self._pair.halves):
            if cursor.canvas is None:
                half.place(pygame.FRect(box.left + side * (wide + _GAP), box.top, wide, box.height))
            else:
                self._draw(cursor.canvas, side, half)

    def _draw(self, canvas: Canvas, side: int, half: Small) -> None:
        """Draw a flight, or say what is waited for."""
        if self._pair.question is None:
            canvas.fill(canvas.rect(*half.box), NIGHT0)
            canvas.text(self._waits(), half.box.center, size=SMALL, colour=MUTE, align="centre")
            return
        half.draw(canvas)
        if self._pair.over(side):
            word = texts.OUTCOMES[Outcome(self._pair.question[side].outcome).name][0]
            canvas.text(word, (half.box.left + 12, half.box.top + 24), size=SMALL, colour=INK)
        pointed = canvas.pointer is not None and half.box.collidepoint(canvas.pointer)
        canvas.outline(half.box, 8, INK if pointed else LINE)


def _seen(flight: Flight, at: int) -> SwarmState:
    """Return a flight after so many decisions, as a swarm of one."""
    last = len(flight.actions)
    pose = flight.poses[None, at]
    action = np.array([flight.actions[min(at, last - 1)]], np.int8)
    outcome = np.array([flight.outcome if at == last else Outcome.FLYING], np.int8)
    return SwarmState(pose[:, :2], pose[:, 2], action, outcome, at)
