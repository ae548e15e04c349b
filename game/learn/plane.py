"""Chapter 2, a second layer: points that no line divides, and a small network that is trained on them live."""

from __future__ import annotations

from collections.abc import Sequence
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
    Optimizer,
)
from game.core import texts
from game.core.scene import Route
from game.core.source import Mark
from game.drawing.canvas import Canvas
from game.drawing.paint_cache import PaintCache
from game.drawing.tokens import FAINT, INK, LABEL, MUTE, SMALL
from game.learn.chapter import STAGE, Chapter, Code
from game.learn.heat import grid, paint_heat
from game.ui.context import Context
from game.ui.widget import PointsManager, Widget
from game.ui.widgets import Choice, TextButton

UNITS: Final = (0, 2, 4, 8)  # hidden units to choose from
QUARTER: Final = 20  # points in each quarter of the plane
STEPS: Final = 1200  # learning steps after which training rests
SPOKEN: Final = 300  # learning steps after which a try says something
_RATE: Final = 0.02
_GAP: Final = 0.12  # no point is nearer to an axis
_CELLS: Final = 40
_EVERY: Final = 6  # updates from one picture of the plane to the next
_SIDE: Final = 400.0
_PLANE: Final = pygame.FRect(STAGE.left, STAGE.top + 4, _SIDE, _SIDE)
_MINI: Final = 42.0
_PITCH: Final = 49.0
_UNITS_X: Final = STAGE.left + 590
_OUT: Final = pygame.FRect(STAGE.right - 64, STAGE.top + 4 + _SIDE / 2 - 28, 56, 56)
_INPUTS_X: Final = STAGE.left + 490


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
    if units:
        network.add_layer(FullyConnectedLayer(2, units)).add_layer(_tanh())
    return network.add_layer(FullyConnectedLayer(units or 2, 1)).add_layer(_tanh())


def _tanh() -> ActivationLayer:
    return ActivationLayer(*ActivationFunctions.use_tanh())


