"""Drawing of rigid bodies and their contacts: outlines, contact points, normals and impulses."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache, partial
from itertools import repeat
from typing import Final

import numpy as np
import pygame

from engine import DT, Body, Circle, Polygon, Shape, Sprite, World
from engine.vector import Array, dot, right_of, rotate
from game.core import texts
from game.drawing import shapes
from game.drawing.canvas import Canvas
from game.drawing.paint import mix
from game.drawing.tokens import EMBER, FAINT, HUMAN, INK, MUTE, NET, NIGHT1, SMALL, Colour
from game.world.camera import View

_MARK: Final = (0.45, 0.82)  # start and end of the mark that shows a disc's rotation, in shares of its radius
_EDGE: Final = 1.2  # points
_FILL: Final = 0.26
_LIT: Final = 0.45
# Length of a line that shows a force, in points: for the weight of a kilogram, and of the longest.
_PER_WEIGHT: Final = 6.0
_LONGEST: Final = 72.0
_SCALE: Final = (24.0, 60.0)  # length in points of the line in the legend
_RUB: Final = mix(NIGHT1, NET, 0.6)
_Colours = tuple[Colour, Colour, Colour]  # of the edge, the inside, and the mark that shows the turning
_Shades = Callable[[int, _Colours], _Colours]  # of a body, by its index
_Paint = Callable[[tuple[int, int]], pygame.Surface]


@dataclass(frozen=True)
class SpriteShape:
    """Shape drawn for an image key: corners in units of a sprite's size (none for a disc), and a colour."""

    corners: tuple[tuple[float, float], ...]
    colour: Colour

    @lru_cache(maxsize=256)  # noqa: B019  # there are as many pictures as rows below
    def outline(self, size: tuple[float, float]) -> Shape:
        """Return the picture's outline at a sprite's size in metres; it is kept, as a pile has many of one size."""
        return Polygon(np.array(self.corners) * size) if self.corners else Circle(size[0] / 2)


_SQUARE: Final = ((-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5))
_WEDGE: Final = ((-0.5, -0.5), (0.5, -0.5), (-0.5, 0.5))
# One row a picture, by the image key that sprites have
PICTURES: Final[dict[str, SpriteShape]] = {
    "rail": SpriteShape(_SQUARE, FAINT),
    "slope": SpriteShape(_WEDGE, FAINT),
    "box": SpriteShape(_SQUARE, MUTE),
    "bright-box": SpriteShape(_SQUARE, INK),
    "disc": SpriteShape((), MUTE),
    "bright-disc": SpriteShape((), INK),
    "ember-disc": SpriteShape((), EMBER),
}


class Outlines:
    """The sprites of a world, in layers from back to front. Raises KeyError for an image that is not in `PICTURES`."""

    def __init__(self, sprites: Sequence[Sprite]) -> None:
        self.shapes = [(sprite.body, PICTURES[sprite.image].outline(sprite.size)) for sprite in sprites]
        layers = sorted({sprite.layer for sprite in sprites})
        self._layers = [_Layer([sprite for sprite in sprites if sprite.layer == layer]) for layer in layers]

    def draw(self, canvas: Canvas, view: View, poses: Array, lit: int | None = None, *, held: bool = False) -> None:
        """Draw every sprite at its body's pose (bodies, 3); draw body `lit` brighter, and in amber if `held`."""
        for layer in self._layers:
            layer.draw(canvas, view, poses, lit, held)

    def body_at(self, poses: Array, place: Array, reach: float) -> Body | None:
        """Return the movable body at a place in metres, or within `reach` of it; None if there is none."""
        best, nearest = None, reach
        for body, shape in self.shapes:
            if body.static:
                continue
            x, y, angle = poses[body.index]
            local = rotate(place - (x, y), np.cos(-angle), np.sin(-angle))
            if isinstance(shape, Circle):
                gap = float(np.hypot(*local)) - shape.radius
            else:
                gap = float(dot(shape.normals, local - shape.vertices).max())
            if gap < nearest:
                best, nearest = body, gap
        return best


