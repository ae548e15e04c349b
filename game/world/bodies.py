"""Rigid bodies and their contacts, drawn as they are: outlines, points, normals, impulses."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
import pygame

from engine import DT, Circle, World
from engine.vector import Array, dot, right_of, rotate
from game.exhibits import Piece
from game.render import View
from game.ui.canvas import Canvas
from game.ui.tokens import HUMAN, INK, NET, NIGHT1, Colour
from game.world.paint import mix

_ROUND: Final = 28  # corners of a disc
_MARK: Final = np.array([(0.45, 0.0), (0.82, 0.0)])  # on a disc of radius 1, so that its turning is seen
_EDGE: Final = 1.2  # points
_FILL: Final = 0.26
_LIT: Final = 0.45
# A normal is this long at the least, in points, and longer by so much for each kilogram that it carries.
_NORMAL: Final = 6.0
_PER_WEIGHT: Final = 4.0
_LONGEST: Final = 64.0


class Outlines:
    """The corners of every piece, kept in one array, so that all are turned and placed at once."""

    def __init__(self, pieces: Sequence[Piece]) -> None:
        self.pieces = pieces
        outlines = [_outline(piece) for piece in pieces]
        lengths = [len(outline) for outline in outlines]
        self._corners = np.concatenate(outlines)
        self._body = np.repeat([piece.body.index for piece in pieces], lengths)
        ends = np.cumsum(lengths).tolist()
        self._spans = list(zip([0, *ends[:-1]], ends, strict=True))
        self._colours = [_colours(piece.colour, _FILL) for piece in pieces]

    def draw(self, canvas: Canvas, view: View, poses: Array, lit: int | None, held: bool) -> None:
        """Draw every piece at its pose (bodies, 3); the one of body `lit` brighter, and in amber if `held`."""
        x, y, angle = poses[self._body].T
        places = rotate(self._corners, np.cos(angle), np.sin(angle)) + np.stack([x, y], axis=1)
        pixels = view.pixels(places)
        width = max(1, canvas.px(_EDGE))
        surface = canvas.surface
        for piece, (start, end), colours in zip(self.pieces, self._spans, self._colours, strict=True):
            edge, fill, mark = colours
            if piece.body.index == lit:
                edge, fill, mark = _colours(HUMAN if held else mix(edge, INK, 0.6), _LIT)
            # Piece by piece: thousands of pairs alive at once would set Python's garbage collector going.
            corners = pixels[start:end].tolist()
            if isinstance(piece.shape, Circle):
                *corners, inner, outer = corners
            pygame.draw.polygon(surface, fill, corners)
            _draw_edge(surface, edge, corners, width)
            if isinstance(piece.shape, Circle):
                pygame.draw.aaline(surface, mark, inner, outer, width)


def draw_contacts(canvas: Canvas, view: View, world: World, weight: float) -> None:
    """Draw the last step's contacts: a dot for a point, a line along the normal, as long as its impulse.

    `weight` in newtons is that of one kilogram; friction is a fainter line along the surface.
    """
    contacts = world.contacts
    if contacts is None:
        return
    manifold = contacts.manifold
    units = contacts.impulse / (weight * DT)
    row, which = manifold.valid.nonzero()
    points = view.points(manifold.points[row, which])
    normal = manifold.normal[row] * (1, -1)
    reach = np.minimum(_NORMAL + _PER_WEIGHT * units[which, row], _LONGEST)[:, None] / 2 * normal
    faint = mix(NIGHT1, NET, 0.6)
    rubbing = np.flatnonzero(np.abs(units[2]) > 0.05)
    middle = manifold.points[rubbing, 0]
    both = manifold.valid[rubbing].all(axis=1)
    middle[both] = manifold.points[rubbing[both]].mean(axis=1)
    along = right_of(manifold.normal[rubbing]) * (1, -1)
    rub = np.clip(_PER_WEIGHT * units[2, rubbing], -_LONGEST, _LONGEST)[:, None] / 2 * along
    middle = view.points(middle)
    _draw_lines(canvas, middle - rub, middle + rub, faint)
    _draw_lines(canvas, points - reach, points + reach, NET)
    for x, y in zip(*points.T.tolist(), strict=True):
        canvas.dot((x, y), 1.6, NET)


def draw_grip(canvas: Canvas, start: tuple[float, float], end: tuple[float, float]) -> None:
    """Draw, in points, the thread by which a body is pulled."""
    if start != end:
        canvas.line(start, end, HUMAN, 1.2)
    canvas.dot(start, 3.5, HUMAN)
    canvas.dot(end, 2.0, HUMAN)


def body_at(pieces: Sequence[Piece], poses: Array, place: Array, reach: float) -> Piece | None:
    """Return the piece that can be moved and covers a place in metres, or is within `reach` of it."""
    best, nearest = None, reach
    for piece in pieces:
        if piece.body.static:
            continue
        x, y, angle = poses[piece.body.index]
        local = rotate(place - (x, y), np.cos(-angle), np.sin(-angle))
        shape = piece.shape
        if isinstance(shape, Circle):
            gap = float(np.hypot(*local)) - shape.radius
        else:
            gap = float(dot(shape.normals, local - shape.vertices).max())
        if gap < nearest:
            best, nearest = piece, gap
    return best


def _colours(edge: Colour, share: float) -> tuple[Colour, Colour, Colour]:
    """Of the edge, the inside, and the mark that shows the turning."""
    return edge, mix(NIGHT1, edge, share), mix(NIGHT1, edge, 0.75)


def _outline(piece: Piece) -> Array:
    shape = piece.shape
    if not isinstance(shape, Circle):
        return shape.vertices
    around = np.arange(_ROUND) * (2 * np.pi / _ROUND)
    ring = np.stack([np.cos(around), np.sin(around)], axis=1)
    return shape.radius * np.concatenate([ring, _MARK])


def _draw_edge(surface: pygame.Surface, colour: Colour, corners: list[tuple[float, float]], width: int) -> None:
    if width == 1:
        pygame.draw.aalines(surface, colour, True, corners)
        return
    for start, end in zip(corners, [*corners[1:], corners[0]], strict=True):
        pygame.draw.aaline(surface, colour, start, end, width)


def _draw_lines(canvas: Canvas, starts: Array, ends: Array, colour: Colour) -> None:
    width = max(1, canvas.px(1.0))
    columns = np.concatenate([starts, ends], axis=1).T * canvas.scale
    for left, top, right, bottom in zip(*columns.tolist(), strict=True):
        pygame.draw.aaline(canvas.surface, colour, (left, top), (right, bottom), width)
