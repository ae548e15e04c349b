"""Small runs in a worker process, and the part of a chapter that all that show such runs share."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from typing import ClassVar, Final

import numpy as np
import pygame

from ai.environment import Doubles
from ai.lander.environment import PARAMS, Outcome
from ai.training.config import PRESETS, Config
from ai.training.small_run import Flown, Plan, SmallState, small_runs
from game.core import texts
from game.core.worker import Worker, WorkerState
from game.drawing.canvas import Canvas
from game.drawing.tokens import FAINT, INK, MUTE, SMALL
from game.scenes.learn.chapter import Chapter
from game.scenes.learn.pictures import inside, view_in
from game.ui.context import Context
from game.ui.panel import Column
from game.world.craft import draw_crowd, draw_fires

PACE: Final = 40.0  # decisions a second: four times as fast as they would fly
_APART: Final = 2.6  # metres between two landers of the picture
_SKY: Final = 14.0  # metres of height that are shown, at least
_SHARE: Final = 0.5  # a lander's size


class RunsChapter(Chapter):
    """Chapter in which some small runs learn side by side, from the same seed, once they are started.

    Attributes:
        choice: what the player has chosen, by its number; `flown` is that of the runs which are shown.
        states: states of all runs, after each decision so far.

    """

    LENGTH: ClassVar[int] = 600  # decisions after which they stop
    PLAN: ClassVar[Plan] = Plan()
    first: ClassVar[int] = 0  # the choice that stands there at first

    def __init__(self, context: Context) -> None:
        super().__init__(context)
        self._worker: Worker | None = None
        self.restart()

    @abstractmethod
    def configs(self) -> Sequence[Config]:
        """Return the configurations of the runs."""

    @property
    def words(self) -> dict[str, str]:
        words, modern, ours = super().words, PRESETS["modern"], self.configs()[0]
        steps, further = (texts.LEARN_SMALL_STEPS.format(count=each.n_step) for each in (ours, modern))
        differs = texts.LEARN_SMALL.format(
            steps=steps, modern_steps=further, batch=ours.batch_size, modern_batch=modern.batch_size
        )
        return {**words, "why": f"{words['why']} {differs}"}

    @property
    def plan(self) -> Plan:
        return self.PLAN

    def restart(self) -> None:
        self._forget()
        self.seed, self.tried, self.choice, self.flown = 0, False, self.first, self.first

    def _forget(self) -> None:
        self.close()
        self.states: list[tuple[SmallState, ...]] = []

    def choose(self, index: int) -> None:
        """Choose what the next runs are to differ by."""
        self.choice = index

    def start(self) -> None:
        """Start the runs with the choice as it is now, from another seed each time."""
        self._forget()
        self.flown = self.choice
        self._worker = Worker(small_runs, tuple(self.configs()), self.seed, self.plan)
        self._worker.set_pace(PACE)
        self.seed += 1
        self.changed = True

    def close(self) -> None:
        if self._worker is not None:
            self._worker.close(0.0)

    @property
    def running(self) -> bool:
        return self._worker is not None and self._worker.state in (WorkerState.STARTING, WorkerState.RUNNING)

    @property
    def over(self) -> bool:
        """Whether the runs have come to their end."""
        return len(self.states) > self.LENGTH

    @property
    def fault(self) -> str:
        """Why the worker failed; empty if it did not."""
        return self._worker.problem if self._worker is not None else ""

    def update(self) -> None:
        if self._worker is None or len(self.states) > self.LENGTH:
            return
        for states in self._worker.poll()[: self.LENGTH + 1 - len(self.states)]:
            self._take(states)
        if self.over:
            self.close()
            self.tried = self.changed = True
            self._finish()

    def _finish(self) -> None:
        """Take note that the runs have come to their end."""

    def _take(self, states: tuple[SmallState, ...]) -> None:
        self.states.append(states)

    def history(self, run: int, name: str) -> Doubles:
        """Return a figure of one run after each decision, by the name of a field of `SmallState`; NaN for None."""
        told = (getattr(states[run], name) for states in self.states)
        return np.array([np.nan if value is None else value for value in told], dtype=float)

    def starter(self, column: Column, label: str) -> None:
        """Add the button that starts the runs; it is lit while none goes on."""
        column.button(label, self.start, colour=MUTE if self.running else INK)

    def below(self, column: Column) -> None:
        column.bar(lambda: max(len(self.states) - 1, 0) / self.LENGTH)
        column.text(self._status, size=SMALL, colour=MUTE)

    def _status(self) -> str:
        key = "over" if self.over else "learning" if self.states else "starting" if self.running else "ready"
        done = self.states[-1][0].decisions if self.states else 0
        return self.fault or texts.LEARN_RUNS[key].format(done=done, all=self.LENGTH)


def draw_landers(canvas: Canvas, box: pygame.FRect, flown: Flown | None, flicker: int, count: int = 16) -> None:
    """Draw one-engine landers side by side; only the ground before they fly."""
    metres = _APART * (count + 0.6)
    height = metres * box.height / box.width
    view = view_in(box, (0.0, height / 2), metres, canvas.scale)
    canvas.line(box.bottomleft, box.bottomright, FAINT)
    if flown is None:
        return
    across = _APART * (np.arange(count) - (count - 1) / 2)
    # A picture lower than the sky is squeezed: heights are drawn to a scale of their own.
    squeeze = min(1.0, (height - 2 * PARAMS.stand) / _SKY)
    poses = np.stack([across, flown.height * squeeze + PARAMS.stand, np.zeros(count)], axis=1)
    with inside(canvas, box):
        burning = flown.main & (flown.outcome == Outcome.FLYING)
        draw_fires(canvas, view, poses[burning], flicker, 2 * _SHARE)
        draw_crowd(canvas, view, poses, 2 * _SHARE)
