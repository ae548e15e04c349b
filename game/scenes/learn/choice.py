"""Chapter 6, six values and what came: a frozen moment, an action to begin with, and the network flies on."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from itertools import pairwise
from typing import Final, NamedTuple

import numpy as np
import pygame

from ai.agent.agent import DeepQAgent
from ai.agent.decision import Decision
from ai.environment import Floats
from ai.lander.environment import ACTION_NAMES, PARAMS, LanderEnv, Outcome
from ai.training.config import Config
from game.core import texts
from game.core.catalogue import capital
from game.core.scene import Route
from game.drawing.canvas import Canvas
from game.drawing.paint import mix
from game.drawing.tokens import INK, NET, NIGHT1
from game.explain.figures import points
from game.explain.tables import Line, table
from game.flight import networks
from game.flight.networks import DECISION_STEPS
from game.scenes.learn.chapter import Chapter
from game.scenes.learn.pictures import draw_ground, draw_lander
from game.ui.context import Context
from game.ui.panel import Column
from game.world.camera import View

# Moments of flights of the shipped network: seed, kind of start, and decisions flown before.
MOMENTS: Final = (
    (1, "random", 0),
    (4, "random", 60),
    (9, "hard", 0),
    (2, "random", 25),
    (3, "hard", 50),
    (8, "random", 5),
)
_METRES, _BELOW, _ABOVE = 52.0, 1.2, 2.0  # metres: across the picture at least, below the ground, above the lander
_ALIKE: Final = 5.0  # points by which what came of two actions may differ and be about the same


class Came(NamedTuple):
    """What came of one flight: the pay in points, later pay counted less, and whether it landed."""

    points: float
    landed: bool


class Moment:
    """A frozen moment; a first action is chosen, and the shipped network flies on, paid as in training.

    Attributes:
        number: the moment, of `MOMENTS`.
        values: the network's values at the moment, in points, one an action.
        first: the action that was chosen; None before.
        came: pay since the moment, later pay counted less.
        path: where the lander was at the moment, and after each decision since.
        results: what came of each action that was tried from this moment.

    """

    first: int | None

    def __init__(self, agent: DeepQAgent) -> None:
        self.agent, self.number = agent, 0
        self.results: dict[int, Came] = {}
        self.freeze(0)

    def freeze(self, number: int) -> None:
        """Fly to a moment, and stop there; one that is new has no results."""
        if number != self.number:
            self.results.clear()
        self.number, self.first, self.came, self._steps = number, None, 0.0, 0
        seed, spawn, decisions = MOMENTS[number]
        self.env = LanderEnv(1, seed, spawn, frame_skip=1, weights=Config.of(self.agent).reward_weights)
        self.env.reset()
        for step in range(DECISION_STEPS * decisions):
            if step % DECISION_STEPS == 0:
                self._decide()
            self.env.step(self.decision.action)
        self._decide()
        assert self.decision.points is not None
        self.values: Floats = self.decision.points[0].copy()
        self.best, self.worst = int(self.values.argmax()), int(self.values.argmin())
        self.path = [self.env.position[0].copy()]

    def _decide(self) -> None:
        self.decision: Decision = self.agent.decide(self.env.observe(), held=self.env.actions)

    @property
    def over(self) -> bool:
        """Whether the flight from this moment has ended."""
        return self.first is not None and self.env.outcome[0] != Outcome.FLYING

    @property
    def running(self) -> bool:
        """Whether it goes on."""
        return self.first is not None and not self.over

    @property
    def landed(self) -> bool:
        """Whether it has landed."""
        return bool(self.env.outcome[0] == Outcome.LANDED)

    def begin_with(self, action: int) -> None:
        """Go back to the moment, and let the flight begin with an action for one decision."""
        self.freeze(self.number)
        self.first, self.decision = action, replace(self.decision, action=np.array([action]))

    def step(self) -> bool:
        """Advance a flight that goes on by 1/60 s; return whether it has come to its end."""
        assert self.first is not None
        if self._steps % DECISION_STEPS == 0 and self._steps:
            self._decide()
        pay = float(self.env.step(self.decision.action).reward[0])
        self.came += self.agent.config.discount ** (self._steps // DECISION_STEPS) * pay
        self._steps += 1
        if self._steps % DECISION_STEPS == 0:
            self.path.append(self.env.position[0].copy())
        ended = bool(self.env.outcome[0] != Outcome.FLYING)
        if ended:
            self.results[self.first] = Came(self.came, self.landed)
        return ended

    def verdict(self) -> int | None:
        """Return what came of the lowest value; None before it and the highest were flown, and where that was lost."""
        best, worst = self.results.get(self.best), self.results.get(self.worst)
        if best is None or worst is None or not best.landed:
            return None
        return 0 if not worst.landed else 1 if best.points - worst.points <= _ALIKE else 2


class ChoiceChapter(Chapter):
    """Moments, the actions to begin with, and a table of what each was said to bring, and what it brought."""

    key, door, shape = "choice", Route("watch"), 0.3
    model: Moment

    def __init__(self, context: Context) -> None:
        super().__init__(context)
        self.model = Moment(DeepQAgent.load(context.models_dir / networks.LANDER / networks.DEFAULT))

    def turn(self) -> None:
        """Go to the next moment."""
        self.model.freeze((self.model.number + 1) % len(MOMENTS))
        self.tried, self.changed = False, True

    def controls(self, column: Column) -> None:
        names = [capital(texts.said(name)) for name in ACTION_NAMES]
        column.words([(name, partial(self.begin_with, action)) for action, name in enumerate(names)], colour=INK)
        column.button(texts.LEARN_CHOICE_NEXT, self.turn)

    def begin_with(self, action: int) -> None:
        """Let a flight begin with an action."""
        self.model.begin_with(action)
        self.changed = True

    def update(self) -> None:
        if self.model.running:
            super().update()

    def why(self) -> str:
        return " ".join(
            texts.LEARN_CHOICE_WHY[came.landed].format(
                action=texts.said(ACTION_NAMES[action]),
                value=points(float(self.model.values[action]), 1),
                came=points(came.points, 1),
            )
            for action, came in list(self.model.results.items())[-2:]  # all stand in the table
        )

    def below(self, column: Column) -> None:
        column.add(table(("", *texts.LEARN_CHOICE_HEAD), self._lines))

    def _lines(self) -> Sequence[Line]:
        """Return each action with its value, and what came of it."""
        model, lines = self.model, list[Line]()
        for action, value in enumerate(model.values.tolist()):
            brought = points(model.results[action].points, 1) if action in model.results else ""
            lines.append(Line((texts.said(ACTION_NAMES[action]), points(value, 1), brought), lit=action == model.best))
        return lines

    def draw(self, canvas: Canvas, box: pygame.FRect) -> None:
        foot = PARAMS.ground - _BELOW
        high = max(_METRES * box.height / box.width, max(y for _, y in self.model.path) + _ABOVE - foot)
        view = View.within(box, canvas.scale, (0.0, foot + high / 2), box.height / high)
        with canvas.clipped(box):
            draw_ground(canvas, box, view)
            for a, b in pairwise(view.points(self.model.path).tolist()):
                canvas.line(a, b, mix(NIGHT1, NET, 0.6), 1.5)
            draw_lander(canvas, view, self.model.env)
