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

Shape = Literal["circle", "ring", "triangle", "triangle_down", "diamond", "cross", "check"]

_FACTOR: Final = 8  # how many times larger a shape is painted before it is scaled down
_LARGE_SHAPE: Final = 3.0  # pixels of radius from which shapes are painted half as fine
_LARGE_GLOW, HUGE_GLOW = 64, 256  # pixels
_APART: Final = 32  # pixels by which radii of huge glows differ
_BAND: Final = 32  # rows of a huge glow that are scaled at once
_FALL: Final = 2.4  # how steeply a glow fades outwards
# Corners on a circle of radius 1, y down.
_POLYGONS: Final[dict[str, list[tuple[float, float]]]] = {
    "triangle": [(0.0, -0.9), (0.95, 0.75), (-0.95, 0.75)],
    "triangle_down": [(0.0, 0.9), (0.95, -0.75), (-0.95, -0.75)],
    "diamond": [(0.0, -1.0), (1.0, 0.0), (0.0, 1.0), (-1.0, 0.0)],
}
_STROKES: Final[dict[str, list[list[tuple[float, float]]]]] = {
    "cross": [[(-0.7, -0.7), (0.7, 0.7)], [(-0.7, 0.7), (0.7, -0.7)]],
    "check": [[(-0.85, 0.05), (-0.25, 0.65), (0.85, -0.6)]],
}


@lru_cache(maxsize=2048)
def shape(name: Shape, radius: float, colour: Colour, quarters: tuple[int, int] = (0, 0)) -> pygame.Surface:
    """Return a shape of a radius in pixels, shifted by `quarters` of a pixel in x and y."""
    half, factor = math.ceil(radius) + 2, _FACTOR if radius < _LARGE_SHAPE else _FACTOR // 2
    side = 2 * half
    sheet = _sheet((side * factor, side * factor), colour)
    x, y = (factor * (half + quarter / 4) for quarter in quarters)
    large = factor * radius
    if name == "circle":
        pygame.draw.circle(sheet, colour, (x, y), large)
    elif name == "ring":
        pygame.draw.circle(sheet, colour, (x, y), large, max(factor, round(large * 0.22)))
    elif name in _POLYGONS:
        pygame.draw.polygon(sheet, colour, [(x + large * u, y + large * v) for u, v in _POLYGONS[name]])
    else:
        strokes = [[(x + large * u, y + large * v) for u, v in line] for line in _STROKES[name]]
        _stroke(sheet, colour, strokes, max(factor, round(0.28 * large)))
    return pygame.transform.smoothscale(sheet, (side, side))


def _stroke(sheet: pygame.Surface, colour: Colour, strokes: list[list[tuple[float, float]]], width: int) -> None:
    for points in strokes:
        for start, end in pairwise(points):
            pygame.draw.line(sheet, colour, start, end, width)
        for point in points:
            pygame.draw.circle(sheet, colour, point, width / 2)


@lru_cache(maxsize=512)
def rounded(
    size: tuple[int, int],
    radius: float,
    colour: Colour,
    width: int = 0,
    cover: float = 1.0,
    *,
    premultiplied: bool = False,
) -> pygame.Surface:
    """Return a rectangle with round corners: filled, or as an outline `width` pixels wide; `cover` is its opacity.

    A large one that is always as translucent is blended twice as fast with that in its pixels as with an alpha set,
    and a quarter faster still `premultiplied`, where the surface below is opaque.
    """
    if cover < 1:
        pale = rounded(size, radius, colour, width).copy()
        pale.fill((255, 255, 255, round(255 * cover)), special_flags=pygame.BLEND_RGBA_MULT)
        return pale.premul_alpha_ip() if premultiplied else pale
    reach = math.ceil(max(radius, width)) + 1  # pixels from an end, beyond which nothing changes
    small = _rounded((min(size[0], 2 * reach), min(size[1], 2 * reach)), radius, colour, width)
    if small.get_size() == size:
        return small
    surface = _sheet(size, colour)
    across, down = (_parts(was, length) for was, length in zip(small.get_size(), size, strict=True))
    for (x, left), (wide, columns) in across:
        for (y, top), (high, rows) in down:
            part = small.subsurface((left, top, columns, rows))
            surface.blit(
                part if (wide, high) == (columns, rows) else pygame.transform.scale(part, (wide, high)), (x, y)
            )
    return surface


@lru_cache(maxsize=256)
def _rounded(size: tuple[int, int], radius: float, colour: Colour, width: int) -> pygame.Surface:
    sheet = _sheet((size[0] * 4, size[1] * 4), colour)
    pygame.draw.rect(sheet, colour, sheet.get_rect(), width * 4, border_radius=max(0, round(radius * 4)))
    return pygame.transform.smoothscale(sheet, size)


def _parts(length: int, wanted: int) -> list[tuple[tuple[int, int], tuple[int, int]]]:
    """Return for each part of a longer row where it begins, and in the shorter one, and how long it is in both.

    The ends stay, and one pixel in the middle is stretched.
    """
    end = (length - 1) // 2
    parts = [((0, 0), (end, end)), ((end, end), (wanted - 2 * end, 1)), ((wanted - end, length - end), (end, end))]
    return [part for part in parts if part[1][0]]


