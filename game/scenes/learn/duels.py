"""Chapters 8 and 10: two agents from the same seed that differ in one thing, the target's copy or random actions."""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Sequence
from typing import Final

import numpy as np
import pygame

from ai.agent.agent import DeepQAgent
from ai.agent.schedule import exploration
from ai.environment import Doubles
from ai.lander.rewards import RewardWeights
from ai.training.config import Config
from ai.training.small_run import SMALL_RUN, Plan, SmallState
from game.core import texts
from game.core.scene import Route
from game.drawing.canvas import Canvas
from game.drawing.tokens import CAPTION, HUMAN, MUTE, NET, NIGHT0, SMALL
from game.explain.figures import percent, points
from game.scenes.learn.chapter import Code
from game.scenes.learn.pictures import draw_axis, draw_curve
from game.scenes.learn.runs import RunsChapter, draw_landers
from game.ui.panel import Column

EVERY: Final = (1, 10, 100, 1)  # gradient steps between two copies, to choose from; the last with normalised layers
NORMALISED: Final = len(EVERY) - 1
# No flight from any height below the ceiling can score more points than this: what is paid for coming down and
# slowing down, for both feet and for landing comes to 280.
BOUND: Final = 300.0
DARING: Final = (0.0, 0.05, 0.2, 1.0)  # shares of random actions, to choose from
# Nothing is paid for coming nearer or slower: only time, fuel, feet on the pad and the end count.
PAY: Final = RewardWeights(distance=0.0, speed=0.0, alignment=0.0, tilt=0.0)
_TOP: Final = 10.0  # points of the scale of values that are linear; beyond, it is logarithmic
_HIGHEST, _LOWEST = 1e7, -1e2
_TICKS: Final = ((0.0, "0"), (1e3, "1,000"), (1e5, "100,000"), (1e7, "10,000,000"))
_MORE: Final = 0.2  # share of landings by which one agent is better than another
_LEARNED: Final = 0.5  # share of flights that land, from which an agent has learned it


class DuelChapter(RunsChapter):
    """Two agents; the right one is as the player chooses. A chart of one quantity stands below each."""

    door, shape = Route("train"), 0.6

    @property
    @abstractmethod
    def options(self) -> tuple[str, Sequence[str]]:
        """What is chosen, and the words of the choices."""

    @abstractmethod
    def name(self, run: int, choice: int) -> str:
        """Return the name of a run, the right one with its choice."""

    @abstractmethod
    def told(self, state: SmallState) -> str:
        """Return what is written beside a run's chart."""

    @abstractmethod
    def draw_chart(self, canvas: Canvas, box: pygame.FRect, run: int | None, colour: tuple[int, int, int]) -> None:
        """Draw the chart of a run; None before there is one."""

    @property
    def landed(self) -> tuple[float, ...]:
        """Share of the latest flights that landed, of each run."""
        return tuple(state.landed or 0.0 for state in self.states[-1])

    def controls(self, column: Column) -> None:
        label, words = self.options
        column.choice(label, words, self.choice, self.choose)
        self.starter(column, texts.LEARN_RUNS_START[bool(self.seed)])

    def draw(self, canvas: Canvas, box: pygame.FRect, alpha: float) -> None:
        half, shown = (box.width - 32) / 2, self.flown if self.states else self.choice
        for run, colour in enumerate((NET, HUMAN)):
            left = box.left + run * (half + 32)
            canvas.text(self.name(run, shown), (left, box.top + 14), size=SMALL + 1, colour=colour, room=half)
            sky = pygame.FRect(left, box.top + 22, half, 0.36 * box.height)
            state = self.states[-1][run] if self.states else None
            draw_landers(canvas, sky, state.flown if state else None, len(self.states))
            chart = pygame.FRect(left + 72, sky.bottom + 34, half - 72, box.bottom - sky.bottom - 44)
            self.draw_chart(canvas, chart, run if state else None, colour)
            if state:
                canvas.text(self.told(state), (left, sky.bottom + 20), size=SMALL, tabular=True, room=half)


