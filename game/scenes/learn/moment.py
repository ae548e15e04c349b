"""Chapters 6 and 7: what a moment is worth, and six values, of which a network takes the highest."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from itertools import pairwise
from typing import Final, NamedTuple

import numpy as np
import pygame

from ai.agent.agent import DeepQAgent
from ai.agent.decision import Decision, in_points
from ai.environment import Floats
from ai.lander.environment import ACTION_NAMES, PARAMS, LanderEnv, Outcome
from ai.nn import NeuralNetwork
from ai.training.config import Config
from game.core import texts
from game.core.catalogue import capital
from game.core.scene import Route
from game.drawing.canvas import Canvas
from game.drawing.paint import mix
from game.drawing.tokens import HUMAN, INK, MUTE, NET, NIGHT1, SMALL
from game.explain.figures import decimal, points
from game.explain.tables import Line, Part, formula, from_zero, table
from game.flight import networks
from game.flight.flight import DECISION_STEPS
from game.scenes.learn.chapter import Chapter, Code
from game.scenes.learn.pictures import DrawnLander, draw_ground, inside, view_in
from game.ui.context import Context
from game.ui.panel import Column

# Moments of flights of the shipped network: seed, kind of start, and decisions flown before.
MOMENTS: Final = (
    (1, "random", 0),
    (4, "random", 60),
    (9, "hard", 0),
    (2, "random", 25),
    (3, "hard", 50),
    (8, "random", 5),
)
SCALE: Final = (-150.0, 200.0)  # points, of the line
_METRES, _BELOW, _ABOVE = 52.0, 1.2, 2.0  # metres: across the picture at least, below the ground, above the lander
_ANSWERS: Final = (140.0, 80.0, 30.0)  # points of the answers, before that of less than 0
_ASKED: Final = range(80, 121)  # decisions until the end, that are about the hundred of the question
_BAR, _ROOM = 50.0, 1.5  # the scale of the six values: in steps of so many points, so many times the largest
_ALIKE: Final = 5.0  # points by which what came of two actions may differ and be about the same


class Came(NamedTuple):
    """What came of one flight: two guesses, the pay with and without the discount in points, decisions to its end."""

    guess: float
    value: float
    came: float
    plain: float
    decisions: int
    landed: bool
    decision: Decision  # the network's at the moment


class MomentChapter(Chapter):
    """A frozen moment of a flight of the shipped network; it flies on, and is paid as it was in training.

    Attributes:
        guess, value: what the player and the network expect, in points; `values` are the network's, one an action.
        came, plain: pay since the moment, with and without the discount.
        judged: the moments that have been flown to their ends.

    """

    key, door, shape = "moment", Route("watch"), 0.38
    flying = False

    def __init__(self, context: Context) -> None:
        super().__init__(context)
        network = networks.load(networks.DEFAULT, context.models_dir / networks.LANDER / networks.DEFAULT)
        self.judged: list[Came] = []
        if isinstance(network.policy, DeepQAgent):
            self.agent = network.policy
            self.restart()
        else:
            self.problem = network.problem

    def restart(self) -> None:
        self._number, self.tried = 0, False
        self.judged.clear()
        self._freeze()

    def _freeze(self) -> None:
        """Fly to the moment, and stop there."""
        self.guess = self.came = self.plain = 0.0
        self.flying, self._steps = False, 0
        seed, spawn, decisions = MOMENTS[self._number]
        self.env = LanderEnv(1, seed, spawn, frame_skip=1, weights=Config.of(self.agent).reward_weights)
        self.env.reset()
        for step in range(DECISION_STEPS * decisions):
            if step % DECISION_STEPS == 0:
                self._decide()
            self.env.step(self.decision.action)
        self._decide()
        self._first = self.decision
        assert self.decision.points is not None
        self.values: Floats = self.decision.points[0].copy()
        self.value = float(self.values.max())
        self._lander, self._path = DrawnLander(self.env), [self.env.position[0].copy()]

    def _decide(self) -> None:
        self.decision: Decision = self.agent.decide(self.env.observe(), held=self.env.actions)

    @property
    def over(self) -> bool:
        """Whether the flight from this moment has ended."""
        return self.flying and self.env.outcome[0] != Outcome.FLYING

    @property
    def running(self) -> bool:
        return self.flying and not self.over

    @property
    def words(self) -> dict[str, str]:
        words = super().words
        return {**words, "task": words["flown"]} if self.flying and "flown" in words else words

    def controls(self, column: Column) -> None:
        if self.flying:
            column.button(texts.LEARN_MOMENT_NEXT, self.turn, colour=INK)
        else:
            column.slider(texts.LEARN_MOMENT_GUESS, self.guess, SCALE, self.set_guess, step=5,
                          figure=lambda guess: points(guess, 0))  # fmt: skip
            column.button(texts.LEARN_MOMENT_GO, self.go, colour=INK)

    def set_guess(self, guess: float) -> None:
        """Set the player's guess."""
        self.guess = guess

    def go(self) -> None:
        """Let the network fly on."""
        self.flying = self.changed = True

    def turn(self) -> None:
        """Go to the next moment."""
        self._number = (self._number + 1) % len(MOMENTS)
        self._freeze()
        self.changed = True

    def update(self) -> None:
        if not self.running:
            return
        if self._steps % DECISION_STEPS == 0 and self._steps:
            self._decide()
        pay = float(self.env.step(self.decision.action).reward[0])
        self.came += self.agent.config.discount ** (self._steps // DECISION_STEPS) * pay
        self.plain += pay
        self._steps += 1
        self._lander.follow()
        if self._steps % DECISION_STEPS == 0:
            self._path.append(self.env.position[0].copy())
        if self.over:
            landed, decisions = bool(self.env.outcome[0] == Outcome.LANDED), -(-self._steps // DECISION_STEPS)
            self.end(Came(self.guess, self.value, self.came, self.plain, decisions, landed, self._first))

    def end(self, came: Came) -> None:
        """Keep what came of the flight."""
        self.judged.append(came)
        self.tried = self.changed = True

    def verdict(self) -> int | None:
        """Return the answer next to what came of the last flight of about a hundred decisions; None before one."""
        came = next((each.came for each in reversed(self.judged) if each.decisions in _ASKED), None)
        if came is None:
            return None
        return len(_ANSWERS) if came < 0 else int(np.argmin(np.abs(np.array(_ANSWERS) - came)))

    def why(self) -> str:
        last = self.judged[-1]
        sentence = texts.LEARN_MOMENT_WHY.format(
            guess=points(last.guess, 1),
            value=points(last.value, 1),
            came=points(last.came, 1),
            plain=points(last.plain, 1),
            decisions=last.decisions,
            last=f"{self.agent.config.discount ** (last.decisions - 1):.2f}",
        )
        if len(self.judged) == 1:
            return sentence
        said = [(each.guess, each.value) for each in self.judged]
        yours, its = np.abs(np.array(said) - [[each.came] for each in self.judged]).mean(axis=0)
        return f"{sentence} {texts.LEARN_MOMENT_MISSED.format(count=len(self.judged), yours=yours, its=its)}"

    def code(self) -> Sequence[Code]:
        config, decision = self.agent.config, self.judged[-1].decision if self.judged else self._first
        assert decision.values is not None
        assert decision.points is not None
        best = decimal(float(decision.values.max()), 3)
        scaled = f"{best} / {config.reward_scale:g} = {points(float(decision.points.max()), 1)}"
        asked = texts.LEARN_MOMENT_BEST.format(value=best)
        return [
            Code(DeepQAgent.q_values, NeuralNetwork.predict, {NeuralNetwork.predict: asked}),
            Code(in_points, "points", {"points": scaled}),
            Code(DeepQAgent.targets, "targets", {"discount": f"γ = {config.discount:g}, {config.n_step}"}),
        ]

    def below(self, column: Column) -> None:
        column.add(formula(self._figures))

    def _figures(self) -> list[Part]:
        """Return the guesses, and what came."""
        guess = Part(points(self.guess, 0), texts.LEARN_MOMENT_GUESS, colour=HUMAN)
        if not self.flying:
            return [guess]
        came = texts.LEARN_MOMENT_CAME if self.over else texts.LEARN_MOMENT_SO_FAR
        return [
            guess,
            Part(points(self.value, 1), texts.LEARN_MOMENT_VALUE, colour=NET),
            Part(points(self.came, 1), came),
            Part(points(self.plain, 1), texts.LEARN_MOMENT_PLAIN, colour=MUTE),
        ]

    def draw(self, canvas: Canvas, box: pygame.FRect, alpha: float) -> None:
        foot = PARAMS.ground - _BELOW
        high = max(_METRES * box.height / box.width, max(y for _, y in self._path) + _ABOVE - foot)
        view = view_in(box, (0.0, foot + high / 2), high * box.width / box.height, canvas.scale)
        with inside(canvas, box):
            draw_ground(canvas, box, view)
            for a, b in pairwise(view.points(self._path).tolist()):
                canvas.line(a, b, mix(NIGHT1, NET, 0.6), 1.5)
            self._lander.draw(canvas, view, alpha if self.running else 1.0)
            if not self.flying:
                start = self.env.position[0]
                a, b = view.points([start, start + self.env.velocity[0]]).tolist()
                canvas.line(a, b, HUMAN, 2)
        number = texts.LEARN_MOMENT_NUMBER.format(number=self._number + 1, count=len(MOMENTS))
        landed = "landed" if self.over and self.env.outcome[0] == Outcome.LANDED else "lost"
        end = texts.LEARN_MOMENT_ENDS[landed if self.over else "flying" if self.flying else "still"]
        canvas.text(number, (box.left, box.top + 14), size=SMALL, colour=MUTE)
        canvas.text(end, (box.right, box.top + 14), size=SMALL, colour=MUTE, align="right")


class ChoiceChapter(MomentChapter):
    """A frozen moment; the player chooses its first action, and the network flies on from there.

    Attributes:
        first: the action that was chosen; None before.
        results: what came of each action that was tried from this moment.

    """

    key, shape = "choice", 0.3

    def __init__(self, context: Context) -> None:
        self.results: dict[int, Came] = {}
        super().__init__(context)

    def restart(self) -> None:
        self.results.clear()
        super().restart()

    def turn(self) -> None:
        self.tried = False
        self.results.clear()
        super().turn()

    def _freeze(self) -> None:
        super()._freeze()
        self.first: int | None = None
        self.best, self.worst = int(self.values.argmax()), int(self.values.argmin())

    def controls(self, column: Column) -> None:
        for action, name in enumerate(ACTION_NAMES):
            colour, press = NET if action == self.best else INK, partial(self.begin_with, action)
            column.button(capital(texts.said(name)), press, size=SMALL + 1, colour=colour)
        column.button(texts.LEARN_MOMENT_NEXT, self.turn)

    def begin_with(self, action: int) -> None:
        """Go back to the moment, and let the flight begin with an action for one decision."""
        self._freeze()
        self.first, self.decision = action, replace(self.decision, action=np.array([action]))
        self.go()

    def end(self, came: Came) -> None:
        super().end(came)
        if self.first is not None:
            self.results[self.first] = came
        self.tried = len(self.results) > 1

    def verdict(self) -> int | None:
        """Return what came of the lowest value; None before it and the highest were flown, and where that was lost."""
        best, worst = self.results.get(self.best), self.results.get(self.worst)
        if best is None or worst is None or not best.landed:
            return None
        return 0 if not worst.landed else 1 if best.came - worst.came <= _ALIKE else 2

    def why(self) -> str:
        sentences = " ".join(
            texts.LEARN_CHOICE_WHY[came.landed].format(
                action=texts.said(ACTION_NAMES[action]),
                value=points(float(self.values[action]), 1),
                came=points(came.came, 1),
            )
            for action, came in self.results.items()
        )
        best = self.results.get(self.best)
        surprises = best is not None and best.came < max(came.came for came in self.results.values())
        return f"{sentences} {texts.LEARN_CHOICE_SURPRISE}" if surprises else sentences

    def code(self) -> Sequence[Code]:
        best = texts.said(ACTION_NAMES[self.best])
        return [
            Code(DeepQAgent.q_values, NeuralNetwork.predict, {NeuralNetwork.predict: best}),
            Code(DeepQAgent.decide),
        ]

    def below(self, column: Column) -> None:
        column.add(table(("", *texts.LEARN_CHOICE_HEAD), self._lines))

    def _lines(self) -> list[Line]:
        """Return each action with its value, and what came of it; bars begin at 0, on one scale for the moment."""
        came = {action: each.came for action, each in self.results.items()}
        shown = [*self.values.tolist(), *came.values()]
        high, lines = _BAR * math.ceil(_ROOM * max(float(np.abs(self.values).max()), 1.0) / _BAR), list[Line]()
        low = -high if min(shown) < 0 else 0.0
        for action, value in enumerate(self.values.tolist()):
            brought = points(came[action], 1) if action in came else ""
            bars = [from_zero(each, low, high) for each in (value, came.get(action, 0.0))]
            cells = (texts.said(ACTION_NAMES[action]), points(value, 1), brought)
            lines.append(Line(cells, lit=action == self.best, bars=bars))
        return lines
