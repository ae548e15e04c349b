"""Pictures of maps and filters to point into: one map large, or many beside each other."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np
import numpy.typing as npt
import pygame

from game.digits.cell_picker import CellPicker
from game.digits.pictures import Numbers, mosaic, picture, tiling
from game.drawing.canvas import Canvas
from game.drawing.paint_cache import PaintCache
from game.drawing.tokens import HUMAN, INK, LABEL, LINE, MUTE
from game.ui.widget import PointsManager

_GAP: Final = 3.0
_ABOVE: Final = 10.0  # from a picture up to its name's baseline


class MapPicker(CellPicker):
    """One map, (height, width) in -1 to 1, in a square box; a pixel of it is chosen.

    Attributes:
        window: top, left, bottom and right of the pixels that are lit by an edge.

    """

    def __init__(
        self,
        manager: PointsManager,
        box: pygame.typing.RectLike,
        label: str,
        on_choose: Callable[[int, int], None],
        shades: npt.NDArray[np.uint8],
    ) -> None:
        super().__init__(manager, box, label, on_choose)
        self.values: Numbers = np.zeros((1, 1), np.float32)
        self.window = (0, 0, 1, 1)
        self._shades, self._painted, self._shown = shades, PaintCache(), 0

    def show_map(self, values: Numbers, label: str, window: tuple[int, int, int, int]) -> None:
        """Show a map, its name, and a window in it."""
        self._shown += values is not self.values
        self.values, self.label, self.window = values, label, window
        self.set_grid(*values.shape)

    def paint(self, canvas: Canvas) -> None:
        """Draw the map, the window and the name above."""
        super().paint(canvas)
        self._painted.draw(canvas, self.box, self._shown, self._paint_map)
        first = self.place(*self.window[:2])
        last = self.place(self.window[2] - 1, self.window[3] - 1)
        canvas.outline(first.union(last).inflate(2, 2), 1, HUMAN, 2)
        canvas.text(self.label, (self.box.left, self.box.top - _ABOVE), size=LABEL, colour=MUTE, weight="medium",
                    room=self.box.width)  # fmt: skip

    def _paint_map(self, sheet: Canvas) -> None:
        area = sheet.rect(0, 0, *self.box.size)
        sheet.surface.blit(picture(self.values, area.size, self._shades), area)
        pygame.draw.rect(sheet.surface, LINE, area, 1)


class TilesPicker(CellPicker):
    """Many small pictures, (n, height, width) in -1 to 1, as large as a room allows; one of them is chosen."""

    def __init__(
        self,
        manager: PointsManager,
        room: tuple[float, float, float, float],
        label: str,
        tiles: Numbers,
        on_choose: Callable[[int], None],
    ) -> None:
        left, top, width, most = room
        columns, size = tiling(len(tiles), tiles.shape[1:], (width, most), _GAP)
        super().__init__(manager, (left, top, round(size[0]), round(size[1])), label,
                         lambda row, column: on_choose(row * columns + column), gap=_GAP)  # fmt: skip
        self.tiles = tiles
        self.set_grid(-(-len(tiles) // columns), columns, len(tiles))
        self._room = width
        self._painted, self._shown = PaintCache(), 0

    def show_tiles(self, chosen: int, label: str, tiles: Numbers | None = None) -> None:
        """Mark the chosen picture, and name it; with `tiles`, show others as many."""
        self.label, self.cell = label, divmod(chosen, self.columns)
        if tiles is not None:
            self.tiles, self._shown = tiles, self._shown + 1

    def paint(self, canvas: Canvas) -> None:
        """Draw the pictures, an edge around the chosen one, and the name above."""
        super().paint(canvas)
        self._painted.draw(canvas, self.box, self._shown, self._paint_tiles)
        canvas.outline(self.place(*self.cell).inflate(3, 3), 1, INK, 1.5)
        canvas.text(self.label, (self.box.left, self.box.top - _ABOVE), size=LABEL, colour=MUTE, weight="medium",
                    room=self._room)  # fmt: skip

    def _paint_tiles(self, sheet: Canvas) -> None:
        area = sheet.rect(0, 0, *self.box.size)
        sheet.surface.blit(mosaic(self.tiles, self.columns, area.size, _GAP * sheet.scale), area)
