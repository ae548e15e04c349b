"""Picker of one cell of a picture: a pixel of a map, or a picture among others; by mouse, arrows or a gamepad."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np
import numpy.typing as npt
import pygame

from game.core import texts
from game.digits.pictures import SIGNED, Numbers, mosaic, tiling
from game.drawing.canvas import Canvas
from game.drawing.cursor import Cursor
from game.drawing.paint_cache import PaintCache
from game.drawing.tokens import HUMAN, INK, LINE
from game.input.controls import Command, Controls, presses_main, translate
from game.ui.hints import Hint
from game.ui.widget import RowWidget

_WAYS: Final = {Command.UP: (-1, 0), Command.DOWN: (1, 0), Command.LEFT: (0, -1), Command.RIGHT: (0, 1)}
_AFTER, _EVERY = 18, 4  # updates that an arrow is held before the cell moves on, and between two moves
_GAP: Final = 3.0
_NOWHERE: Final = (0, 0, 1, 1)


class CellPicker(RowWidget):
    """Picture of cells, `rows` by `columns`, of which one is chosen: pixels of a map, or many small pictures.

    The mouse chooses what it points at. Enter, or a gamepad's A, takes hold of the cell: then the arrows move it, as
    long as one is held, until Enter or Escape lets go; until then they move the focus past the picture.

    Args:
        choose: gets the row and the column of a newly chosen cell.
        most: height of the picture, in points, at most.
        shades: colours of values from -1 to 1.

    Attributes:
        rows, columns: the grid.
        count: cells that there are, row by row; the others of the last row are empty.
        cell: row and column of the chosen cell.
        window: top, left, bottom and right of the cells that are lit by an edge.
        stride: cells that an arrow moves on.
        grid: where the cells are, in points.

    """

    pad = 0.0

    def __init__(
        self,
        choose: Callable[[int, int], None],
        most: float,
        shades: npt.NDArray[np.uint8] = SIGNED,
    ) -> None:
        super().__init__(_NOWHERE, "")
        self._on_choose, self._most, self._shades = choose, most, shades
        self.tiles: Numbers = np.zeros((1, 1, 1), np.float32)
        self.rows = self.columns = self.count = self.stride = 1
        self.cell, self.window = (0, 0), (0, 0, 1, 1)
        self.grid = pygame.FRect(0, 0, 1, 1)
        self._gap, self._painted, self._shown = 0.0, PaintCache(), 0
        self._held: dict[int, Command] = {}
        self._steps = 0

    def show_map(self, values: Numbers, label: str, window: tuple[int, int, int, int]) -> None:
        """Show a map (height, width) in -1 to 1, whose pixels are the cells, and a window in it."""
        if not np.array_equal(self.tiles[0], values):
            self.tiles, self._shown = values[None], self._shown + 1
        self.label, self.window = label, window
        (self.rows, self.columns), self.count = values.shape, values.size

    def show_tiles(self, tiles: Numbers, label: str, chosen: int) -> None:
        """Show many pictures (n, height, width) in -1 to 1, which are the cells, and which one is chosen."""
        if tiles is not self.tiles:
            self.tiles, self.count, self._gap, self._shown = tiles, len(tiles), _GAP, self._shown + 1
        self.label = label
        self._light(chosen)

    def _light(self, chosen: int) -> None:
        row, column = self.cell = divmod(chosen, self.columns)
        self.window = (row, column, row + 1, column + 1)

    def write(self, cursor: Cursor) -> None:
        cursor.caption(self.label)
        if cursor.canvas is None:
            self._lay_grid(cursor)
        cursor.y += self.grid.height
        if (canvas := cursor.canvas) is None:
            return
        self._painted.draw(canvas, self.grid, self._shown, self._paint)
        edge = self.place(*self.window[:2]).union(self.place(self.window[2] - 1, self.window[3] - 1))
        canvas.outline(edge.inflate(2, 2), 1, INK if self._gap else HUMAN, 2)

    def _lay_grid(self, cursor: Cursor) -> None:
        """Lay a map out as a square, and pictures in as many columns as fill the room best."""
        width = height = min(cursor.width, self._most)
        if self._gap:
            chosen = self.cell[0] * self.columns + self.cell[1]
            room = (cursor.width, self._most)
            self.columns, (width, height) = tiling(self.count, self.tiles.shape[1:], room, _GAP)
            self.rows = -(-self.count // self.columns)
            self._light(chosen)
        self.grid = pygame.FRect(cursor.left, cursor.y, width, height)

    def lay(self, cursor: Cursor) -> None:
        super().lay(cursor)
        if cursor.canvas is None:
            self.rect.width = min(self.rect.width, round(self.grid.width))

    def _paint(self, sheet: Canvas) -> None:
        area = sheet.rect(0, 0, *self.grid.size)
        columns = self.columns if self._gap else 1
        sheet.surface.blit(mosaic(self.tiles, columns, area.size, self._gap * sheet.scale, self._shades), area)
        if not self._gap:
            pygame.draw.rect(sheet.surface, LINE, area, 1)

    def place(self, row: int, column: int) -> pygame.FRect:
        """Return the box of a cell, in points."""
        gap = self._gap
        across, down = (self.grid.width + gap) / self.columns, (self.grid.height + gap) / self.rows
        return pygame.FRect(self.grid.left + column * across, self.grid.top + row * down, across - gap, down - gap)

    # Choosing

    def press(self) -> None:
        self.typing = self.ringed and self.count > 1

    def hints(self, controls: Controls) -> list[Hint]:
        leave = Hint(controls.word(Command.BACK), texts.PATCH_LET_GO, self._let_go)
        return [Hint(controls.arrows, texts.HINT_MOVE), leave]

    def take(self, event: pygame.event.Event) -> bool:
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
        if event.type == pygame.MOUSEMOTION and self.hover_point(*event.pos) and self.grid.collidepoint(event.pos):
            x, y = event.pos
            row = int((y - self.grid.top) * self.rows / self.grid.height)
            column = int((x - self.grid.left) * self.columns / self.grid.width)
            self._choose(min(row, self.rows - 1), min(column, self.columns - 1))
        return super().process_event(event)

    def ease(self, at_once: bool) -> None:
        super().ease(at_once)
        if self.typing and not self.focused:
            self._let_go()
        self._steps = self._steps + 1 if self._held else 0
        if self._steps >= _AFTER and self._steps % _EVERY == 0:
            for command in tuple(self._held.values()):
                self._move(command)

    def _let_go(self) -> None:
        self.typing = False
        self._held.clear()

    def _move(self, command: Command) -> None:
        down, across = _WAYS[command]
        row, column = self.cell[0] + self.stride * down, self.cell[1] + self.stride * across
        if 0 <= row < self.rows and 0 <= column < self.columns:
            self._choose(row, column)

    def _choose(self, row: int, column: int) -> None:
        if row * self.columns + column < self.count and (row, column) != self.cell:
            self.cell = (row, column)
            self._on_choose(row, column)
