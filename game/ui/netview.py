"""A network, drawn: its units in columns, the strongest links between them, and what runs along these now.

Blue adds and orange takes away, told apart by eyes of every kind. What is drawn is kept on two sheets, one of
light and one of signs, until the numbers change; only the pulses of learning are drawn every frame.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final, Literal

import numpy as np
import numpy.typing as npt
import pygame

from ai.inspect import Link, links, traces
from ai.nn import NeuralNetwork
from game import texts
from game.ui import plotting, typeface
from game.ui.canvas import Align, Canvas, Point
from game.ui.tokens import EMBER, FAINT, INK, LABEL, MUTE, NET, NIGHT0, NIGHT1, SMALL, Colour
from game.ui.tooltip import Row, draw_tooltip

Show = Literal["weights", "activations", "gradients"]
Indices = npt.NDArray[np.intp]
Numbers = npt.NDArray[np.floating[Any]]

ADDS: Final = NET
TAKES: Final = EMBER

_FOOT: Final = 18.0  # for the legend and the numbers of units
_PITCH: Final = 13.0  # points between units, at least
_MOST_UNITS: Final = 24  # in a column
_LOYALTY: Final = 1.5  # how much stronger a unit must be than one that is shown to take its place
_REST: Final = 6  # sixtieths of a second between two drawings of new numbers
_FLOW: Final = 1 / 90  # of an edge that a pulse travels in a sixtieth of a second
_MOST_PULSES: Final = 26
_ROOMY: Final = 36.0  # points between units, from which on their values are written beside them
_GOLDEN: Final = 0.618034


@dataclass(frozen=True)
class Column:
    """One stage of units, as far as it is shown.

    Attributes:
        units: (k,) numbers of those that are shown, rising.
        total: how many there are.
        values: (k,) activations; NaN where unknown or damaged.
        bias: (k,) or None for the inputs.
        damaged: (k,) whether any of a unit's numbers is not finite.

    """

    units: Indices
    total: int
    values: Numbers
    bias: Numbers | None
    damaged: npt.NDArray[np.bool_]


@dataclass(frozen=True)
class Edge:
    """A link that is drawn, from a unit of `column` to one of the next, both by their place among the shown."""

    column: int
    start: int
    end: int
    size: float  # 0 to 1, of the largest between these columns
    positive: bool


def steady_choice(strength: Numbers, most: int, before: Indices | None = None) -> Indices:
    """Return the `most` strongest units, rising; those of `before` stay until another is much stronger."""
    if len(strength) <= most:
        return np.arange(len(strength))
    strength = np.nan_to_num(np.asarray(strength, float), nan=np.inf, posinf=np.inf)  # damage is to be seen
    if before is not None and len(before) == most and before[-1] < len(strength):
        strength[before] *= _LOYALTY
    return np.sort(np.argsort(-strength, kind="stable")[:most])


def strongest_edges(matrix: Numbers, column: int, most: int) -> list[Edge]:
    """Return the `most` largest numbers of a matrix (starts, ends) as edges, the faintest first."""
    size = np.nan_to_num(np.abs(matrix).astype(float), nan=0.0, posinf=0.0).ravel()
    chosen = np.argsort(size, kind="stable")[-most:]
    largest = float(size[chosen[-1]]) if len(chosen) else 0.0
    if not largest > 0:
        return []
    ends = matrix.shape[1]
    signs = matrix.ravel() > 0
    return [
        Edge(column, int(index) // ends, int(index) % ends, float(size[index] / largest), bool(signs[index]))
        for index in chosen
        if size[index] > 0.02 * largest
    ]


class NetView:
    """The drawing in a box of points, of any size. `inputs` and `outputs` name what goes in and comes out."""

    def __init__(self, box: pygame.typing.RectLike, inputs: Sequence[str] = (), outputs: Sequence[str] = ()) -> None:
        self.box = pygame.FRect(box)
        self.inputs, self.outputs = tuple(inputs), tuple(outputs)
        self.columns: list[Column] = []
        self.edges: list[Edge] = []
        self.redraws = 0  # how often the sheets were drawn
        self._show: Show = "weights"
        self._links: list[Link] = []
        self._hovered: tuple[int, int] | None = None
        self._sheets: tuple[Canvas, Canvas] | None = None
        self._stale = True
        self._still = False
        self._rested = 0
        self._phase = 0.0

    # What is shown

    @property
    def show(self) -> Show:
        """What the edges stand for: "weights", "activations" or "gradients"."""
        return self._show

    @show.setter
    def show(self, show: Show) -> None:
        if show != self._show:
            self._show = show
            self._pick_edges()
            self._sheets = None

    def place(self, box: pygame.typing.RectLike) -> None:
        """Move to another box; a larger one shows more units."""
        if pygame.FRect(box) != self.box:
            self.box = pygame.FRect(box)
            self._sheets = None

    def set(self, network: NeuralNetwork, observation: npt.ArrayLike | None = None) -> None:
        """Show a network as it is now, and what it makes of an observation (inputs,), as the network takes it.

        All numbers are read at once: the network may be changed afterwards.
        """
        found = links(network)
        sizes = [len(found[0].weights), *(len(link.bias) for link in found)] if found else []
        values = traces(network, observation) if observation is not None else []
        if [np.shape(each) for each in values] != [(size,) for size in sizes]:
            values = [np.full(size, np.nan) for size in sizes]
        known = observation is not None
        before = [column.units for column in self.columns] if [c.total for c in self.columns] == sizes else None
        columns = []
        for stage, size in enumerate(sizes):
            strength = _strength(found, stage)
            units = steady_choice(strength, self._most_units, before[stage] if before else None)
            bias = found[stage - 1].bias[units].copy() if stage else None
            damaged = ~np.isfinite(strength[units])
            if known:
                damaged |= ~np.isfinite(values[stage][units])
            columns.append(Column(units, size, values[stage][units].astype(float), bias, damaged))
        self._links = [
            Link(*(_shown(each, left.units, right.units) for each in (link.weights, link.bias, link.gradient)))
            for link, left, right in zip(found, columns[:-1], columns[1:], strict=True)
        ]
        self.columns = columns
        self._pick_edges()
        self._stale = True

    @property
    def _most_units(self) -> int:
        return int(min(max((self.box.height - _FOOT) // _PITCH, 2), _MOST_UNITS))

    def _pick_edges(self) -> None:
        most = int(min(max(0.3 * self.box.height, 16), 140))
        self.edges = []
        for number, link in enumerate(self._links):
            with np.errstate(all="ignore"):
                if self._show == "gradients":
                    matrix = -link.gradient  # the way in which learning moves the weight
                elif self._show == "activations":
                    matrix = link.weights * self.columns[number].values[:, None]
                else:
                    matrix = link.weights
            self.edges += strongest_edges(matrix, number, most)
        self.edges.sort(key=lambda edge: edge.size)

    def hover(self, point: Point | None) -> None:
        """Let the unit under a point of the canvas stand out; None for none."""
        hovered = self.unit_at(point) if point else None
        if hovered != self._hovered:
            self._hovered = hovered
            self._sheets = None

    def unit_at(self, point: Point) -> tuple[int, int] | None:
        """Return the column and the place in it of the unit at a point of the canvas."""
        if not self.box.inflate(8, 8).collidepoint(point):
            return None
        places = [(number, k) for number, column in enumerate(self.columns) for k in range(len(column.units))]
        if not places:
            return None
        away = [math.dist(point, self._centre(*place)) for place in places]
        nearest = int(np.argmin(away))
        return places[nearest] if away[nearest] <= max(10.0, 2.2 * self._radius) else None

    def update(self, at_once: bool = False) -> None:
        """Let 1/60 s pass: pulses travel, or stand still as brightness if all motion is to be `at_once`."""
        self._rested += 1
        self._still = at_once
        self._phase = (self._phase + _FLOW) % 1.0
        if self._stale and self._rested >= _REST:
            self._sheets = None

    # Where things are, in points

    @property
    def _name_size(self) -> float:
        return LABEL if self.box.height < 300 else SMALL

    @property
    def _sides(self) -> tuple[float, float]:
        """Room for the names on the left and on the right."""
        size = self._name_size
        left, right = (
            max((typeface.width(name, size, "regular") + 10 for name in names), default=4.0)
            for names in (self.inputs, self.outputs)
        )
        return left, right

    @property
    def _radius(self) -> float:
        crowd = max((len(column.units) for column in self.columns), default=1)
        return min(max(0.24 * (self.box.height - _FOOT) / crowd, 2.0), 7.0)

    def _centre(self, column: int, place: int) -> Point:
        left, right = self._sides
        box = self.box
        across = (column / (len(self.columns) - 1)) if len(self.columns) > 1 else 0.5
        count = len(self.columns[column].units)
        inner = box.height - _FOOT - 2 * self._radius - 4
        down = place / (count - 1) if count > 1 else 0.5
        x = box.x + left + self._radius + across * (box.width - left - right - 2 * self._radius)
        return x, box.y + self._radius + 2 + down * inner

    def _ends(self, edge: Edge) -> tuple[Point, Point]:
        return self._centre(edge.column, edge.start), self._centre(edge.column + 1, edge.end)

    # The picture

    def draw(self, canvas: Canvas) -> None:
        """Draw the network, and the pulses and the read-out over it."""
        if self._sheets is None or self._sheets[0].scale != canvas.scale:
            self._sheets = self._paint(canvas)
            self._stale, self._rested = False, 0
        corner = (canvas.px(self.box.x) - canvas.px(8), canvas.px(self.box.y) - canvas.px(8))
        light, signs = self._sheets
        canvas.surface.blit(light.surface, corner, special_flags=pygame.BLEND_RGB_ADD)
        canvas.surface.blit(signs.surface, corner)
        if self._show == "gradients" and not self._still:
            self._draw_pulses(canvas)
        if self._hovered:
            self._draw_readout(canvas, *self._hovered)

    def _paint(self, canvas: Canvas) -> tuple[Canvas, Canvas]:
        self.redraws += 1
        light, signs = (canvas.sheet(self.box.width + 16, self.box.height + 16) for _ in range(2))
        light.surface = pygame.Surface(light.size)
        shift = (8 - self.box.x, 8 - self.box.y)
        for edge in self.edges:
            self._paint_edge(light, edge, shift)
        for number, column in enumerate(self.columns):
            for place in range(len(column.units)):
                self._paint_unit(light, signs, number, place, shift)
            self._paint_names(signs, number, column, shift)
        self._paint_legend(signs, shift)
        return light, signs

    def _paint_edge(self, light: Canvas, edge: Edge, shift: Point) -> None:
        touched = self._hovered in ((edge.column, edge.start), (edge.column + 1, edge.end))
        strength = 0.10 + 0.62 * edge.size**1.5
        if self._hovered:
            strength = 0.35 + 0.65 * edge.size if touched else 0.25 * strength
        wide = 0.7 + 1.3 * edge.size * min(1.0, self.box.height / 300)
        half = 0.5 / light.scale  # a line runs through the middles of pixels, a dot lies between them
        start, end = (_moved(_moved(point, shift), (-half, -half)) for point in self._ends(edge))
        light.line(start, end, _dimmed(ADDS if edge.positive else TAKES, strength), wide)

    def _brightness(self, column: int) -> Numbers:
        """Return how the units are lit, (k,) in -1 to 1."""
        values = self.columns[column].values
        finite = values[np.isfinite(values)]
        if not len(finite):
            return np.zeros(len(values))
        values = np.nan_to_num(values, nan=0.0, posinf=0.0, neginf=0.0)
        if column == len(self.columns) - 1:
            span = float(np.ptp(finite))
            return (values - finite.min()) / span if span > 0 else np.full(len(values), 0.5)
        least = 1.0 if column == 0 else 1e-9
        lit: Numbers = values / max(float(np.abs(finite).max()), least)
        return lit

    def _best(self) -> int | None:
        values = self.columns[-1].values
        return int(np.nanargmax(values)) if len(self.columns[-1].units) > 1 and np.isfinite(values).any() else None

    def _paint_unit(self, light: Canvas, signs: Canvas, number: int, place: int, shift: Point) -> None:
        centre, radius = _moved(self._centre(number, place), shift), self._radius
        column = self.columns[number]
        lit = float(self._brightness(number)[place])
        chosen = number == len(self.columns) - 1 and place == self._best()
        tone = NET if chosen else INK if lit >= 0 else TAKES
        if abs(lit) > 0.55:
            light.glow(centre, 4.2 * radius, tone, 0.55 * abs(lit))
        signs.dot(centre, radius + 0.9, NIGHT0)
        signs.dot(centre, radius, NIGHT1)
        if column.damaged[place]:
            signs.marker("cross", centre, 2.2 * radius, signs.palette.warn)
            return
        signs.dot(centre, radius, FAINT, 0.75)
        if abs(lit) > 0.02:
            signs.dot(centre, radius, tone, abs(lit) ** 0.8)
        if self._hovered == (number, place):
            signs.marker("ring", centre, 2 * radius + 6, INK)

    def _paint_names(self, signs: Canvas, number: int, column: Column, shift: Point) -> None:
        last = len(self.columns) - 1
        names = self.inputs if number == 0 else self.outputs if number == last else ()
        best = self._best() if number == last else None
        size = self._name_size
        roomy = self.box.height / len(column.units) > _ROOMY and bool(np.isfinite(column.values).any())
        align: Align
        for place, unit in enumerate(column.units.tolist()):
            if unit >= len(names):
                break
            x, y = _moved(self._centre(number, place), shift)
            gap, align = (-self._radius - 6, "right") if number == 0 else (self._radius + 6, "left")
            where, y = x + gap, y + 0.36 * size - (7 if roomy else 0)
            signs.text(names[unit], (where, y), size=size, colour=NET if place == best else MUTE, align=align)
            if roomy:
                figure = plotting.compact(float(column.values[place]))
                signs.text(figure, (where, y + 15), size=size, colour=INK, align=align, tabular=True)
        if len(column.units) < column.total or 0 < number < last:
            shown = len(column.units)
            words = texts.NET_ALL if shown == column.total else texts.NET_SOME
            x, _ = _moved(self._centre(number, 0), shift)
            text = words.format(shown=shown, total=column.total)
            signs.text(text, (x, self.box.height + 8 - 3), size=LABEL - 1, colour=MUTE, align="centre")

    def _paint_legend(self, signs: Canvas, shift: Point) -> None:
        if not self.columns:
            middle = _moved(self.box.center, shift)
            signs.text(texts.CHART_EMPTY, middle, size=SMALL, colour=MUTE, align="centre")
            return
        y, (adds, takes) = self.box.height + 8 - 3, texts.NET_LEGEND[self._show]
        signs.pill((8, y - 5, 9, 2), ADDS)
        signs.text(adds, (21, y), size=LABEL - 1, colour=MUTE)
        word = signs.text(takes, (self.box.width + 8, y), size=LABEL - 1, colour=MUTE, align="right")
        signs.pill((word.left - 13, y - 5, 9, 2), TAKES)

    def _draw_pulses(self, canvas: Canvas) -> None:
        """Let light run backwards along the edges that learning moves most."""
        for number, edge in enumerate(self.edges[-_MOST_PULSES:]):
            along = (self._phase * (1.0 + 0.5 * (number % 3 == 0)) + _GOLDEN * number) % 1.0
            (x0, y0), (x1, y1) = self._ends(edge)
            place = (x1 + (x0 - x1) * along, y1 + (y0 - y1) * along)
            alpha = (0.35 + 0.65 * edge.size) * min(1.0, 6 * along, 6 * (1 - along))
            colour, radius = ADDS if edge.positive else TAKES, max(1.4, 0.4 * self._radius)
            canvas.glow(place, 4 * radius, colour, 0.5 * alpha)
            canvas.dot(place, radius, colour, alpha)

    def _draw_readout(self, canvas: Canvas, number: int, place: int) -> None:
        column = self.columns[number]
        if place >= len(column.units):
            return
        rows = [Row(texts.NET_VALUE, plotting.compact(float(column.values[place])))]
        if column.bias is not None:
            rows.append(Row(texts.NET_BIAS, plotting.compact(float(column.bias[place]))))
        head = self.name(number, place) + (texts.NET_DAMAGED if column.damaged[place] else "")
        draw_tooltip(canvas, self._centre(number, place), self.box, [head], rows)

    def name(self, number: int, place: int) -> str:
        """Return what a unit is called."""
        unit = int(self.columns[number].units[place])
        names = self.inputs if number == 0 else self.outputs if number == len(self.columns) - 1 else ()
        if unit < len(names):
            return names[unit]
        return texts.NET_UNIT.format(layer=number, unit=unit + 1)


def _strength(found: Sequence[Link], stage: int) -> Numbers:
    """Return how much hangs on each unit of a stage: the norms of what leads to it and away from it, multiplied."""
    with np.errstate(all="ignore"):
        away = np.linalg.norm(found[stage].weights, axis=1) if stage < len(found) else 1.0
        to = np.linalg.norm(found[stage - 1].weights, axis=0) + 0 * found[stage - 1].bias if stage else 1.0
        strength: Numbers = np.asarray(away * to, float)
    return strength


def _shown(array: Numbers, rows: Indices, columns: Indices) -> Numbers:
    """Return a copy of what is shown of weights (inputs, outputs), or of a bias (outputs,)."""
    return array[columns] if array.ndim == 1 else array[np.ix_(rows, columns)]


def _moved(point: Point, shift: Point) -> Point:
    return point[0] + shift[0], point[1] + shift[1]


def _dimmed(colour: Colour, strength: float) -> Colour:
    """Return a colour as light to be added."""
    red, green, blue = (round(min(max(strength, 0.0), 1.0) * part) for part in colour)
    return red, green, blue
