"""Small runs side by side in a worker process, and the part of a chapter that all that show such runs share."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from itertools import pairwise
from typing import ClassVar, Final

import numpy as np
import pygame

from ai.environment import Doubles, Ints
from ai.lander.environment import PARAMS, Outcome
from ai.training.config import Config
from ai.training.small_run import Flown, Plan, SmallState, small_runs
from game.core import texts
from game.core.worker import Worker, WorkerState
from game.drawing.canvas import Canvas
from game.drawing.prose import draw_wrapped
from game.drawing.tokens import FAINT, INK, LABEL, LINE, MUTE, SMALL, Colour
from game.learn.chapter import STAGE, Chapter
from game.learn.small_flight import inside, view_in
from game.ui.context import Context
from game.ui.widget import PointsManager
from game.ui.widgets import TextButton
from game.world.craft import draw_crowd, draw_fires

PACE: Final = 40.0  # decisions a second: four times as fast as they would fly
_APART: Final = 2.6  # metres between two landers of the picture
_SKY: Final = 14.0  # metres of height that are shown, at least
_SHARE: Final = 0.5  # a lander's size


class RunsChapter(Chapter):
    """Chapter in which some small runs learn side by side, from the same seed, once they are started.

    Attributes:
        states: states of all runs, after each decision so far.
        last: how each lander's last flight ended, for each run; `Outcome.FLYING` before.

    """

    LENGTH: ClassVar[int] = 600  # decisions after which they stop
    PLAN: ClassVar[Plan] = Plan()

    def __init__(self, context: Context, manager: PointsManager) -> None:
        super().__init__(context, manager)
        self._worker: Worker | None = None
        self.seed = 0
        self._forget()

    @abstractmethod
    def configs(self) -> Sequence[Config]:
        """Return the configurations of the runs."""

    @property
    def plan(self) -> Plan:
        """Where flights begin."""
        return self.PLAN

    def restart(self) -> None:
        """Forget the runs."""
        self.close()
        self._forget()
        self.seed, self.tried = 0, False

    def _forget(self) -> None:
        self.states: list[tuple[SmallState, ...]] = []
        self.last: list[Ints] = []

    def start(self) -> None:
        """Start the runs, from another seed each time."""
        self.close()
        self._forget()
        self._worker = Worker(small_runs, tuple(self.configs()), self.seed, self.plan)
        self._worker.set_pace(PACE)
        self.seed += 1
        self.changed = True

    def close(self) -> None:
        """End the worker's process."""
        if self._worker is not None:
            self._worker.close(0.0)

    @property
    def running(self) -> bool:
        """Whether the runs go on."""
        return self._worker is not None and self._worker.state in (WorkerState.STARTING, WorkerState.RUNNING)

    def starter(self, label: str) -> TextButton:
        """Return the button that starts the runs; it is lit while none goes on."""
        return TextButton(self.manager, self.row(3), label, self.start, colour=MUTE if self.running else INK)

    @property
    def over(self) -> bool:
        """Whether the runs have come to their end."""
        return len(self.states) > self.LENGTH

    @property
    def problem(self) -> str:
        """Why the worker failed; empty if it did not."""
        return self._worker.problem if self._worker is not None else ""

    def update(self) -> None:
        """Take what the worker has told, and end it when the runs are long enough."""
        if self._worker is None or self.over:
            return
        for states in self._worker.poll()[: self.LENGTH + 1 - len(self.states)]:
            self._take(states)
        if len(self.states) > self.LENGTH:
            self.close()
            self.tried = self.changed = True
            self.finished()

    def finished(self) -> None:
        """Take note that the runs have come to their end."""

    def _take(self, states: tuple[SmallState, ...]) -> None:
        self.states.append(states)
        if not self.last:
            self.last = [np.zeros_like(state.flown.outcome) for state in states]
        for last, state in zip(self.last, states, strict=True):
            ended = state.flown.outcome != Outcome.FLYING
            last[ended] = state.flown.outcome[ended]

    def history(self, run: int, name: str) -> Doubles:
        """Return a figure of one run after each decision, by the name of a field of `SmallState`; NaN for None."""
        told = (getattr(states[run], name) for states in self.states)
        return np.array([np.nan if value is None else value for value in told], dtype=float)

    def draw_status(self, canvas: Canvas) -> None:
        """Say on the lower edge how far the runs are, or what is wrong."""
        decisions = self.states[-1][0].decisions if self.states else 0
        if self.problem:
            draw_wrapped(canvas, self.problem, (STAGE.left, STAGE.bottom - 18), STAGE.width, size=SMALL, most=2)
            return
        key = "over" if self.over else "learning" if self.states else "starting" if self.running else "ready"
        told = texts.LEARN_RUNS[key].format(done=decisions, all=self.LENGTH)
        canvas.text(told, (STAGE.left, STAGE.bottom), size=SMALL, colour=MUTE, tabular=True, room=STAGE.width * 0.4)
        self._draw_legend(canvas)

    def _draw_legend(self, canvas: Canvas) -> None:
        """Say at the right of the lower edge what the marks under landers mean."""
        x, y = STAGE.left + STAGE.width * 0.42, STAGE.bottom
        told = texts.LEARN_RUNS_LEGEND
        canvas.text(told, (x, y), size=SMALL, colour=MUTE, room=STAGE.width * 0.2)
        x += canvas.text_width(told, size=SMALL) + 20
        for name, outcome in (
            ("landed", Outcome.LANDED),
            ("crashed", Outcome.CRASHED),
            ("lost", Outcome.OUT_OF_BOUNDS),
        ):
            _draw_end(canvas, (x, y - 4), outcome)
            canvas.text(texts.LEARN_RUNS_ENDS[name], (x + 10, y), size=SMALL, colour=MUTE)
            x += canvas.text_width(texts.LEARN_RUNS_ENDS[name], size=SMALL) + 34


