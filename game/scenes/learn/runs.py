"""Small runs in a worker process: what chapters that show them share, and chapters 7 and 9, two agents each."""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Sequence
from typing import ClassVar, Final

import numpy as np
import pygame

from ai.environment import Doubles
from ai.lander.environment import PARAMS, Outcome
from ai.lander.rewards import RewardWeights
from ai.training.config import Config
from ai.training.small_run import RECENT, SMALL_RUN, Flown, Plan, SmallState, small_runs
from game.core import texts
from game.core.scene import Route
from game.core.worker import Worker, WorkerState
from game.drawing.canvas import Canvas
from game.drawing.tokens import FAINT, HUMAN, INK, MUTE, NET, SMALL, Colour
from game.explain.figures import percent, points
from game.scenes.learn.chapter import Chapter
from game.scenes.learn.pictures import HEAD, draw_axis, draw_curve, draw_landers
from game.ui.context import Context
from game.ui.panel import Column
from game.world.camera import View

PACE: Final = 40.0  # decisions a second: four times as fast as they would fly
_APART: Final = 2.6  # metres between two landers of the picture
_SKY: Final = 14.0  # metres of height that are shown, at least


class RunsChapter(Chapter):
    """Chapter in which some small runs learn side by side, from the same seed, once they are started.

    Attributes:
        choice: what the player has chosen, by its number; `flown` is that of the runs which are shown.
        states: states of all runs, after each decision so far.
        came: number of the answer that the runs have shown; None before.

    """

    LENGTH: ClassVar[int] = 600  # decisions after which they stop
    PLAN: ClassVar[Plan] = Plan()
    door = Route("train")

    def __init__(self, context: Context) -> None:
        super().__init__(context)
        self._worker: Worker | None = None
        self.seed = self.choice = self.flown = 0
        self.states: list[tuple[SmallState, ...]] = []
        self.came: int | None = None

    @abstractmethod
    def configs(self) -> Sequence[Config]:
        """Return the configurations of the runs."""

    @property
    def plan(self) -> Plan:
        return self.PLAN

    def choose(self, index: int) -> None:
        """Choose what the next runs are to differ by."""
        self.choice = index

    def start(self) -> None:
        """Start the runs with the choice as it is now, from another seed each time."""
        self.close()
        self.states, self.flown, self.tried, self.changed = [], self.choice, False, True
        self._worker = Worker(small_runs, tuple(self.configs()), self.seed, self.plan)
        self._worker.set_pace(PACE)
        self.seed += 1

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

    def update(self) -> None:
        if self._worker is None or len(self.states) > self.LENGTH:
            return
        self.states += self._worker.poll()[: self.LENGTH + 1 - len(self.states)]
        if self.over:
            self.close()
            self.finish()
            self.found()

    @abstractmethod
    def finish(self) -> None:
        """Take note that the runs have come to their end."""

    def verdict(self) -> int | None:
        return self.came

    def history(self, run: int, name: str) -> Doubles:
        """Return a figure of one run after each decision, by the name of a field of `SmallState`; NaN for None."""
        values = (getattr(states[run], name) for states in self.states)
        return np.array([np.nan if value is None else value for value in values], dtype=float)

    def starter(self, column: Column, choices: Sequence[str], label: str) -> None:
        """Add what can be chosen, and the button that starts the runs; it is lit while none goes on."""
        column.choice("", choices, self.choice, self.choose).by_arrows = True
        column.button(label, self.start, colour=MUTE if self.running else INK)

    def below(self, column: Column) -> None:
        column.bar(lambda: max(len(self.states) - 1, 0) / self.LENGTH)
        column.text(self._status, size=SMALL, colour=MUTE)

    def _status(self) -> str:
        key = "learning" if self.states else "starting" if self.running else "ready"
        done, problem = self.states[-1][0].decisions if self.states else 0, self._worker and self._worker.problem
        return problem or texts.LEARN_RUNS[key].format(done=done, all=self.LENGTH)


