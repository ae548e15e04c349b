"""Manrope at any size: strings become surfaces, once.

Text is drawn large and scaled down, so sizes need not be whole pixels and letters keep their spacing;
hinted small sizes do neither. A pad's buttons are letters as well: see `game.drawing.glyphs`.
"""

from __future__ import annotations

from bisect import bisect_right
from functools import lru_cache
from typing import Final, Literal

import numpy as np
import pygame
from font_manrope import font_files

from game.drawing.glyphs import SIGN, draw_sign, sign_width
from game.drawing.tokens import GROWS, Colour

Weight = Literal["extralight", "light", "regular", "medium", "semibold"]

_FILES: Final[dict[Weight, str]] = {
    "extralight": "ManropeExtraLight",
    "light": "ManropeLight",
    "regular": "Manrope",
    "medium": "ManropeMedium",
    "semibold": "ManropeSemiBold",
}
_LONGEST: Final = 1000  # letters of a text; no line on any screen has more
# Pixels of a text before it is scaled down; a whole line of the largest screen takes half of it. From some 100,000
# on, SDL's scaling writes past the end of its memory.
_WIDEST: Final = 32_768
# Thin light strokes on a dark ground look thinner than they are; this lifts the half-covered pixels.
_COVERAGE: Final = np.round(255 * (np.arange(256) / 255) ** 0.82).astype(np.uint8)


class _Growth:
    """How much larger small text is than it was laid out for."""

    factor = 1.0


def _oversampling(pixels: float) -> int:
    return 4 if pixels < 40 else 2


@lru_cache(maxsize=64)
def _font(pixels: float, weight: Weight) -> pygame.font.Font:
    return pygame.font.Font(font_files[_FILES[weight]], max(1, round(pixels * _oversampling(pixels))))


def grow(factor: float) -> None:
    """Make all text larger from now on, the small most of all; what is large enough stays as it is."""
    if factor != _Growth.factor:
        _Growth.factor = factor
        forget()


def growth() -> float:
    """Return what `grow` was told last."""
    return _Growth.factor


@lru_cache(maxsize=64)
def grown(size: float) -> float:
    """Return the size at which a text of this size is written."""
    small, large = GROWS
    return size + (_Growth.factor - 1) * min(size, small) * min(max((large - size) / (large - small), 0.0), 1.0)


def width(string: str, size: float, weight: Weight) -> float:
    """How far a string of this size reaches, both in points: to lay out what is to be written."""
    return reach(string, grown(size), weight)


@lru_cache(maxsize=2048)
def reach(string: str, pixels: float, weight: Weight) -> float:
    """How far the string reaches as it is written, in pixels and their fractions."""
    string = _writable(string)
    font, factor = _font(pixels, weight), _oversampling(pixels)
    if not SIGN.search(string):
        return font.size(string)[0] / factor
    parts = SIGN.split(string)  # every second one is a sign
    signs = sum(sign_width(part, pixels) for part in parts[1::2])
    return signs + sum(font.size(part)[0] for part in parts[::2]) / factor


@lru_cache(maxsize=64)
def extent(pixels: float, weight: Weight) -> tuple[float, float]:
    """How far the line reaches above and below the baseline, in pixels."""
    font, factor = _font(pixels, weight), _oversampling(pixels)
    return font.get_ascent() / factor, -font.get_descent() / factor


@lru_cache(maxsize=64)
def digit_width(pixels: float, weight: Weight) -> float:
    """Width of the widest digit, which every tabular digit is given."""
    return max(reach(digit, pixels, weight) for digit in "0123456789")


@lru_cache(maxsize=1024)
def render(string: str, pixels: float, weight: Weight, colour: Colour) -> tuple[pygame.Surface, int]:
    """Return the string's surface and the row of its baseline in it; what no screen has room for is left out."""
    string = _cut(_writable(string), pixels, weight)
    font, factor = _font(pixels, weight), _oversampling(pixels)
    large = _write(string, pixels, weight, colour) if SIGN.search(string) else font.render(string, True, colour)
    baseline = -(-font.get_ascent() // factor)
    top = baseline * factor - font.get_ascent()
    columns = max(1, -(-large.get_width() // factor))
    rows = max(1, -(-(large.get_height() + top) // factor))
    padded = pygame.Surface((columns * factor, rows * factor), pygame.SRCALPHA)
    padded.fill((*colour, 0))
    padded.blit(large, (0, top), special_flags=pygame.BLEND_RGBA_MAX)
    surface = pygame.transform.smoothscale(padded, (columns, rows))
    alpha = pygame.surfarray.pixels_alpha(surface)
    alpha[:] = _COVERAGE[alpha]
    del alpha
    return surface, baseline


def _write(string: str, pixels: float, weight: Weight, colour: Colour) -> pygame.Surface:
    """Return a string with signs in it, before it is scaled down."""
    font, factor = _font(pixels, weight), _oversampling(pixels)
    surface = pygame.Surface((-(-reach(string, pixels, weight) * factor // 1), font.get_height()), pygame.SRCALPHA)
    surface.fill((*colour, 0))
    x = 0.0
    for number, part in enumerate(SIGN.split(string)):
        if number % 2:
            draw_sign(
                surface, part, (x, font.get_ascent()), pixels * factor, colour,
                lambda letters, size: _font(size / factor, "semibold").render(letters, True, colour),
            )  # fmt: skip
            x += sign_width(part, pixels) * factor
        elif part:
            surface.blit(font.render(part, True, colour), (round(x), 0))
            x += font.size(part)[0]
    return surface


def _writable(string: str) -> str:
    """Put question marks where no font has anything: the name of a file can be any bytes, and any number of them."""
    return string[:_LONGEST].replace("\0", "?").encode(errors="replace").decode()


def _cut(string: str, pixels: float, weight: Weight) -> str:
    """Leave out the end of a string that is wider than any screen."""
    most = _WIDEST / _oversampling(pixels)
    if reach(string, pixels, weight) <= most:
        return string
    return string[: bisect_right(range(len(string)), most, key=lambda count: reach(string[:count], pixels, weight)) - 1]


def forget() -> None:
    """Drop every rendered string: the window's size has changed."""
    for cache in (_font, grown, reach, extent, digit_width, render):
        cache.cache_clear()
