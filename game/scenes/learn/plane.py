"""Chapter 2, a second layer: points that no line divides, and a small network that is trained on them live."""

from __future__ import annotations

from typing import Final

import numpy as np
import pygame

from ai.nn import (
    ActivationFunctions,
    ActivationLayer,
    Adam,
    Array,
    CostFunctions,
    FullyConnectedLayer,
    NeuralNetwork,
)
from game.core import texts
from game.core.scene import Route
from game.drawing.canvas import Canvas
from game.drawing.paint_cache import PaintCache
from game.drawing.tokens import FAINT, INK, LABEL, MUTE, NIGHT0, SMALL
from game.scenes.learn.chapter import Chapter
from game.ui.context import Context
from game.ui.panel import Column

UNITS: Final = (0, 2, 4, 8)  # hidden units to choose from
QUARTER: Final = 20  # points in each quarter of the plane
STEPS: Final = 1200  # learning steps after which training rests
SPOKEN: Final = 300  # learning steps after which a try says something
NEARLY: Final = 0.95  # share of the points that is nearly all
_RATE: Final = 0.02
_GAP: Final = 0.12  # no point is nearer to an axis
_CELLS: Final = 40
_DEPTH: Final = 0.62  # share of the pure colour at an end of a picture's scale
_EVERY: Final = 6  # updates from one picture of the plane to the next


def examples(seed: int) -> tuple[Array, Array]:
    """Return points (80, 2) of tilt and place from -1 to 1, and targets (80, 1): 1 leans towards the pad, -1 away."""
    rng = np.random.default_rng(seed)
    signs = np.repeat([(-1, -1), (-1, 1), (1, -1), (1, 1)], QUARTER, axis=0)
    points = signs * rng.uniform(_GAP, 1.0, signs.shape)
    away = signs[:, :1] * signs[:, 1:] > 0
    return points.astype(np.float32), np.where(away, -1.0, 1.0).astype(np.float32)


def network_of(units: int, seed: int) -> NeuralNetwork:
    """Return an untrained network of two inputs, hidden tanh units or none, and one tanh output."""
    network = NeuralNetwork(*CostFunctions.use_mse(), rng=np.random.default_rng(seed))
    for inputs, outputs in ((2, units), (units, 1)) if units else ((2, 1),):
        network.add_layer(FullyConnectedLayer(inputs, outputs))
        network.add_layer(ActivationLayer(*ActivationFunctions.use_tanh()))
    return network


class Divided:
    """Training on points of two kinds, and what the network answers on the whole plane.

    Attributes:
        units: hidden units of the network.
        network: the network that is trained.
        right: number of points on the right side, when it was last asked.
        planes: what its hidden units and its output say at every place, (units + 1, cells, cells).
        version: counter of these answers.
        results: by number of hidden units, how many points were divided right at best.

    """

    def __init__(self) -> None:
        cells = np.linspace(-1.0, 1.0, _CELLS)  # the middles of the picture's cells, column by column
        self._places = np.stack(np.meshgrid(cells, cells, indexing="ij"), axis=-1).reshape(-1, 2).astype(np.float32)
        self.points, self.targets = examples(0)
        self.units = self._seed = self.version = 0
        self.results: dict[int, int] = {}
        self.begin()

    def begin(self) -> None:
        """Begin training from new first weights."""
        self.network, self._optimizer = network_of(self.units, self._seed), Adam(_RATE)
        self.steps = 0
        self._seed += 1
        self._look()

    def choose(self, index: int) -> None:
        """Train with another number of hidden units, an index into `UNITS`."""
        self.units = UNITS[index]
        self.begin()

    def step(self) -> bool:
        """Take a learning step, unless there were enough; return whether this has shown something."""
        if self.steps >= STEPS:
            return False
        self.network.train_batch(self.points, self.targets, self._optimizer)
        self.steps += 1
        if self.steps % _EVERY == 0:
            self._look()
        if self.steps < SPOKEN or self.right <= self.results.get(self.units, -1):
            return False
        self.results[self.units] = self.right
        return True

    def _look(self) -> None:
        """Ask the network, at every place of the plane, for what its hidden units and its output say."""
        stages = self.network.activations(self._places)
        hidden = stages[1] if self.units else np.empty((len(self._places), 0))
        self.planes = np.concatenate([hidden, stages[-1]], axis=1).T.reshape(-1, _CELLS, _CELLS)
        self.version += 1
        self.right = int(((self.network.predict(self.points) > 0) == (self.targets > 0)).sum())

    def verdict(self) -> int | None:
        """Return the fewest neurons that divided nearly all points; None before all fewer ones were tried, too."""
        for answer, units in enumerate(UNITS[:-1]):
            if units not in self.results:
                return None
            if self.results[units] >= NEARLY * len(self.points):
                return answer
        return None


