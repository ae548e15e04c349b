"""Marks made of lines and arcs: the contents of gamepad signs, and the icons of missions."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import Final

import numpy as np
import pygame

from game.drawing.tokens import Colour

Mark = Callable[[pygame.Surface, pygame.Vector2, float, Colour, int], object]


def lines(*strokes: Sequence[tuple[float, float]]) -> Mark:
    """Return a mark of polylines with round ends and corners; points are in half widths from its middle."""

    def draw(surface: pygame.Surface, middle: pygame.Vector2, half: float, colour: Colour, stroke: int) -> None:
        for points in strokes:
            places = [middle + half * pygame.Vector2(point) for point in points]
            for start, end in pairwise(places):
                pygame.draw.line(surface, colour, start, end, stroke)
            for place in places:
                pygame.draw.circle(surface, colour, place, stroke / 2)

    return draw


def outline(*corners: tuple[float, float], filled: bool = False) -> Mark:
    """Return a polygon, filled or not, as a mark."""

    def draw(surface: pygame.Surface, middle: pygame.Vector2, half: float, colour: Colour, stroke: int) -> None:
        points = [middle + half * pygame.Vector2(corner) for corner in corners]
        pygame.draw.polygon(surface, colour, points, 0 if filled else stroke)

    return draw


def both(*marks: Mark) -> Mark:
    """Return the union of several marks."""

    def draw(surface: pygame.Surface, middle: pygame.Vector2, half: float, colour: Colour, stroke: int) -> None:
        for mark in marks:
            mark(surface, middle, half, colour, stroke)

    return draw


def ring(surface: pygame.Surface, middle: pygame.Vector2, half: float, colour: Colour, stroke: int) -> None:
    """Draw a circle; itself a mark."""
    pygame.draw.circle(surface, colour, middle, half, stroke)


def arrow(degrees: float, away: float = 0.0) -> Mark:
    """Return a filled arrow head that points to an angle, 0 being up, `away` from the middle in half widths."""
    corners = [pygame.Vector2(x, y - away).rotate(degrees) for x, y in ((-0.8, 0.5), (0.8, 0.5), (0.0, -0.6))]
    return outline(*((corner.x, corner.y) for corner in corners), filled=True)


def arc(start: float, end: float, radius: float = 1.0, x: float = 0.0, y: float = 0.0) -> Mark:
    """Return an arc of a circle around (x, y), between two angles in degrees, 0 being right, 90 up."""
    angles = [math.radians(start + (end - start) * step / 24) for step in range(25)]
    points = [(x + radius * math.cos(angle), y - radius * math.sin(angle)) for angle in angles]
    return lines(points)


_SQUARE: Final = ((-0.85, -0.85), (0.85, -0.85), (0.85, 0.85), (-0.85, 0.85))
MARKS: Final[dict[str, Mark]] = {
    "saltire": lines(((-0.9, -0.9), (0.9, 0.9)), ((-0.9, 0.9), (0.9, -0.9))),
    "ring": ring,
    "square": outline(*_SQUARE),
    "triangle": outline((0.0, -1.1), (1.0, 0.65), (-1.0, 0.65)),
    "lines": lines(*(((-1.0, y), (1.0, y)) for y in (-0.7, 0.0, 0.7))),
    "windows": both(
        outline((-1.0, -0.9), (0.4, -0.9), (0.4, 0.4), (-1.0, 0.4)),
        lines(((0.0, 1.0), (1.0, 1.0)), ((1.0, 1.0), (1.0, 0.0))),
    ),
    "minus": lines(((-0.9, 0.0), (0.9, 0.0))),
    "plus": lines(((-0.9, 0.0), (0.9, 0.0)), ((0.0, -0.9), (0.0, 0.9))),
    "turn": both(arrow(-90, 0.62), arrow(90, 0.62)),
    "left": arrow(-90),
    "right": arrow(90),
}

_PAD: Final = ((-0.9, 0.9), (0.9, 0.9))
_LEFT_ARROW: Final = ((-0.65, -0.35), (-1.0, 0.0), (-0.65, 0.35))
_RIGHT_ARROW: Final = ((0.65, -0.35), (1.0, 0.0), (0.65, 0.35))
_RAYS: Final = [(math.cos(turn), math.sin(turn)) for turn in np.arange(0.0, math.tau, math.tau / 8).tolist()]
ICONS: Final[dict[str, Mark]] = {
    "first": lines(((-0.6, 1.0), (-0.6, -0.95), (0.8, -0.5), (-0.6, 0.0))),
    "fall": lines(((0.0, -1.0), (0.0, 0.5)), ((-0.45, 0.05), (0.0, 0.5), (0.45, 0.05)), _PAD),
    "brake": lines(((-0.55, -0.95), (0.0, -0.45), (0.55, -0.95)), ((-0.55, -0.2), (0.0, 0.3), (0.55, -0.2)), _PAD),
    "aside": both(arc(165, 25, 0.95, -0.1, 0.45), lines(((0.95, -0.5), (0.76, 0.05), (0.2, -0.1)), _PAD)),
    "wind": both(
        lines(((-1.0, -0.3), (0.35, -0.3)), ((-1.0, 0.1), (0.95, 0.1)), ((-1.0, 0.5), (0.1, 0.5))),
        arc(-90, 150, 0.32, 0.35, -0.62),
        arc(90, -150, 0.28, 0.1, 0.78),
    ),
    "tank": both(arc(-212, 32, 0.64, 0.0, 0.32), lines(((-0.54, -0.02), (0.0, -1.0), (0.54, -0.02)))),
    "narrow": lines(
        ((-1.0, 0.0), (-0.4, 0.0)),
        ((-0.7, -0.3), (-0.4, 0.0), (-0.7, 0.3)),
        ((1.0, 0.0), (0.4, 0.0)),
        ((0.7, -0.3), (0.4, 0.0), (0.7, 0.3)),
        ((-0.3, 0.9), (0.3, 0.9)),
    ),
    "mars": both(arc(0, 360), arc(0, 360, 0.22, -0.3, -0.25), arc(0, 360, 0.12, 0.35, 0.3)),
    "earth": both(arc(0, 360), lines(((-1.0, 0.0), (1.0, 0.0))), arc(-68, 68, 1.08, -0.4), arc(112, 248, 1.08, 0.4)),
    "night": both(arc(45, 315), arc(60, 300, 0.82, 0.3)),
    "ferry": lines(_LEFT_ARROW, _RIGHT_ARROW, ((-1.0, 0.0), (1.0, 0.0)), ((-0.6, 0.9), (0.6, 0.9))),
    "outage": lines(((0.25, -1.0), (-0.55, 0.15), (0.55, -0.15), (-0.25, 1.0))),
    "daily": both(arc(0, 360, 0.45), lines(*(((0.75 * x, 0.75 * y), (x, y)) for x, y in _RAYS))),
}
