"""Pictures of the lander: flat facets in its own frame (metres), lit from where the sun will rise.

The outline is that of the physics: the hull's corners and the feet of `ai.lander.environment`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from typing import Final

import numpy as np
import pygame

from ai.environment import Doubles
from ai.lander.rules import FOOT_CENTRE, FOOT_SIZE
from engine import Sprite
from game.drawing.tokens import Colour
from game.world.landscape.sheet import fitted

Corner = tuple[float, float]

REACH: Final = 1.45  # metres from the centre of mass to just beyond the tips of the feet
SIZE: Final = (2 * REACH, 2 * REACH)  # metres across and up a picture of the lander, true to scale
LANDER, WRECK = "lander", "wreck"  # image keys of sprites
ANTENNA_TIP: Final = (0.16, 1.16)
NOZZLE: Final = (0.0, -0.66)
JETS: Final = ((-0.56, 0.60), (0.56, 0.60))  # the left-hand and the right-hand one

_FACTOR: Final = 4
LARGE: Final = 60.0  # pixels per metre from which half of that will do
_SUN: Final = np.array((0.84, 0.06, 0.54))
_EARTH: Final = np.array((-0.62, 0.58, 0.53))
_SUNLIGHT: Final = np.array((1.0, 0.86, 0.70))
_EARTHLIGHT: Final = np.array((0.34, 0.44, 0.66))
_GOLD: Final = (226, 164, 70)
_SILVER: Final = (198, 204, 218)
_STEEL: Final = (128, 136, 158)
_DARK: Final = (44, 48, 66)
_GLASS: Final = (22, 36, 66)


@dataclass(frozen=True)
class Facet:
    """A flat piece: corners in metres, base colour, and normal (right, up, towards the viewer)."""

    corners: tuple[Corner, ...]
    colour: Colour
    facing: tuple[float, float, float] = (0.0, 0.0, 1.0)
    width: float = 0.0  # of a line through the corners; 0 fills
    gloss: float = 1.0


@dataclass(frozen=True)
class Finish:
    """How facets are painted: their share of the light, and whether the craft is whole: its edges catch the sun."""

    light: float
    whole: bool


# One row a picture, by the image key that sprites have
PICTURES: Final = {LANDER: Finish(1.0, whole=True), WRECK: Finish(0.42, whole=False)}


def _mirrored(facet: Facet) -> Facet:
    right, up, towards = facet.facing
    corners = tuple((-x, y) for x, y in facet.corners)
    return Facet(corners, facet.colour, (-right, up, towards), facet.width, facet.gloss)


def _both(*facets: Facet) -> list[Facet]:
    return [side for facet in facets for side in (_mirrored(facet), facet)]


def _legs() -> list[Facet]:
    x, y = FOOT_CENTRE
    half, rise = FOOT_SIZE[0] / 2, FOOT_SIZE[1] / 2
    lower, upper = ((x - half, y - rise), (x + half, y - rise)), ((x + 0.09, y + rise), (x - 0.09, y + rise))
    dish = (*lower, (x + half, y - 0.01), *upper, (x - half, y - 0.01))
    return _both(
        Facet(((0.40, -0.44), (x - 0.02, y + 0.20)), _DARK, (0.2, -0.6, 0.7), 0.045),
        Facet(((0.66, -0.30), (x - 0.01, y + 0.16)), _STEEL, (0.3, -0.5, 0.8), 0.045),
        Facet(((0.60, 0.02), (x, y + rise)), _SILVER, (0.75, 0.3, 0.6), 0.066),
        Facet(((0.60, 0.02), (x - 0.115, y + 0.35)), _GOLD, (0.7, 0.3, 0.6), 0.085),
        Facet(dish, _STEEL, (0.0, 0.35, 0.9)),
        Facet(((x - half, y - 0.012), *upper[::-1], (x + half, y - 0.012)), _SILVER, (0.15, 0.8, 0.55)),
    )


def _engine() -> list[Facet]:
    return [
        Facet(((-0.12, -0.42), (0.12, -0.42), (0.24, -0.67), (-0.24, -0.67)), _STEEL, (-0.3, -0.2, 0.6)),
        Facet(((0.03, -0.42), (0.12, -0.42), (0.24, -0.67), (0.08, -0.67)), _STEEL, (0.8, -0.2, 0.6)),
        Facet(((-0.24, -0.645), (0.24, -0.645), (0.24, -0.67), (-0.24, -0.67)), _DARK),
    ]


def _descent_stage() -> list[Facet]:
    low, mid, top = -0.45, -0.19, 0.06
    bright, deep = (240, 184, 92), (188, 122, 44)
    front = [
        Facet(((-0.30, low), (0.30, low), (0.0, mid), (-0.34, mid)), _GOLD, (-0.10, -0.30, 0.95)),
        Facet(((0.30, low), (0.34, mid), (0.0, mid)), deep, (0.15, -0.45, 0.90)),
        Facet(((-0.34, mid), (0.0, mid), (-0.10, top), (-0.34, top)), deep, (-0.15, 0.20, 0.95)),
        Facet(((0.0, mid), (0.34, mid), (0.34, top), (-0.10, top)), bright, (0.16, 0.25, 0.95)),
    ]
    side = _both(
        Facet(((0.30, low), (0.62, low), (0.50, mid), (0.34, mid)), _GOLD, (0.62, -0.45, 0.6)),
        Facet(((0.62, low), (0.68, mid), (0.50, mid)), deep, (0.80, -0.30, 0.5)),
        Facet(((0.34, mid), (0.50, mid), (0.52, top), (0.34, top)), bright, (0.55, 0.15, 0.75)),
        Facet(((0.50, mid), (0.68, mid), (0.72, 0.05), (0.72, top), (0.52, top)), _GOLD, (0.85, 0.20, 0.45)),
    )
    deck = [
        Facet(((-0.72, 0.05), (0.72, 0.05), (0.66, 0.12), (-0.66, 0.12)), (150, 112, 62), (0.0, 0.7, 0.7)),
        Facet(((-0.34, 0.12), (0.34, 0.12), (0.34, 0.075), (-0.34, 0.075)), (214, 168, 98), (0.0, 0.5, 0.8)),
    ]
    return side + front + deck


def _cabin() -> list[Facet]:
    base, waist, brow, top = 0.12, 0.34, 0.60, 0.75
    white, shade = (222, 226, 236), (168, 176, 196)
    faces = [
        Facet(((-0.26, base), (0.26, base), (0.26, waist), (-0.26, waist)), white, (0.0, -0.12, 0.99)),
        Facet(((-0.26, waist), (0.26, waist), (0.22, brow), (-0.22, brow)), white, (0.0, 0.22, 0.97)),
        Facet(((-0.22, brow), (0.22, brow), (0.18, top), (-0.18, top)), _SILVER, (0.0, 0.62, 0.78)),
    ]
    sides = _both(
        Facet(((0.26, base), (0.54, base), (0.57, waist), (0.26, waist)), _SILVER, (0.72, -0.10, 0.68)),
        Facet(((0.26, waist), (0.57, waist), (0.48, brow), (0.22, brow)), white, (0.70, 0.28, 0.66)),
        Facet(((0.22, brow), (0.48, brow), (0.40, top), (0.18, top)), shade, (0.50, 0.70, 0.50)),
    )
    trim = [
        Facet(((-0.55, base), (0.55, base)), _DARK, width=0.03),
        Facet(((-0.565, waist), (0.565, waist)), (126, 134, 156), width=0.016),
        Facet(((-0.13, top), (0.13, top), (0.10, 0.82), (-0.10, 0.82)), _STEEL, (0.0, 0.4, 0.9)),
        Facet(((-0.09, base), (0.09, base), (0.09, 0.315), (-0.09, 0.315)), (118, 126, 148)),
        Facet(((-0.065, 0.145), (0.065, 0.145), (0.065, 0.295), (-0.065, 0.295)), (152, 160, 180)),
    ]
    glass = _both(
        Facet(((0.045, 0.375), (0.215, 0.375), (0.185, 0.575), (0.045, 0.575)), _DARK, (0.0, 0.2, 0.95)),
        Facet(((0.066, 0.395), (0.188, 0.395), (0.166, 0.555), (0.066, 0.555)), _GLASS, gloss=0.0),
        Facet(((0.61, 0.53), (0.61, 0.67), (0.47, 0.67), (0.47, 0.53)), _STEEL, (0.4, 0.2, 0.6)),
        Facet(((0.61, 0.53), (0.61, 0.67), (0.56, 0.67), (0.56, 0.53)), _DARK, (0.7, 0.2, 0.6)),
    )
    glint = [
        Facet(((-0.166, 0.555), (-0.13, 0.555), (-0.178, 0.43), (-0.184, 0.43)), (104, 148, 208), gloss=0.0),
        Facet(((0.095, 0.555), (0.166, 0.555), (0.176, 0.48)), (240, 178, 124), gloss=0.0),
    ]
    x, y = ANTENNA_TIP
    mast = [
        Facet(((x, top), (x, y - 0.03)), _STEEL, (0.5, 0.0, 0.8), 0.028),
        Facet(((-0.28, 0.70), (-0.375, 0.925)), _STEEL, (0.5, 0.0, 0.8), 0.028),
        Facet(((-0.46, 0.84), (-0.44, 0.93), (-0.36, 0.99), (-0.27, 0.98)), white, (-0.5, 0.5, 0.7)),
    ]
    return mast + faces + sides + trim + glass + glint


FACETS: Final = tuple(_legs() + _engine() + _descent_stage() + _cabin())
_LOST: Final = frozenset(FACETS.index(each) for each in [*_legs()[1::2], *_cabin()[:3]])  # of a wreck: a leg, and masts
# Edges that catch the light, each from corner to corner counter-clockwise around the craft.
_RIMS: Final = (
    ((0.62, -0.45), (0.72, 0.05), (0.66, 0.12)),
    ((-0.66, 0.12), (-0.72, 0.05), (-0.62, -0.45)),
    ((0.54, 0.12), (0.57, 0.34), (0.48, 0.60), (0.40, 0.75), (0.13, 0.75)),
    ((-0.13, 0.75), (-0.40, 0.75), (-0.48, 0.60), (-0.57, 0.34), (-0.54, 0.12)),
    ((-0.62, -0.45), (0.62, -0.45)),
)


def share(sprite: Sprite) -> float:
    """Return the size at which a sprite is drawn; 1 is true to scale."""
    return sprite.size[0] / SIZE[0]


def turned(
    image: str, pixels_per_metre: float, angle: float, middle: tuple[float, float] = (0.0, 0.0), ratio: float = 1.0
) -> tuple[pygame.Surface, tuple[int, int]]:
    """Return a picture turned by `angle`, and the corner that puts its centre of mass at `middle`, in pixels.

    The picture is painted at `pixels_per_metre` and then scaled by `ratio`.
    """
    degrees = round(math.degrees(angle)) % 360
    return fitted(lambda halves: painted(pixels_per_metre, degrees, halves, image), ratio, middle)


def sprites(pixels_per_metre: float, angles: Doubles, middles: Doubles) -> list[tuple[pygame.Surface, tuple[int, int]]]:
    """Return a swarm ready to be blitted: angles (n,), centres of mass (n, 2) in pixels."""
    degrees = np.rint(np.degrees(angles) / 5).astype(int) * 5 % 360
    half = painted(pixels_per_metre, 0, (0, 0), LANDER).get_width() // 2
    corners = np.rint(middles - half).astype(int).tolist()
    return [
        (_packed(pixels_per_metre, turn), (left, top))
        for turn, (left, top) in zip(degrees.tolist(), corners, strict=True)
    ]


@lru_cache(maxsize=512)
def _packed(pixels_per_metre: float, degrees: int) -> pygame.Surface:
    """Return the lander, run-length encoded (RLE): there are hundreds to draw, and RLE makes clear pixels free."""
    picture = painted(pixels_per_metre, degrees, (0, 0), LANDER).copy()
    picture.set_alpha(255, pygame.RLEACCEL)
    return picture


@lru_cache(maxsize=256)  # a seventh of a megabyte each, and more in a large window
def painted(pixels_per_metre: float, degrees: int, halves: tuple[int, int], image: str) -> pygame.Surface:
    """Return a picture at a size and angle, its middle moved right and down by 0 or 1 `halves` of a pixel."""
    finish = PICTURES[image]
    half = math.ceil(REACH * pixels_per_metre) + 2
    side = 2 * half + 1
    factor = _FACTOR if pixels_per_metre < LARGE else _FACTOR // 2
    sheet = pygame.Surface((side * factor, side * factor), pygame.SRCALPHA)
    sheet.fill((60, 60, 78, 0))
    turn = math.radians(degrees)
    scale = pixels_per_metre * factor
    middle = [factor * (half + 0.5 + part / 2) for part in halves]
    placed = _CORNERS @ np.array(((math.cos(turn), -math.sin(turn)), (math.sin(turn), math.cos(turn)))).T
    places = (placed * (scale, -scale) + middle).tolist()
    colours = _lit(turn, finish.light)
    for number, (facet, (start, stop), colour) in enumerate(zip(FACETS, _SPANS, colours, strict=True)):
        if not finish.whole and number in _LOST:
            continue
        if facet.width:
            _strut(sheet, colour, places[start], places[stop - 1], facet.width * scale)
        else:
            pygame.draw.polygon(sheet, colour, places[start:stop])
    if finish.whole:
        _paint_rim(sheet, turn, scale, middle)
    return pygame.transform.smoothscale(sheet, (side, side))


def _strut(sheet: pygame.Surface, colour: Colour, start: Corner, end: Corner, width: float) -> None:
    along = math.hypot(end[0] - start[0], end[1] - start[1]) or 1.0
    x, y = (end[1] - start[1]) / along * width / 2, (start[0] - end[0]) / along * width / 2
    corners = [(start[0] + x, start[1] + y), (end[0] + x, end[1] + y), (end[0] - x, end[1] - y)]
    pygame.draw.polygon(sheet, colour, [*corners, (start[0] - x, start[1] - y)])


def _lit(turn: float, share: float) -> list[Colour]:
    """Return each facet's colour in the sun's first warm and the Earth's cold light, or in a share of it."""
    cos, sin = math.cos(turn), math.sin(turn)
    facing = _FACING.copy()
    facing[:, 0], facing[:, 1] = _FACING[:, 0] * cos - _FACING[:, 1] * sin, _FACING[:, 0] * sin + _FACING[:, 1] * cos
    sun = np.clip(facing @ _SUN, 0, None)[:, None]
    earth = np.clip(facing @ _EARTH, 0, None)[:, None]
    light = 0.16 + 0.98 * sun * _SUNLIGHT + 0.52 * earth * _EARTHLIGHT
    shaded = share * _COLOURS * (_GLOSS * light + (1 - _GLOSS))
    return [(r, g, b) for r, g, b in np.clip(shaded, 0, 255).astype(int).tolist()]


