"""Drawing of a network: its units in columns, and the strongest links between them.

Blue adds and orange takes away, two colours that colour-blind eyes tell apart too. The drawing is cached on two
sheets, one of light and one of signs, until the numbers change; then new sheets are painted, a few edges a step, and
replace the old ones when finished.
"""

from __future__ import annotations

import math
from collections.abc import Generator, Sequence
from copy import copy
from typing import Final

import numpy as np
import numpy.typing as npt
import pygame

from ai.nn import NeuralNetwork
from game.core import texts
from game.drawing import typeface
from game.drawing.canvas import Align, Canvas, Point
from game.drawing.paint import mix
from game.drawing.tokens import EMBER, FAINT, INK, LABEL, MUTE, NET, NIGHT0, NIGHT1, SMALL, Colour
from game.explain.figures import decimal
from game.explain.network_plan import Column, Edge, NetworkPlan, Show
from game.ui import plotting
from game.ui.tooltip import TooltipRow, draw_tooltip

Sheets = tuple[Canvas, Canvas]  # additive light, and the signs above it

_ADDS: Final = NET
_BLACK: Final[Colour] = (0, 0, 0)
_TAKES: Final = EMBER
_LARGE: Final = 300.0  # points of height from which there is room for values beside the names
_MARGIN: Final = 8.0  # of the sheets around the box
_CHUNK: Final = 9_000.0  # pixels of edges drawn in one step: about a millisecond
_GLOWING: Final = 0.55  # units lit more than this shine on what is around them
_PITCH: Final = 13.0  # points between units, at least
_MOST_UNITS: Final = 24  # in a column
_REST: Final = 6  # sixtieths of a second between two drawings of new numbers


