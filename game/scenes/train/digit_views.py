"""What is seen of a run of digits: what is misread, with the digits of one cell."""

from __future__ import annotations

from typing import Final

import numpy as np
import pygame

from ai.digits.validation import Confusion
from game.core import texts
from game.digits.pictures import picture
from game.drawing.canvas import Canvas
from game.drawing.paint import mix
from game.drawing.paint_cache import PaintCache
from game.drawing.tokens import INK, LABEL, LINE, MUTE, NET, NIGHT0, SMALL, TEXT
from game.input.controls import Command, translate
from game.ui.widget import Widget

_DIGITS: Final = 10
_ARROWS: Final = {Command.UP: (-1, 0), Command.DOWN: (1, 0), Command.LEFT: (0, -1), Command.RIGHT: (0, 1)}
_COUNT: Final = 12.0  # the size of a cell's figure
_COLUMNS: Final = 4  # of misread digits
_GAP: Final = 8.0


class ConfusionMatrix(Widget):
    """Confusion matrix: ten true digits (rows) by ten read ones (columns). Mouse and arrows choose a cell.

    Attributes:
        cell: row and column of the chosen cell.

    """

    def __init__(self, box: pygame.typing.RectLike) -> None:
        super().__init__(box, "")
        self.confusion: Confusion | None = None
        self.cell = (0, 0)
        self._chosen = False  # by the player; until then, the most frequent error is chosen
        self._painted = PaintCache()

    @property
    def pitch(self) -> float:
        """Distance from one cell to the next, in points."""
        return self.box.width / _DIGITS

    def set(self, confusion: Confusion | None) -> None:
        """Show a confusion matrix; None for nothing yet."""
        self.confusion = confusion
        if confusion is None:
            self._chosen = False
        elif not self._chosen:
            wrong = confusion.table * (1 - np.eye(_DIGITS, dtype=np.int64))
            row, column = divmod(int(wrong.argmax()), _DIGITS)
            self.cell = (row, column)

    def take_over(self, other: ConfusionMatrix) -> None:
        """Show what another one shows."""
        self.confusion, self.cell, self._chosen = other.confusion, other.cell, other._chosen

    def take(self, event: pygame.event.Event) -> bool:
        command = translate(event)
        if command not in _ARROWS:
            return False
        row, column = (now + step for now, step in zip(self.cell, _ARROWS[command], strict=True))
        if not (0 <= row < _DIGITS and 0 <= column < _DIGITS):
            return False
        self._choose(row, column)
        return True

    def process_event(self, event: pygame.event.Event) -> bool:
        if event.type == pygame.MOUSEMOTION and self.hover_point(*event.pos):
            across, down = event.pos[0] - self.box.left, event.pos[1] - self.box.top
            self._choose(*(min(int(way / self.pitch), _DIGITS - 1) for way in (down, across)))
        return super().process_event(event)

    def _choose(self, row: int, column: int) -> None:
        self.cell, self._chosen = (row, column), True

    def paint(self, canvas: Canvas) -> None:
        super().paint(canvas)
        box, pitch, (row, column) = self.box, self.pitch, self.cell
        sheet = (box.left, box.top, box.width + 1, box.height + 1)
        self._painted.draw(canvas, sheet, self.confusion, self._paint_cells)
        for digit in range(_DIGITS):
            at = (digit + 0.5) * pitch
            for place, lit in (((box.left - 12, box.top + at + 4), row), ((box.left + at, box.top - 7), column)):
                canvas.text(str(digit), place, size=SMALL, align="centre", colour=INK if digit == lit else MUTE)
        if self.confusion is not None:
            cell = (box.left + column * pitch, box.top + row * pitch, pitch, pitch)
            canvas.outline(cell, 4, INK, 1.5, 0.5 + 0.5 * self.warmth)

    def _paint_cells(self, sheet: Canvas) -> None:
        pitch = self.pitch
        for number in range(_DIGITS + 1):
            sheet.line((0, number * pitch), (self.box.width, number * pitch), LINE)
            sheet.line((number * pitch, 0), (number * pitch, self.box.height), LINE)
        if self.confusion is None:
            return
        table = self.confusion.table
        first = {tuple(cell): number for number, cell in reversed(list(enumerate(self.confusion.cells.tolist())))}
        for row, column in np.argwhere(table).tolist():
            area = sheet.rect(column * pitch + 1, row * pitch + 1, pitch - 1, pitch - 1)
            if row == column:
                share = table[row, row] / table[row].sum()
                sheet.fill(area, mix(NIGHT0, NET, 0.45 * share))
                words = f"{100 * share:.0f}" if share < 0.995 else f"{100 * share:.4g}"[:4]
                middle = (column + 0.5) * pitch, (row + 0.5) * pitch + 4
                sheet.text(words, middle, size=LABEL, align="centre", tabular=True)
            elif (row, column) in first:
                image = self.confusion.images[first[row, column]] / np.float32(255)
                sheet.surface.blit(picture(image, area.size), area)
                _draw_count(sheet, int(table[row, column]), (column + 1) * pitch - 1, (row + 1) * pitch - 1)

    # The chosen cell

    def draw_cell(self, canvas: Canvas, box: pygame.typing.RectLike) -> None:
        """Draw the meaning of the chosen cell and its misread digits."""
        if self.confusion is None:
            return
        (row, column), area = self.cell, pygame.FRect(box)
        count, shown = int(self.confusion.table[row, column]), int(self.confusion.table[row].sum())
        right = row == column
        words = texts.MATRIX_RIGHT if right else texts.MATRIX_WRONG
        canvas.text(words.format(digit=row, read=column), (area.left, area.top + 14), size=TEXT)
        share = texts.MATRIX_COUNT.format(count=count, shown=shown, percent=100 * count / max(shown, 1))
        canvas.text(share, (area.left, area.top + 34), size=SMALL, colour=MUTE, tabular=True)
        if right or not count:
            return
        found = self.confusion.images[(self.confusion.cells == (row, column)).all(axis=1)]
        side = (area.width - (_COLUMNS - 1) * _GAP) / _COLUMNS
        for number, image in enumerate(found):
            down, across = divmod(number, _COLUMNS)
            place = (area.left + across * (side + _GAP), area.top + 48 + down * (side + _GAP))
            if place[1] + side > area.bottom + 1:
                break
            tile = canvas.rect(*place, side, side)
            canvas.surface.blit(picture(image / np.float32(255), tile.size), tile)


def _draw_count(sheet: Canvas, count: int, right: float, bottom: float) -> None:
    """Draw a count in the corner of a cell."""
    words = str(count)
    width = sheet.text_width(words, size=_COUNT) + 4
    sheet.fill(sheet.rect(right - width, bottom - 12, width, 12), NIGHT0)
    sheet.text(words, (right - 2, bottom - 2), size=_COUNT, colour=sheet.palette.warn, align="right")