class PlaneChapter(Chapter):
    """Training on points of two kinds; the plane's colour is what the network answers there.

    Attributes:
        units: hidden units of the network.
        network: the network that is trained.
        results: by number of hidden units, how many points were divided right at best.

    """

    key = "plane"
    answer = 2
    door = Route("train")

    def __init__(self, context: Context, manager: PointsManager) -> None:
        super().__init__(context, manager)
        self._cache, self._places = PaintCache(most=2 * max(UNITS) + 4), grid(_CELLS, _CELLS)
        self.points, self.targets = examples(0)
        self.restart()

    def restart(self) -> None:
        """Forget all tries, and begin with a single neuron."""
        self.units, self._seed, self.tried = 0, 0, False
        self.results: dict[int, int] = {}
        self._version = 0
        self.begin()

    def begin(self) -> None:
        """Begin training from new first weights."""
        self.network, self._optimizer = network_of(self.units, self._seed), Adam(_RATE)
        self.steps, self.cost = 0, float("nan")
        self._seed += 1
        self._look()

    @property
    def right(self) -> int:
        """Number of points on the right side."""
        return int(((self.network.predict(self.points) > 0) == (self.targets > 0)).sum())

    def widgets(self) -> list[Widget]:
        """Return the choice of hidden units, and a button for other first weights."""
        words = [str(units) for units in UNITS]
        units = Choice(self.manager, self.row(0), texts.LEARN_PLANE_UNITS, words, UNITS.index(self.units),
                       self._choose, label_width=150)  # fmt: skip
        return [units, TextButton(self.manager, self.row(1), texts.LEARN_PLANE_AGAIN, self.begin)]

    def _choose(self, index: int) -> None:
        self.units = UNITS[index]
        self.begin()

    def update(self) -> None:
        """Take one learning step on all points."""
        if self.steps < STEPS:
            self.cost = self.network.train_batch(self.points, self.targets, self._optimizer)
            self.steps += 1
            if self.steps % _EVERY == 0:
                self._look()
            if self.steps >= SPOKEN:
                self.results[self.units] = max(self._shown, self.results.get(self.units, 0))
                self.tried = True

    def _look(self) -> None:
        """Ask the network, at every place of the plane, for what its hidden units and its output say."""
        stages = self.network.activations(self._places)
        hidden = stages[1] if self.units else np.empty((len(self._places), 0))
        planes = np.concatenate([hidden, stages[-1]], axis=1)
        self._planes = planes.T.reshape(-1, _CELLS, _CELLS)
        self._version += 1
        self._shown = self.right

    # What it tells

    def why(self, guess: int | None) -> str:  # noqa: ARG002
        """Return how many points were on the right side, for each number of hidden units that was tried."""
        count = len(self.points)
        return " ".join(
            texts.LEARN_PLANE_WHY.format(units=units, right=self.results[units], count=count)
            for units in sorted(self.results)
        )

    def code(self) -> Sequence[Code]:
        """Return a pass through the layers, and a learning step, with this network's shapes and cost."""
        stages = self.network.activations(self.points)
        shapes = " → ".join(str(stage.shape[1]) for stage in (self.points, *stages[1::2]))
        passes: dict[Mark, str] = {FullyConnectedLayer.forward_propagate: shapes}
        step: dict[Mark, str] = {"cost": f"{self.cost:.4f}", Optimizer.step: f"{self.network.values.size}"}
        return [
            Code(NeuralNetwork.forward_propagate, FullyConnectedLayer.forward_propagate, passes),
            Code(NeuralNetwork.correct, NeuralNetwork.backward_propagate, step),
        ]

    def draw(self, canvas: Canvas, alpha: float) -> None:  # noqa: ARG002
        """Draw the plane with its points, and the network beside it."""
        self._draw_plane(canvas, _PLANE, -1)
        canvas.line((_PLANE.centerx, _PLANE.top), (_PLANE.centerx, _PLANE.bottom), FAINT)
        canvas.line((_PLANE.left, _PLANE.centery), (_PLANE.right, _PLANE.centery), FAINT)
        for (x, y), target in zip(self.points.tolist(), self.targets[:, 0].tolist(), strict=True):
            place = (_PLANE.centerx + x * _SIDE / 2, _PLANE.centery - y * _SIDE / 2)
            colour = canvas.palette.good if target > 0 else canvas.palette.warn
            canvas.marker("ring" if target > 0 else "triangle", place, 9, colour)
        self._draw_axes(canvas)
        self._draw_network(canvas)

    def _draw_plane(self, canvas: Canvas, box: pygame.FRect, number: int) -> None:
        colours, values = (canvas.palette.warn, canvas.palette.good), self._planes[number]
        shows = (self._version, number % len(self._planes))
        self._cache.draw(canvas, box, shows, lambda sheet: paint_heat(sheet, values, *colours))

    def _draw_axes(self, canvas: Canvas) -> None:
        left, right, below, above = texts.LEARN_PLANE_AXES
        y = _PLANE.bottom + 18
        canvas.text(left, (_PLANE.left, y), size=LABEL, colour=MUTE, room=_SIDE / 2 - 8)
        canvas.text(right, (_PLANE.right, y), size=LABEL, colour=MUTE, align="right", room=_SIDE / 2 - 8)
        for text, y in ((above, _PLANE.top + 10), (below, _PLANE.bottom - 2)):
            canvas.text(text, (_PLANE.right + 8, y), size=LABEL, colour=MUTE, room=124)

    def _draw_network(self, canvas: Canvas) -> None:
        """Draw each hidden unit as its own map of the plane, with lines as wide as the weights."""
        boxes = [
            pygame.FRect(_UNITS_X, _PLANE.centery + (number - self.units / 2) * _PITCH, _MINI, _MINI)
            for number in range(self.units)
        ]
        inputs = [(_INPUTS_X, _PLANE.centery + side * 60.0) for side in (-1, 1)]
        layers = [layer for layer in self.network.layers if isinstance(layer, FullyConnectedLayer)]
        targets = [boxes, [_OUT]] if boxes else [[_OUT]]
        sources = [inputs, [box.midright for box in boxes]]
        for layer, starts, ends in zip(layers, sources, targets, strict=False):
            for row, start in enumerate(starts):
                for column, end in enumerate(ends):
                    weight = float(layer.weights[row, column])
                    colour = canvas.palette.good if weight > 0 else canvas.palette.warn
                    canvas.line(start, end.midleft, colour, min(0.5 + abs(weight), 4.0), 0.55)
        for name, place in zip(texts.LEARN_PLANE_INPUTS, inputs, strict=True):
            canvas.dot(place, 5, INK)
            canvas.text(name, (place[0] - 4, place[1] - 12), size=LABEL, colour=MUTE, align="centre", room=96)
        for number, box in enumerate(boxes):
            self._draw_plane(canvas, box, number)
        self._draw_plane(canvas, _OUT, -1)
        told = texts.LEARN_PLANE_STATE.format(right=self._shown, count=len(self.points), steps=self.steps)
        canvas.text(told, (STAGE.right, _PLANE.bottom + 20), size=SMALL, align="right", tabular=True, room=330)
