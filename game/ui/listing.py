"""Scrolling list of rows to choose from, in a panel."""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Final

import pygame

from game.drawing.canvas import least
from game.drawing.tokens import FAINT, INK, LINE, MUTE, NET, SMALL, TEXT
from game.input.controls import Command, translate
from game.ui.widget import NOWHERE, RowWidget, Widget, mix

if TYPE_CHECKING:
    from game.core.scene import Transition
    from game.drawing.canvas import Canvas
    from game.drawing.cursor import Cursor

Row = tuple[str, ...]  # its name, then the text of each further column
_ROWS: Final = 8
_BAR: Final = 3.0
_BETWEEN: Final = 8.0  # points between two columns
_GAP: Final = 12.0  # points between a row's text and the scroll bar


class ListRow(RowWidget):
    """List to choose from, as high as its rows: at most eight of them, or as many as a window has room for.

    The wheel, the arrows and Page Up and Down scroll; at either end, the arrows lead to the next widget.

    Args:
        rows: the rows.
        press: called with a row's number on Enter, a gamepad's A or a second click on it.
        empty: what stands there without rows.
        index: the chosen row.
        around: height of all else in the window, in points; 0 for at most eight rows.
        on_choose: called with the number of each newly chosen row.
        columns: distance from the right end to the right end of each cell after the first, in points.
        pitch: of the rows, in points.
        size: of the names.

    """

    def __init__(
        self,
        rows: Sequence[Row],
        press: Callable[[int], Transition | None],
        empty: str = "",
        *,
        index: int = 0,
        around: float = 0.0,
        on_choose: Callable[[int], None] = lambda _: None,
        columns: Sequence[float] = (0.0,),
        pitch: float = 32,
        size: float = TEXT,
    ) -> None:
        super().__init__(NOWHERE, "")
        self.key = "list"
        self._on_choose, self._on_press, self._empty = on_choose, press, empty
        self._columns, self._pitch, self._size = columns, pitch, size
        self._around, self._most, self.first = around, _ROWS, 0
        self._pressed = -1
        self.rows = list(rows)
        self.index = min(max(index, 0), max(0, len(self.rows) - 1))

    def follow(self, before: Widget) -> None:
        super().follow(before)
        self.first = before.first if isinstance(before, ListRow) else 0

    def lay(self, cursor: Cursor) -> None:
        before = self.room
        super().lay(cursor)
        if self.room != before:
            self._show_chosen()

    def write(self, cursor: Cursor) -> None:
        if self._around and cursor.seen and cursor.canvas is None:
            self._most = max(4, int((cursor.seen.height - self._around) / self._pitch))
        cursor.take(self._pitch * min(max(len(self.rows), 1), self._most))
        if cursor.canvas:
            self._paint(cursor.canvas)

    @property
    def room(self) -> int:
        return max(1, int(self.box.height // self._pitch))

    def baseline(self, row: int) -> float:
        """Return the y of a row's baseline, in points."""
        return self.box.top + (row - self.first + 0.62) * self._pitch

    @property
    def right(self) -> float:
        """Right end of the rows, before the scroll bar if there is one, in points."""
        return self.box.right - (_BAR + _GAP if len(self.rows) > self.room else 0.0)

    def choose(self, index: int) -> None:
        index = min(max(index, 0), len(self.rows) - 1)
        if self.rows and index != self.index:
            self.index = index
            self._on_choose(index)
        self._show_chosen()

    def press(self) -> Transition | None:
        return self._on_press(self.index) if self.rows else None

    def take(self, event: pygame.event.Event) -> bool:
        steps = {Command.UP: -1, Command.DOWN: 1, Command.PREVIOUS: -self.room, Command.NEXT: self.room}
        if event.type == pygame.KEYDOWN and event.key in (pygame.K_HOME, pygame.K_END):
            self.choose(0 if event.key == pygame.K_HOME else len(self.rows) - 1)
            return True
        step = steps.get(command) if (command := translate(event)) else None
        if step is None:
            return False
        before = self.index
        self.choose(self.index + step)
        return self.index != before or abs(step) > 1

    def scroll(self, rows: int) -> bool:
        self._look(self.first - rows)
        return len(self.rows) > self.room

    def process_event(self, event: pygame.event.Event) -> bool:
        row = self._row_at(event.pos) if event.type in (pygame.MOUSEBUTTONDOWN, pygame.MOUSEBUTTONUP) else None
        if row is None or event.button != 1:
            return False
        if event.type == pygame.MOUSEBUTTONDOWN:
            self._pressed = row if row == self.index else -1
            self.choose(row)
        elif row == self._pressed:
            self.outcome = self.press()
        return True

    def _row_at(self, place: tuple[float, float]) -> int | None:
        if not self.hover_point(*place):
            return None
        row = self.first + int((place[1] - self.box.top) // self._pitch)
        return row if row < min(len(self.rows), self.first + self.room) else None

    def _show_chosen(self) -> None:
        self._look(min(max(self.first, self.index - self.room + 1), self.index))

    def _look(self, first: int) -> None:
        self.first = min(max(first, 0), max(0, len(self.rows) - self.room))

    def _paint(self, canvas: Canvas) -> None:
        box = self.box
        if not self.rows:
            canvas.text(self._empty, (box.left, self.baseline(self.first)), size=self._size, colour=MUTE)
        for number, row in enumerate(self.rows[self.first : self.first + self.room], self.first):
            top = box.top + (number - self.first) * self._pitch
            self._paint_row(canvas, row, (box.left, top, self.right), number)
        if len(self.rows) > self.room:
            self._paint_bar(canvas)

    def _paint_row(self, canvas: Canvas, row: Row, place: tuple[float, float, float], number: int) -> None:
        left, top, right = place
        chosen = number == self.index
        baseline = top + 0.62 * self._pitch
        words, *cells = row
        room = right - left
        before = math.inf
        for cell, column in zip(cells, self._columns, strict=False):
            end, beside = right - column, before - column - _BETWEEN
            box = canvas.text(cell, (end, baseline), size=SMALL, colour=MUTE, align="right", tabular=True, room=beside)
            before = column
            room = min(room, box.left - left - 24)
        colour = INK if chosen else mix(MUTE, INK, 0.35)
        words = shortened(canvas, words, self._size, room)
        canvas.text(words, (left, baseline), size=self._size, colour=colour, room=room)
        canvas.line((left, top + self._pitch - 1), (right, top + self._pitch - 1), LINE, 1)
        if chosen:
            canvas.line((left - 7, top + 0.26 * self._pitch), (left - 7, top + 0.76 * self._pitch), NET, 2)

    def _paint_bar(self, canvas: Canvas) -> None:
        box, count = self.box, len(self.rows)
        left = box.right - _BAR
        canvas.pill((left, box.top, _BAR, box.height), LINE)
        height = max(12.0, box.height * self.room / count)
        top = box.top + (box.height - height) * self.first / (count - self.room)
        canvas.pill((left, top, _BAR, height), mix(FAINT, MUTE, self.warmth))


def shortened(canvas: Canvas, text: str, size: float, room: float) -> str:
    """Return a text, cut with an ellipsis if necessary, that `Canvas.text` can write within the room in points."""
    room *= size / least(size)
    if canvas.text_width(text, size=size) <= room:
        return text
    lengths = range(len(text))
    fitting = bisect_right(lengths, room, key=lambda length: canvas.text_width(text[:length] + "…", size=size))
    return text[: max(0, fitting - 1)] + "…"
