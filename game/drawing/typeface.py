"""Text rendering in Manrope at any size, and of code in Fira Code, with a cache of rendered strings.

Text is drawn large and scaled down, so sizes need not be whole pixels and letters keep their spacing;
hinted small sizes do neither. Signs of buttons are characters as well: see `game.drawing.glyphs`.
"""

from __future__ import annotations

import re
from bisect import bisect_right
from functools import lru_cache
from importlib.resources import files
from typing import Final, Literal

import numpy as np
import numpy.typing as npt
import pygame
from font_manrope import font_files

from ai.files.reading import CONTROLS
from game.core import texts
from game.core.catalogue import ENGLISH
from game.drawing.glyphs import SIGN, draw_sign, sign_width
from game.drawing.tokens import Colour

Weight = Literal["extralight", "light", "regular", "medium", "semibold", "code"]

_FILES: Final[dict[Weight, str]] = {
    "extralight": "ManropeExtraLight",
    "light": "ManropeLight",
    "regular": "Manrope",
    "medium": "ManropeMedium",
    "semibold": "ManropeSemiBold",
}
_CODE: Final = "data/FiraCode-Regular.ttf"  # in pygame_gui: all letters of it are equally wide
_PARTS: Final = re.compile(r"\d|\D+")  # single digits, and the text between them
_NUMBER: Final = re.compile(r"(?<![\w./])(?:\d{1,3}(?:,\d{3})++|\d++)(?:\.\d++)?(?![,.]\d)")
_DATE: Final = re.compile(  # but not in a file's name
    r"(?<![\w./-])(?P<year>\d{4})-(?P<month>\d\d)-(?P<day>\d\d)(?![\w-]| \d\d\.)"
)
_LONGEST: Final = 1000  # characters of a text; no line on any screen has more
# Width in pixels of a text before it is scaled down; a full line of the largest screen takes half. From some 100,000
# on, SDL's scaling writes past the end of its memory.
_WIDEST: Final = 32_768
_LIFT: Final = 0.82
_INK: Final = (255, 255, 255)


def _oversampling(pixels: float) -> int:
    return 4 if pixels < 30 else 2


def _font(pixels: float, weight: Weight) -> pygame.font.Font:
    """Return the font that renders text of this size as large as it is drawn at first."""
    return _opened(max(1, round(pixels * _oversampling(pixels))), weight)


@lru_cache(maxsize=64)
def _opened(pixels: int, weight: Weight) -> pygame.font.Font:
    file = font_files[_FILES[weight]] if weight != "code" else str(files("pygame_gui") / _CODE)
    return pygame.font.Font(file, pixels)


@lru_cache(maxsize=2048)
def reach(string: str, pixels: float, weight: Weight) -> float:
    """Return the width of a string as rendered, in pixels and fractions."""
    return _reach(_writable(string, weight), pixels, weight)


def _reach(string: str, pixels: float, weight: Weight) -> float:
    font, factor = _font(pixels, weight), _oversampling(pixels)
    if not SIGN.search(string):
        return font.size(string)[0] / factor
    parts = SIGN.split(string)  # every second one is a sign
    signs = sum(sign_width(part, pixels) for part in parts[1::2])
    return signs + sum(font.size(part)[0] for part in parts[::2]) / factor


@lru_cache(maxsize=64)
def extent(pixels: float, weight: Weight) -> tuple[float, float]:
    """Return the ascent and the descent of a line, in pixels."""
    font, factor = _font(pixels, weight), _oversampling(pixels)
    return font.get_ascent() / factor, -font.get_descent() / factor


@lru_cache(maxsize=64)
def digit_width(pixels: float, weight: Weight) -> float:
    """Return the width of the widest digit, in pixels, which every tabular digit is given."""
    return max(reach(digit, pixels, weight) for digit in "0123456789")


@lru_cache(maxsize=1024)
def render(string: str, pixels: float, weight: Weight, colour: Colour) -> tuple[pygame.Surface, int]:
    """Return the string's surface and the row of its baseline; text wider than any screen is cut off."""
    cover, baseline = _covered(string, pixels, weight)
    surface = pygame.Surface(cover.shape[::-1], pygame.SRCALPHA)
    surface.fill(colour)
    pygame.surfarray.pixels_alpha(surface)[:] = cover.T
    return surface, baseline