def draw_side_by_side(canvas: Canvas, box: pygame.FRect, flown: Flown | None, flicker: int, count: int = 16) -> None:
    """Draw one-engine landers side by side; only the ground before they fly."""
    metres = _APART * (count + 0.6)
    height = metres * box.height / box.width
    view = View.within(box, canvas.scale, (0.0, height / 2), box.width / metres)
    canvas.line(box.bottomleft, box.bottomright, FAINT)
    if flown is None:
        return
    across = _APART * (np.arange(count) - (count - 1) / 2)
    # A picture lower than the sky is squeezed: heights are drawn to a scale of their own.
    squeeze = min(1.0, (height - PARAMS.stand - HEAD) / _SKY)
    poses = np.stack([across, flown.height * squeeze + PARAMS.stand, np.zeros(count)], axis=1)
    with canvas.clipped(box):
        draw_landers(canvas, box, view, poses, flown.main & (flown.outcome == Outcome.FLYING), flicker)


# Two agents that differ in one thing


class DuelChapter(RunsChapter):
    """Two agents; the right one is as the player chooses. A chart of one quantity stands below each.

    Attributes:
        quantity: the field of `SmallState` that the charts show.
        ticks: its values beside them, in rising order; the last is at their top.
        results: by choice, what its latest runs have shown.

    """

    shape = 0.6
    quantity: ClassVar[str]
    ticks: ClassVar[Sequence[float]]

    def __init__(self, context: Context) -> None:
        super().__init__(context)
        self.results: dict[int, str] = {}

    @abstractmethod
    def names(self) -> Sequence[str]:
        """Return the name of the left agent, and that of the right one for each choice."""

    @abstractmethod
    def caption(self, state: SmallState) -> str:
        """Return what is written beside a run's chart."""

    @abstractmethod
    def figure(self, value: float) -> str:
        """Write a value of the quantity."""

    @abstractmethod
    def shown(self) -> str:
        """Return what the runs that are on the screen have shown."""

    @property
    def judged(self) -> str:  # type: ignore[override]
        return self.names()[1]

    def start(self) -> None:
        """Start the runs, and forget what the last ones of this choice have shown."""
        self.results.pop(self.choice, None)
        if self.choice == 0:
            self.came = None
        super().start()

    def why(self) -> str:
        self.results[self.flown] = self.shown()
        return " ".join(self.results.values())

    @property
    def landed(self) -> tuple[float, ...]:
        """Share of the latest flights that landed, of each run."""
        return tuple(state.landed or 0.0 for state in self.states[-1])

    def controls(self, column: Column) -> None:
        self.starter(column, self.names()[1:], texts.LEARN_RUNS_START[bool(self.seed)])

    def draw(self, canvas: Canvas, box: pygame.FRect) -> None:
        half, shown = (box.width - 32) / 2, self.flown if self.states else self.choice
        for run, colour in enumerate[Colour]((NET, HUMAN)):
            left, name = box.left + run * (half + 32), self.names()[run * (shown + 1)]
            canvas.text(name, (left, box.top + 14), size=SMALL + 1, colour=colour, room=half)
            sky = pygame.FRect(left, box.top + 22, half, 0.36 * box.height)
            state = self.states[-1][run] if self.states else None
            draw_side_by_side(canvas, sky, state.flown if state else None, len(self.states))
            chart = pygame.FRect(left + 72, sky.bottom + 34, half - 72, box.bottom - sky.bottom - 44)
            top = self.ticks[-1]
            draw_axis(canvas, chart, [(tick / top, self.figure(tick)) for tick in self.ticks])
            if state:
                heights = np.clip(self.history(run, self.quantity) / top, 0.0, 1.0)
                draw_curve(canvas, chart, heights, colour, self.LENGTH)
                if (getattr(state, self.quantity) or 0.0) > top:  # off the chart
                    at = chart.left + chart.width * (len(self.states) - 1) / self.LENGTH
                    canvas.marker("triangle", (at, chart.top + 10), 10, colour)
                canvas.text(self.caption(state), (left, sky.bottom + 20), size=SMALL, tabular=True, room=half)


