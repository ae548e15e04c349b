"""Picker of one cell of a picture: a pixel of a map, a filter among others; by mouse, arrows or a gamepad."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np
import numpy.typing as npt
import pygame

from game.core import texts
from game.digits.pictures import Numbers, mosaic, picture, tiling
from game.drawing.canvas import Canvas
from game.drawing.paint_cache import PaintCache
from game.drawing.tokens import HUMAN, INK, LABEL, LINE, MUTE
from game.input.controls import Command, Controls, presses_main, translate
from game.ui.hints import Hint
from game.ui.widget import PointsManager, Widget

_WAYS: Final = {Command.UP: (-1, 0), Command.DOWN: (1, 0), Command.LEFT: (0, -1), Command.RIGHT: (0, 1)}
_AFTER, _EVERY = 18, 4  # updates that an arrow is held before the cell moves on, and between two moves


class CellPicker(Widget):
    """Grid of cells over a picture, `rows` by `columns`, of which one is chosen.

    The mouse chooses what it points at. Enter, or a gamepad's A, takes hold of the cell: then the arrows move it, as
    long as one is held, until Enter or Escape lets go; until then they move the focus past the picture.

    Attributes:
        rows, columns: the grid; 0 for nothing to choose from.
        count: cells that there are, row by row; the others of the last row are empty.
        cell: row and column of the chosen cell.
        gap: points between two cells.
        stride: cells that an arrow moves on.

    """

    def __init__(
        self,
        manager: PointsManager,
        box: pygame.typing.RectLike,
        label: str,
        on_choose: Callable[[int, int], None],
        *,
        gap: float = 0.0,
    ) -> None:
        super().__init__(manager, box, label)
        self.rows = self.columns = self.count = 0
        self.cell = (0, 0)
        self.gap, self.stride, self._on_choose = gap, 1, on_choose
        self._held: dict[int, Command] = {}
        self._steps = 0

    def set_grid(self, rows: int, columns: int, count: int | None = None) -> None:
        """Divide the box into other cells."""
        self.rows, self.columns = rows, columns
        self.count = rows * columns if count is None else count

    def place(self, row: int, column: int) -> pygame.FRect:
        """Return the box of a cell, in points."""
        pitch_x = (self.box.width + self.gap) / max(self.columns, 1)
        pitch_y = (self.box.height + self.gap) / max(self.rows, 1)
        left, top = self.box.left + column * pitch_x, self.box.top + row * pitch_y
        return pygame.FRect(left, top, pitch_x - self.gap, pitch_y - self.gap)

    def press(self) -> None:
        """Take hold of the cell, unless a mouse is in use."""
        self.typing = self.ringed and self.count > 1

    def hints(self, controls: Controls) -> list[Hint]:
        """Return the hints while the cell is held."""
        return [
            Hint(controls.arrows, texts.HINT_MOVE),
            Hint(controls.word(Command.BACK), texts.PATCH_LET_GO, self._let_go),
        ]

    def take(self, event: pygame.event.Event) -> bool:
        """Move the cell that is held, or let go of it."""
        if not self.typing:
            return False
        code = getattr(event, "key", getattr(event, "button", 0))
        if event.type in (pygame.KEYUP, pygame.CONTROLLERBUTTONUP):
            self._held.pop(code, None)
            return True
        command = translate(event)
        if command in _WAYS:
            self._held[code] = command
            self._steps = 0
            self._move(command)
        elif command in (Command.BACK, Command.PAUSE, Command.CONFIRM) or presses_main(event):
            self._let_go()
        elif event.type == pygame.WINDOWFOCUSLOST or command is Command.UNPLUGGED:
            self._let_go()
            return False
        else:
            return False
        return True

    def process_event(self, event: pygame.event.Event) -> bool:
        """Choose the cell under the mouse."""
        if event.type == pygame.MOUSEMOTION and self.hover_point(*event.pos):
            self._point(*event.pos)
        return super().process_event(event)

    def ease(self, at_once: bool) -> None:
        """Move on while an arrow is held."""
        super().ease(at_once)
        if self.typing and not self.focused:
            self._let_go()
        self._steps = self._steps + 1 if self._held else 0
        if self._steps >= _AFTER and self._steps % _EVERY == 0:
            for command in tuple(self._held.values()):
                self._move(command)

    def paint(self, canvas: Canvas) -> None:
        """Draw the focus ring; brighter while the cell is held."""
        if self.ringed and self.warmth > 0.02:
            canvas.outline(self.box.inflate(10, 10), 6, INK, 1, (0.9 if self.typing else 0.4) * self.warmth)

    def _let_go(self) -> None:
        self.typing = False
        self._held.clear()

    def _point(self, x: float, y: float) -> None:
        if not self.count:
            return
        column = int((x - self.box.left) * self.columns / self.box.width)
        row = int((y - self.box.top) * self.rows / self.box.height)
        self._choose(min(max(row, 0), self.rows - 1), min(max(column, 0), self.columns - 1))

    def _move(self, command: Command) -> None:
        down, across = _WAYS[command]
        row, column = self.cell[0] + self.stride * down, self.cell[1] + self.stride * across
        if 0 <= row < self.rows and 0 <= column < self.columns:
            self._choose(row, column)

    def _choose(self, row: int, column: int) -> None:
        if row * self.columns + column < self.count and (row, column) != self.cell:
            self.cell = (row, column)
            self._on_choose(row, column)


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
