"""Chapter 8, a guess from a guess: the target network, and values that chase their own tail without it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final

import numpy as np
import pygame

from ai.agent.agent import DeepQAgent
from ai.environment import Doubles
from ai.training.config import Config
from ai.training.small_run import SMALL_RUN
from game.core import texts
from game.core.scene import Route
from game.drawing.canvas import Canvas
from game.drawing.tokens import HUMAN, LABEL, MUTE, NET, NIGHT0, SMALL, TEXT
from game.learn.chapter import STAGE, Code
from game.learn.runs import RunsChapter, draw_axis, draw_curve, draw_landers
from game.panels.q_values import signed
from game.ui.context import Context
from game.ui.widget import PointsManager, Widget
from game.ui.widgets import Choice

EVERY: Final = (1, 10, 100, 1)  # gradient steps between two copies, to choose from; the last with normalised layers
NORMALISED: Final = len(EVERY) - 1
# No flight from any height below the ceiling can score more points than this: what is paid for coming down and
# slowing down, for both feet and for landing comes to 280.
BOUND: Final = 300.0
_GAP: Final = 40.0
_HALF: Final = (STAGE.width - _GAP) / 2
_TOP: Final = 10.0  # points of the scale's linear part; beyond, it is logarithmic
_HIGHEST, _LOWEST = 1e7, -1e2
_CHART: Final = 150.0
_MORE: Final = 0.2  # share of landings by which one agent is better than another


class TargetChapter(RunsChapter):
    """Two agents from the same seed: the left one's target network is a copy made every 100 gradient steps.

    Attributes:
        choice: index into `EVERY`, of the right one.

    """

    key = "target"
    door = Route("train")

    def __init__(self, context: Context, manager: PointsManager) -> None:
        self.choice = self._flown = 0
        super().__init__(context, manager)

    def restart(self) -> None:
        """Forget the runs and the choice."""
        super().restart()
        self.choice = 0

    def configs(self) -> Sequence[Config]:
        """Return the configurations: that of all small runs, and the same with the chosen copies."""
        return SMALL_RUN, config_of(self.choice)

    def widgets(self) -> list[Widget]:
        """Return the choice, and the button that starts."""
        words = [*(f"{every:,}" for every in EVERY[:NORMALISED]), texts.LEARN_TARGET_NORMALISED]
        choice = Choice(
            self.manager,
            self.row(1),
            texts.LEARN_TARGET_LABEL,
            words,
            self.choice,
            self._choose,
            label_width=96,
            size=SMALL,
        )
        return [choice, self.starter(texts.LEARN_RUNS_START[bool(self.seed)])]

    def _choose(self, index: int) -> None:
        self.choice = index

    @property
    def peaks(self) -> tuple[float, ...]:
        """Largest value that each run expected of its landers so far, in points."""
        return tuple(float(np.nanmax(self.history(run, "value"))) for run in range(2))

    def verdict(self) -> int | None:
        """Return what became of the agent without a copy that stands still; None if the right one had such."""
        usual, other = (state.landed or 0.0 for state in self.states[-1])
        if self._flown:
            return None
        if self.peaks[1] > BOUND:
            return 2
        return 0 if other > usual + _MORE else 1 if other >= usual - _MORE else None

    def why(self, guess: int | None) -> str:  # noqa: ARG002
        """Return what both expected at most, and how they landed in the end."""
        usual, other = self.states[-1]
        peaks = self.peaks
        told = texts.LEARN_TARGET_WHY["ran" if peaks[1] > BOUND else "kept"].format(
            peak=_figure(peaks[1]), usual=_figure(peaks[0]), bound=f"{BOUND:g}"
        )
        landed = texts.LEARN_TARGET_LANDED.format(usual=usual.landed or 0.0, other=other.landed or 0.0)
        return f"{told} {landed}"

    def start(self) -> None:
        """Start both, with the choice as it is now."""
        self._flown = self.choice
        super().start()

    def code(self) -> Sequence[Code]:
        """Return how a target is made, and when the target network is copied."""
        every, discount = EVERY[self.choice], texts.LEARN_TARGET_DISCOUNT.format(discount=SMALL_RUN.discount)
        return [
            Code(DeepQAgent.targets, "targets", {"discount": discount}),
            Code(DeepQAgent._next_value, "values", {"values": texts.LEARN_TARGET_JUDGE}),
            Code(DeepQAgent._update_target, "gradient_steps", {
                "gradient_steps": texts.LEARN_TARGET_EVERY.format(every=every),
            }),
        ]  # fmt: skip

    # The picture

    def draw(self, canvas: Canvas, alpha: float) -> None:  # noqa: ARG002
        """Draw both groups of landers, and below each what its network expects."""
        usual, some, always, normalised = texts.LEARN_TARGET_NAMES
        shown = self._flown if self.states else self.choice
        other = {0: always, NORMALISED: normalised}.get(shown, some.format(every=f"{EVERY[shown]:,}"))
        names = (usual, other)
        for run, (name, colour) in enumerate(zip(names, (NET, HUMAN), strict=True)):
            box = pygame.FRect(STAGE.left + run * (_HALF + _GAP), STAGE.top + 22, _HALF, 168)
            canvas.text(name, (box.left, STAGE.top + 12), colour=colour, room=_HALF)
            state = self.states[-1][run] if self.states else None
            draw_landers(canvas, box, state.flown if state else None, self.last[run] if state else None,
                         len(self.states))  # fmt: skip
            chart = pygame.FRect(box.left + 70, box.bottom + 62, _HALF - 70, _CHART)
            draw_axis(canvas, chart, [(float(_height(np.array(tick))), word) for tick, word in _TICKS])
            bound = chart.bottom - _CHART * float(_height(np.array(BOUND)))
            canvas.line((chart.left, bound), (chart.right, bound), MUTE, 1.5)
            if state is not None:
                values = self.history(run, "value")
                draw_curve(canvas, chart, _height(values), colour, self.LENGTH)
            said = texts.LEARN_TARGET_BOUND.format(bound=f"{BOUND:g}")
            width = min(canvas.text_width(said, size=LABEL), chart.width)
            canvas.fill(canvas.rect(chart.right - width - 4, bound - 18, width + 4, 16), NIGHT0)
            canvas.text(said, (chart.right, bound - 6), size=LABEL, colour=MUTE, align="right", room=chart.width)
            if state is None:
                continue
            told = texts.LEARN_TARGET_EXPECTS.format(points=_figure(float(values[-1])))
            canvas.text(told, (box.left, box.bottom + 30), size=TEXT, tabular=True, room=_HALF * 0.62)
            if state.landed is not None:
                landed = texts.LEARN_RUNS_LANDED.format(share=state.landed)
                canvas.text(landed, (box.right, box.bottom + 30), size=SMALL, colour=MUTE, align="right",
                            tabular=True, room=_HALF * 0.36)  # fmt: skip
        self.draw_status(canvas)


def config_of(choice: int) -> Config:
    """Return the configuration of the right-hand agent, by an index into `EVERY`."""
    return SMALL_RUN.changed(target_update_interval=EVERY[choice], layer_normalisation=choice == NORMALISED)


_TICKS: Final = ((-100.0, "−100"), (0.0, "0"), (1e3, "1,000"), (1e5, "100,000"), (1e7, "10,000,000"))


def _bent(points: Doubles) -> Doubles:
    bent: Doubles = np.sign(points) * np.log10(1 + np.abs(points) / _TOP)
    return bent


def _height(points: Doubles) -> Doubles:
    """Return where points stand on the chart, 0 to 1: evenly near 0, by powers of ten beyond."""
    low, high = _bent(np.array(_LOWEST)), _bent(np.array(_HIGHEST))
    height: Doubles = np.clip((_bent(points) - low) / (high - low), 0.0, 1.0)
    return height


def _figure(points: float) -> str:
    if not math.isfinite(points):
        return signed(points)
    whole = round(points)
    return f"{whole:+,}".replace("-", "−") if whole else "0"
