"""Units and links of a drawn network: which one lies at a point, and marks over those that were picked or edited."""

from __future__ import annotations

import math
from typing import Final, NamedTuple

import numpy as np
import pygame

from ai.training.edits import NetworkEdits
from game.core import texts
from game.drawing.canvas import Canvas, Point
from game.drawing.tokens import HUMAN, NIGHT0
from game.explain.network_view import NetworkView

_NEAR: Final = 5.0  # points from a link within which it is picked
_CLEAR: Final = 0.04  # share of a link at either end that belongs to its units
_DASH: Final = 7.0


class Unit(NamedTuple):
    """Unit of a network; stage 0 are the inputs."""

    stage: int
    unit: int


class Link(NamedTuple):
    """Link of a network, from a unit of stage `layer` to one of the next."""

    layer: int
    start: int
    end: int

    @property
    def ends(self) -> tuple[Unit, Unit]:
        """The units that it links."""
        return Unit(self.layer, self.start), Unit(self.layer + 1, self.end)


Part = Unit | Link


def part_at(view: NetworkView, point: Point) -> Part | None:
    """Return the unit at a point of the canvas, or else the drawn link; None for neither."""
    if found := view.unit_at(point):
        return Unit(found[0], int(view.columns[found[0]].units[found[1]]))
    best, least = None, _NEAR
    for edge in view.edges:
        start, end = view.centres[edge.column][edge.start], view.centres[edge.column + 1][edge.end]
        away = _distance(point, start, end) - edge.size  # of two that cross, the stronger one is meant
        if away < least:
            best, least = edge, away
    if best is None:
        return None
    left, right = view.columns[best.column], view.columns[best.column + 1]
    return Link(best.column, int(left.units[best.start]), int(right.units[best.end]))


def name_of(view: NetworkView, part: Part) -> str:
    """Return the name of a unit, or of a link by those of its ends."""
    if isinstance(part, Link):
        return texts.EDIT_LINK.format(start=name_of(view, part.ends[0]), end=name_of(view, part.ends[1]))
    place = _place(view, part)
    return "" if place is None else view.name(part.stage, place)


def draw_marks(canvas: Canvas, view: NetworkView, edits: NetworkEdits, picked: Part | None) -> None:
    """Draw silenced units hollow, cut links dashed, and the picked unit or link in amber."""
    for weight in edits.weights:
        _draw_link(canvas, view, Link(*weight), cut=True)
    for place in edits.silenced:
        if centre := _centre(view, Unit(*place)):
            canvas.dot(centre, view.radius + 2, NIGHT0)
            canvas.marker("ring", centre, 2 * view.radius + 2, HUMAN)
    if isinstance(picked, Link):
        _draw_link(canvas, view, picked, cut=tuple(picked) in edits.weights)
    elif picked and (centre := _centre(view, picked)):
        canvas.marker("ring", centre, 2 * view.radius + 8, HUMAN)


def _draw_link(canvas: Canvas, view: NetworkView, link: Link, *, cut: bool) -> None:
    start, end = (_centre(view, unit) for unit in link.ends)
    if start is None or end is None:
        return
    if not cut:
        canvas.line(start, end, HUMAN, 2.0)
        return
    first = pygame.Vector2(start)
    count = max(1, round(math.dist(start, end) / _DASH / 2))
    for number in range(count):
        here, there = first.lerp(end, number / count), first.lerp(end, (number + 0.5) / count)
        canvas.line((here.x, here.y), (there.x, there.y), HUMAN, 1.5, 0.7)


def _place(view: NetworkView, unit: Unit) -> int | None:
    """Return the place of a unit among the shown ones of its column; None if it is not shown."""
    if unit.stage >= len(view.columns):
        return None
    shown = np.flatnonzero(view.columns[unit.stage].units == unit.unit)
    return int(shown[0]) if len(shown) else None


def _centre(view: NetworkView, unit: Unit) -> Point | None:
    place = _place(view, unit)
    return None if place is None else view.centres[unit.stage][place]


def _distance(point: Point, start: Point, end: Point) -> float:
    """Return the distance from a point to a link between its ends; infinite beside them."""
    (x, y), (x0, y0), (x1, y1) = point, start, end
    along = ((x - x0) * (x1 - x0) + (y - y0) * (y1 - y0)) / max((x1 - x0) ** 2 + (y1 - y0) ** 2, 1e-9)
    if not _CLEAR < along < 1 - _CLEAR:
        return math.inf
    return math.hypot(x - x0 - along * (x1 - x0), y - y0 - along * (y1 - y0))
