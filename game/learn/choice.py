"""Chapter 7, six values: a network takes the highest, and what comes of any other is tried from the same moment."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from typing import NamedTuple

import numpy as np

from ai.agent.agent import DeepQAgent
from ai.lander.environment import ACTION_NAMES, NUM_ACTIONS, Outcome
from ai.nn import NeuralNetwork
from game.core import texts
from game.core.scene import Route
from game.drawing.canvas import Canvas
from game.drawing.tokens import HUMAN, INK, LABEL, LINE, MUTE, NET, SMALL
from game.learn.chapter import STAGE, Code
from game.learn.moment import MomentChapter
from game.panels.q_values import signed
from game.ui.context import Context
from game.ui.widget import PointsManager, Widget
from game.ui.widgets import TextButton

_ALIKE = 5.0  # points by which what came of two actions may differ and be about the same
_FIRST = STAGE.top + 322  # baseline of the first of the six rows
_ROW = 21.0
_LEFT, _RIGHT = STAGE.left + 210, STAGE.right - 100  # ends of the scale


class Came(NamedTuple):
    """What came of a flight that began with one action: discounted pay in points, and whether it landed."""

    points: float
    landed: bool


class ChoiceChapter(MomentChapter):
    """A frozen moment; the player chooses its first action, and the network flies on from there.

    Attributes:
        first: the action that was chosen; None before.
        results: what came of each action that was tried from this moment.

    """

    key = "choice"
    door = Route("watch")

    def __init__(self, context: Context, manager: PointsManager) -> None:
        self.first: int | None = None
        self.results: dict[int, Came] = {}
        super().__init__(context, manager)

    def _freeze(self) -> None:
        super()._freeze()
        self.first = None
        self.values = self.points.copy() if self.agent is not None else np.zeros(NUM_ACTIONS, np.float32)

    def restart(self) -> None:
        """Begin with the first moment, and forget what came of it."""
        self.results = {}
        super().restart()

    def turn(self) -> None:
        """Go to the next moment."""
        self.results = {}
        super().turn()

    @property
    def words(self) -> dict[str, str]:
        """The chapter's texts."""
        return texts.LEARN[self.key]

    def widgets(self) -> list[Widget]:
        """Return a button for each action, and what goes on to the next moment."""
        if self.agent is None:
            return []
        actions: list[Widget] = [
            TextButton(self.manager, self.row(action), texts.said(name).capitalize(), partial(self.begin_with, action),
                       size=SMALL + 1, colour=NET if action == self.best else INK)
            for action, name in enumerate(ACTION_NAMES)
        ]  # fmt: skip
        return [*actions, TextButton(self.manager, self.row(NUM_ACTIONS + 1), texts.LEARN_MOMENT_NEXT, self.turn)]

    def begin_with(self, action: int) -> None:
        """Go back to the moment, and let the flight begin with an action for one decision."""
        self._freeze()
        self.first = action
        self.decision = replace(self.decision, action=np.array([action]))
        self.go()

    def update(self) -> None:
        """Fly on; keep what came of the action."""
        before = len(self.judged)
        super().update()
        if len(self.judged) > before and self.first is not None:
            self.results[self.first] = Came(self.came, bool(self.env.outcome[0] == Outcome.LANDED))
            self.tried = len(self.results) > 1
            self.changed = True

    @property
    def best(self) -> int:
        """The action with the highest value."""
        return int(self.values.argmax())

    @property
    def worst(self) -> int:
        """The action with the lowest value."""
        return int(self.values.argmin())

    # What it tells

    def verdict(self) -> int | None:
        """Return what came of the lowest value; None before it and the highest were flown, and where that was lost."""
        if not {self.best, self.worst} <= set(self.results) or not self.results[self.best].landed:
            return None
        best, worst = self.results[self.best], self.results[self.worst]
        return 0 if not worst.landed else 1 if best.points - worst.points <= _ALIKE else 2

    def why(self, guess: int | None) -> str:  # noqa: ARG002
        """Return the value of each action that was tried, and what came of it."""
        told = " ".join(
            texts.LEARN_CHOICE_WHY[came.landed].format(
                action=texts.said(ACTION_NAMES[action]), value=signed(float(self.values[action])),
                came=signed(came.points),
            )
            for action, came in self.results.items()
        )  # fmt: skip
        best = self.results.get(self.best)
        surprises = best is not None and best.points < max(came.points for came in self.results.values())
        return f"{told} {texts.LEARN_CHOICE_SURPRISE}" if surprises else told

    def code(self) -> Sequence[Code]:
        """Return where the six values come from, and where the highest is taken."""
        if self.agent is None:
            return [Code(DeepQAgent.q_values), Code(DeepQAgent.decide)]
        best = texts.said(ACTION_NAMES[self.best])
        return [
            Code(DeepQAgent.q_values, NeuralNetwork.predict, {NeuralNetwork.predict: best}),
            Code(DeepQAgent.decide),
        ]

    # The picture

    def _draw_line(self, canvas: Canvas) -> None:
        """Draw the six values, and beside each what came of it."""
        shown = [*self.values.tolist(), *(came.points for came in self.results.values())]
        low, high = min(shown) - 2.0, max(shown) + 2.0
        canvas.text(texts.LEARN_CHOICE_LEGEND, (STAGE.left + 16, _FIRST - 22), size=LABEL, colour=MUTE,
                    room=STAGE.width - 32)  # fmt: skip
        for action, value in enumerate(self.values.tolist()):
            y, best = _FIRST + _ROW * action, action == self.best
            colour = NET if best else INK if action == self.first else MUTE
            canvas.text(texts.said(ACTION_NAMES[action]), (STAGE.left + 16, y), size=SMALL, colour=colour, room=110)
            canvas.text(signed(value), (_LEFT - 16, y), size=SMALL, colour=colour, align="right", tabular=True)
            canvas.line((_LEFT, y - 4), (_RIGHT, y - 4), LINE)
            x = _LEFT + (_RIGHT - _LEFT) * (value - low) / (high - low)
            canvas.marker("triangle", (x, y - 4), 9, NET if best else MUTE)
            if (came := self.results.get(action)) is None:
                continue
            x = _LEFT + (_RIGHT - _LEFT) * (came.points - low) / (high - low)
            canvas.dot((x, y - 4), 4, HUMAN)
            canvas.text(
                signed(came.points), (STAGE.right - 16, y), size=SMALL, colour=HUMAN, align="right", tabular=True
            )