class _Layer:
    """The corners of every sprite of a layer, kept in one array, so that all are turned and placed at once."""

    def __init__(self, sprites: Sequence[Sprite]) -> None:
        shapes = [PICTURES[sprite.image].outline(sprite.size) for sprite in sprites]
        rows = [(sprite.body.index, _colours(PICTURES[sprite.image].colour, _FILL)) for sprite in sprites]
        discs = [(row, shape.radius) for row, shape in zip(rows, shapes, strict=True) if isinstance(shape, Circle)]
        self._discs = [row for row, _ in discs]
        self._radii = [radius for _, radius in discs]
        self._disc_bodies = np.array([index for index, _ in self._discs], dtype=int)
        angular = [(row, shape.vertices) for row, shape in zip(rows, shapes, strict=True) if isinstance(shape, Polygon)]
        lengths = [len(outline) for _, outline in angular]
        self._corners = np.concatenate([np.empty((0, 2)), *(outline for _, outline in angular)])
        self._body = np.repeat([index for (index, _), _ in angular], lengths).astype(int)
        ends = np.cumsum(lengths, dtype=int)
        self._angular = [
            (row, start, end)
            for (row, _), start, end in zip(angular, (ends - lengths).tolist(), ends.tolist(), strict=True)
        ]

    def draw(self, canvas: Canvas, view: View, poses: Array, lit: int | None, held: bool) -> None:
        """Draw the layer as `Outlines.draw` does."""

        def shades(index: int, colours: _Colours) -> _Colours:
            return _colours(HUMAN if held else mix(colours[0], INK, 0.6), _LIT) if index == lit else colours

        if self._angular:
            self._draw_angular(canvas, view, poses, shades)
        if self._discs:
            self._draw_discs(canvas, view, poses[self._disc_bodies], shades)

    def _draw_angular(self, canvas: Canvas, view: View, poses: Array, shades: _Shades) -> None:
        x, y, angle = poses[self._body].T
        places = rotate(self._corners, np.cos(angle), np.sin(angle)) + np.stack([x, y], axis=1)
        pixels = view.pixels(places)
        width = max(1, canvas.px(_EDGE))
        surface = canvas.surface
        for (index, colours), start, end in self._angular:
            edge, fill, _ = shades(index, colours)
            # One by one: thousands of pairs alive at once would set Python's garbage collector going.
            corners = pixels[start:end].tolist()
            pygame.draw.polygon(surface, fill, corners)
            _draw_edge(surface, edge, corners, width)

    def _draw_discs(self, canvas: Canvas, view: View, poses: Array, shades: _Shades) -> None:
        """Draw discs at `poses` (discs, 3), and on each the mark that shows its turning."""
        width = max(1, canvas.px(_EDGE))
        middles = view.pixels(poses[:, :2])
        colours = [shades(index, colours) for index, colours in self._discs]
        radii = [round(4 * radius * view.pixels_per_metre) / 4 for radius in self._radii]
        discs = (
            partial(_disc, radius, edge, fill, width) for radius, (edge, fill, _) in zip(radii, colours, strict=True)
        )
        # To whole and half pixels only, which limits how many costly pictures are painted.
        _stamp(canvas.surface, middles, discs, 2)
        way = np.stack([np.cos(poses[:, 2]), -np.sin(poses[:, 2])], axis=1) * np.array(radii)[:, None]
        inner, outer = ((middles + share * way).tolist() for share in _MARK)
        for start, end, (_, _, mark) in zip(inner, outer, colours, strict=True):
            pygame.draw.aaline(canvas.surface, mark, start, end, width)


