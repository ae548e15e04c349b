"""Marks made of lines: the contents of gamepad signs."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import Final

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