def _draw_end(canvas: Canvas, place: tuple[float, float], outcome: int) -> None:
    """Draw the mark of a flight's end: a dot for a landing, a triangle for a crash, a dash for all others."""
    x, y = place
    if outcome == Outcome.LANDED:
        canvas.dot(place, 2.5, canvas.palette.good)
    elif outcome == Outcome.CRASHED:
        canvas.marker("triangle", place, 6, canvas.palette.warn)
    elif outcome:
        canvas.line((x - 3, y), (x + 3, y), MUTE, 1.5)


def draw_landers(
    canvas: Canvas, box: pygame.FRect, flown: Flown | None, last: Ints | None, flicker: int, count: int = 16
) -> None:
    """Draw one-engine landers side by side, and under each how its last flight ended; only the pad before they fly."""
    metres = _APART * (count + 0.6)
    height = metres * (box.height - 14) / box.width
    foot = box.bottom - 14
    picture = pygame.FRect(box.left, box.top, box.width, box.height - 14)
    view = view_in(picture, (0.0, height / 2), metres, canvas.scale)
    canvas.line((box.left, foot), (box.right, foot), FAINT)
    if flown is None:
        return
    across = _APART * (np.arange(count) - (count - 1) / 2)
    # A picture lower than the sky is squeezed: heights are drawn to a scale of their own.
    squeeze = min(1.0, (height - 2 * PARAMS.stand) / _SKY)
    poses = np.stack([across, flown.height * squeeze + PARAMS.stand, np.zeros(count)], axis=1)
    with inside(canvas, picture):
        burning = flown.main & (flown.outcome == Outcome.FLYING)
        draw_fires(canvas, view, poses[burning], flicker, 2 * _SHARE)
        draw_crowd(canvas, view, poses, 2 * _SHARE)
    if last is None:
        return
    places = view.points(poses[:, :2]).tolist()
    for (x, _), outcome in zip(places, last.tolist(), strict=True):
        _draw_end(canvas, (x, foot + 8), outcome)


def draw_curve(canvas: Canvas, box: pygame.FRect, heights: Doubles, colour: Colour, length: int) -> None:
    """Draw a curve of heights, 0 to 1, over `length` decisions; NaN leaves a gap."""
    kept = range(0, len(heights), max(1, length // 150))
    places = [
        (box.left + box.width * at / length, box.bottom - box.height * float(heights[at]))
        for at in kept if np.isfinite(heights[at])
    ]  # fmt: skip
    for a, b in pairwise(places):
        canvas.line(a, b, colour, 2)


def draw_axis(canvas: Canvas, box: pygame.FRect, ticks: Sequence[tuple[float, str]]) -> None:
    """Draw hairlines at heights, 0 to 1, of a chart, each with its word on the left."""
    for height, word in ticks:
        y = box.bottom - box.height * height
        canvas.line((box.left, y), (box.right, y), LINE)
        canvas.text(word, (box.left - 6, y + 4), size=LABEL, colour=MUTE, align="right", tabular=True)