class PlaneChapter(Chapter):
    """The points, and the plane in the colour of what the network answers there."""

    key, door = "plane", Route("train")
    model: Divided

    def __init__(self, context: Context) -> None:
        super().__init__(context)
        self._cache = PaintCache(most=2 * max(UNITS) + 4)
        self.model = Divided()

    def controls(self, column: Column) -> None:
        at = UNITS.index(self.model.units)
        column.choice(texts.LEARN_PLANE_UNITS, list(map(str, UNITS)), at, self.model.choose).by_arrows = True
        column.button(texts.LEARN_PLANE_AGAIN, self.model.begin)

    def why(self) -> str:
        return " ".join(
            texts.LEARN_PLANE_WHY.format(units=units, right=right, count=len(self.model.points))
            for units, right in sorted(self.model.results.items())
        )

    def below(self, column: Column) -> None:
        column.text(
            lambda: texts.LEARN_PLANE_STATE.format(
                right=self.model.right, count=len(self.model.points), steps=self.model.steps
            ),
            size=SMALL,
        )

    def draw(self, canvas: Canvas, box: pygame.FRect) -> None:
        side, points, targets = box.height - 22, self.model.points, self.model.targets
        plane = pygame.FRect(box.left, box.top, side, side)
        self._draw_plane(canvas, plane, -1)
        canvas.line((plane.centerx, plane.top), (plane.centerx, plane.bottom), FAINT)
        canvas.line((plane.left, plane.centery), (plane.right, plane.centery), FAINT)
        for (x, y), target in zip(points.tolist(), targets[:, 0].tolist(), strict=True):
            place = (plane.centerx + x * side / 2, plane.centery - y * side / 2)
            colour = canvas.palette.good if target > 0 else canvas.palette.warn
            canvas.marker("ring" if target > 0 else "triangle", place, 9, colour)
        left, right, below, above = texts.LEARN_PLANE_AXES
        y = plane.bottom + 17
        canvas.text(left, (plane.left, y), size=LABEL, colour=MUTE, room=side / 2 - 8)
        canvas.text(right, (plane.right, y), size=LABEL, colour=MUTE, align="right", room=side / 2 - 8)
        beside = pygame.FRect(plane.right + 12, plane.top, box.right - plane.right - 12, side)
        for text, y in ((above, plane.top + 12), (below, plane.bottom - 2)):
            canvas.text(text, (beside.left, y), size=LABEL, colour=MUTE, room=beside.width / 2)
        self._draw_network(canvas, beside)

    def _draw_plane(self, canvas: Canvas, box: pygame.FRect, number: int) -> None:
        """Draw what a hidden unit says everywhere, or the output, number -1: `warn` at -1, dark at 0, `good` at 1."""
        warn, good = (np.array(each, float) for each in (canvas.palette.warn, canvas.palette.good))
        share = _DEPTH * self.model.planes[number][:, ::-1, None]

        def paint(sheet: Canvas) -> None:
            colours = NIGHT0 + np.abs(share) * (np.where(share < 0, warn, good) - NIGHT0)
            away = np.abs(share) / (np.hypot(*np.gradient(share, axis=(0, 1))) + 1e-9)  # cells from where it is 0
            colours += np.clip(0.9 - away, 0.0, 1.0) * (np.array(INK) - colours)
            picture = pygame.surfarray.make_surface(colours.astype(np.uint8))
            sheet.surface.blit(pygame.transform.smoothscale(picture, sheet.size), (0, 0))

        self._cache.draw(canvas, box, (self.model.version, number % len(self.model.planes)), paint)

    def _draw_network(self, canvas: Canvas, box: pygame.FRect) -> None:
        """Draw each hidden unit as its own map of the plane, with lines as wide as the weights."""
        count = self.model.units
        mini = min(0.1 * box.height, 0.22 * box.width)
        units = [
            pygame.FRect(box.left + 0.5 * box.width, box.centery + (number - count / 2) * 1.16 * mini, mini, mini)
            for number in range(count)
        ]
        out = pygame.FRect(box.right - 1.3 * mini, box.centery - 0.65 * mini, 1.3 * mini, 1.3 * mini)
        inputs = [(box.left + 0.2 * box.width, box.centery + side * 0.16 * box.height) for side in (-1, 1)]
        layers = [layer for layer in self.model.network.layers if isinstance(layer, FullyConnectedLayer)]
        sources, targets = [inputs, [unit.midright for unit in units]], [units, [out]] if units else [[out]]
        for layer, starts, ends in zip(layers, sources, targets, strict=False):
            for row, start in enumerate(starts):
                for column, end in enumerate(ends):
                    weight = float(layer.weights[row, column])
                    colour = canvas.palette.good if weight > 0 else canvas.palette.warn
                    canvas.line(start, end.midleft, colour, min(0.5 + abs(weight), 4.0), 0.55)
        for name, (x, y) in zip(texts.LEARN_PLANE_INPUTS, inputs, strict=True):
            canvas.dot((x, y), 5, INK)
            canvas.text(name, (x, y - 12), size=LABEL, colour=MUTE, align="centre", room=0.36 * box.width)
        for number, unit in enumerate(units):
            self._draw_plane(canvas, unit, number)
        self._draw_plane(canvas, out, -1)
