"""Painting of a network, a part at a time: its links as light, its units, names and legend as signs above it."""

from __future__ import annotations

import math
from collections.abc import Generator, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from game.core import texts
from game.drawing.canvas import Align, Canvas, Point
from game.drawing.tokens import EMBER, FAINT, INK, LABEL, MUTE, NET, NIGHT0, NIGHT1, SMALL, Colour
from game.panels.network_plan import Column, Edge, NetworkPlan, Show
from game.ui import plotting

Sheets = tuple[Canvas, Canvas]  # additive light, and the signs above it

ADDS: Final = NET
TAKES: Final = EMBER
LARGE: Final = 300.0  # points of height from which there is room for values beside the names
MARGIN: Final = 8.0  # of the sheets around the box
_CHUNK: Final = 9_000.0  # pixels of edges drawn in one step: about a millisecond
_GLOWING: Final = 0.55  # units lit more than this shine on what is around them


@dataclass(frozen=True)
class NetworkPainting:
    """A network laid out on its sheets, in points, ready to be painted.

    Attributes:
        plan: the units and their values; None without a network.
        edges: the links that are shown.
        show: quantity that they show.
        hovered: column and place of the highlighted unit, if any.
        centres: place on the sheet of each unit of each column.
        names: names of the units of each column, as far as they have any.
        output_scale: one point of reward, in units of the network's outputs.
        size: width and height of the box that the sheets surround.
        radius: radius of a unit.
        name_size: size of the names.
        large: whether there is room for values beside the names.

    """

    plan: NetworkPlan | None
    edges: Sequence[Edge]
    show: Show
    hovered: tuple[int, int] | None
    centres: Sequence[Sequence[Point]]
    names: Sequence[Sequence[str]]
    output_scale: float
    size: tuple[float, float]
    radius: float
    name_size: float
    large: bool

    def paint(self, light: Canvas, signs: Canvas) -> Generator[None, None, Sheets]:
        """Paint onto empty sheets, in parts, and return them."""
        plan, centres, hovered = self.plan, self.centres, self.hovered
        if not plan or not centres:
            middle = (MARGIN + self.size[0] / 2, MARGIN + self.size[1] / 2)
            signs.text(texts.NETWORK_VIEW_EMPTY, middle, size=SMALL, colour=MUTE, align="centre", room=self.size[0])
            return light, signs
        yield
        drawn = 0.0
        for edge in self.edges:
            ends = centres[edge.column][edge.start], centres[edge.column + 1][edge.end]
            self._paint_edge(light, edge, ends)
            drawn += math.dist(*ends) * light.scale
            if drawn > _CHUNK:
                drawn = 0.0
                yield
        yield
        best, last = plan.best(), len(centres) - 1
        for number, column in enumerate(plan.columns):
            lights = plan.brightness(number).tolist()
            for place, (centre, lit) in enumerate(zip(centres[number], lights, strict=True)):
                chosen = number == last and place == best
                self._paint_unit(light, signs, centre, lit, damaged=bool(column.damaged[place]), chosen=chosen)
            self._paint_names(signs, number, column, best if number == last else None)
        if hovered:
            signs.marker("ring", centres[hovered[0]][hovered[1]], 2 * self.radius + 6, INK)
        self._paint_legend(signs)
        return light, signs

    def _paint_edge(self, light: Canvas, edge: Edge, ends: tuple[Point, Point]) -> None:
        strength = 0.10 + 0.62 * edge.size**1.5
        if self.hovered:
            touched = self.hovered in ((edge.column, edge.start), (edge.column + 1, edge.end))
            strength = 0.35 + 0.65 * edge.size if touched else 0.25 * strength
        wide = 0.7 + 1.3 * edge.size * min(1.0, self.size[1] / LARGE)
        half = 0.5 / light.scale  # a line runs through the middles of pixels, a dot lies between them
        colour = _dimmed(ADDS if edge.positive else TAKES, strength)
        start, end = ends
        light.line((start[0] - half, start[1] - half), (end[0] - half, end[1] - half), colour, wide)

    def _paint_unit(
        self, light: Canvas, signs: Canvas, centre: Point, lit: float, *, damaged: bool, chosen: bool
    ) -> None:
        radius, tone = self.radius, NET if chosen else INK if lit >= 0 else TAKES
        signs.dot(centre, radius + 0.9, NIGHT0)
        signs.dot(centre, radius, NIGHT1)
        if damaged:
            signs.marker("cross", centre, 2.4 * radius, signs.palette.warn)
            return
        if abs(lit) > _GLOWING:
            light.glow(centre, 4.2 * radius, tone, _GLOWING * abs(lit))
        signs.dot(centre, radius, FAINT, 0.75)
        if abs(lit) > 0.02:
            signs.dot(centre, radius, tone, abs(lit) ** 0.8)

    def _paint_names(self, signs: Canvas, number: int, column: Column, best: int | None) -> None:
        """Write names beside the units (with values, in a large drawing), and the unit counts below."""
        centres, names, size = self.centres[number], self.names[number], self.name_size
        unit_value = self.output_scale if number == len(self.centres) - 1 else 1.0  # outputs are in points of reward
        values = self.large and bool(np.isfinite(column.values).any())
        side = self.radius + 6
        align: Align
        shift, align = (-side, "right") if number == 0 else (side, "left")
        for place, unit in enumerate(column.units.tolist()):
            if unit >= len(names):
                break
            x, y = centres[place][0] + shift, centres[place][1] + 0.36 * size - (7 if values else 0)
            signs.text(names[unit], (x, y), size=size, colour=NET if place == best else MUTE, align=align)
            if values:
                figure = _figure(float(column.values[place]) / unit_value)
                signs.text(figure, (x, y + 15), size=size, colour=INK, align=align, tabular=True)
        shown = len(column.units)
        if shown < column.total or not names:
            words = (texts.NETWORK_VIEW_ALL if shown == column.total else texts.NETWORK_VIEW_SOME).format(
                shown=shown, count=column.total
            )
            middle = (centres[0][0], self._last_line)
            signs.text(words, middle, size=LABEL - 1, colour=MUTE, align="centre")

    @property
    def _last_line(self) -> float:
        return MARGIN + self.size[1] - 3

    def _paint_legend(self, signs: Canvas) -> None:
        y, (adds, takes) = self._last_line, texts.NETWORK_VIEW_LEGEND[self.show]
        signs.pill((MARGIN, y - 5, 9, 2), ADDS)
        signs.text(adds, (MARGIN + 13, y), size=LABEL - 1, colour=MUTE)
        word = signs.text(takes, (MARGIN + self.size[0], y), size=LABEL - 1, colour=MUTE, align="right")
        signs.pill((word.left - 13, y - 5, 9, 2), TAKES)


def all_of(painting: Generator[None, None, Sheets]) -> Sheets:
    """Paint all parts at once."""
    while True:
        try:
            next(painting)
        except StopIteration as done:
            sheets: Sheets = done.value
            return sheets


def _figure(value: float) -> str:
    """Write a value in no more room than -99.99 takes."""
    if abs(value) >= 1000:
        return plotting.compact(value)
    return f"{value:.{2 if abs(value) < 99.995 else 1}f}".replace("-", "−")


def _dimmed(colour: Colour, strength: float) -> Colour:
    """Return a colour dimmed to `strength`, for additive blending."""
    red, green, blue = (round(min(max(strength, 0.0), 1.0) * part) for part in colour)
    return red, green, blue
