"""Drawing of rigid bodies and their contacts: outlines, contact points, normals and impulses."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final

import numpy as np
import pygame

from engine import DT, Body, Circle, Polygon, World
from engine.vector import Array, dot, right_of, rotate
from game.drawing.canvas import Canvas
from game.drawing.paint import mix
from game.drawing.tokens import HUMAN, INK, NET, NIGHT1, Colour
from game.scenes.physics.exhibit import Drawn
from game.world.camera import View

_MARK: Final = (0.45, 0.82)  # start and end of the mark that shows a disc's rotation, in shares of its radius
_EDGE: Final = 1.2  # points
_FILL: Final = 0.26
_LIT: Final = 0.45
# Length of a line that shows a force, in points: for the weight of a kilogram, and of the longest.
_PER_WEIGHT: Final = 6.0
_LONGEST: Final = 72.0
_RUB: Final = mix(NIGHT1, NET, 0.6)


class Outlines:
    """The bodies of an exhibit, those with corners behind the discs."""

    def __init__(self, drawn: Sequence[Drawn]) -> None:
        self._drawn = drawn
        self._discs = [(each, each.shape.radius) for each in drawn if isinstance(each.shape, Circle)]
        angular = [(each, each.shape.vertices) for each in drawn if isinstance(each.shape, Polygon)]
        # All corners in one array, so that they are turned and placed at once.
        self._angular, lengths = [each for each, _ in angular], [len(corners) for _, corners in angular]
        self._corners = np.concatenate([np.empty((0, 2)), *(corners for _, corners in angular)])
        self._body = np.repeat([each.body.index for each in self._angular], lengths).astype(int)
        self._starts = np.cumsum([0, *lengths]).tolist()

    def draw(self, canvas: Canvas, view: View, poses: Array, lit: int | None = None, *, held: bool = False) -> None:
        """Draw every body at its pose, (bodies, 3); draw body `lit` brighter, and in amber if `held`."""

        def colours(each: Drawn) -> tuple[Colour, Colour]:
            """Return the colours of the edge and the inside."""
            if each.body.index != lit:
                return each.colour, mix(NIGHT1, each.colour, _FILL)
            edge = HUMAN if held else mix(each.colour, INK, 0.6)
            return edge, mix(NIGHT1, edge, _LIT)

        x, y, angle = poses[self._body].T
        pixels = view.pixels(rotate(self._corners, np.cos(angle), np.sin(angle)) + np.stack([x, y], axis=1))
        width = max(1, canvas.px(_EDGE))
        for each, start, end in zip(self._angular, self._starts, self._starts[1:], strict=False):
            edge, fill = colours(each)
            # One by one: thousands of pairs alive at once would set Python's garbage collector going.
            corners = pixels[start:end].tolist()
            pygame.draw.polygon(canvas.surface, fill, corners)
            _draw_edge(canvas.surface, edge, corners, width)
        for each, radius in self._discs:
            edge, fill = colours(each)
            across, up, angle = poses[each.body.index].tolist()
            (x, y), points = view.point(across, up), radius * view.pixels_per_metre / canvas.scale
            canvas.dot((x, y), points + _EDGE / 2, edge)
            canvas.dot((x, y), points - _EDGE / 2, fill)
            right, down = points * math.cos(angle), -points * math.sin(angle)
            start, end = ((x + share * right, y + share * down) for share in _MARK)
            canvas.line(start, end, mix(NIGHT1, edge, 0.75), _EDGE)

    def body_at(self, poses: Array, place: Array, reach: float) -> Body | None:
        """Return the movable body at a place in metres, or within `reach` of it; None if there is none."""
        best, nearest = None, reach
        for each in self._drawn:
            if each.body.static:
                continue
            x, y, angle = poses[each.body.index]
            local = rotate(place - (x, y), np.cos(-angle), np.sin(-angle))
            if isinstance(each.shape, Circle):
                gap = float(np.hypot(*local)) - each.shape.radius
            else:
                gap = float(dot(each.shape.normals, local - each.shape.vertices).max())
            if gap < nearest:
                best, nearest = each.body, gap
        return best


def draw_contacts(canvas: Canvas, view: View, world: World, weight: float) -> None:
    """Draw the last step's contacts: a dot for a point, and a line along the normal, its length the force there.

    `weight` in newtons is that of one kilogram; friction is a fainter line along the surface.
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
    for x, y in points.tolist():
        canvas.dot((x, y), 1.6, NET)


def draw_grip(canvas: Canvas, start: tuple[float, float], end: tuple[float, float]) -> None:
    """Draw, in points, the thread by which a body is pulled."""
    if start != end:
        canvas.line(start, end, HUMAN, 1.2)
    canvas.dot(start, 3.5, HUMAN)
    canvas.dot(end, 2.0, HUMAN)


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
