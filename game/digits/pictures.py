"""Arrays as pictures: grey, or two colours for what speaks for and against; one, or many side by side."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
import numpy.typing as npt
import pygame

from game.ui.tokens import HUMAN, INK, MUTE, NET, NIGHT0, PALETTE, Colour

Numbers = npt.NDArray[np.float32]
_BACK: Final = np.array(NIGHT0, float)


def _shades(low: Colour, high: Colour) -> npt.NDArray[np.uint8]:
    """Return 255 colours for -1 to 1: one colour on either side of the night."""
    part = np.linspace(-1, 1, 255)[:, None]
    ends = np.where(part < 0, np.array(low, float), np.array(high, float))
    return np.asarray((_BACK + np.abs(part) * (ends - _BACK)).round(), np.uint8)


GREY: Final = _shades(NIGHT0, INK)
SIGNED: Final = _shades(PALETTE.warn, NET)
AMBER: Final = _shades(MUTE, HUMAN)


def picture(values: Numbers, size: tuple[int, int], shades: npt.NDArray[np.uint8] = GREY) -> pygame.Surface:
    """Return (height, width) numbers within -1 to 1 at a size in pixels, every number a sharp rectangle."""
    return mosaic(values[None], 1, size, 0, shades)


def mosaic(
    tiles: Numbers, columns: int, size: tuple[int, int], gap: float, shades: npt.NDArray[np.uint8] = SIGNED
) -> pygame.Surface:
    """Return (n, height, width) tiles row by row, with gaps between them, at a size in pixels."""
    rows = -(-len(tiles) // columns)
    row, y, below = _places(rows, tiles.shape[1], size[1], gap)
    column, x, beside = _places(columns, tiles.shape[2], size[0], gap)
    tile = row[:, None] * columns + column
    blank = below[:, None] | beside | (tile >= len(tiles))
    values = tiles[np.minimum(tile, len(tiles) - 1), y[:, None], x]
    surface = pygame.Surface(size, pygame.SRCALPHA)
    pygame.surfarray.pixels3d(surface)[...] = _coloured(values, shades)
    pygame.surfarray.pixels_alpha(surface)[...] = np.where(blank, 0, 255).T
    return surface


def height_of(count: int, columns: int, shape: tuple[int, int], width: float, gap: float) -> float:
    """Return how tall a mosaic is whose cells are squares."""
    tile = (width + gap) / columns - gap
    return -(-count // columns) * (tile * shape[0] / shape[1] + gap) - gap


def _places(count: int, cells: int, pixels: int, gap: float) -> tuple[npt.NDArray[np.intp], ...]:
    """Return for each pixel along a side the number of its tile and the cell in there, and whether it is a gap."""
    pitch = (pixels + gap) / count
    at = np.arange(pixels) + 0.5
    tile = np.minimum(at // pitch, count - 1).astype(np.intp)
    within = (at - tile * pitch) / (pitch - gap)
    return tile, np.minimum(within * cells, cells - 1).astype(np.intp), within >= 1


def _coloured(values: npt.NDArray[Any], shades: npt.NDArray[np.uint8]) -> npt.NDArray[np.uint8]:
    """Return (width, height, 3), as pygame has it."""
    colours: npt.NDArray[np.uint8] = shades[(np.clip(values.T, -1, 1) * 127 + 127).astype(np.intp)]
    return colours
