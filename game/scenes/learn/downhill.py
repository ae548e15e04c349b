"""Chapter 3, downhill: the real cost of a neuron with one weight as a curve, and steps down it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import Final

import numpy as np
import pygame

from ai.environment import Doubles
from ai.lander.environment import LanderEnv
from ai.nn import SGD, Array, CostFunctions, DivergenceError, FullyConnectedLayer, NeuralNetwork
from game.core import texts
from game.core.scene import Route
from game.drawing.canvas import Canvas, Point
from game.drawing.tokens import FAINT, HUMAN, LABEL, MUTE, NET, SMALL, Colour
from game.explain.figures import decimal
from game.scenes.learn.chapter import Chapter, Code
from game.ui.context import Context
from game.ui.panel import Column

RATES: Final = (0.005, 0.5)
ENOUGH: Final = 20  # steps
KINDS: Final = ("short", "right", "long")  # keys of `LEARN_DOWNHILL_WHY`
START: Final = -2.0  # the first weight
_FIRST_RATE: Final = 0.01
_FLIGHTS: Final = 20
_SECOND: Final = 60  # physics steps
_COAST: Final = 0
_PAUSE: Final = 15  # updates from one step to the next
_SEEN: Final = ((-3.0, 5.0), (-3.0, 46.0))  # weights and costs at the ends of the picture
_LOST: Final = 50.0  # weight beyond which a descent has left for good


def flights() -> tuple[Array, Array]:
    """Let twenty landers coast for a second; return what was sensed, and where that led.

    Inputs (40, 1) are the sideways speed in m/s, targets (40, 1) the metres gone sideways. Each flight is there in its
    mirror image as well, so that the bias of a network stays at 0.
    """
    rng, none = np.random.default_rng(0), np.zeros(_FLIGHTS)
    speed = rng.uniform(-3.0, 3.0, _FLIGHTS)
    env = LanderEnv(_FLIGHTS, seed=0, spawn="fixed", frame_skip=_SECOND)
    env.reset()
    env.place(np.ones(_FLIGHTS, bool), np.stack([none, none + 15.0, speed, none, none, none], axis=1))
    env.fly(np.full(_FLIGHTS, _COAST))
    inputs, gone = speed[:, None].astype(np.float32), env.position[:, :1].astype(np.float32)
    return np.concatenate([inputs, -inputs]), np.concatenate([gone, -gone])


class Descent:
    """A neuron that is moved downhill by plain steps, and the way it has gone.

    Attributes:
        trail: the weight after each step, the first one included.
        costs: the cost at each of them.
        lost: whether its numbers have grown beyond all bounds.
        results: what has been seen, by its kind: the figures of `LEARN_DOWNHILL_WHY`.

    """

    def __init__(self, inputs: Array, targets: Array) -> None:
        self._inputs, self._targets = inputs, targets
        self.network = NeuralNetwork(*CostFunctions.use_mse()).add_layer(FullyConnectedLayer(1, 1))
        self.results: dict[str, dict[str, float]] = {}
        self.begin(_FIRST_RATE)

    def begin(self, rate: float) -> None:
        """Go back to the first weight, with a step length."""
        self.rate, self.optimizer, self.network.values[:] = rate, SGD(rate), (START, 0.0)
        self.lost, self._wait = False, 0
        self.trail: list[float] = []
        self.costs: list[float] = []
        self._look()

    def step(self) -> bool:
        """Take a step on all examples now and then, until it is over; return whether that was the last one."""
        self._wait += 1
        if self._wait % _PAUSE or self.lost or len(self.costs) > ENOUGH:
            return False
        try:
            self.network.train_batch(self._inputs, self._targets, self.optimizer)
            self._look()
        except DivergenceError:
            self.lost = True
        self.lost |= abs(self.trail[-1]) > _LOST
        if not self.lost and len(self.costs) <= ENOUGH:
            return False
        first, last = self.costs[0], self.costs[-1]
        kind = "long" if last >= first else "right" if last < 0.01 * first else "short"
        self.results[kind] = {"rate": self.rate, "first": first, "last": last, "steps": len(self.costs) - 1}
        return True

    def verdict(self) -> int | None:
        """Return that longer steps help up to a point, once some were too short, some right and some too long."""
        return 1 if set(KINDS) <= self.results.keys() else None

    def cost(self, weights: Doubles) -> Doubles:
        """Return what the network would cost with other weights (n,): its mean squared error."""
        cost: Doubles = np.square(self._inputs * weights - self._targets).mean(axis=0)
        return cost

    @property
    def slope(self) -> float:
        """The gradient at the present weight."""
        return float(self.network.gradients[0])

    def _look(self) -> None:
        """Note weight and cost, and fill the gradient of this place, from which the next step is taken."""
        network = self.network
        prediction = network.forward_propagate(self._inputs)
        self.costs.append(network.cost(prediction, self._targets))
        network.backward_propagate(network.cost.derivative(prediction, self._targets))
        self.trail.append(float(network.values[0]))


class DownhillChapter(Chapter):
    """Steps of a length that is chosen, down the cost of one weight."""

    key, door = "downhill", Route("train")
    model: Descent

    def __init__(self, context: Context) -> None:
        super().__init__(context)
        self.model = Descent(*flights())
        weights = np.linspace(*_SEEN[0], 121)
        self._curve = list(zip(weights.tolist(), self.model.cost(weights).tolist(), strict=True))

    def controls(self, column: Column) -> None:
        low, high = map(math.log10, RATES)
        column.slider(texts.LEARN_DOWNHILL_RATE, math.log10(self.model.rate), (low, high),
                      lambda power: self.model.begin(round(10**power, 3)), step=0.1,
                      figure=lambda power: f"{10**power:.3f}")  # fmt: skip
        column.button(texts.LEARN_DOWNHILL_BEGIN, lambda: self.model.begin(self.model.rate))

    def why(self) -> str:
        results = self.model.results
        return " ".join(texts.LEARN_DOWNHILL_WHY[kind].format(**results[kind]) for kind in KINDS if kind in results)

    def code(self) -> Code:
        return Code(SGD._fill_step, np.multiply, f"{decimal(self.model.slope, 3, '+')} · {self.model.rate:.3f}")

    def below(self, column: Column) -> None:
        column.text(self._step, size=SMALL, colour=HUMAN)

    def _step(self) -> str:
        """Return the cost of the ball's weight, the slope there, and the step."""
        descent = self.model
        cost, slope, rate = descent.costs[-1], descent.slope, descent.rate
        if descent.lost or not _seen((descent.trail[-1], cost)):
            return texts.LEARN_DOWNHILL_GONE.format(steps=len(descent.costs) - 1)
        step = decimal(-slope * rate, 3, "+")
        return texts.LEARN_DOWNHILL_STEP.format(cost=cost, slope=decimal(slope, 3, "+"), rate=rate, step=step)

    def draw(self, canvas: Canvas, box: pygame.FRect) -> None:
        _draw_way(canvas, box, self._curve, NET)
        trail = list(zip(self.model.trail, self.model.costs, strict=True))
        with canvas.clipped(box):  # each step across to the next weight, and then up or down to its cost
            for here, there in pairwise(trail):
                for start, end in pairwise(_on(box, point) for point in (here, (there[0], here[1]), there)):
                    canvas.line(start, end, FAINT)
        for point in filter(_seen, trail):
            canvas.dot(_on(box, point), 2.5, HUMAN, 0.7)
        (weight, cost), slope = trail[-1], self.model.slope
        if _seen(trail[-1]):
            canvas.dot(_on(box, trail[-1]), 7, HUMAN)
            span = 0.5 / math.hypot(1.0, 0.1 * slope)  # of the slope under the ball
            ends = [(weight + side * span, cost + side * span * slope) for side in (-1, 1)]
            _draw_way(canvas, box, ends, MUTE)
        up, across = texts.LEARN_DOWNHILL_AXES
        canvas.text(up, (box.left + 8, box.top + 16), size=LABEL, colour=MUTE)
        canvas.text(across, (box.right - 8, box.bottom - 8), size=LABEL, colour=MUTE, align="right")


def _draw_way(canvas: Canvas, box: pygame.FRect, points: Sequence[Point], colour: Colour) -> None:
    """Draw lines from point to point, as far as they are seen."""
    for start, end in pairwise(_on(box, point) for point in points if _seen(point)):
        canvas.line(start, end, colour, 1.5)


def _seen(point: Point) -> bool:
    return all(low <= value <= high for value, (low, high) in zip(point, _SEEN, strict=True))


def _on(box: pygame.FRect, point: Point) -> Point:
    """Return where a weight and a cost stand in a box."""
    across, up = ((value - low) / (high - low) for value, (low, high) in zip(point, _SEEN, strict=True))
    return box.left + across * box.width, box.bottom - up * box.height
