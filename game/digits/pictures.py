"""Pictures of arrays in grey or diverging colours."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
import numpy.typing as npt
import pygame

from game.drawing.canvas import Canvas
from game.drawing.paint_cache import PaintCache
from game.drawing.tokens import HUMAN, INK, LINE, MUTE, NET, NIGHT0, PALETTE, Colour

Numbers = npt.NDArray[np.float32]
Shades = npt.NDArray[np.uint8]  # (255, 3), colours of -1 to 1
_BACK: Final = np.array(NIGHT0, float)


def _shades(low: Colour, high: Colour) -> Shades:
    """Return a diverging palette, dark in the middle."""
    part = np.linspace(-1, 1, 255)[:, None]
    ends = np.where(part < 0, np.array(low, float), np.array(high, float))
    return np.asarray((_BACK + np.abs(part) * (ends - _BACK)).round(), np.uint8)


GREY: Final = _shades(NIGHT0, INK)
SIGNED: Final = _shades(PALETTE.warn, NET)
AMBER: Final = _shades(MUTE, HUMAN)


def picture(values: Numbers, size: tuple[int, int], shades: Shades = GREY) -> pygame.Surface:
    """Return a picture of numbers (height, width) in -1 to 1, every number a sharp rectangle; `size` in pixels."""
    row, column = (np.arange(pixels) * cells // pixels for pixels, cells in zip(size[::-1], values.shape, strict=True))
    numbers = (np.clip(values, -1, 1) * 127 + 127).astype(np.uint8)
    surface = pygame.Surface(size, depth=8)
    surface.set_palette(shades.tolist())
    pygame.surfarray.blit_array(surface, numbers[row][:, column].T)
    return surface


def visible(values: npt.NDArray[np.floating[Any]]) -> Numbers:
    """Return signed square roots of values in -1 to 1, so that small ones are seen too."""
    return np.asarray(np.sign(values) * np.sqrt(np.abs(values)), np.float32)


class Picture:
    """Square picture of numbers with a hairline around it, painted anew when they change."""

    def __init__(self, shades: Shades = GREY) -> None:
        self._shades, self._painted = shades, PaintCache()

    def draw(self, canvas: Canvas, box: pygame.FRect, values: Numbers) -> None:
        """Draw it at the upper left corner of a box, as large as fits into that."""
        side = min(box.size)

        def paint(sheet: Canvas) -> None:
            area = sheet.surface.get_rect()
            sheet.surface.blit(picture(values, area.size, self._shades), area)
            pygame.draw.rect(sheet.surface, LINE, area, 1)

        self._painted.draw(canvas, (*box.topleft, side, side), values.tobytes(), paint)