@lru_cache(maxsize=1024)
def _covered(string: str, pixels: float, weight: Weight) -> tuple[npt.NDArray[np.uint8], int]:
    """Return how far a string covers each pixel (rows, columns), whatever its colour, and the row of its baseline.

    A pixel is the mean of the squares that lie in it, `_oversampling` down and as many across.
    """
    string = _cut(_writable(string, weight), pixels, weight)
    font, factor = _font(pixels, weight), _oversampling(pixels)
    large = _large(string, pixels, weight)
    baseline = -(-font.get_ascent() // factor)
    top = baseline * factor - font.get_ascent()
    columns = max(1, -(-large.shape[1] // factor))
    rows = max(1, -(-(large.shape[0] + top) // factor))
    padded = np.zeros((rows * factor, columns * factor), np.uint8)
    padded[top : top + large.shape[0], : large.shape[1]] = large
    # Rows first, which are long: numpy's own sum over both axes takes three times as long.
    tall = np.add.reduce(padded.reshape(rows, factor, -1), axis=1, dtype=np.uint16)
    total = tall[:, ::factor].copy()
    for place in range(1, factor):
        total += tall[:, place::factor]
    return _coverage(factor)[total], baseline


@lru_cache(maxsize=4)
def _coverage(factor: int) -> npt.NDArray[np.uint8]:
    """Return what each sum of factor × factor squares counts, a square being 0 to 255.

    Thin light strokes on a dark ground look thinner than they are; the power lifts the half-covered pixels.
    """
    share = np.linspace(0, 1, 255 * factor * factor + 1)
    return np.round(255 * share**_LIFT).astype(np.uint8)


@lru_cache(maxsize=4096)
def span(string: str, pixels: float, weight: Weight, tabular: bool) -> float:
    """Return the width of a string in pixels; `tabular` gives every digit the same."""
    if not tabular:
        return reach(string, pixels, weight)
    digit, parts = digit_width(pixels, weight), _PARTS.findall(numbers(string))
    return sum(digit if part.isdecimal() else reach(part, pixels, weight) for part in parts)


@lru_cache(maxsize=4096)
def digits(string: str, pixels: float, weight: Weight, colour: Colour) -> list[tuple[pygame.Surface, float, int]]:
    """Return a figure that changes as the digits it is made of, and what stands between, each rendered once.

    Each comes with its place across, and the row of its baseline.
    """
    found, x, digit = [], 0.0, digit_width(pixels, weight)
    for part in _PARTS.findall(numbers(string)):
        own = reach(part, pixels, weight)
        cell = digit if part.isdecimal() else own
        surface, baseline = render(part, pixels, weight, colour)
        found.append((surface, x + (cell - own) / 2, baseline))
        x += cell
    return found


@lru_cache(maxsize=1024)
def line(
    string: str, size: float, weight: Weight, colour: Colour, tabular: bool, scale: float, room: float, least: float
) -> tuple[list[tuple[pygame.Surface, float, int]], float, float, float]:
    """Return all that is needed to write a text in one look-up: most words on a screen stay from frame to frame.

    Its surfaces, each with its place across and the row of its baseline; its width, ascent and descent in pixels. It is
    no wider than `room`, nor smaller than `least`; these and `size` are in points, of `scale` pixels.
    """
    pixels = round(size * scale, 2)
    too_wide = span(string, pixels, weight, tabular) / max(room * scale, 1.0)
    if too_wide > 1 and pixels > least * scale:
        pixels = round(max(pixels / too_wide, least * scale), 2)
    if tabular:
        parts = digits(string, pixels, weight, colour)
    elif string:
        surface, baseline = render(string, pixels, weight, colour)
        parts = [(surface, 0.0, baseline)]
    else:
        parts = []
    return parts, span(string, pixels, weight, tabular), *extent(pixels, weight)


def _large(string: str, pixels: float, weight: Weight) -> npt.NDArray[np.uint8]:
    """Return a string as large as it is rendered, before it is scaled down: cover of each square (rows, columns)."""
    if SIGN.search(string):
        return pygame.surfarray.pixels_alpha(_with_signs(string, pixels, weight)).T
    # On black, in shades of grey: a quarter of the memory of a surface with colours and alpha.
    return pygame.surfarray.pixels2d(_font(pixels, weight).render(string, True, _INK, (0, 0, 0))).T


def _with_signs(string: str, pixels: float, weight: Weight) -> pygame.Surface:
    """Return the surface of a string with signs."""
    font, factor = _font(pixels, weight), _oversampling(pixels)
    surface = pygame.Surface((-(-_reach(string, pixels, weight) * factor // 1), font.get_height()), pygame.SRCALPHA)
    surface.fill((*_INK, 0))
    x = 0.0
    for number, part in enumerate(SIGN.split(string)):
        if number % 2:
            draw_sign(
                surface,
                part,
                (x, font.get_ascent()),
                pixels * factor,
                _INK,
                lambda letters, size: _opened(max(1, round(size)), "semibold").render(letters, True, _INK),
            )
            x += sign_width(part, pixels) * factor
        elif part:
            surface.blit(font.render(part, True, _INK), (round(x), 0))
            x += font.size(part)[0]
    return surface


@lru_cache(maxsize=2048)
def numbers(words: str) -> str:
    """Return words with numbers and dates as the language writes them; versions, paths and times stay."""
    if texts.LANGUAGE == ENGLISH:
        return words
    marks = str.maketrans({",": texts.THOUSANDS_MARK, ".": texts.DECIMAL_MARK})
    words = _NUMBER.sub(lambda found: found[0].translate(marks), words)
    return _DATE.sub(lambda found: texts.DATE.format(**found.groupdict()), words)


def _writable(string: str, weight: Weight) -> str:
    """Return a string with numbers as the language writes them, but for code.

    What no font has or no line can hold is replaced by question marks: a file's name can be any bytes, at any length.
    """
    string = string if weight == "code" else numbers(string)
    return CONTROLS.sub("?", string[:_LONGEST]).encode(errors="replace").decode()


def _cut(string: str, pixels: float, weight: Weight) -> str:
    """Cut off the end of a string that is wider than any screen."""
    most = _WIDEST / _oversampling(pixels)
    if _reach(string, pixels, weight) <= most:
        return string
    return string[
        : bisect_right(range(len(string)), most, key=lambda count: _reach(string[:count], pixels, weight)) - 1
    ]


def forget() -> None:
    """Clear the cache of rendered strings, after a change of the window's size or of the language; fonts stay open."""
    caches = numbers, reach, digit_width, render, _covered, span, digits, line
    for cache in caches:
        cache.cache_clear()
