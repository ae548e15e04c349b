"""Picture of cells that are pointed at: the pixels of a map, or many small pictures."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np
import numpy.typing as npt
import pygame

from ai.explain.unit_sums import Box
from game.core import texts
from game.digits.pictures import SIGNED, Numbers, mosaic, tiling
from game.drawing.canvas import Canvas
from game.drawing.paint_cache import PaintCache
from game.drawing.tokens import HUMAN, INK, LINE
from game.ui.virtual_pointer import PictureRow

_GAP: Final = 3.0
_PACE: Final = 3.0  # points in a step of 1/60 s


class Cells(PictureRow):
    """Picture of cells, of which the mouse or a virtual pointer chooses one.

    Args:
        tiles: returns pictures (n, height, width) in -1 to 1, which are the cells; of a single one, its pixels are.
        lit: returns top, left, bottom and right of the cells that have an edge around them; of tiles, their numbers.
        choose: gets the row and the column of a cell that is pointed at; of tiles, 0 and its number.
        most: height of the picture, in points, at most.
        shades: colours of values from -1 to 1.

    """

    def __init__(
        self,
        tiles: Callable[[], Numbers],
        lit: Callable[[], Box],
        choose: Callable[[int, int], None],
        most: float,
        shades: npt.NDArray[np.uint8] = SIGNED,
    ) -> None:
        super().__init__(texts.POINTER, self._fit, self._point, self._draw_cells, pace=_PACE)
        self._tiles, self._lit, self._choose, self._most, self._shades = tiles, lit, choose, most, shades
        self._painted = PaintCache()

    def _fit(self, width: float) -> float:
        """Lay the cells out, a map as a square, and return the height of the picture."""
        tiles = self._tiles()
        self._gap, self._shape = 0.0, tiles.shape[1:]
        self._size = (min(width, self._most),) * 2
        if len(tiles) > 1:
            columns, self._size = tiling(len(tiles), self._shape, (width, self._most), _GAP)
            self._gap, self._shape = _GAP, (-(-len(tiles) // columns), columns)
        return self._size[1]

    def cell(self, row: int, column: int) -> pygame.FRect:
        """Return the box of a cell, in points."""
        (width, height), (rows, columns), gap = self._size, self._shape, self._gap
        row, column = row + column // columns, column % columns
        across, down = (width + gap) / columns, (height + gap) / rows
        left, top = self.picture.topleft
        return pygame.FRect(left + column * across, top + row * down, across - gap, down - gap)

    def _point(self, event: pygame.event.Event) -> None:
        (width, height), (rows, columns) = self._size, self._shape
        row = int((event.pos[1] - self.picture.top) // (height / rows))
        column = int((event.pos[0] - self.picture.left) // (width / columns))
        if not (0 <= row < rows and 0 <= column < columns):
            return
        if not self._gap:
            self._choose(row, column)
        elif row * columns + column < len(self._tiles()):
            self._choose(0, row * columns + column)

    def _draw_cells(self, canvas: Canvas, box: pygame.FRect) -> None:
        tiles = self._tiles()
        place = *box.topleft, *self._size
        self._painted.draw(canvas, place, tiles.tobytes(), lambda sheet: self._paint(sheet, tiles))
        top, left, bottom, right = self._lit()
        edge = self.cell(top, left).union(self.cell(bottom - 1, right - 1))
        canvas.outline(edge.inflate(2, 2), 1, INK if self._gap else HUMAN, 2)

    def _paint(self, sheet: Canvas, tiles: Numbers) -> None:
        area, columns = sheet.rect(0, 0, *self._size), self._shape[1] if self._gap else 1
        sheet.surface.blit(mosaic(tiles, columns, area.size, self._gap * sheet.scale, self._shades), area)
        pygame.draw.rect(sheet.surface, LINE, area, 1)
