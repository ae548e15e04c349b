"""Outcome card of a flight, in rows: how it ended, why, what it earned, and what comes next."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import pygame

from game.core import texts
from game.drawing.cursor import BASELINE, LEADING, Cursor
from game.drawing.tokens import HUMAN, INK, LABEL, LINE, LOW, MEDALS, MUTE, NARROW, SMALL, TITLE
from game.flight.outcomes import OutcomeCard
from game.ui.hints import Hint, HintRow, hint_lines
from game.world.camera import ClearArea

if TYPE_CHECKING:
    from game.drawing.canvas import Canvas, Point
    from game.drawing.shapes import Shape

_WIDEST: Final = 440.0
_MARGIN: Final = 32.0
_AROUND: Final = 16.0  # least points from the sides of the window
_KEYS: Final = 54.0  # in a narrow one, keys stand above the card, and the flight below it
_TOP: Final = 96.0  # of the card, in a window with room
_LAMP: Final = 13.0  # points from one lamp to the next
_FIGURES: Final = LEADING * LABEL + 4 + LEADING * TITLE  # points of a row of figures
_SIGN: Final = 34.0  # points for the sign before the title


@dataclass(frozen=True)
class ShownCard:
    """Card on the screen: `shown` 0 to 1 of the way in, with its `hints` at the foot.

    `advise` is whether advice is wanted, `aside` whether a craft at the right needs the card at the left.
    """

    card: OutcomeCard
    hints: Sequence[Hint]
    shown: float = 1.0
    advise: bool = True
    aside: bool = False

    def box(self, canvas: Canvas) -> pygame.FRect:
        """Return the card's box, in points of a canvas for text that flows: at a side, or at the top."""
        view = canvas.view
        width = min(_WIDEST, view.width - 2 * _AROUND)
        rows = Cursor(0.0, 0.0, width - 2 * _MARGIN, canvas.scale)
        self._write(rows, low=view.height < LOW)
        height = rows.y + 29.0 * len(hint_lines(self.hints, canvas, (0.0, 0.0), rows.width)) + 16
        narrow = view.width < NARROW
        side = view.left + 3 * _AROUND if self.aside else view.right - 3 * _AROUND - width
        left = view.centerx - width / 2 if narrow else side
        top = view.top + _KEYS if narrow else max(view.top + _AROUND, min(_TOP, (view.height - height) / 3))
        return pygame.FRect(left, top - 10 * (1 - self.shown), width, height)

    def clear(self, canvas: Canvas) -> ClearArea:
        """Return what the card leaves free of the world, beside it or below it."""
        box, view = self.box(canvas), canvas.view
        if view.width < NARROW:
            return ClearArea.of(canvas, pygame.FRect(view.left, box.bottom, view.width, view.bottom - box.bottom))
        return ClearArea.of(canvas, pygame.FRect(view.left, 0, box.left - view.left, view.height))

    def hint_rows(self, canvas: Canvas) -> list[HintRow]:
        box = self.box(canvas)
        return hint_lines(self.hints, canvas, (box.left + _MARGIN, box.bottom - 16), box.width - 2 * _MARGIN)

    def draw(self, canvas: Canvas) -> None:
        box = self.box(canvas)
        canvas.panel(box, 1.0)  # neither the Earth nor a path shines through
        rows = Cursor(box.left + _MARGIN, box.top, box.width - 2 * _MARGIN, canvas.scale, canvas)
        self._write(rows, low=canvas.view.height < LOW)  # without figures, the craft is seen below
        canvas.line((rows.left, rows.y), (rows.right, rows.y), LINE)
        for row in self.hint_rows(canvas):
            row.draw(canvas)

    # Rows

    def _write(self, rows: Cursor, *, low: bool) -> None:
        card = self.card
        rows.gap(12 if low else 24)
        self._write_title(rows)
        rows.text(card.reason)
        if card.advice and self.advise:
            rows.gap(3)
            rows.aside(card.advice)
        if not low:
            rows.gap(12)
            self._write_figures(rows)
        small = rows.in_style(SMALL, MUTE)
        if card.score:
            if rows.canvas:
                last = rows.right - small.measured(card.score, tabular=True) - 14, small.baseline - 4
                draw_lamps(rows.canvas, last, card.medal)
            small.pair(texts.CARD_SCORE, card.score, HUMAN)
        for words, figure in card.compared.items():
            small.pair(words, figure, INK)
        if card.climb:
            small.styled(card.climb, colour=INK)
        rows.y = small.y + 8

    def _write_title(self, rows: Cursor) -> None:
        card = self.card
        colour = INK if card.intact else rows.palette.good if card.good else rows.palette.warn
        if rows.canvas:
            mark: Shape = "check" if card.good else "diamond" if card.intact else "cross"
            place = rows.left + 10, rows.in_style(TITLE).baseline - 8
            rows.canvas.glow(place, 30, colour, 0.5 * self.shown)
            rows.canvas.marker(mark, place, 18, colour)
        rows.styled(card.title, TITLE, colour, indent=_SIGN)
        rows.gap(4)

    def _write_figures(self, rows: Cursor) -> None:
        figures = self.card.figures
        widest = max(rows.in_style(LABEL, weight="medium").measured(label) for label, _, _ in figures) + 12
        across = len(figures) if widest * len(figures) <= rows.width else (len(figures) + 1) // 2
        column = rows.width / across
        for number, (label, value, unit) in enumerate(figures):
            if number and number % across == 0:
                rows.gap(_FIGURES)
            if canvas := rows.canvas:
                x, line = rows.left + number % across * column, rows.y + LEADING * LABEL + 4 + BASELINE * TITLE
                canvas.text(label, (x, rows.y + LABEL), size=LABEL, colour=MUTE, weight="medium")
                box = canvas.text(value, (x, line), size=TITLE, weight="light", tabular=True)
                canvas.text(unit, (box.right + 4, line), size=LABEL, colour=MUTE)
        rows.gap(_FIGURES + 4)


def draw_lamps(canvas: Canvas, last: Point, medal: int) -> None:
    """Draw the lamps of a medal from right to left, three for gold."""
    for lamp in range(medal):
        canvas.glow((last[0] - _LAMP * lamp, last[1]), 14, MEDALS[medal], 0.35)
        canvas.dot((last[0] - _LAMP * lamp, last[1]), 4, MEDALS[medal])
