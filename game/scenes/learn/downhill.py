"""Chapter 3, downhill: the real cost of a small network as a line or a map of its weights, and steps down it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import partial
from itertools import pairwise
from typing import Final

import numpy as np
import pygame

from ai.environment import Doubles
from ai.lander.environment import LanderEnv
from ai.nn import SGD, Adam, Array, CostFunctions, DivergenceError, FullyConnectedLayer, NeuralNetwork, Optimizer
from game.core import texts
from game.core.scene import Route
from game.drawing.canvas import Canvas, Point
from game.drawing.paint_cache import PaintCache
from game.drawing.tokens import CAPTION, HUMAN, MUTE, NET, SMALL, Colour
from game.explain.figures import decimal
from game.scenes.learn.chapter import Chapter, Code
from game.scenes.learn.pictures import paint_heat
from game.ui.context import Context
from game.ui.panel import Column

Reach = tuple[tuple[float, float], tuple[float, float]]  # what is seen of two quantities, across and up
RATES: Final = (0.005, 0.5)
ADAM_RATE: Final = 0.3
ENOUGH: Final = 20  # steps on the line
VALLEY_STEPS: Final = 60
KINDS: Final = ("short", "right", "long", "valley", "lost")  # keys of `LEARN_DOWNHILL_WHY`
LINE_START: Final = (-2.0,)
VALLEY_START: Final = (-1.0, 3.0)
_FIRST_RATE: Final = 0.01
_FLIGHTS: Final = 20
_SECOND: Final = 60  # physics steps
_COAST, _MAIN = 0, 3
_PAUSE: Final = (15, 6)  # updates from one step to the next: on the line, in the valley
_LINE: Final = ((-3.0, 5.0), (-3.0, 46.0))  # weights and costs at the ends of the line's picture
_MAP: Final = ((-2.0, 4.0), (-7.0, 5.0))  # of the two weights on the map
_CELLS: Final = 40
_DEEP: Final[Colour] = (96, 128, 200)  # the valley's floor
_LOST: Final = 50.0  # weight beyond which a descent has left for good


def flights(action: int, tilt: float) -> tuple[Array, Array]:
    """Fly twenty landers for a second with one action; return what was sensed, and where that led.

    Inputs (40, 2) are sideways speed in m/s and the sine of the tilt, targets (40, 1) the metres gone sideways. Each
    flight is there in its mirror image as well, so that the bias of a network stays at 0.
    """
    rng, none = np.random.default_rng(0), np.zeros(_FLIGHTS)
    speed, angle = rng.uniform(-3.0, 3.0, _FLIGHTS), rng.uniform(-tilt, tilt, _FLIGHTS)
    env = LanderEnv(_FLIGHTS, seed=0, spawn="fixed", frame_skip=_SECOND)
    env.reset()
    env.place(np.ones(_FLIGHTS, bool), np.stack([none, none + 15.0, speed, none, angle, none], axis=1))
    env.fly(np.full(_FLIGHTS, action))
    inputs = np.stack([speed, np.sin(angle)], axis=1).astype(np.float32)
    gone = env.position[:, :1].astype(np.float32)
    return np.concatenate([inputs, -inputs]), np.concatenate([gone, -gone])


class Descent:
    """A network of one neuron that is moved downhill by an optimizer, and the way it has gone.

    Attributes:
        trail: the weights after each step, the first ones included.
        costs: the cost at each of them.
        lost: whether its numbers have grown beyond all bounds.

    """

    def __init__(self, inputs: Array, targets: Array, optimizer: Optimizer, start: Sequence[float]) -> None:
        self._inputs, self._targets, self.optimizer = inputs, targets, optimizer
        self.network = NeuralNetwork(*CostFunctions.use_mse()).add_layer(FullyConnectedLayer(inputs.shape[1], 1))
        self._start = start
        self.begin(optimizer)

    def begin(self, optimizer: Optimizer) -> None:
        """Go back to the first weights, with an optimizer."""
        self.optimizer, self.network.values[:] = optimizer, [*self._start, 0.0]
        self.lost = False
        self.trail: list[tuple[float, ...]] = []
        self.costs: list[float] = []
        self._look()

    def step(self) -> None:
        """Take one step of the optimizer on all examples."""
        if self.lost:
            return
        try:
            self.network.train_batch(self._inputs, self._targets, self.optimizer)
        except DivergenceError:
            self.lost = True
            return
        self._look()
        self.lost = max(map(abs, self.trail[-1])) > _LOST

    def cost(self, weights: Doubles) -> Doubles:
        """Return what the network would cost with other weights, (n, inputs) to (n,): its mean squared error."""
        cost: Doubles = np.square(self._inputs @ weights.T - self._targets).mean(axis=0)
        return cost

    @property
    def slopes(self) -> Array:
        """The gradient at the present weights."""
        return self.network.gradients[:-1]

    def _look(self) -> None:
        """Note weights and cost, and fill the gradients of this place, from which the next step is taken."""
        network = self.network
        prediction = network.forward_propagate(self._inputs)
        self.costs.append(network.cost(prediction, self._targets))
        network.backward_propagate(network.cost.derivative(prediction, self._targets))
        self.trail.append(tuple(network.values[:-1].tolist()))


class DownhillChapter(Chapter):
    """Steps down the cost of one weight, and down a valley of two, by plain steps and by Adam.

    Attributes:
        rate: the step length.
        valley: whether the map of two weights is shown.
        results: what has been seen, by its kind: the figures of `LEARN_DOWNHILL_WHY`.

    """

    key, door = "downhill", Route("train")

    def __init__(self, context: Context) -> None:
        super().__init__(context)
        self._cache = PaintCache()
        coasting, burning = flights(_COAST, 0.0), flights(_MAIN, 0.2)
        self.line = Descent(coasting[0][:, :1], coasting[1], SGD(_FIRST_RATE), LINE_START)
        self.plain = Descent(*burning, SGD(_FIRST_RATE), VALLEY_START)
        self.adam = Descent(*burning, Adam(ADAM_RATE), VALLEY_START)
        weights = np.linspace(*_LINE[0], 121)
        self._curve = list(zip(weights.tolist(), self.line.cost(weights[:, None]).tolist(), strict=True))
        places = np.meshgrid(*(np.linspace(*reach, _CELLS) for reach in _MAP), indexing="ij")
        heights = self.plain.cost(np.stack(places, axis=-1).reshape(-1, 2)).reshape(_CELLS, _CELLS)
        bands = np.floor(2.0 * np.log2(heights + 0.05))
        self._map = 1.0 - (bands - bands.min()) / (bands.max() - bands.min())
        self.restart()

    def restart(self) -> None:
        self.rate, self.valley, self.tried = _FIRST_RATE, False, False
        self.results: dict[str, dict[str, float]] = {}
        self.begin()

    def begin(self) -> None:
        """Go back to the start."""
        self.line.begin(SGD(self.rate))
        self.plain.begin(SGD(self.rate))
        self.adam.begin(Adam(ADAM_RATE))
        self._wait = 0

    def controls(self, column: Column) -> None:
        column.choice("", texts.LEARN_DOWNHILL_PICTURES, int(self.valley), self.choose)
        low, high = map(math.log10, RATES)
        column.slider(texts.LEARN_DOWNHILL_RATE, math.log10(self.rate), (low, high),
                      lambda power: self.set_rate(round(10**power, 3)), step=0.1,
                      figure=lambda power: f"{10**power:.3f}")  # fmt: skip
        column.button(texts.LEARN_DOWNHILL_BEGIN, self.begin)

    def set_rate(self, rate: float) -> None:
        """Begin with another step length."""
        self.rate = rate
        self.begin()

    def choose(self, index: int) -> None:
        """Show the line, 0, or the valley, 1, which begins with short steps."""
        self.valley = bool(index)
        if self.valley:  # the longest steps on the line leave the valley at once
            self.rate, self.changed = _FIRST_RATE, True
        self.begin()

    def update(self) -> None:
        self._wait += 1
        if self._wait % _PAUSE[self.valley]:
            return
        for descent in (self.plain, self.adam) if self.valley else (self.line,):
            if len(descent.costs) <= (VALLEY_STEPS if self.valley else ENOUGH):
                descent.step()
        self._note()

    def _note(self) -> None:
        """Keep what this try has shown, once it says something."""
        first, last, before = self.line.costs[0], self.line.costs[-1], dict(self.results)
        if self.valley:
            if len(self.adam.costs) > VALLEY_STEPS:
                figures = {"plain": self.plain.costs[-1], "adam": self.adam.costs[-1], "steps": VALLEY_STEPS}
                self.results["lost" if self.plain.lost else "valley"] = {"rate": self.rate, **figures}
        elif self.line.lost or len(self.line.costs) > ENOUGH:
            kind = "long" if last >= first else "right" if last < 0.01 * first else "short"
            figures = {"first": first, "last": last, "steps": len(self.line.costs) - 1}
            self.results[kind] = {"rate": self.rate, **figures}
        if self.results != before:
            self.found()

    def why(self) -> str:
        templates = texts.LEARN_DOWNHILL_WHY
        return " ".join(templates[kind].format(**self.results[kind]) for kind in KINDS if kind in self.results)

    def verdict(self) -> int | None:
        """Return that longer steps help up to a point, once some were too short, some right and some too long."""
        return 1 if {"short", "right", "long"} <= self.results.keys() else None

    def code(self) -> Code:
        slope = float((self.plain if self.valley else self.line).slopes[0])
        return Code(SGD._fill_step, np.multiply, f"{decimal(slope, 3, '+')} · {self.rate:.3f}")

    def below(self, column: Column) -> None:
        column.text(lambda: self._descent_words(self.plain) if self.valley else self._step(), size=SMALL, colour=HUMAN)
        column.text(lambda: self._descent_words(self.adam) if self.valley else "", size=SMALL, colour=NET)

    def _step(self) -> str:
        """Return the cost of the ball's weight, the slope there, and the step."""
        cost, slope, steps = self.line.costs[-1], float(self.line.slopes[0]), len(self.line.costs) - 1
        if self.line.lost or not _seen(_LINE, (self.line.trail[-1][0], cost)):
            return texts.LEARN_DOWNHILL_GONE.format(steps=steps)
        step = decimal(-slope * self.rate, 3, "+")
        return texts.LEARN_DOWNHILL_STEP.format(cost=cost, slope=decimal(slope, 3, "+"), rate=self.rate, step=step)

    def _descent_words(self, descent: Descent) -> str:
        """Return how far a descent in the valley has come."""
        plain = descent is self.plain
        name = (texts.LEARN_DOWNHILL_PLAIN if plain else texts.LEARN_DOWNHILL_ADAM).format(
            rate=self.rate if plain else ADAM_RATE
        )
        template = texts.LEARN_DOWNHILL_LOST if descent.lost else texts.LEARN_DOWNHILL_COST
        return f"{name}: {template.format(cost=descent.costs[-1], steps=len(descent.costs) - 1)}"

    def draw(self, canvas: Canvas, box: pygame.FRect, alpha: float) -> None:
        line = [(weight, cost) for (weight,), cost in zip(self.line.trail, self.line.costs, strict=True)]
        trails, reach, words = [(line, HUMAN)], _LINE, texts.LEARN_DOWNHILL_AXES
        if self.valley:
            ways = [[(across, up) for across, up in each.trail] for each in (self.plain, self.adam)]
            trails, reach, words = list(zip(ways, (HUMAN, NET), strict=True)), _MAP, texts.LEARN_DOWNHILL_MAP
            box = pygame.FRect(box.left, box.top, min(box.width, 1.3 * box.height), box.height)
            self._cache.draw(canvas, box, (), lambda sheet: paint_heat(sheet, self._map, _DEEP, _DEEP))
        else:
            _draw_way(canvas, box, reach, self._curve, NET)
        for trail, colour in trails:
            if self.valley:
                _draw_way(canvas, box, reach, trail, colour)
            for point in filter(partial(_seen, reach), trail):
                canvas.dot(_on(box, reach, point), 2.5, colour, 0.7)
            if _seen(reach, trail[-1]):
                canvas.dot(_on(box, reach, trail[-1]), 7, colour)
        if not self.valley and _seen(reach, line[-1]):  # the slope under the ball
            (weight, cost), slope = line[-1], float(self.line.slopes[0])
            span = 0.5 / math.hypot(1.0, 0.1 * slope)
            ends = [(weight + side * span, cost + side * span * slope) for side in (-1, 1)]
            _draw_way(canvas, box, reach, ends, MUTE)
        canvas.text(words[0], (box.left + 8, box.top + 16), size=CAPTION, colour=MUTE)
        canvas.text(words[1], (box.right - 8, box.bottom - 8), size=CAPTION, colour=MUTE, align="right")


def _draw_way(canvas: Canvas, box: pygame.FRect, reach: Reach, points: Sequence[Point], colour: Colour) -> None:
    """Draw lines from point to point, as far as they are seen."""
    for start, end in pairwise(_on(box, reach, point) for point in points if _seen(reach, point)):
        canvas.line(start, end, colour, 1.5)


def _seen(reach: Reach, point: Sequence[float]) -> bool:
    return all(low <= value <= high for value, (low, high) in zip(point, reach, strict=True))


def _on(box: pygame.FRect, reach: Reach, point: Sequence[float]) -> Point:
    """Return where two numbers stand in a box that shows so much of both."""
    across, up = ((value - low) / (high - low) for value, (low, high) in zip(point, reach, strict=True))
    return box.left + across * box.width, box.bottom - up * box.height
