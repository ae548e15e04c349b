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
    surface = pygame.Surface(size)
    pygame.surfarray.blit_array(surface, _coloured(_grown(values[None], size)[0], shades))
    return surface


def mosaic(tiles: Numbers, columns: int, tile: int, gap: int, shades: npt.NDArray[np.uint8] = SIGNED) -> pygame.Surface:
    """Return (n, height, width) tiles row by row, `tile` pixels wide each, on a transparent ground."""
    rows = -(-len(tiles) // columns)
    large = _grown(tiles, (tile, tile))
    pitch = tile + gap
    surface = pygame.Surface((columns * pitch - gap, rows * pitch - gap), pygame.SRCALPHA)
    field = np.zeros((rows * columns, pitch, pitch), np.float32)
    field[: len(tiles), :tile, :tile] = large
    inked = np.zeros_like(field, np.uint8)
    inked[: len(tiles), :tile, :tile] = 255
    width, height = surface.get_size()
    pygame.surfarray.pixels3d(surface)[...] = _coloured(_joined(field, columns)[:height, :width], shades)
    pygame.surfarray.pixels_alpha(surface)[...] = _joined(inked, columns)[:height, :width].T
    return surface


def _grown(tiles: Numbers, size: tuple[int, int]) -> Numbers:
    (width, height), (_, rows, columns) = size, tiles.shape
    down, across = np.arange(height) * rows // height, np.arange(width) * columns // width
    return tiles[:, down[:, None], across]


def _joined(tiles: npt.NDArray[Any], columns: int) -> npt.NDArray[Any]:
    _, height, width = tiles.shape
    return tiles.reshape(-1, columns, height, width).swapaxes(1, 2).reshape(-1, columns * width)


def _coloured(values: npt.NDArray[Any], shades: npt.NDArray[np.uint8]) -> npt.NDArray[np.uint8]:
    """Return (width, height, 3), as pygame has it."""
    colours: npt.NDArray[np.uint8] = shades[(np.clip(values.T, -1, 1) * 127 + 127).astype(np.intp)]
    return colours
