"""Picker of one cell of a picture: a pixel of a map, a filter among others; by mouse, arrows or a gamepad."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import pygame

from game.core import texts
from game.drawing.canvas import Canvas
from game.drawing.tokens import INK
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
