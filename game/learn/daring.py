"""Chapter 10, daring: exploration, and landers that never dare."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import pygame

from ai.agent.agent import DeepQAgent
from ai.agent.schedule import exploration
from ai.lander.rewards import RewardWeights
from ai.training.config import Config
from ai.training.small_run import SMALL_RUN, Plan
from game.core import texts
from game.core.scene import Route
from game.drawing.canvas import Canvas
from game.drawing.tokens import HUMAN, MUTE, NET, SMALL, TEXT
from game.learn.chapter import STAGE, Code
from game.learn.runs import RunsChapter, draw_axis, draw_curve, draw_landers
from game.ui.context import Context
from game.ui.widget import PointsManager, Widget
from game.ui.widgets import Choice

DARING: Final = (0.0, 0.05, 0.2, 1.0)  # shares of random actions, to choose from
# Nothing is paid for coming nearer or slower: only time, fuel, feet on the pad and the end count.
PAY: Final = RewardWeights(distance=0.0, speed=0.0, alignment=0.0, tilt=0.0)
_GAP: Final = 40.0
_HALF: Final = (STAGE.width - _GAP) / 2
_CHART: Final = 120.0
_LEARNED: Final = 0.5  # share of flights that land, from which an agent has learned it


class DaringChapter(RunsChapter):
    """Two agents from the same seed: the left one never takes a random action, the right one as often as chosen.

    Attributes:
        choice: index into `DARING`, of the right one.

    """

    key = "daring"
    door = Route("train")
    PLAN = Plan(heights=(5.0, 8.0))

    def __init__(self, context: Context, manager: PointsManager) -> None:
        self.choice = self._flown = 1
        super().__init__(context, manager)

    def restart(self) -> None:
        """Forget the runs and the choice."""
        super().restart()
        self.choice = 1

    def configs(self) -> Sequence[Config]:
        """Return a configuration without random actions, and the same with the chosen share of them."""
        return [
            SMALL_RUN.changed(n_step=5, reward_weights=PAY, epsilon_start=share, epsilon_end=share)
            for share in (DARING[0], DARING[self.choice])
        ]

    def widgets(self) -> list[Widget]:
        """Return the choice, and the button that starts."""
        words = [f"{share:.0%}" for share in DARING]
        choice = Choice(
            self.manager,
            self.row(1),
            texts.LEARN_DARING_LABEL,
            words,
            self.choice,
            self._choose,
            label_width=120,
            size=SMALL,
        )
        return [choice, self.starter(texts.LEARN_RUNS_START[bool(self.seed)])]

    def _choose(self, index: int) -> None:
        self.choice = index

    def start(self) -> None:
        """Start both, with the choice as it is now."""
        self._flown = self.choice
        super().start()

    def verdict(self) -> int | None:
        """Return which of both lands at least half its flights; None for another share than that of the question."""
        if self._flown != 1:
            return None
        never, other = ((state.landed or 0.0) >= _LEARNED for state in self.states[-1])
        return 2 if never and other else 0 if never else 1 if other else 3

    def why(self, guess: int | None) -> str:  # noqa: ARG002
        """Return how both landed in the end."""
        never, other = self.states[-1]
        return texts.LEARN_DARING_WHY.format(
            share=DARING[self._flown], never=never.landed or 0.0, other=other.landed or 0.0, decisions=self.LENGTH
        )

    def code(self) -> Sequence[Code]:
        """Return where an action is replaced by a random one, and the schedule."""
        share = f"ε = {DARING[self.choice]:g}"
        return [Code(DeepQAgent.act, "explore", {"explore": share}), Code(exploration)]

    def draw(self, canvas: Canvas, alpha: float) -> None:  # noqa: ARG002
        """Draw both groups of landers, and below each how many of its latest flights landed."""
        shown = self._flown if self.states else self.choice
        names = (texts.LEARN_DARING_NAMES[0], texts.LEARN_DARING_NAMES[1].format(share=DARING[shown]))
        for run, (name, colour) in enumerate(zip(names, (NET, HUMAN), strict=True)):
            box = pygame.FRect(STAGE.left + run * (_HALF + _GAP), STAGE.top + 22, _HALF, 208)
            canvas.text(name, (box.left, STAGE.top + 12), colour=colour, room=_HALF)
            state = self.states[-1][run] if self.states else None
            draw_landers(canvas, box, state.flown if state else None, self.last[run] if state else None,
                         len(self.states))  # fmt: skip
            chart = pygame.FRect(box.left + 46, box.bottom + 50, _HALF - 46, _CHART)
            draw_axis(canvas, chart, [(0.0, "0%"), (0.5, "50%"), (1.0, "100%")])
            if state is None:
                continue
            draw_curve(canvas, chart, self.history(run, "landed"), colour, self.LENGTH)
            told = (
                texts.LEARN_RUNS_NOTHING if state.landed is None else texts.LEARN_RUNS_LANDED.format(share=state.landed)
            )
            canvas.text(told, (box.left, box.bottom + 28), size=TEXT, tabular=True, room=_HALF * 0.6)
            flights = texts.LEARN_RUNS_FLIGHTS.format(count=state.flights)
            canvas.text(flights, (box.right, box.bottom + 28), size=SMALL, colour=MUTE, align="right", tabular=True,
                        room=_HALF * 0.36)  # fmt: skip
        self.draw_status(canvas)