def draw_contacts(canvas: Canvas, view: View, world: World, weight: float) -> None:
    """Draw the last step's contacts: a dot for a point, and a line along the normal, its length the force there.

    `weight` in newtons is that of one kilogram; friction is a fainter line along the surface. `draw_force_scale` draws
    the legend.
    """
    contacts = world.contacts
    if contacts is None:
        return
    units = contacts.impulse / (weight * DT)
    row, which = contacts.valid.nonzero()
    points = view.points(contacts.points[row, which])
    normal = contacts.normal[row] * (1, -1)
    reach = np.minimum(_PER_WEIGHT * units[row, which], _LONGEST)[:, None] / 2 * normal
    rubbing = np.flatnonzero(np.abs(units[:, 2]) > 0.05)
    middle = contacts.points[rubbing, 0]
    both = contacts.valid[rubbing].all(axis=1)
    middle[both] = contacts.points[rubbing[both]].mean(axis=1)
    along = right_of(contacts.normal[rubbing]) * (1, -1)
    rub = np.clip(_PER_WEIGHT * units[rubbing, 2], -_LONGEST, _LONGEST)[:, None] / 2 * along
    middle = view.points(middle)
    _draw_lines(canvas, middle - rub, middle + rub, _RUB)
    _draw_lines(canvas, points - reach, points + reach, NET)
    dot = partial(shapes.shape, "circle", round(4 * 1.6 * canvas.scale) / 4, NET)
    _stamp(canvas.surface, points * canvas.scale, repeat(dot))


def scale_force(weight: float) -> tuple[float, float]:
    """Return a round force in newtons, and how long, in points, `draw_contacts` draws it for that `weight`."""
    per_newton = _PER_WEIGHT / weight
    force = next(each for each in (2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0) if each * per_newton > _SCALE[0])
    return force, force * per_newton


def draw_force_scale(canvas: Canvas, start: tuple[float, float], weight: float, room: float) -> None:
    """Draw the legend of `draw_contacts` from the left end of its baseline on, in `room` points."""
    x, y = start
    force, length = scale_force(weight)
    normal, friction = texts.FORCE_SCALE
    canvas.line((x, y - 4), (x + length, y - 4), NET)
    words = normal.format(force=force, most=_LONGEST / _PER_WEIGHT * weight)
    after = canvas.text(words, (x + length + 8, y), size=SMALL, colour=MUTE, room=0.66 * room - length).right + 18
    canvas.line((after, y - 4), (after + 16, y - 4), _RUB)
    canvas.text(friction, (after + 24, y), size=SMALL, colour=MUTE, room=start[0] + room - after - 24)


def draw_grip(canvas: Canvas, start: tuple[float, float], end: tuple[float, float]) -> None:
    """Draw, in points, the thread by which a body is pulled."""
    if start != end:
        canvas.line(start, end, HUMAN, 1.2)
    canvas.dot(start, 3.5, HUMAN)
    canvas.dot(end, 2.0, HUMAN)


def _colours(edge: Colour, share: float) -> _Colours:
    """Return the colours of the edge, the inside, and the mark that shows the rotation."""
    return edge, mix(NIGHT1, edge, share), mix(NIGHT1, edge, 0.75)


@lru_cache(maxsize=256)
def _disc(radius: float, edge: Colour, fill: Colour, width: int, quarters: tuple[int, int]) -> pygame.Surface:
    """Return a disc of that radius in pixels, its middle `quarters` of a pixel past the middle one."""
    disc = shapes.shape("circle", radius + width / 2, edge, quarters).copy()
    inside = shapes.shape("circle", radius - width / 2, fill, quarters)
    for sheet in (disc, inside):
        sheet.set_alpha(255)
    disc.blit(inside, ((disc.width - inside.width) // 2, (disc.height - inside.height) // 2))
    return disc


def _stamp(surface: pygame.Surface, middles: Array, paints: Iterable[_Paint], step: int = 1) -> None:
    """Blit pictures in one call, their middles at (n, 2) pixels, to a `step` of 1 or 2 quarters of a pixel."""
    whole = np.floor(middles)
    quarters = ((4 * (middles - whole)).astype(int) // step * step).tolist()
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
