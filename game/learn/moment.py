"""Chapter 6, the value of a moment: guess the score to come, then let the flight go on and compare."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Final, NamedTuple

import numpy as np
import pygame

from ai.agent.agent import DeepQAgent
from ai.agent.decision import Decision, in_points
from ai.environment import Floats
from ai.lander.environment import LanderEnv, Outcome
from ai.nn import NeuralNetwork
from ai.training.config import Config
from game.core import texts
from game.core.scene import Route
from game.drawing.canvas import Canvas
from game.drawing.paint import mix
from game.drawing.prose import draw_wrapped
from game.drawing.tokens import FAINT, HUMAN, INK, LABEL, LINE, MUTE, NET, NIGHT1, SMALL, TEXT, Colour
from game.flight import networks
from game.flight.flight import DECISION_STEPS
from game.learn.chapter import STAGE, Chapter, Code
from game.learn.small_flight import DrawnLander, inside, view_in
from game.panels.q_values import signed
from game.ui.context import Context
from game.ui.widget import PointsManager, Widget
from game.ui.widgets import Slider, TextButton

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
_WORLD: Final = pygame.FRect(STAGE.left, STAGE.top, STAGE.width, 292)
_MIDDLE: Final = (0.0, 9.4)  # metres, of the picture
_METRES: Final = 50.0  # across the picture
_PATH: Final = mix(NIGHT1, NET, 0.6)
_LINE: Final = STAGE.top + 366  # y of the line of points
_ANSWERS: Final = (150.0, 80.0, 20.0)  # points of the answers, before that of less than 0
_ASKED: Final = range(80, 121)  # decisions until the end, that are about the hundred of the question


class Judged(NamedTuple):
    """What three judges said of one moment, in points.

    Attributes:
        guess: the player's.
        value: the network's.
        came: the discounted pay that came.
        plain: the same pay without the discount.
        decisions: decisions until the end.
        decision: the network's at the moment.

    """

    guess: float
    value: float
    came: float
    plain: float
    decisions: int
    decision: Decision


class MomentChapter(Chapter):
    """A frozen moment of a flight of the shipped network; it flies on, and is paid as it was in training.

    Attributes:
        agent: the network; None if it could not be read, and `problem` then says why.
        guess: the player's, in points.
        value: the network's value of the moment, in points.
        came, plain: pay since the moment, with and without the discount.
        judged: the moments that have been flown to their ends.

    """

    key = "moment"
    door = Route("watch")

    def __init__(self, context: Context, manager: PointsManager) -> None:
        super().__init__(context, manager)
        network = networks.chosen(context.models_dir, context.user_dir)
        self.agent = network.policy if isinstance(network.policy, DeepQAgent) else None
        self.problem = network.problem
        self.judged: list[Judged] = []
        self.restart()

    def restart(self) -> None:
        """Begin with the first moment, and forget what was judged."""
        self._number = 0
        self.tried = False
        self.judged.clear()
        self._freeze()

    def _freeze(self) -> None:
        """Fly to the moment, and stop there."""
        self.guess = self.came = self.plain = self.value = 0.0
        self.flying, self._steps = False, 0
        if self.agent is None:
            return
        seed, spawn, decisions = MOMENTS[self._number]
        self.env = LanderEnv(1, seed, spawn, frame_skip=1, weights=Config.of(self.agent).reward_weights)
        self.env.reset()
        for step in range(DECISION_STEPS * decisions):
            if step % DECISION_STEPS == 0:
                self._decide()
            self.env.step(self.decision.action)
        self._decide()
        self._first = self.decision
        self.value = float(self.points.max())
        self._lander = DrawnLander(self.env)
        self._path = [self.env.position[0].copy()]

    def _decide(self) -> None:
        assert self.agent is not None
        self.decision: Decision = self.agent.decide(self.env.observe(), held=self.env.actions)

    @property
    def points(self) -> Floats:
        """Value of each action at the latest decision, in points, (6,)."""
        assert self.decision.points is not None
        points: Floats = self.decision.points[0]
        return points

    @property
    def over(self) -> bool:
        """Whether the flight from this moment has ended."""
        return self.agent is not None and self.flying and self.env.outcome[0] != Outcome.FLYING

    @property
    def words(self) -> dict[str, str]:
        """The chapter's texts; what to do becomes how to read the figures, once it flies."""
        words = super().words
        return {**words, "task": texts.LEARN_MOMENT_FLOWN} if self.flying else words

    def widgets(self) -> list[Widget]:
        """Return the slider for the guess, and what to press."""
        if self.agent is None:
            return []
        if self.flying:
            return [TextButton(self.manager, self.row(3), texts.LEARN_MOMENT_NEXT, self.turn, colour=INK)]
        slider = Slider(self.manager, self.row(1), texts.LEARN_MOMENT_GUESS, self.guess, SCALE, self.set_guess,
                        step=5, figure=_whole, label_width=120, colour=HUMAN)  # fmt: skip
        go = TextButton(self.manager, self.row(3), texts.LEARN_MOMENT_GO, self.go, colour=INK)
        return [slider, go]

    def set_guess(self, points: float) -> None:
        """Set the player's guess."""
        self.guess = points

    def go(self) -> None:
        """Let the network fly on."""
        self.flying = self.changed = True

    def turn(self) -> None:
        """Go to the next moment."""
        self._number = (self._number + 1) % len(MOMENTS)
        self._freeze()
        self.changed = True

    def update(self) -> None:
        """Fly one physics step, and add what it is paid; every decision counts a little less than the one before."""
        if self.agent is None or not self.flying or self.over:
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
        if self.env.outcome[0] != Outcome.FLYING:
            decisions = -(-self._steps // DECISION_STEPS)
            self.judged.append(Judged(self.guess, self.value, self.came, self.plain, decisions, self._first))
            self.tried = True

    # What it tells

    def verdict(self) -> int | None:
        """Return the answer next to what came of the last moment; None if it was not about a hundred decisions."""
        last = self.judged[-1]
        if last.decisions not in _ASKED:
            return None
        return len(_ANSWERS) if last.came < 0 else int(np.argmin(np.abs(np.array(_ANSWERS) - last.came)))

    def why(self, guess: int | None) -> str:  # noqa: ARG002
        """Return the last moment's numbers, and how far off both judges were on average."""
        assert self.agent is not None
        last = self.judged[-1]
        told = texts.LEARN_MOMENT_WHY.format(
            guess=signed(last.guess), value=signed(last.value), came=signed(last.came), plain=signed(last.plain),
            decisions=last.decisions, discount=self.agent.config.discount,
            last=f"{self.agent.config.discount ** (last.decisions - 1):.2f}",
        )  # fmt: skip
        if len(self.judged) == 1:
            return told
        yours, its = (np.mean([abs(said - each.came) for said, each in pairs]) for pairs in (
            [(each.guess, each) for each in self.judged], [(each.value, each) for each in self.judged]
        ))  # fmt: skip
        return f"{told} {texts.LEARN_MOMENT_MISSED.format(count=len(self.judged), yours=yours, its=its)}"

    def code(self) -> Sequence[Code]:
        """Return the network's answer, its unit, and the target it was taught with."""
        if self.agent is None:
            return [Code(DeepQAgent.q_values), Code(in_points), Code(DeepQAgent.targets)]
        config, told = self.agent.config, self.judged[-1].decision if self.judged else self._first
        assert told.values is not None
        assert told.points is not None
        best = f"{float(told.values.max()):.3f}"
        scaled = f"{best} / {config.reward_scale:g} = {signed(float(told.points.max()))}"
        return [
            Code(DeepQAgent.q_values, NeuralNetwork.predict, {
                NeuralNetwork.predict: texts.LEARN_MOMENT_BEST.format(value=best),
            }),
            Code(in_points, "points", {"points": scaled}),
            Code(DeepQAgent.targets, "targets", {
                "discount": f"γ = {config.discount:g}, {config.n_step}",
            }),
        ]  # fmt: skip

    # The picture

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw the flight, and the line of points below it."""
        if self.agent is None:
            draw_wrapped(canvas, self.problem, (STAGE.left, STAGE.top + 40), STAGE.width, size=TEXT, leading=22)
            return
        view = view_in(_WORLD, _MIDDLE, _METRES, canvas.scale)
        params = self.env.params
        with inside(canvas, _WORLD):
            half = params.pad_width / 2
            (_, ground), (left, pad), (right, _) = view.points(
                [(0.0, params.ground), (-half, params.pad_top), (half, params.pad_top)]
            ).tolist()
            canvas.line((_WORLD.left, ground), (_WORLD.right, ground), FAINT)
            canvas.line((left, pad), (right, pad), MUTE, 3)
            places = view.points(self._path).tolist()
            for a, b in pairwise(places):
                canvas.line(a, b, _PATH, 1.5)
            self._lander.draw(canvas, view, alpha if self.flying and not self.over else 1.0)
            if not self.flying:
                start = self.env.position[0]
                a, b = view.points([start, start + self.env.velocity[0]]).tolist()
                canvas.line(a, b, HUMAN, 2)
        self._draw_state(canvas)
        self._draw_line(canvas)

    def _draw_state(self, canvas: Canvas) -> None:
        number = texts.LEARN_MOMENT_NUMBER.format(number=self._number + 1, count=len(MOMENTS))
        canvas.text(number, (STAGE.left, STAGE.top + 14), size=SMALL, colour=MUTE)
        if self.over:
            told = texts.LEARN_MOMENT_ENDS["landed" if self.env.outcome[0] == Outcome.LANDED else "lost"]
        else:
            told = texts.LEARN_MOMENT_ENDS["flying" if self.flying else "still"]
        canvas.text(told, (STAGE.right, STAGE.top + 14), size=SMALL, colour=MUTE, align="right")

    def _x(self, points: float) -> float:
        low, high = SCALE
        return STAGE.left + 16 + (STAGE.width - 32) * min(max((points - low) / (high - low), 0.0), 1.0)

    def _draw_line(self, canvas: Canvas) -> None:
        canvas.line((self._x(SCALE[0]), _LINE), (self._x(SCALE[1]), _LINE), LINE, 2)
        for tick in np.arange(SCALE[0], SCALE[1] + 1, 50.0):
            x = self._x(tick)
            canvas.line((x, _LINE - 4), (x, _LINE + 4), MUTE if tick == 0 else FAINT)
            canvas.text(f"{tick:g}".replace("-", "−"), (x, _LINE + 22), size=LABEL, colour=MUTE, align="centre")
        figures: list[tuple[str, str, Colour]] = [(texts.LEARN_MOMENT_GUESS, signed(self.guess), HUMAN)]
        canvas.marker("triangle_down", (self._x(self.guess), _LINE - 12), 11, HUMAN)
        if self.flying:
            canvas.marker("triangle", (self._x(self.value), _LINE - 28), 11, NET)
            canvas.line((self._x(self.value), _LINE - 22), (self._x(self.value), _LINE), NET)
            canvas.dot((self._x(self.came), _LINE), 6, INK)
            figures += [
                (texts.LEARN_MOMENT_VALUE, signed(self.value), NET),
                (texts.LEARN_MOMENT_CAME if self.over else texts.LEARN_MOMENT_SO_FAR, signed(self.came), INK),
                (texts.LEARN_MOMENT_PLAIN, signed(self.plain), MUTE),
            ]
        width = STAGE.width / 4
        for column, (name, figure, colour) in enumerate(figures):
            x = STAGE.left + 16 + column * width
            canvas.text(name, (x, _LINE + 54), size=SMALL, colour=MUTE, room=width - 16)
            canvas.text(figure, (x, _LINE + 80), size=20, colour=colour, weight="light", tabular=True)


def _whole(points: float) -> str:
    return signed(points).partition(".")[0]
