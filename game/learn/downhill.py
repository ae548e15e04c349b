"""Chapter 3, downhill: the real cost of a small network as a line or a map of its weights, and steps down it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import Final

import numpy as np
import pygame

from ai.lander.environment import LanderEnv
from ai.nn import SGD, Adam, Array, CostFunctions, DivergenceError, FullyConnectedLayer, NeuralNetwork, Optimizer
from game.core import texts
from game.core.scene import Route
from game.drawing.canvas import Canvas, Point
from game.drawing.figures import write_figures
from game.drawing.paint_cache import InPieces, PaintCache, Steps
from game.drawing.tokens import FAINT, HUMAN, INK, LABEL, MUTE, NET, SMALL, Colour
from game.learn.chapter import STAGE, Chapter, Code
from game.learn.heat import paint_heat
from game.ui.context import Context
from game.ui.widget import PointsManager, Widget
from game.ui.widgets import Choice, Slider, TextButton

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
_COAST: Final = 0
_MAIN: Final = 3
_PAUSE: Final = (15, 6)  # updates from one step to the next: on the line, in the valley
_LEFT: Final = (-3.0, 5.0)  # weights at the ends of the line
_TOP: Final = 46.0  # cost at the top of the picture
_LINE: Final = pygame.FRect(STAGE.left, STAGE.top + 44, STAGE.width, STAGE.height - 72)
_MAP: Final = pygame.FRect(STAGE.left, STAGE.top + 8, 424, 424)
_REACH: Final = ((-2.0, 4.0), (-7.0, 5.0))  # of the two weights on the map
_CELLS: Final = 40
_A_CELL: Final = 500  # pixels of a picture that could be painted while the cost of one cell is measured
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
        self.begin(start)

    def begin(self, start: Sequence[float]) -> None:
        """Go back to the first weights."""
        self.network.values[:] = [*start, 0.0]
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

    def cost(self, weights: Sequence[float]) -> float:
        """Return what the network costs with other weights, and leave it as it is."""
        before = self.network.values.copy()
        self.network.values[:] = [*weights, 0.0]
        cost = self.network.cost(self.network.predict(self._inputs), self._targets)
        self.network.values = before
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

    key = "downhill"
    answer = 1
    door = Route("train")

    def __init__(self, context: Context, manager: PointsManager) -> None:
        super().__init__(context, manager)
        self._cache = PaintCache(most=2)
        coasting, burning = flights(_COAST, 0.0), flights(_MAIN, 0.2)
        self.line = Descent(coasting[0][:, :1], coasting[1], SGD(_FIRST_RATE), LINE_START)
        self.plain = Descent(*burning, SGD(_FIRST_RATE), VALLEY_START)
        self.adam = Descent(*burning, Adam(ADAM_RATE), VALLEY_START)
        self._curve = [(weight, self.line.cost((weight,))) for weight in np.linspace(*_LEFT, 121).tolist()]
        self._heights = InPieces(self._measured)
        self.restart()

    def _measured(self, share: float) -> Steps[Array]:
        """Measure the cost everywhere on the map, at a share of its cells."""
        across, up = (np.linspace(*reach, round(share * _CELLS)).tolist() for reach in _REACH)
        heights = np.zeros((len(across), len(up)))
        for column, first in enumerate(across):
            heights[column] = [self.plain.cost((first, second)) for second in up]
            yield _A_CELL * len(up)
        return heights

    def restart(self) -> None:
        """Forget all tries, and stand at the start with short steps."""
        self.rate, self.valley, self.tried = _FIRST_RATE, False, False
        self.results: dict[str, dict[str, float]] = {}
        self.begin()

    def begin(self) -> None:
        """Go back to the start."""
        self.line.optimizer.learning_rate = self.plain.optimizer.learning_rate = self.rate
        self.adam.optimizer = Adam(ADAM_RATE)
        self.line.begin(LINE_START)
        self.plain.begin(VALLEY_START)
        self.adam.begin(VALLEY_START)
        self._wait = 0

    def widgets(self) -> list[Widget]:
        """Return the choice of the picture, the step length, and the way back to the start."""
        rate = Slider(self.manager, self.row(1), texts.LEARN_DOWNHILL_RATE, self.rate, RATES, self._set_rate,
                      logarithmic=True, figure="{:.3f}".format, colour=HUMAN)  # fmt: skip
        words = texts.LEARN_DOWNHILL_PICTURES
        picture = Choice(self.manager, self.row(0), "", words, int(self.valley), self._choose)
        return [picture, rate, TextButton(self.manager, self.row(2), texts.LEARN_DOWNHILL_BEGIN, self.begin)]

    def _set_rate(self, rate: float) -> None:
        self.rate = rate
        self.begin()

    def _choose(self, index: int) -> None:
        self.valley = bool(index)
        self.begin()

    def update(self) -> None:
        """Take a step now and then."""
        self._wait += 1
        if self._wait % _PAUSE[self.valley]:
            return
        moving = (self.plain, self.adam) if self.valley else (self.line,)
        for descent in moving:
            if len(descent.costs) <= (VALLEY_STEPS if self.valley else ENOUGH):
                descent.step()
        self._note()

    def _note(self) -> None:
        """Keep what this try has shown, once it says something."""
        figures = {"rate": self.rate, "first": self.line.costs[0], "last": self.line.costs[-1]}
        if self.valley:
            if len(self.adam.costs) > VALLEY_STEPS:
                plain = self.plain.costs[-1]
                figures = {"rate": self.rate, "plain": plain, "adam": self.adam.costs[-1], "steps": VALLEY_STEPS}
                self.results["lost" if self.plain.lost else "valley"] = figures
        elif self.line.lost or len(self.line.costs) > ENOUGH:
            first, last = self.line.costs[0], self.line.costs[-1]
            kind = "long" if last >= first else "right" if last < 0.01 * first else "short"
            self.results[kind] = {**figures, "steps": len(self.line.costs) - 1}
        self.tried = bool(self.results)

    # What it tells

    def why(self, guess: int | None) -> str:  # noqa: ARG002
        """Return what each kind of step length has led to, as far as it was tried."""
        told = texts.LEARN_DOWNHILL_WHY
        return " ".join(told[kind].format(**self.results[kind]) for kind in KINDS if kind in self.results)

    def code(self) -> Sequence[Code]:
        """Return the step of the optimizers, with this moment's slope."""
        slope = float((self.plain if self.valley else self.line).slopes[0])
        plain = Code(SGD._fill_step, np.multiply, {np.multiply: f"{slope:+.3f} · {self.rate:.3f}"})
        adam = Code(Adam._fill_step, np.divide, {np.divide: texts.LEARN_DOWNHILL_ADAM_NOTE})
        return [plain, adam, Code(Optimizer.step, "values")]

    def draw(self, canvas: Canvas, alpha: float) -> None:  # noqa: ARG002
        """Draw the line with its ball, or the map with two trails."""
        if self.valley:
            self._draw_valley(canvas)
        else:
            self._draw_line(canvas)

    def _draw_line(self, canvas: Canvas) -> None:
        self._cache.draw(canvas, _LINE, "line", self._paint_line)
        descent, steps = self.line, len(self.line.costs) - 1
        weight, cost, slope = descent.trail[-1][0], descent.costs[-1], float(descent.slopes[0])
        for (before,), height in zip(descent.trail[:-1], descent.costs[:-1], strict=True):
            if _seen(before, height):
                canvas.dot(_on_line(before, height), 3, HUMAN, 0.45)
        if _seen(weight, cost):
            middle, span = _on_line(weight, cost), 0.5 / math.hypot(1.0, 0.1 * slope)
            for side in (-1, 1):
                canvas.line(middle, _on_line(weight + side * span, cost + side * span * slope), MUTE, 1)
            canvas.dot(middle, 7, HUMAN)
        place = (STAGE.left, STAGE.top + 16)
        if descent.lost or not _seen(weight, cost):
            write_figures(canvas, texts.LEARN_DOWNHILL_GONE.format(steps=steps), place, size=SMALL + 1, colour=INK)
        else:
            told = texts.LEARN_DOWNHILL_STEP.format(slope=slope, rate=self.rate, step=-slope * self.rate, cost=cost)
            write_figures(canvas, told, place, size=SMALL + 1, colour=INK)

    def _paint_line(self, sheet: Canvas) -> None:
        places = [_on_line(*point) for point in self._curve if _seen(*point)]
        places = [(x - _LINE.left, y - _LINE.top) for x, y in places]
        for start, end in pairwise(places):
            sheet.line(start, end, NET, 2)
        sheet.line((0, _LINE.height - 24), (_LINE.width, _LINE.height - 24), FAINT)
        cost, weight = texts.LEARN_DOWNHILL_AXES
        sheet.text(cost, (2, 14), size=LABEL, colour=MUTE)
        sheet.text(weight, (_LINE.width - 2, _LINE.height - 8), size=LABEL, colour=MUTE, align="right")

    def _draw_valley(self, canvas: Canvas) -> None:
        self._cache.draw(canvas, _MAP, ("map", self._heights.whole), self._paint_map)
        rows = ((self.plain, HUMAN, texts.LEARN_DOWNHILL_PLAIN, self.rate),
                (self.adam, NET, texts.LEARN_DOWNHILL_ADAM, ADAM_RATE))  # fmt: skip
        left, y = _MAP.right + 32, _MAP.top + 20
        for descent, colour, words, rate in rows:
            places = [_on_map(weights) for weights in descent.trail if _on_the_map(weights)]
            for start, end in pairwise(places):
                canvas.line(start, end, colour, 1.5)
            for place in places:
                canvas.dot(place, 2.5, colour)
            if places and _on_the_map(descent.trail[-1]):
                canvas.dot(places[-1], 6, colour)
            canvas.dot((left + 4, y - 5), 5, colour)
            canvas.text(words.format(rate=rate), (left + 20, y), size=SMALL + 1, room=STAGE.right - left - 20)
            told = texts.LEARN_DOWNHILL_LOST if descent.lost else texts.LEARN_DOWNHILL_COST
            told = told.format(cost=descent.costs[-1], steps=len(descent.costs) - 1)
            write_figures(canvas, told, (left + 20, y + 24), size=SMALL)
            y += 72

    def _paint_map(self, sheet: Canvas) -> None:
        bands = np.floor(2.0 * np.log2(self._heights.picture + 0.05))
        levels = (bands - bands.min()) / (bands.max() - bands.min())
        paint_heat(sheet, 1.0 - levels, _DEEP, _DEEP)
        first, second = texts.LEARN_DOWNHILL_MAP
        sheet.text(first, (_MAP.width - 8, _MAP.height - 8), size=LABEL, colour=MUTE, align="right")
        sheet.text(second, (8, 16), size=LABEL, colour=MUTE)


def _seen(weight: float, cost: float) -> bool:
    return _LEFT[0] <= weight <= _LEFT[1] and cost <= _TOP


def _on_line(weight: float, cost: float) -> Point:
    share = (weight - _LEFT[0]) / (_LEFT[1] - _LEFT[0])
    return _LINE.left + share * _LINE.width, _LINE.bottom - 24 - (_LINE.height - 24) * cost / _TOP


def _on_the_map(weights: Sequence[float]) -> bool:
    return all(low <= weight <= high for weight, (low, high) in zip(weights, _REACH, strict=True))


def _on_map(weights: Sequence[float]) -> Point:
    across, up = ((weight - low) / (high - low) for weight, (low, high) in zip(weights, _REACH, strict=True))
    return _MAP.left + across * _MAP.width, _MAP.bottom - up * _MAP.height
