"""Small anti-aliased shapes, drawn large once, scaled down and cached."""

from __future__ import annotations

import math
from functools import lru_cache
from itertools import pairwise
from typing import Final, Literal

import numpy as np
import numpy.typing as npt
import pygame

from game.drawing.tokens import Colour

Shape = Literal["circle", "ring", "triangle", "triangle_down", "diamond", "tick", "cross", "check"]

_FACTOR: Final = 8
_LARGE_GLOW, _HUGE_GLOW = 64, 256  # pixels
# Corners on a circle of radius 1, y down.
_POLYGONS: Final[dict[str, list[tuple[float, float]]]] = {
    "triangle": [(0.0, -0.9), (0.95, 0.75), (-0.95, 0.75)],
    "triangle_down": [(0.0, 0.9), (0.95, -0.75), (-0.95, -0.75)],
    "diamond": [(0.0, -1.0), (1.0, 0.0), (0.0, 1.0), (-1.0, 0.0)],
    "tick": [(-0.13, -1.0), (0.13, -1.0), (0.13, 1.0), (-0.13, 1.0)],
}
_STROKES: Final[dict[str, list[list[tuple[float, float]]]]] = {
    "cross": [[(-0.7, -0.7), (0.7, 0.7)], [(-0.7, 0.7), (0.7, -0.7)]],
    "check": [[(-0.85, 0.05), (-0.25, 0.65), (0.85, -0.6)]],
}


@lru_cache(maxsize=2048)
def shape(name: Shape, radius: float, colour: Colour, quarters: tuple[int, int] = (0, 0)) -> pygame.Surface:
    """Return a shape of a radius in pixels, shifted by `quarters` of a pixel in x and y."""
    half = math.ceil(radius) + 2
    side = 2 * half
    sheet = _sheet((side * _FACTOR, side * _FACTOR), colour)
    x, y = (_FACTOR * (half + quarter / 4) for quarter in quarters)
    large = _FACTOR * radius
    if name == "circle":
        pygame.draw.circle(sheet, colour, (x, y), large)
    elif name == "ring":
        pygame.draw.circle(sheet, colour, (x, y), large, max(_FACTOR, round(large * 0.22)))
    elif name in _POLYGONS:
        pygame.draw.polygon(sheet, colour, [(x + large * u, y + large * v) for u, v in _POLYGONS[name]])
    else:
        strokes = [[(x + large * u, y + large * v) for u, v in line] for line in _STROKES[name]]
        _stroke(sheet, colour, strokes, large)
    return pygame.transform.smoothscale(sheet, (side, side))


def _stroke(sheet: pygame.Surface, colour: Colour, strokes: list[list[tuple[float, float]]], radius: float) -> None:
    width = max(_FACTOR, round(0.28 * radius))
    for points in strokes:
        for start, end in pairwise(points):
            pygame.draw.line(sheet, colour, start, end, width)
        for point in points:
            pygame.draw.circle(sheet, colour, point, width / 2)


@lru_cache(maxsize=512)
def rounded(size: tuple[int, int], radius: float, colour: Colour, width: int = 0, cover: float = 1.0) -> pygame.Surface:
    """Return a rectangle with round corners: filled, or as an outline `width` pixels wide; `cover` is its opacity.

    A large one that is always as translucent is blended twice as fast with that in its pixels as with an alpha set.
    """
    if cover < 1:
        pale = rounded(size, radius, colour, width).copy()
        pale.fill((255, 255, 255, round(255 * cover)), special_flags=pygame.BLEND_RGBA_MULT)
        return pale
    reach = math.ceil(max(radius, width)) + 1  # pixels from an end, beyond which nothing changes
    small = _rounded((min(size[0], 2 * reach), min(size[1], 2 * reach)), radius, colour, width)
    if small.get_size() == size:
        return small
    columns, rows = (_stretched(was, length) for was, length in zip(small.get_size(), size, strict=True))
    surface = _sheet(size, colour)
    pygame.surfarray.pixels_alpha(surface)[:] = pygame.surfarray.pixels_alpha(small)[columns[:, None], rows]
    return surface


@lru_cache(maxsize=256)
def _rounded(size: tuple[int, int], radius: float, colour: Colour, width: int) -> pygame.Surface:
    sheet = _sheet((size[0] * 4, size[1] * 4), colour)
    pygame.draw.rect(sheet, colour, sheet.get_rect(), width * 4, border_radius=max(0, round(radius * 4)))
    return pygame.transform.smoothscale(sheet, size)


def _stretched(length: int, wanted: int) -> npt.NDArray[np.intp]:
    """Return for each pixel of a longer row the pixel to copy: the ends stay, the middle is stretched."""
    places = np.arange(wanted)
    return np.where(
        places < wanted / 2, np.minimum(places, (length - 1) // 2), np.maximum(places - wanted + length, length // 2)
    )


@lru_cache(maxsize=256)
def plain(size: tuple[int, int], colour: Colour) -> pygame.Surface:
    """Return a filled rectangle for alpha blending."""
    surface = pygame.Surface(size)
    surface.fill(colour)
    return surface


def glow(radius: int, colour: Colour, level: int) -> pygame.Surface:
    """Return a radial glow for additive blending, in pixels; `level` is its strength in 1/32."""
    return (_glow if radius < _HUGE_GLOW else _huge_glow)(radius, colour, level)


@lru_cache(maxsize=8)  # ten megabytes each in a large window, and seldom the same again
def _huge_glow(radius: int, colour: Colour, level: int) -> pygame.Surface:
    return _glow.__wrapped__(radius, colour, level)


@lru_cache(maxsize=256)
def _glow(radius: int, colour: Colour, level: int) -> pygame.Surface:
    # A large glow is smooth enough to scale up from a small one; an explosion needs a new one every few frames.
    half = radius if radius < _LARGE_GLOW else max(_LARGE_GLOW // 2, radius // 8)
    axis = np.arange(-half, half + 1, dtype=np.float32) / max(half, 1)
    distance = np.minimum(np.sqrt(axis[:, None] ** 2 + axis[None, :] ** 2), 1.0)
    light = (1 - distance) ** 2.4 * (level / 32)
    surface = pygame.surfarray.make_surface(
        np.minimum(light[..., None] * np.array(colour, np.float32), 255).astype(np.uint8)
    )
    return surface if half == radius else pygame.transform.smoothscale(surface, (2 * radius + 1, 2 * radius + 1))


def forget() -> None:
    """Clear the cache of shapes, after a change of the window's size."""
    for cache in (shape, rounded, _rounded, plain, _glow, _huge_glow):
        cache.cache_clear()


def _sheet(size: tuple[int, int], colour: Colour) -> pygame.Surface:
    # Transparent in the shape's own colour, so that scaling down does not darken its edge.
    sheet = pygame.Surface(size, pygame.SRCALPHA)
    sheet.fill((*colour, 0))
    return sheet
