"""Painting of a network, a part at a time: its links as light, its units, names and legend as signs above it."""

from __future__ import annotations

import math
from collections.abc import Generator
from typing import TYPE_CHECKING, Final

import numpy as np

from game.core import texts
from game.drawing.canvas import Align, Canvas, Point
from game.drawing.tokens import EMBER, FAINT, INK, LABEL, MUTE, NET, NIGHT0, NIGHT1, SMALL, Colour
from game.explain.network_plan import Edge
from game.ui import plotting

if TYPE_CHECKING:
    from game.explain.network_view import NetworkView

Sheets = tuple[Canvas, Canvas]  # additive light, and the signs above it

ADDS: Final = NET
TAKES: Final = EMBER
LARGE: Final = 300.0  # points of height from which there is room for values beside the names
MARGIN: Final = 8.0  # of the sheets around the box
_CHUNK: Final = 9_000.0  # pixels of edges drawn in one step: about a millisecond
_GLOWING: Final = 0.55  # units lit more than this shine on what is around them


def paint(view: NetworkView, light: Canvas, signs: Canvas) -> Generator[None, None, Sheets]:
    """Paint a view onto empty sheets, in parts, and return them; it must not change meanwhile."""
    plan, hovered = view.plan, view.hovered
    centres = [[(x - view.box.x + MARGIN, y - view.box.y + MARGIN) for x, y in column] for column in view.centres]
    if not plan or not centres:
        middle = (MARGIN + view.box.width / 2, MARGIN + view.box.height / 2)
        signs.text(texts.NETWORK_VIEW_EMPTY, middle, size=SMALL, colour=MUTE, align="centre", room=view.box.width)
        return light, signs
    yield
    drawn = 0.0
    for edge in view.edges:
        ends = centres[edge.column][edge.start], centres[edge.column + 1][edge.end]
        _paint_edge(view, light, edge, ends)
        drawn += math.dist(*ends) * light.scale
        if drawn > _CHUNK:
            drawn = 0.0
            yield
    yield
    best, last = plan.best(), len(centres) - 1
    for number, column in enumerate(plan.columns):
        lights = plan.brightness(number).tolist()
        for place, (centre, lit) in enumerate(zip(centres[number], lights, strict=True)):
            tone = NET if number == last and place == best else INK if lit >= 0 else TAKES
            _paint_unit(view, light, signs, centre, abs(lit), tone, damaged=bool(column.damaged[place]))
        _paint_names(view, signs, number, centres[number], best if number == last else None)
    if hovered:
        signs.marker("ring", centres[hovered[0]][hovered[1]], 2 * view.radius + 6, INK)
    y, (adds, takes) = _last_line(view), texts.NETWORK_VIEW_LEGEND[view.show]
    signs.pill((MARGIN, y - 5, 9, 2), ADDS)
    signs.text(adds, (MARGIN + 13, y), size=LABEL - 1, colour=MUTE)
    word = signs.text(takes, (MARGIN + view.box.width, y), size=LABEL - 1, colour=MUTE, align="right")
    signs.pill((word.left - 13, y - 5, 9, 2), TAKES)
    return light, signs


def _paint_edge(view: NetworkView, light: Canvas, edge: Edge, ends: tuple[Point, Point]) -> None:
    strength = 0.10 + 0.62 * edge.size**1.5
    if view.hovered:
        touched = view.hovered in ((edge.column, edge.start), (edge.column + 1, edge.end))
        strength = 0.35 + 0.65 * edge.size if touched else 0.25 * strength
    wide = 0.7 + 1.3 * edge.size * min(1.0, view.box.height / LARGE)
    half = 0.5 / light.scale  # a line runs through the middles of pixels, a dot lies between them
    start, end = ((x - half, y - half) for x, y in ends)
    light.line(start, end, _dimmed(ADDS if edge.positive else TAKES, strength), wide)


def _paint_unit(
    view: NetworkView, light: Canvas, signs: Canvas, centre: Point, lit: float, tone: Colour, *, damaged: bool
) -> None:
    radius = view.radius
    signs.dot(centre, radius + 0.9, NIGHT0)
    signs.dot(centre, radius, NIGHT1)
    if damaged:
        signs.marker("cross", centre, 2.4 * radius, signs.palette.warn)
        return
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
            figure = _figure(float(column.values[place]) / view.unit_of(number))
            signs.text(figure, (x, y + 15), size=size, colour=INK, align=align, tabular=True)
    shown = len(column.units)
    if shown < column.total or not names:
        words = texts.NETWORK_VIEW_ALL if shown == column.total else texts.NETWORK_VIEW_SOME
        told = words.format(shown=shown, count=column.total)
        signs.text(told, (centres[0][0], _last_line(view)), size=LABEL - 1, colour=MUTE, align="centre")


def _last_line(view: NetworkView) -> float:
    return MARGIN + view.box.height - 3


def _figure(value: float) -> str:
    """Write a value in no more room than -99.99 takes."""
    if abs(value) >= 1000:
        return plotting.compact(value)
    return f"{value:.{2 if abs(value) < 99.995 else 1}f}".replace("-", "−")


def _dimmed(colour: Colour, strength: float) -> Colour:
    """Return a colour dimmed to `strength`, for additive blending."""
    red, green, blue = (round(min(max(strength, 0.0), 1.0) * part) for part in colour)
    return red, green, blue