class NetworkView:
    """View of a network in a box of any size, in points. `inputs` and `outputs` are the names of its ends.

    Attributes:
        output_scale: one point of reward, in units of the network's outputs.
        lit: output in the colour of the chosen one; None for the largest.
        show: quantity that the edges show.
        plan: what is drawn of the network; None before one was set.
        hovered: column and place in it of the highlighted unit.
        centres: of all units that are shown, in points.

    """

    def __init__(self, box: pygame.typing.RectLike, inputs: Sequence[str] = (), outputs: Sequence[str] = ()) -> None:
        self.box = pygame.FRect(box)
        self.inputs, self.outputs = tuple(inputs), tuple(outputs)
        self.output_scale = 1.0
        self.lit: int | None = None
        self.show: Show = "weights"
        self.plan: NetworkPlan | None = None
        self._given: tuple[NeuralNetwork, npt.ArrayLike | None] | None = None
        self.hovered: tuple[int, int] | None = None
        self.centres: list[list[Point]] = []
        self._canvas: Canvas | None = None  # for which the sheets were painted
        self._sheets: Sheets | None = None
        self._painting: Generator[None, None, Sheets] | None = None
        self._painted: tuple[Show, tuple[int, int] | None] | None = None  # what they show, and what is highlighted
        self._stale, self._rested = False, 0

    @property
    def columns(self) -> list[Column]:
        """The shown columns of the network, one per layer."""
        return self.plan.columns if self.plan else []

    def set(self, network: NeuralNetwork, observation: npt.ArrayLike | None = None) -> None:
        """Show a network's current state, and its activations for an observation (inputs,) already normalised."""
        self._given, self._stale = (network, observation), True
        most = int(min(max((self.box.height - self._foot) // _PITCH, 2), _MOST_UNITS))
        self.plan = NetworkPlan(network, observation, most, self.plan)
        self.centres = self._lay_out()
        if self.hovered and self.hovered not in self._places():
            self.hovered = None

    def place(self, box: pygame.typing.RectLike) -> None:
        """Move to another box; a larger one shows more of the network."""
        if pygame.FRect(box) != self.box:
            self.box = pygame.FRect(box)
            self._sheets = self._painting = self.hovered = self._canvas = None
            if self._given:
                self.set(*self._given)

    def hover(self, point: Point | None) -> None:
        """Highlight the unit under a point of the canvas; None for none."""
        self.hovered = self.unit_at(point) if point else None

    def unit_at(self, point: Point) -> tuple[int, int] | None:
        """Return the column and the place in it of the unit at a point of the canvas."""
        if not self.centres or not self.box.inflate(8, 8).collidepoint(point):
            return None
        away = {(i, j): math.dist(point, self.centres[i][j]) for i, j in self._places()}
        nearest = min(away, key=away.__getitem__)
        return nearest if away[nearest] <= max(10.0, 2.2 * self.radius) else None

    def _places(self) -> list[tuple[int, int]]:
        return [(number, place) for number, column in enumerate(self.centres) for place in range(len(column))]

    def unit_name(self, column: int, unit: int) -> str:
        """Return the name of a unit, by its number in the layer."""
        names = self.names(column)
        return names[unit] if unit < len(names) else texts.NETWORK_VIEW_UNIT.format(layer=column, unit=unit + 1)

    def unit_of(self, number: int) -> float:
        """Return the divisor for a column's displayed values; outputs are shown in points of reward."""
        return self.output_scale if number == len(self.columns) - 1 else 1.0

    def names(self, number: int) -> tuple[str, ...]:
        """Return the names of a column's units, as far as they have any."""
        return self.inputs if number == 0 else self.outputs if number == len(self.columns) - 1 else ()

    def update(self) -> None:
        """Advance by 1/60 s: if new sheets are due, part of them is painted."""
        self._rested += 1
        due = self._painted != (self.show, self.hovered) or (self._stale and self._rested >= _REST)
        if self._canvas and due and self._painting is None:
            self._painting = self._paint(self._canvas)
        self._go_on_painting()

    def _go_on_painting(self) -> None:
        """Paint a part of the new sheets, which replace the old ones once they are whole."""
        if self._painting:
            try:
                next(self._painting)
            except StopIteration as done:
                self._sheets, self._painting = done.value, None

    # Where things are, in points

    @property
    def large(self) -> bool:
        """Whether there is room for values beside the names."""
        return self.box.height >= _LARGE

    @property
    def _foot(self) -> float:
        """Height for the legend and the unit counts, in points."""
        return 36.0 if self.large else 18.0

    @property
    def name_size(self) -> float:
        """Size of the names."""
        return SMALL if self.large else LABEL

    @property
    def radius(self) -> float:
        """Radius of a unit, in points."""
        crowd = max((len(column.units) for column in self.columns), default=1)
        return min(max(0.24 * (self.box.height - self._foot) / crowd, 2.0), 7.0)

    def _lay_out(self) -> list[list[Point]]:
        """Return the places of each column's units, in points."""
        left, right = (
            max((typeface.reach(name, self.name_size, "regular") + 10 for name in names), default=4.0)
            for names in (self.inputs, self.outputs)
        )
        box, radius = self.box, self.radius
        across = (box.width - left - right - 2 * radius) / max(len(self.columns) - 1, 1)
        high = box.height - self._foot - 2 * radius - 4
        centres = []
        for number, column in enumerate(self.columns):
            x, count = box.x + left + radius + number * across, len(column.units)
            steps = [place / (count - 1) for place in range(count)] if count > 1 else [0.5]
            centres.append([(x, box.y + radius + 2 + step * high) for step in steps])
        return centres

    # The picture

    def draw(self, canvas: Canvas) -> None:
        """Draw the network, and the read-out over it."""
        if self._sheets is None or self._sheets[0].scale != canvas.scale:
            self._canvas, self._painting = canvas, self._paint(canvas)
            while self._painting:
                self._go_on_painting()
        corner = (canvas.px(self.box.x - _MARGIN), canvas.px(self.box.y - _MARGIN))
        assert self._sheets is not None
        light, signs = self._sheets
        canvas.surface.blit(light.surface, corner, special_flags=pygame.BLEND_RGB_ADD)
        canvas.surface.blit(signs.surface, corner)
        if self.hovered:
            self._draw_tooltip(canvas, *self.hovered)

    def _paint(self, canvas: Canvas) -> Generator[None, None, Sheets]:
        """Return the painting of the network as it is now onto new sheets."""
        self._painted, self._stale, self._rested = (self.show, self.hovered), False, 0
        light, signs = (canvas.sheet(self.box.width + 2 * _MARGIN, self.box.height + 2 * _MARGIN) for _ in range(2))
        light.surface = pygame.Surface(light.size)
        return _paint_all(copy(self), light, signs)

    def _draw_tooltip(self, canvas: Canvas, number: int, place: int) -> None:
        column = self.columns[number]
        unit, last = self.unit_of(number), number == len(self.columns) - 1
        words = texts.NETWORK_VIEW_POINTS if last and self.outputs else texts.NETWORK_VIEW_VALUE
        rows = [TooltipRow(words, plotting.compact(float(column.values[place]) / unit))]
        if column.bias is not None:
            rows.append(TooltipRow(texts.NETWORK_VIEW_BIAS, plotting.compact(float(column.bias[place]) / unit)))
        head = self.unit_name(number, int(column.units[place]))
        draw_tooltip(canvas, self.centres[number][place], self.box, [head], rows)


def _paint_all(view: NetworkView, light: Canvas, signs: Canvas) -> Generator[None, None, Sheets]:
    """Paint a view onto empty sheets, in parts, and return them; it must not change meanwhile."""
    plan, hovered = view.plan, view.hovered
    centres = [[(x - view.box.x + _MARGIN, y - view.box.y + _MARGIN) for x, y in column] for column in view.centres]
    if not plan or not centres:
        middle = (_MARGIN + view.box.width / 2, _MARGIN + view.box.height / 2)
        signs.text(texts.NETWORK_VIEW_EMPTY, middle, size=SMALL, colour=MUTE, align="centre", room=view.box.width)
        return light, signs
    drawn = 0.0
    for edge in plan.edges(view.show, int(min(max(0.3 * view.box.height, 16), 110))):
        ends = centres[edge.column][edge.start], centres[edge.column + 1][edge.end]
        _paint_edge(view, light, edge, ends)
        drawn += math.dist(*ends) * light.scale
        if drawn > _CHUNK:
            drawn = 0.0
            yield
    yield
    best, last = plan.best() if view.lit is None else view.lit, len(centres) - 1
    for number in range(len(centres)):
        lights = plan.brightness(number).tolist()
        for place, (centre, lit) in enumerate(zip(centres[number], lights, strict=True)):
            tone = NET if number == last and place == best else INK if lit >= 0 else _TAKES
            _paint_unit(view, light, signs, centre, abs(lit), tone)
        _paint_names(view, signs, number, centres[number], best if number == last else None)
    if hovered:
        signs.marker("ring", centres[hovered[0]][hovered[1]], 2 * view.radius + 6, INK)
    y, (adds, takes) = _last_line(view), texts.NETWORK_VIEW_LEGEND[view.show]
    signs.pill((_MARGIN, y - 5, 9, 2), _ADDS)
    signs.text(adds, (_MARGIN + 13, y), size=LABEL, colour=MUTE)
    word = signs.text(takes, (_MARGIN + view.box.width, y), size=LABEL, colour=MUTE, align="right")
    signs.pill((word.left - 13, y - 5, 9, 2), _TAKES)
    return light, signs


def _paint_edge(view: NetworkView, light: Canvas, edge: Edge, ends: tuple[Point, Point]) -> None:
    strength = 0.10 + 0.62 * edge.size**1.5
    if view.hovered:
        touched = view.hovered in ((edge.column, edge.start), (edge.column + 1, edge.end))
        strength = 0.35 + 0.65 * edge.size if touched else 0.25 * strength
    wide = 0.7 + 1.3 * edge.size * min(1.0, view.box.height / _LARGE)
    half = 0.5 / light.scale  # a line runs through the middles of pixels, a dot lies between them
    start, end = ((x - half, y - half) for x, y in ends)
    light.line(start, end, mix(_BLACK, _ADDS if edge.positive else _TAKES, min(strength, 1.0)), wide)


def _paint_unit(view: NetworkView, light: Canvas, signs: Canvas, centre: Point, lit: float, tone: Colour) -> None:
    radius = view.radius
    signs.dot(centre, radius + 0.9, NIGHT0)
    signs.dot(centre, radius, NIGHT1)
    if lit > _GLOWING:
        light.glow(centre, 4.2 * radius, tone, _GLOWING * lit)
    signs.dot(centre, radius, FAINT, 0.75)
    if lit > 0.02:
        signs.dot(centre, radius, tone, lit**0.8)


def _paint_names(view: NetworkView, signs: Canvas, number: int, centres: list[Point], best: int | None) -> None:
    """Write names beside the units (with values, in a large drawing), and the unit counts below."""
    column, names, size = view.columns[number], view.names(number), view.name_size
    values = view.large and bool(np.isfinite(column.values).any())
    side = view.radius + 6
    align: Align
    shift, align = (-side, "right") if number == 0 else (side, "left")
    for place, unit in enumerate(column.units.tolist()):
        if unit >= len(names):
            break
        x, y = centres[place][0] + shift, centres[place][1] + 0.36 * size - 7 * values
        signs.text(names[unit], (x, y), size=size, colour=NET if place == best else MUTE, align=align)
        if values:
            figure = decimal(float(column.values[place]) / view.unit_of(number), 2)
            signs.text(figure, (x, y + 15), size=size, colour=INK, align=align, tabular=True)
    shown = len(column.units)
    if shown < column.total or not names:
        words = texts.NETWORK_VIEW_ALL if shown == column.total else texts.NETWORK_VIEW_SOME
        caption = words.format(shown=shown, count=column.total)
        signs.text(caption, (centres[0][0], _last_line(view)), size=LABEL, colour=MUTE, align="centre")


def _last_line(view: NetworkView) -> float:
    return _MARGIN + view.box.height - 3
