"""Pictures of arrays: grey or diverging colours, single or as a mosaic."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import Any, Final

import numpy as np
import numpy.typing as npt
import pygame

from game.drawing.canvas import Canvas
from game.drawing.tokens import HUMAN, INK, LINE, MUTE, NET, NIGHT0, PALETTE, Colour

Numbers = npt.NDArray[np.float32]
_GAP: Final = 255  # palette index of a gap
_BACK: Final = np.array(NIGHT0, float)


def _shades(low: Colour, high: Colour) -> npt.NDArray[np.uint8]:
    """Return a diverging palette of 255 colours for -1 to 1, dark in the middle."""
    part = np.linspace(-1, 1, 255)[:, None]
    ends = np.where(part < 0, np.array(low, float), np.array(high, float))
    return np.asarray((_BACK + np.abs(part) * (ends - _BACK)).round(), np.uint8)


GREY: Final = _shades(NIGHT0, INK)
SIGNED: Final = _shades(PALETTE.warn, NET)
AMBER: Final = _shades(MUTE, HUMAN)


def picture(values: Numbers, size: tuple[int, int], shades: npt.NDArray[np.uint8] = GREY) -> pygame.Surface:
    """Return a picture of numbers (height, width) in -1 to 1, every number a sharp rectangle; `size` in pixels."""
    return mosaic(values[None], 1, size, 0, shades)


def visible(values: npt.NDArray[np.floating[Any]]) -> Numbers:
    """Return signed square roots of values in -1 to 1, so that small ones are seen too."""
    return np.asarray(np.sign(values) * np.sqrt(np.abs(values)), np.float32)


def framed(values: Numbers, shades: npt.NDArray[np.uint8] = GREY) -> Callable[[Canvas], None]:
    """Return what paints such a picture over a whole sheet, with a hairline around it."""

    def paint(sheet: Canvas) -> None:
        area = sheet.surface.get_rect()
        sheet.surface.blit(picture(values, area.size, shades), area)
        pygame.draw.rect(sheet.surface, LINE, area, 1)

    return paint


def mosaic(
    tiles: Numbers, columns: int, size: tuple[int, int], gap: float, shades: npt.NDArray[np.uint8] = SIGNED
) -> pygame.Surface:
    """Return (n, height, width) tiles row by row, with gaps between them, at a size in pixels."""
    rows = -(-len(tiles) // columns)
    row, y = _places(rows, tiles.shape[1], size[1], gap)
    column, x = _places(columns, tiles.shape[2], size[0], gap)
    numbers = np.full((rows * columns, tiles.shape[1] + 1, tiles.shape[2] + 1), _GAP, np.uint8)
    numbers[: len(tiles), :-1, :-1] = np.clip(tiles, -1, 1) * 127 + 127
    field = numbers.reshape(rows, columns, *numbers.shape[1:]).swapaxes(1, 2).reshape(rows * numbers.shape[1], -1)
    pixels = field[row * numbers.shape[1] + y][:, column * numbers.shape[2] + x]
    surface = pygame.Surface(size, depth=8)
    surface.set_palette([*shades.tolist(), (0, 0, 0)])
    surface.set_colorkey(_GAP)
    pygame.surfarray.blit_array(surface, pixels.T)
    return surface


def tiling(
    count: int, shape: tuple[int, ...], room: tuple[float, float], gap: float
) -> tuple[int, tuple[float, float]]:
    """Return in how many columns tiles (height, width) fill a room best, and the width and height that they take."""
    (width, most), aspect = room, shape[0] / shape[1]

    def height(columns: int) -> float:
        return -(-count // columns) * (((width + gap) / columns - gap) * aspect + gap) - gap

    columns = next((columns for columns in range(1, count + 1) if height(columns) <= most), 0)
    if not columns:  # all in one row, as high as there is room
        return count, (count * (most / aspect + gap) - gap, most)
    return columns, (width, height(columns))


@lru_cache(maxsize=64)
def _places(count: int, cells: int, pixels: int, gap: float) -> tuple[npt.NDArray[np.intp], npt.NDArray[np.intp]]:
    """Return for each pixel along a side its tile and its cell in that tile; cell number `cells` is the gap."""
    pitch = (pixels + gap) / count
    at = np.arange(pixels) + 0.5
    tile = np.minimum(at // pitch, count - 1).astype(np.intp)
    within = (at - tile * pitch) / (pitch - gap)
    return tile, np.minimum(within * cells, cells).astype(np.intp)