class TargetChapter(DuelChapter):
    """A guess from a guess: the left agent's target network is a copy made every 100 gradient steps."""

    key = "target"

    def configs(self) -> Sequence[Config]:
        return SMALL_RUN, config_of(self.choice)

    @property
    def options(self) -> tuple[str, Sequence[str]]:
        return texts.LEARN_TARGET_LABEL, [*map(str, EVERY[:NORMALISED]), texts.LEARN_TARGET_NORMALISED]

    def name(self, run: int, choice: int) -> str:
        usual, some, always, normalised = texts.LEARN_TARGET_NAMES
        return {0: always, NORMALISED: normalised}.get(choice, some.format(every=EVERY[choice])) if run else usual

    @property
    def peaks(self) -> tuple[float, ...]:
        """Largest value that each run expected of its landers so far, in points."""
        return tuple(float(np.nanmax(self.history(run, "value"))) for run in range(2))

    def verdict(self) -> int | None:
        """Return what became of the agent without a copy that stands still; None if the right one had such."""
        usual, other = self.landed
        if self.flown:
            return None
        if self.peaks[1] > BOUND:
            return 2
        return 0 if other > usual + _MORE else 1 if other >= usual - _MORE else None

    def why(self) -> str:
        """Return what both expected at most, and how they landed in the end."""
        (usual, other), (least, peak) = map(percent, self.landed), map(_figure, self.peaks)
        key = "ran" if self.peaks[1] > BOUND else "kept"
        told = texts.LEARN_TARGET_WHY[key].format(peak=peak, usual=least, bound=f"{BOUND:g}")
        return f"{told} {texts.LEARN_TARGET_LANDED.format(usual=usual, other=other)}"

    def code(self) -> Sequence[Code]:
        discount = texts.LEARN_TARGET_DISCOUNT.format(discount=SMALL_RUN.discount)
        every = texts.LEARN_TARGET_EVERY.format(every=EVERY[self.choice])
        return [
            Code(DeepQAgent.targets, "targets", {"discount": discount}),
            Code(DeepQAgent._next_value, "values", {"values": texts.LEARN_TARGET_JUDGE}),
            Code(DeepQAgent._update_target, "gradient_steps", {"gradient_steps": every}),
        ]

    def told(self, state: SmallState) -> str:
        expects = texts.LEARN_TARGET_EXPECTS.format(points=_figure(state.value))
        return expects if state.landed is None else f"{expects}, {_landed(state)}"

    def draw_chart(self, canvas: Canvas, box: pygame.FRect, run: int | None, colour: tuple[int, int, int]) -> None:
        draw_axis(canvas, box, [(float(_height(np.array(tick))), word) for tick, word in _TICKS])
        y = box.bottom - box.height * float(_height(np.array(BOUND)))
        canvas.line((box.left, y), (box.right, y), MUTE, 1.5)
        if run is not None:
            draw_curve(canvas, box, _height(self.history(run, "value")), colour, self.LENGTH)
        said = texts.LEARN_TARGET_BOUND.format(bound=f"{BOUND:g}")
        width = min(canvas.text_width(said, size=CAPTION), box.width)
        canvas.fill(canvas.rect(box.right - width - 4, y - 18, width + 4, 16), NIGHT0)
        canvas.text(said, (box.right, y - 6), size=CAPTION, colour=MUTE, align="right", room=box.width)


def config_of(choice: int) -> Config:
    """Return the configuration of the right-hand agent of `TargetChapter`, by an index into `EVERY`."""
    return SMALL_RUN.changed(target_update_interval=EVERY[choice], layer_normalisation=choice == NORMALISED)


class DaringChapter(DuelChapter):
    """Daring: the left agent never takes a random action, the right one as often as chosen."""

    key, first = "daring", 1
    PLAN = Plan(heights=(5.0, 8.0))

    def configs(self) -> Sequence[Config]:
        return [
            SMALL_RUN.changed(n_step=5, reward_weights=PAY, epsilon_start=share, epsilon_end=share)
            for share in (DARING[0], DARING[self.choice])
        ]

    @property
    def options(self) -> tuple[str, Sequence[str]]:
        return texts.LEARN_DARING_LABEL, list(map(percent, DARING))

    def name(self, run: int, choice: int) -> str:
        return texts.LEARN_DARING_NAMES[run].format(share=percent(DARING[choice]))

    def verdict(self) -> int | None:
        """Return which of both lands at least half its flights; None for another share than that of the question."""
        if self.flown != 1:
            return None
        never, other = (landed >= _LEARNED for landed in self.landed)
        return 2 if never and other else 0 if never else 1 if other else 3

    def why(self) -> str:
        """Return how both landed in the end."""
        never, other = map(percent, self.landed)
        share = percent(DARING[self.flown])
        return texts.LEARN_DARING_WHY.format(share=share, never=never, other=other, decisions=self.LENGTH)

    def code(self) -> Sequence[Code]:
        share = f"ε = {DARING[self.choice]:g}"
        return [Code(DeepQAgent.act, "explore", {"explore": share}), Code(exploration)]

    def told(self, state: SmallState) -> str:
        if state.landed is None:
            return texts.LEARN_RUNS_NOTHING
        return texts.LEARN_RUNS_FLIGHTS.format(count=state.flights, landed=_landed(state))

    def draw_chart(self, canvas: Canvas, box: pygame.FRect, run: int | None, colour: tuple[int, int, int]) -> None:
        draw_axis(canvas, box, [(share, percent(share)) for share in (0.0, 0.5, 1.0)])
        if run is not None:
            draw_curve(canvas, box, self.history(run, "landed"), colour, self.LENGTH)


def _landed(state: SmallState) -> str:
    return texts.LEARN_RUNS_LANDED.format(share=percent(state.landed or 0.0))


def _height(values: Doubles) -> Doubles:
    """Return where points stand on the chart, 0 to 1: evenly near 0, by powers of ten beyond."""
    low, value, high = (
        np.sign(each) * np.log10(1 + np.abs(each) / _TOP) for each in (np.array(_LOWEST), values, np.array(_HIGHEST))
    )
    height: Doubles = np.clip((value - low) / (high - low), 0.0, 1.0)
    return height


def _figure(value: float) -> str:
    """Write points without decimals, however many they are."""
    return f"{round(value):+,}".replace("-", "−") if math.isfinite(value) and round(value) else points(value, 0)
