"""Heat maps: a plane coloured by a network's own numbers."""

from __future__ import annotations

from typing import Final

import numpy as np
import pygame

from ai.nn import Array
from game.drawing.canvas import Canvas
from game.drawing.tokens import NIGHT0, Colour

_DEPTH: Final = 0.62  # share of the pure colour at an end of the scale


def paint_heat(sheet: Canvas, values: Array, low: Colour, high: Colour) -> None:
    """Fill a sheet with values (columns, rows), the first row at the bottom: `low` at -1, dark at 0, `high` at 1."""
    share = _DEPTH * np.clip(np.nan_to_num(values), -1.0, 1.0)[:, ::-1, None]
    ends = np.where(share < 0, np.array(low, float), np.array(high, float))
    colours = NIGHT0 + np.abs(share) * (ends - NIGHT0)
    picture = pygame.surfarray.make_surface(colours.astype(np.uint8))
    sheet.surface.blit(pygame.transform.smoothscale(picture, sheet.size), (0, 0))


def grid(columns: int, rows: int, reach: float = 1.0) -> Array:
    """Return the points (columns · rows, 2) of a grid over the square from -reach to reach, column by column."""
    across, up = np.meshgrid(np.linspace(-reach, reach, columns), np.linspace(-reach, reach, rows), indexing="ij")
    return np.stack([across.ravel(), up.ravel()], axis=1).astype(np.float32)
