"""Frames that show a network: the values that flow through it, each unit's sum written out."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from itertools import pairwise, product
from typing import Final

import numpy as np
import pygame

from ai.explain.recorder import Function
from ai.nn import Array
from game.core import texts
from game.drawing.canvas import Canvas, Point
from game.drawing.tokens import INK, LINE, MUTE, NET
from game.lesson.frame import PICTURE, SMALL_PICTURE, Explanation, Frame, Spot
from game.lesson.step import LearningStep, WeightPlace
from game.panels.figures import number, points, signed
from game.panels.network_plan import Show
from game.panels.network_view import NetworkView
from game.ui.tooltip import TooltipRow

_TERMS: Final = 6  # products of a unit's sum that are written out one by one; the others are summed
_MOST_NAMED: Final = 12  # inputs up to which their names stand beside them
_UNNAMED: Final = (" " * 32,)  # keeps the room of a name free, for the legend below
_SMALL_NET: Final = ((3.0, 3), (15.0, 4), (27.0, 3))  # layers in the strip: where, and how many units
_REACH: Final = 5.0  # points from an edge within which it is pointed at


class NetworkFrame(Frame):
    """Frame with a drawing of the network in `box`, in points from the picture's corner."""

    def __init__(
        self,
        name: str,
        figure: str,
        sentence: str,
        functions: Sequence[Function],
        step: LearningStep,
        box: pygame.typing.RectLike,
        show: Show,
        flowing: Array,
    ) -> None:
        super().__init__(name, figure, sentence, functions)
        self.step = step
        names = step.inputs if len(step.inputs) <= _MOST_NAMED else _UNNAMED
        self.view = NetworkView(pygame.FRect(box).move(PICTURE.topleft), names, step.outputs)
        self.view.reads_out, self.view.show, self.view.output_scale = False, show, step.scale
        self._pointed_link: tuple[Point, Point] | None = None
        self._network = step.network.copy()
        self.flow(flowing)

    def flow(self, gradient: Array) -> None:
        """Show a gradient (parameters,) as the one that flows back."""
        self._network.gradients[:] = gradient
        self.view.set(self._network, self.step.observation)

    def update(self, still: bool) -> None:
        """Paint a part of what is new, and let pulses travel."""
        self.view.update(at_once=still)

    def follow(self, point: Point | None) -> None:
        """Point at a place; the links of a unit there are lit."""
        self._pointed_link = None
        super().follow(point)
        self.view.hover(point)

    def draw_live(self, canvas: Canvas) -> None:
        """Draw the network, and the link that is pointed at."""
        self.view.draw(canvas)
        if self._pointed_link:
            canvas.line(*self._pointed_link, INK, 1.5)

    def paint_small(self, canvas: Canvas) -> None:
        """Paint a net of three layers, of which the values come out on the right."""
        layers = [[(x, SMALL_PICTURE[1] * (row + 0.5) / count) for row in range(count)] for x, count in _SMALL_NET]
        for left, right in pairwise(layers):
            for start, end in product(left, right):
                canvas.line(start, end, LINE)
        for layer in layers:
            for place in layer:
                canvas.dot(place, 2, NET if layer is layers[-1] else MUTE)

    # What is pointed at

    def spot_at(self, place: Point) -> Spot | None:
        """Return the unit or the link at a place."""
        point = (place[0] + PICTURE.x, place[1] + PICTURE.y)
        unit = self.view.unit_at(point)
        if unit is not None:
            return Spot(self._box(self.view.centres[unit[0]][unit[1]]), self.unit(*unit))
        return self._link_at(point)

    def _link_at(self, point: Point) -> Spot | None:
        centres = self.view.centres
        away = [
            (_distance(point, centres[edge.column][edge.start], centres[edge.column + 1][edge.end]), -edge.size, number)
            for number, edge in enumerate(self.view.edges)
        ]
        if not away or min(away)[0] > _REACH:
            return None
        edge = self.view.edges[min(away)[2]]
        columns = self.view.columns
        weight = WeightPlace(
            edge.column,
            int(columns[edge.column].units[edge.start]),
            int(columns[edge.column + 1].units[edge.end]),
        )
        self._pointed_link = centres[edge.column][edge.start], centres[edge.column + 1][edge.end]
        return Spot(self._box(point, 0.0), self.link(weight), self.picks(weight))

    def picks(self, weight: WeightPlace) -> Callable[[], None] | None:  # noqa: ARG002
        """Return what a press on a link does; None for nothing."""
        return None

    def _box(self, point: Point, size: float = 12.0) -> pygame.FRect:
        return pygame.FRect(point[0] - PICTURE.x - size / 2, point[1] - PICTURE.y - size / 2, size, size)

    def unit_name(self, column: int, unit: int) -> str:
        """Return the name of a unit of a column, by its number in the layer."""
        names = self.step.inputs if column == 0 else self.step.outputs if column == len(self.step.weights) else ()
        return names[unit] if unit < len(names) else texts.NETWORK_VIEW_UNIT.format(layer=column, unit=unit + 1)

    def weight_name(self, weight: WeightPlace) -> str:
        """Return the names of the units that a weight connects."""
        start, end = self.unit_name(weight.link, weight.start), self.unit_name(weight.link + 1, weight.end)
        return texts.LESSON_WEIGHT_NAME.format(start=start, end=end)

    def unit(self, column: int, place: int) -> Explanation:
        """Explain the unit at a place of a column: its sum, and all that is made of it."""
        unit = int(self.view.columns[column].units[place])
        name, shown = self.unit_name(column, unit), self.view.columns[column].values[place]
        if column == 0:
            return Explanation((name,), (TooltipRow(texts.LESSON_SENSED, number(float(shown))),))
        link, stages = self.step.weights[column - 1], self.step.stages[column - 1]
        into = self._given(column - 1)
        products = into * link.weights[:, unit]
        strongest = np.argsort(-np.abs(np.nan_to_num(products)), kind="stable")[:_TERMS]
        rows = [
            TooltipRow(
                texts.LESSON_TERM.format(
                    name=self.unit_name(column - 1, int(start)),
                    value=number(float(into[start])),
                    weight=number(float(link.weights[start, unit])),
                ),
                signed(float(products[start])),
            )
            for start in strongest
        ]
        if others := len(products) - len(rows):
            rest = float(products.sum() - products[strongest].sum())
            rows.append(TooltipRow(texts.LESSON_OTHERS.format(count=others), signed(rest)))
        rows.append(TooltipRow(texts.NETWORK_VIEW_BIAS, signed(float(link.bias[unit]))))
        rows += [
            TooltipRow(texts.LESSON_STAGES.get(kind, kind), number(float(values[unit])), INK) for kind, values in stages
        ]
        if column == len(self.step.weights) and self.step.scale != 1.0:
            scaled = float(stages[-1][1][unit]) / self.step.scale
            rows.append(TooltipRow(texts.LESSON_IN_POINTS.format(scale=f"{self.step.scale:g}"), points(scaled)))
        return Explanation((name, texts.LESSON_SUM), tuple(rows))

    def _given(self, link: int) -> Array:
        """Return what a link is given: the observation, or what the stage before it gives, (units,)."""
        return self.step.stages[link - 1][-1][1] if link else np.asarray(self.step.given, float)

    def link(self, weight: WeightPlace) -> Explanation:
        """Explain a weight: what it multiplies, its slope, and its step."""
        value = float(self.step.weights[weight.link].weights[weight.start, weight.end])
        into = float(self._given(weight.link)[weight.start])
        rows = [
            TooltipRow(texts.LESSON_WEIGHT, number(value)),
            TooltipRow(texts.LESSON_TIMES.format(value=number(into)), signed(into * value)),
        ]
        index = self.step.index(weight)
        if index is not None:
            rows += [
                TooltipRow(texts.LESSON_SLOPE_BATCH, signed(float(self.step.taken.gradient[index]))),
                TooltipRow(texts.LESSON_SLOPE_SHARE, signed(float(self.step.taken.share[index]))),
                TooltipRow(texts.LESSON_STEP, signed(-float(self.step.taken.taken[index]))),
            ]
        return Explanation((self.weight_name(weight),), tuple(rows))


def _distance(point: Point, start: Point, end: Point) -> float:
    """Return how far a point is from a piece of a line, in points."""
    across, down = end[0] - start[0], end[1] - start[1]
    length = across**2 + down**2
    share = ((point[0] - start[0]) * across + (point[1] - start[1]) * down) / length if length else 0.0
    share = min(max(share, 0.0), 1.0)
    return math.dist(point, (start[0] + share * across, start[1] + share * down))