# Of the right-hand agent of `TargetChapter`, to choose from; the left one's target network is a copy made every 100
# gradient steps. In *modern*, too, the network that learns judges, and its layers are normalised.
RIGHT: Final = (
    SMALL_RUN.changed(target_update_interval=1),
    SMALL_RUN.changed(target_update_interval=1, layer_normalisation=True),
)
# No flight from any height below the ceiling can score more points than this: a landing is paid 120, and all else,
# coming down, slowing down and both feet, at most 160.
BOUND: Final = 300.0
_TOLD: Final = 20  # decisions after which a verdict is told anew
_MORE: Final = 0.2  # share of landings by which one agent is better than another


class TargetChapter(DuelChapter):
    """A guess from a guess: the left agent has a target network, the right one asks the network that changes."""

    key, quantity, ticks = "target", "value", (0.0, BOUND, 1000.0)

    def configs(self) -> Sequence[Config]:
        return SMALL_RUN, RIGHT[self.choice]

    def names(self) -> Sequence[str]:
        return texts.LEARN_TARGET_NAMES

    @property
    def peaks(self) -> tuple[float, ...]:
        """Largest value that each run expected of its landers so far, in points."""
        return tuple(float(np.nanmax(self.history(run, "value"))) for run in range(2))

    def update(self) -> None:
        """Tell of values that have run away at once, and anew while the runs go on."""
        super().update()
        if self.running and self.states and self.flown == 0 and self.peaks[1] > BOUND:
            self.came = 2
            self.tried, self.changed = True, self.changed or not self.tried or len(self.states) % _TOLD == 0

    def finish(self) -> None:
        if self.flown == 0:
            usual, other = self.landed
            kept = 0 if other > usual + _MORE else 1 if other >= usual - _MORE else 3
            self.came = 2 if self.peaks[1] > BOUND else kept

    def shown(self) -> str:
        (usual, other), (least, peak) = map(percent, self.landed), map(self.figure, self.peaks)
        done = self.states[-1][0].decisions  # the values go on while this stands there
        name = self.names()[self.flown + 1]
        return texts.LEARN_TARGET_WHY.format(done=done, name=name, peak=peak, least=least, usual=usual, other=other)

    def caption(self, state: SmallState) -> str:
        return texts.LEARN_TARGET_EXPECTS.format(points=self.figure(state.value))

    def figure(self, value: float) -> str:
        """Write points without decimals, however many they are."""
        return f"{round(value):+,}".replace("-", "−") if math.isfinite(value) and round(value) else points(value, 0)


DARING: Final = (0.0, 0.05, 0.2, 1.0)  # shares of random actions: of the left agent, and of the right one to choose
# Nothing is paid for coming nearer or slower: only time, fuel, feet on the pad and the end count.
PAY: Final = RewardWeights(distance=0.0, speed=0.0, alignment=0.0, tilt=0.0)
_LEARNED: Final = 0.5  # share of flights that land, from which an agent has learned it


class DaringChapter(DuelChapter):
    """Daring: the left agent never takes a random action, the right one as often as chosen."""

    key, quantity, ticks = "daring", "landed", (0.0, 0.5, 1.0)
    PLAN = Plan(heights=(5.0, 8.0))

    def configs(self) -> Sequence[Config]:
        return [
            SMALL_RUN.changed(n_step=5, reward_weights=PAY, epsilon_start=share, epsilon_end=share)
            for share in (DARING[0], DARING[self.choice + 1])
        ]

    def names(self) -> Sequence[str]:
        return [texts.LEARN_DARING_NAMES[share > 0].format(share=percent(share)) for share in DARING]

    def finish(self) -> None:
        if self.flown == 0:
            never, other = (landed >= _LEARNED for landed in self.landed)
            self.came = 2 if never and other else 0 if never else 1 if other else 3

    def shown(self) -> str:
        never, other = map(percent, self.landed)
        share = percent(DARING[self.flown + 1])
        return texts.LEARN_DARING_WHY.format(share=share, never=never, other=other, decisions=self.LENGTH)

    def caption(self, state: SmallState) -> str:
        if state.landed is None:
            return texts.LEARN_RUNS_NOTHING
        landed = texts.LEARN_RUNS_LANDED.format(share=percent(state.landed))
        return texts.LEARN_RUNS_FLIGHTS.format(count=min(state.flights, RECENT), landed=landed)

    def figure(self, value: float) -> str:
        return percent(value)
