"""What is seen of a run of digits: what is misread, with the digits of one cell, and its first filters as they form."""

from __future__ import annotations

from typing import Final

import numpy as np
import pygame

from ai.digits.filters import FilterMoment
from ai.digits.validation import Confusion
from ai.training.history import History
from game.core import texts
from game.digits import certainty
from game.digits.pictures import mosaic, picture, tiling
from game.drawing.canvas import Canvas
from game.drawing.cursor import Cursor
from game.drawing.paint import mix
from game.drawing.paint_cache import PaintCache
from game.drawing.tokens import INK, LABEL, LINE, MUTE, NET, NIGHT0, SMALL, TEXT
from game.input.controls import Command, translate
from game.training.run import TrainingRun
from game.ui.charts import Charts
from game.ui.widget import Widget

_DIGITS: Final = 10
_ARROWS: Final = {Command.UP: (-1, 0), Command.DOWN: (1, 0), Command.LEFT: (0, -1), Command.RIGHT: (0, 1)}
_COUNT: Final = 10.5  # the size of a cell's figure
_COLUMNS: Final = 4  # of misread digits
_GAP: Final = 8.0
_FILTERS_GAP: Final = 6.0
_SAID: Final = 160.0  # width of the words beside the filters
_APART: Final = 24.0
_HEADING: Final = 16.0


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


class FilterFilm:
    """Filters at one moment of a run.

    Attributes:
        history: the run's history; another one belongs to another run.
        moments: all that the run has sent.
        at: number of the chosen moment; None for the newest, whichever that is.

    """

    def __init__(self, charts: Charts) -> None:
        self.history = History()
        self.moments: list[FilterMoment] = []
        self.at: int | None = None
        self._charts = charts
        self._painted = PaintCache()

    @property
    def moment(self) -> FilterMoment | None:
        """The moment that is shown; None before the first."""
        moments = self.moments
        return moments[-1 if self.at is None else min(self.at, len(moments) - 1)] if moments else None

    def choose(self, place: float | int) -> None:
        """Choose the moment nearest to a place on the charts (float), or the one before or after (int -1 or 1)."""
        moments = self.moments
        if not moments:
            return
        last = len(moments) - 1
        if isinstance(place, int):
            at = min(max((last if self.at is None else self.at) + place, 0), last)
        else:
            at = min(range(len(moments)), key=lambda number: abs(moments[number].seconds - place))
        self.at = None if at == last else at
        self._mark()

    def follow(self, run: TrainingRun) -> None:
        """Follow a run; another one begins with its newest moment."""
        if run.filters is not self.moments:
            self.history, self.moments = run.history, run.filters
            self.release()

    def release(self) -> None:
        """Show the newest moment again."""
        self.at = None
        self._mark()

    def _mark(self) -> None:
        moment = self.moment if self.at is not None else None
        if moment is None:
            self._charts.mark(None)
        else:
            self._charts.mark(moment.seconds, texts.DIGIT_RUN_MOMENT.format(seconds=moment.seconds))

    def draw(self, canvas: Canvas, box: pygame.FRect) -> None:
        """Draw the filters into a box: when they were so, and how well the network read then."""
        moment, (left, top) = self.moment, box.topleft
        if moment is None or not len(moment.images):
            words = texts.DIGIT_RUN_FILTERS_NONE if moment is None else texts.DIGIT_RUN_FILTERS_NO_IMAGE
            Cursor(left, top - SMALL, box.width, canvas.scale, canvas).aside(words)
            return
        words = texts.DIGIT_RUN_FILTERS_AT.format(seconds=f"{moment.seconds:.1f}", steps=moment.step)
        canvas.text(words, (left, top), size=LABEL, colour=MUTE, weight="medium", tabular=True, room=box.width)
        beside = _SAID if box.width > 2 * _SAID else 0.0
        room = (box.width - beside - (_APART if beside else 0.0), box.height - _HEADING)
        self._painted.draw(
            canvas, (left, top + _HEADING, *room), (moment, room), lambda sheet: _paint(sheet, moment, room)
        )
        if not beside:
            return
        scores = [score.success for score in self.history.validations if score.seconds <= moment.seconds]
        rows = Cursor(box.right - beside, top + _HEADING, beside, canvas.scale, canvas)
        if scores:
            rows.styled(texts.DIGIT_RUN_FILTERS_READ.format(percent=certainty(scores[-1])), SMALL)
            rows.gap(14)
        rows.aside(texts.DIGIT_RUN_FILTERS_HOW)


def _paint(sheet: Canvas, moment: FilterMoment, room: tuple[float, float]) -> None:
    images = moment.images.astype(np.float32)
    images = np.nan_to_num(images / np.abs(images).max(axis=(1, 2), keepdims=True).clip(1e-9))
    columns, room = tiling(len(images), images.shape[1:], room, _FILTERS_GAP)
    size = sheet.rect(0, 0, *room).size
    sheet.surface.blit(mosaic(images, columns, size, _FILTERS_GAP * sheet.scale), (0, 0))