def slanted(
    a: tuple[float, float], b: tuple[float, float], colour: Colour, thickness: int
) -> tuple[pygame.Surface, tuple[int, int]]:
    """Return an anti-aliased line between two places in pixels, and the corner where it is drawn."""
    margin = thickness + 1
    left, top = math.floor(min(a[0], b[0])) - margin, math.floor(min(a[1], b[1])) - margin
    sheet = _sheet((int(abs(b[0] - a[0])) + 2 * margin + 2, int(abs(b[1] - a[1])) + 2 * margin + 2), colour)
    pygame.draw.aaline(sheet, (*colour, 255), (a[0] - left, a[1] - top), (b[0] - left, b[1] - top), thickness)
    return sheet, (left, top)


@lru_cache(maxsize=256)
def plain(size: tuple[int, int], colour: Colour) -> pygame.Surface:
    """Return a filled rectangle for alpha blending."""
    surface = pygame.Surface(size)
    surface.fill(colour)
    return surface


def add_huge_glow(
    surface: pygame.Surface, middle: tuple[int, int], radius: int, colour: Colour, strength: float
) -> None:
    """Add a glow of at least `HUGE_GLOW` pixels, to within a sixteenth: explosions need new ones.

    It is scaled up in bands, for which the processor's cache has room: a whole one is ten megabytes of new memory.
    """
    level = round(32 * strength)
    if level <= 0:
        return
    glow = _half_glow(_APART * round(radius / _APART), colour, level)
    side = glow.get_width()
    left, top = middle[0] - side, middle[1] - side
    for row in range(0, side, _BAND):
        rows = min(_BAND, side - row)
        band = _band((2 * side, 2 * rows))
        pygame.transform.scale(glow.subsurface((0, row, side, rows)), band.get_size(), band)
        surface.blit(band, (left, top + 2 * row), None, pygame.BLEND_RGB_ADD)


@lru_cache(maxsize=2)
def _band(size: tuple[int, int]) -> pygame.Surface:
    return pygame.Surface(size)


@lru_cache(maxsize=8)  # a megabyte each in a large window, and seldom the same again
def _half_glow(radius: int, colour: Colour, level: int) -> pygame.Surface:
    """Return a huge glow at half its size, as far as it shines; it is smooth, and painted smaller still."""
    shine = level / 32
    reach = min(max(1 - (255 * shine) ** (-1 / _FALL), 0.25), 1.0)
    light = _fading(radius // 16, reach) * shine
    small = pygame.surfarray.make_surface(
        np.minimum(light[..., None] * np.array(colour, np.float32), 255).astype(np.uint8)
    )
    side = math.ceil(radius * reach)
    return pygame.transform.smoothscale(small, (side, side))


@lru_cache(maxsize=256)
def glow(radius: int, colour: Colour, level: int) -> pygame.Surface:
    """Return a radial glow for additive blending, in pixels; `level` is its strength in 1/32."""
    surface = _halo(radius).copy()
    surface.fill([round(part * min(level, 32) / 32) for part in colour], special_flags=pygame.BLEND_RGB_MULT)
    if level > 32:
        surface.blit(glow(radius, colour, level - 32), (0, 0), special_flags=pygame.BLEND_RGB_ADD)
    return surface


@lru_cache(maxsize=128)
def _halo(radius: int) -> pygame.Surface:
    """Return a white glow of full strength: to tint it takes a tenth of the time of computing it."""
    # A large one is smooth enough to scale up from a small one.
    half = radius if radius < _LARGE_GLOW else max(_LARGE_GLOW // 2, radius // 8)
    light = (255 * _fading(half)).astype(np.uint8)
    surface = pygame.surfarray.make_surface(np.repeat(light[..., None], 3, axis=2))
    return surface if half == radius else pygame.transform.smoothscale(surface, (2 * radius + 1, 2 * radius + 1))


def _fading(half: int, reach: float = 1.0) -> npt.NDArray[np.float32]:
    """Return the strength of a glow around its middle, 1 to 0, as far as a share of its radius."""
    axis = np.linspace(-reach, reach, 2 * half + 1, dtype=np.float32)
    distance = np.minimum(np.sqrt(axis[:, None] ** 2 + axis[None, :] ** 2), 1.0)
    strength: npt.NDArray[np.float32] = (1 - distance) ** np.float32(_FALL)
    return strength


def forget() -> None:
    """Clear the cache of shapes, after a change of the window's size."""
    for cache in (shape, rounded, _rounded, plain, glow, _half_glow, _halo, _band):
        cache.cache_clear()


def _sheet(size: tuple[int, int], colour: Colour) -> pygame.Surface:
    # Transparent in the shape's own colour, so that scaling down does not darken its edge.
    sheet = pygame.Surface(size, pygame.SRCALPHA)
    sheet.fill((*colour, 0))
    return sheet
