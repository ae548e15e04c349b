"""Chapter 1, one neuron steers: three weights, set by hand, decide which jet fires."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import Final

import numpy as np
import pygame

from ai.environment import Floats
from ai.lander.environment import LIMITS, LanderEnv, Outcome
from ai.nn import ActivationFunctions, ActivationLayer, CostFunctions, FullyConnectedLayer, NeuralNetwork
from engine import DT
from game.core import texts
from game.core.scene import Route
from game.drawing.canvas import Canvas
from game.drawing.tokens import LINE, MUTE, NET, SMALL
from game.explain.figures import decimal
from game.scenes.learn.chapter import Chapter, Code
from game.scenes.learn.pictures import draw_lander
from game.ui.context import Context
from game.ui.panel import Column
from game.world.camera import View

# What the neuron senses: indices of sin of the tilt, spin and sideways speed in an observation.
SENSES: Final = (4, 6, 2)
HINT: Final = (-4.0, 0.0, 2.0)  # weights that fly
DECISION: Final = 4  # physics steps with one action, as a network flies
GOAL: Final = 10.0  # seconds to stay upright and in sight
_FIRES: Final = 0.5  # output beyond which a jet fires
_HEIGHT: Final = 12.0  # metres at which the main engine's rule holds it
_SIGHT: Final = 12.0  # metres to either side
_FALLEN: Final = np.radians(60.0)
_LEANS: Final = np.radians((22.0, -30.0, 35.0, -15.0))  # of the flights, in turn
_DRIFT: Final = 2.0  # m/s with which a flight begins, to the side it leans to: out of sight within GOAL if nothing acts
_SHOVE: Final = (1.2, 0.8)  # m/s and rad/s that a push adds
_REST: Final = 50  # updates between a flight and the next
_TOLD: Final = 15  # updates after which a longest flight that goes on is told anew
_MOST: Final = 6.0
_NEURON: Final = 0.3  # share of the picture's height for the neuron


class Steering:
    """One fully connected layer of three inputs and one output, tanh, decides: left jet, none, right jet.

    Attributes:
        seconds: how long the present flight has been upright and in sight.
        sensed: what the neuron was given for its latest decision, (1, 3).
        output: what it answered, from -1 to 1.
        steer: what that means: 1 turns left, 2 right, 0 neither.
        end: how the present flight ended: "fell" over, or "drifted" out of sight; empty while it flies.
        age: physics steps of the present flight.
        best: the longest such time, with the weights of then.

    """

    def __init__(self) -> None:
        self.layer = FullyConnectedLayer(len(SENSES), 1)
        self.network = NeuralNetwork(*CostFunctions.use_mse()).add_layer(self.layer)
        self.network.add_layer(ActivationLayer(*ActivationFunctions.use_tanh()))
        self.env = LanderEnv(1, seed=0, spawn="fixed", frame_skip=1, limits=replace(LIMITS, time=1e9))
        self.env.reset()
        self.network.values[:] = 0.0
        self.best: tuple[float, tuple[float, ...]] = (0.0, (0.0, 0.0, 0.0))
        self._flights = 0
        self._begin()

    @property
    def weights(self) -> tuple[float, ...]:
        """The three weights."""
        return tuple(self.layer.weights[:, 0].tolist())

    @property
    def products(self) -> Floats:
        """What was sensed, times the weights, (3,)."""
        products: Floats = self.sensed[0] * self.layer.weights[:, 0]
        return products

    def set(self, number: int, weight: float) -> None:
        """Set one weight."""
        self.layer.weights[number, 0] = weight
        self.seconds = 0.0

    def push(self) -> None:
        """Push the lander, sideways and into a spin, to one side and then the other."""
        side = 1 - 2 * (self._pushes % 2)
        self._pushes += 1
        body, flying = self.env.lander, self.env.outcome == Outcome.FLYING
        body.set(velocity=body.velocity + np.array([side * _SHOVE[0], 0.0]), mask=flying)
        body.set(angular_velocity=body.angular_velocity - side * _SHOVE[1], mask=flying)

    def step(self) -> bool:
        """Advance by 1/60 s; return whether this has shown something."""
        if self._over:
            self._over -= 1
            if not self._over:
                self._begin()
            return False
        if self.age % DECISION == 0:
            self._decide()
        self.env.fly(self.action)
        self.age += 1
        return self._judge()

    def _begin(self) -> None:
        lean = _LEANS[self._flights % len(_LEANS)]
        self._flights += 1
        self.env.place(np.array([True]), np.array([[0.0, _HEIGHT, -_DRIFT * np.sign(lean), 0.0, lean, 0.0]]))
        self.age = self._pushes = self._over = 0
        self.seconds, self.end = 0.0, ""
        self._decide()

    def _decide(self) -> None:
        """Let the neuron choose the jet; a fixed rule fires the main engine when the lander sinks."""
        self.sensed: Floats = np.round(self.env.observe()[:, SENSES], 2)  # what is written is what is computed
        self.output = float(self.network.predict(self.sensed)[0, 0])
        self.steer = 1 if self.output > _FIRES else 2 if self.output < -_FIRES else 0
        sinking = self.env.velocity[0, 1] + 0.5 * (self.env.position[0, 1] - _HEIGHT) < 0
        self.action = np.array([3 * int(sinking) + self.steer])

    def _judge(self) -> bool:
        before, self.seconds = self.seconds, self.seconds + DT
        in_sight = abs(self.env.position[0, 0]) < _SIGHT
        fallen = self.env.outcome[0] != Outcome.FLYING or self.env.tilt[0] > _FALLEN
        if self.seconds > self.best[0] and any(self.weights):
            self.best = (self.seconds, self.weights)
        if fallen or not in_sight:
            self.end, self._over = ("fell" if fallen else "drifted"), _REST
        return any(self.weights) and bool(self.end or before < GOAL <= self.seconds)

    def verdict(self) -> int | None:
        """Return what the neuron that stayed in sight for long enough has sensed beside the tilt."""
        seconds, (_, spin, speed) = self.best
        return None if seconds < GOAL else 2 if speed else 1 if spin else 0


class NeuronChapter(Chapter):
    """The neuron's three weights, its lander, and what it adds up."""

    key, door = "neuron", Route("watch")
    model: Steering

    def __init__(self, context: Context) -> None:
        super().__init__(context)
        self.model = Steering()

    def controls(self, column: Column) -> None:
        for number, name in enumerate(texts.LEARN_NEURON_INPUTS):
            column.slider(name, self.model.weights[number], (-_MOST, _MOST), partial(self.model.set, number), step=1,
                          figure=lambda weight: decimal(weight, 0, "+"))  # fmt: skip
        column.button(texts.LEARN_NEURON_PUSH, self.model.push)
        column.button(texts.LEARN_NEURON_HINT, self.hint)

    def hint(self) -> None:
        """Set weights that fly."""
        for number, weight in enumerate(HINT):
            self.model.set(number, weight)
        self.changed = True

    def update(self) -> None:
        super().update()
        model = self.model  # the longest flight may be the present one, and grow
        self.changed |= self.tried and model.seconds == model.best[0] and model.age % _TOLD == 0

    def why(self) -> str:
        seconds, weights = self.model.best
        tilt, spin, speed = (decimal(weight, 0, "+") for weight in weights)
        template = texts.LEARN_NEURON_WHY["flew" if seconds >= GOAL else "fell"]
        return template.format(seconds=seconds, tilt=tilt, spin=spin, speed=speed)

    def code(self) -> Code:
        inputs, weights = self.model.sensed[0], self.model.weights
        total = " ".join(
            f"{decimal(value, 2, '+')}×{decimal(weight, 0)}"
            for value, weight in zip(inputs.tolist(), weights, strict=True)
        )
        return Code(FullyConnectedLayer.predict, np.dot, total)

    def below(self, column: Column) -> None:
        column.text(self._summed, size=SMALL)
        column.aside(f"{texts.LEARN_NEURON_FIRES.format(output=_FIRES)} {texts.LEARN_NEURON_RULE}")

    def _summed(self) -> str:
        model = self.model
        total, output = decimal(float(model.products.sum()), 2, "+"), decimal(model.output, 2, "+")
        return texts.LEARN_NEURON_SUM.format(total=total, output=output, action=texts.LEARN_NEURON_ACTIONS[model.steer])

    def draw(self, canvas: Canvas, box: pygame.FRect) -> None:
        world = pygame.FRect(box.left, box.top, box.width, (1 - _NEURON) * box.height)
        view = View.within(world, canvas.scale, (0.0, _HEIGHT - 0.5), world.width / (2 * _SIGHT + 2))
        with canvas.clipped(world):
            ((x, y),) = view.points([(0.0, _HEIGHT)]).tolist()
            canvas.line((world.left, y), (world.right, y), LINE)
            canvas.line((x, world.top), (x, world.bottom), LINE)
            draw_lander(canvas, view, self.model.env)
        there = self.model.seconds >= GOAL
        words = texts.LEARN_NEURON_FLIGHT[self.model.end or ("there" if there else "flies")].format(
            seconds=self.model.seconds
        )
        colour = canvas.palette.good if there else MUTE
        canvas.text(words, (box.left + 4, box.top + 18), size=SMALL, colour=colour, tabular=True)
        self._draw_neuron(canvas, pygame.FRect(box.left, world.bottom, box.width, _NEURON * box.height))

    def _draw_neuron(self, canvas: Canvas, box: pygame.FRect) -> None:
        """Draw what is sensed, times the weights, on lines as thick as the products, into the neuron."""
        neuron = (box.left + 0.8 * box.width, box.centery)
        for number, (name, product) in enumerate(
            zip(texts.LEARN_NEURON_INPUTS, self.model.products.tolist(), strict=True)
        ):
            y = box.top + box.height * (number + 0.6) / len(SENSES)
            words = texts.LEARN_NEURON_PRODUCT.format(
                value=decimal(float(self.model.sensed[0, number]), 2, "+"),
                weight=decimal(self.model.weights[number], 0, "+"),
                product=decimal(product, 2, "+"),
            )
            end = box.left + 0.6 * box.width
            taken = canvas.text(words, (end, y), size=SMALL, align="right", tabular=True)
            canvas.text(name, (box.left + 4, y), size=SMALL, colour=MUTE, room=taken.left - box.left - 16)
            canvas.line((end + 12, y - 4), neuron, NET, 1 + min(abs(product), 3.0), 0.6)
        canvas.glow(neuron, 40, NET, abs(self.model.output))
        canvas.dot(neuron, 16, NET, 0.25 + 0.75 * abs(self.model.output))
