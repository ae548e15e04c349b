"""Rigid bodies and their contacts, drawn as they are: outlines, points, normals, impulses."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import lru_cache, partial
from itertools import repeat
from typing import Final

import numpy as np
import pygame

from engine import DT, Circle, Polygon, World
from engine.vector import Array, dot, right_of, rotate
from game.exhibits import Piece
from game.render import View
from game.ui import shapes
from game.ui.canvas import Canvas
from game.ui.tokens import HUMAN, INK, NET, NIGHT1, Colour
from game.world.paint import mix

_MARK: Final = (0.45, 0.82)  # of a disc's radius, from and to, so that its turning is seen
_EDGE: Final = 1.2  # points
_FILL: Final = 0.26
_LIT: Final = 0.45
# A normal is this long at the least, in points, and longer by so much for each kilogram that it carries.
_NORMAL: Final = 6.0
_PER_WEIGHT: Final = 4.0
_LONGEST: Final = 64.0
_Shades = Callable[[Piece, tuple[Colour, Colour, Colour]], tuple[Colour, Colour, Colour]]
_Paint = Callable[[tuple[int, int]], pygame.Surface]


class Outlines:
    """The corners of every piece, kept in one array, so that all are turned and placed at once."""

    def __init__(self, pieces: Sequence[Piece]) -> None:
        self.pieces = pieces
        discs = [piece for piece in pieces if isinstance(piece.shape, Circle)]
        angular = [piece for piece in pieces if not isinstance(piece.shape, Circle)]
        self._discs = [(piece, _colours(piece.colour, _FILL)) for piece in discs]
        self._disc_bodies = np.array([piece.body.index for piece in discs], dtype=int)
        self._radii = [piece.shape.radius for piece in discs if isinstance(piece.shape, Circle)]
        outlines = [piece.shape.vertices for piece in angular if isinstance(piece.shape, Polygon)]
        lengths = [len(outline) for outline in outlines]
        self._corners = np.concatenate([np.empty((0, 2)), *outlines])
        self._body = np.repeat([piece.body.index for piece in angular], lengths).astype(int)
        ends = np.cumsum(lengths, dtype=int)
        self._angular = [
            (piece, _colours(piece.colour, _FILL), start, end)
            for piece, start, end in zip(angular, (ends - lengths).tolist(), ends.tolist(), strict=True)
        ]

    def draw(self, canvas: Canvas, view: View, poses: Array, lit: int | None, held: bool) -> None:
        """Draw every piece at its pose (bodies, 3); the one of body `lit` brighter, and in amber if `held`."""

        def shades(piece: Piece, colours: tuple[Colour, Colour, Colour]) -> tuple[Colour, Colour, Colour]:
            if piece.body.index != lit:
                return colours
            return _colours(HUMAN if held else mix(colours[0], INK, 0.6), _LIT)

        self._draw_angular(canvas, view, poses, shades)
        if self._discs:
            self._draw_discs(canvas, view, poses[self._disc_bodies], shades)

    def _draw_angular(self, canvas: Canvas, view: View, poses: Array, shades: _Shades) -> None:
        x, y, angle = poses[self._body].T
        places = rotate(self._corners, np.cos(angle), np.sin(angle)) + np.stack([x, y], axis=1)
        pixels = view.pixels(places)
        width = max(1, canvas.px(_EDGE))
        surface = canvas.surface
        for piece, colours, start, end in self._angular:
            edge, fill, _ = shades(piece, colours)
            # Piece by piece: thousands of pairs alive at once would set Python's garbage collector going.
            corners = pixels[start:end].tolist()
            pygame.draw.polygon(surface, fill, corners)
            _draw_edge(surface, edge, corners, width)

    def _draw_discs(self, canvas: Canvas, view: View, poses: Array, shades: _Shades) -> None:
        """Draw discs at `poses` (discs, 3), and on each the mark that shows its turning."""
        width = max(1, canvas.px(_EDGE))
        middles = view.pixels(poses[:, :2])
        colours = [shades(piece, colours) for piece, colours in self._discs]
        radii = [round(4 * radius * view.pixels_per_metre) / 4 for radius in self._radii]
        paints = [
            _half_steps(partial(_disc, radius, edge, fill, width))
            for radius, (edge, fill, _) in zip(radii, colours, strict=True)
        ]
        _stamp(canvas.surface, middles, paints)
        way = np.stack([np.cos(poses[:, 2]), -np.sin(poses[:, 2])], axis=1) * np.array(radii)[:, None]
        inner, outer = ((middles + share * way).tolist() for share in _MARK)
        for start, end, (_, _, mark) in zip(inner, outer, colours, strict=True):
            pygame.draw.aaline(canvas.surface, mark, start, end, width)


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
    dot = partial(shapes.shape, "circle", round(4 * 1.6 * canvas.scale) / 4, NET)
    _stamp(canvas.surface, points * canvas.scale, repeat(dot))


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


def _half_steps(paint: _Paint) -> _Paint:
    """Return what paints only at whole and half pixels: pictures that take long must not be too many."""
    return lambda quarters: paint((quarters[0] & 2, quarters[1] & 2))


@lru_cache(maxsize=256)
def _disc(radius: float, edge: Colour, fill: Colour, width: int, quarters: tuple[int, int]) -> pygame.Surface:
    """Return a disc of that radius in pixels, its middle `quarters` of a pixel past the middle one."""
    disc = shapes.shape("circle", radius + width / 2, edge, quarters).copy()
    inside = shapes.shape("circle", radius - width / 2, fill, quarters)
    for sheet in (disc, inside):
        sheet.set_alpha(255)
    disc.blit(inside, ((disc.width - inside.width) // 2, (disc.height - inside.height) // 2))
    return disc


def _stamp(surface: pygame.Surface, middles: Array, paints: Iterable[_Paint]) -> None:
    """Blit pictures in one go, their middles at (n, 2) in pixels, to a quarter of one."""
    whole = np.floor(middles)
    quarters = (4 * (middles - whole)).astype(int).tolist()
    stamps = []
    for (x, y), (right, down), paint in zip(whole.astype(int).tolist(), quarters, paints, strict=False):
        picture = paint((right, down))
        picture.set_alpha(255)  # others may have drawn it faintly
        half = picture.width // 2
        stamps.append((picture, (x - half, y - half)))
    surface.fblits(stamps)


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