def _paint_rim(sheet: pygame.Surface, turn: float, scale: float, middle: list[float]) -> None:
    cos, sin = math.cos(turn), math.sin(turn)
    for (ax, ay), (bx, by) in _RIM_EDGES:
        length = math.hypot(bx - ax, by - ay)
        out_x, out_y = (by - ay) / length, (ax - bx) / length
        lit = (out_x * cos - out_y * sin) * _SUN[0] + (out_x * sin + out_y * cos) * _SUN[1]
        if lit < 0.25:
            continue
        ends = [(ax, ay), (bx, by)]
        places = [(middle[0] + scale * (x * cos - y * sin), middle[1] - scale * (x * sin + y * cos)) for x, y in ends]
        _strut(sheet, (255, round(190 + 40 * lit), round(130 + 50 * lit)), places[0], places[1], 0.022 * scale)


_RIM_EDGES: Final = [edge for rim in _RIMS for edge in pairwise(rim)]
_CORNERS: Final = np.array([corner for facet in FACETS for corner in facet.corners])
_ENDS: Final = np.cumsum([len(facet.corners) for facet in FACETS]).tolist()
_SPANS: Final = list(zip([0, *_ENDS], _ENDS, strict=False))
_FACING: Final = np.array([np.array(f.facing) / np.linalg.norm(f.facing) for f in FACETS])
_COLOURS: Final = np.array([f.colour for f in FACETS], dtype=float)
_GLOSS: Final = np.array([[f.gloss] for f in FACETS])
