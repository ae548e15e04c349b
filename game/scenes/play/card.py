"""Outcome card of a flight, in rows: how it ended, why, what it earned, and what comes next."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final

import pygame

from game.core import texts
from game.drawing.cursor import BASELINE, LEADING, Cursor
from game.drawing.tokens import HUMAN, INK, LABEL, LINE, MEDALS, MUTE, NET, SMALL, TEXT, TITLE
from game.explain.readouts import draw_share
from game.flight.outcomes import OutcomeCard, RivalOutcome
from game.scenes.play.head import LADDER, draw_ladder
from game.ui.hints import Hint, HintRow, hint_lines

if TYPE_CHECKING:
    from game.drawing.canvas import Canvas, Point
    from game.drawing.shapes import Shape

_WIDEST: Final = 480.0
_MARGIN: Final = 32.0
_COVER: Final = 0.94  # opacity: neither the Earth nor a path shines through the words
_AROUND: Final = 16.0  # least points from the sides of the window
_NARROW, _KEYS = 860.0, 54.0  # in a narrower one, keys stand above the card
_TOP: Final = 136.0  # of the card, in a window with room
_LAMP: Final = 13.0  # points from one lamp to the next
_RING_PARTS: Final = 14
_FIGURES: Final = LEADING * LABEL + 4 + LEADING * TITLE  # points of a row of figures
_SIGN: Final = 34.0  # points for the sign before the title
# Where a card may stand across the window, as shares of the room that is left: where it hides least of the path.
PLACES: Final = (0.5, 0.0, 1.0)


@dataclass(frozen=True)
class ShownCard:
    """Card on the screen: `shown` 0 to 1 of the way in, with its `hints` at the foot.

    `advise` is whether advice is wanted.
    """

    card: OutcomeCard
    hints: Sequence[Hint]
    shown: float = 1.0
    advise: bool = True
    rival: RivalOutcome | None = None

    def box(self, canvas: Canvas) -> pygame.FRect:
        """Return the card's box, in points of a canvas for text that flows."""
        view = canvas.view
        width = min(_WIDEST, view.width - 2 * _AROUND)
        rows = Cursor(0.0, 0.0, width - 2 * _MARGIN, canvas.scale)
        self._write(rows)
        height = rows.y + 29.0 * len(hint_lines(self.hints, canvas, (0.0, 0.0), width - 2 * _MARGIN)) + _MARGIN
        left = view.left + _AROUND + self.card.place * (view.width - 2 * _AROUND - width)
        if width < 0.6 * view.width and self.card.place != PLACES[0]:  # beside the path, but not at the very edge
            left += 48 * (1 if self.card.place < 0.5 else -1)
        above = _KEYS if view.width < _NARROW else _AROUND  # below the keys of the flight
        top = max(view.top + above, min(_TOP, (view.height - height) / 3))
        return pygame.FRect(left, top - 10 * (1 - self.shown), width, height)

    def hint_rows(self, canvas: Canvas) -> list[HintRow]:
        box = self.box(canvas)
        return hint_lines(self.hints, canvas, (box.left + _MARGIN, box.bottom - 22), box.width - 2 * _MARGIN)

    def draw(self, canvas: Canvas) -> None:
        box = self.box(canvas)
        canvas.panel(box, _COVER)
        rows = Cursor(box.left + _MARGIN, box.top, box.width - 2 * _MARGIN, canvas.scale, canvas)
        self._write(rows)
        canvas.line((rows.left, rows.y + 4), (rows.right, rows.y + 4), LINE)
        for row in self.hint_rows(canvas):
            row.draw(canvas)

    # Rows

    def _write(self, rows: Cursor) -> None:
        card = self.card
        rows.gap(24)
        self._write_title(rows)
        rows.gap(6)
        rows.text(card.reason)
        advice = card.advice if self.advise else ""
        for words, colour in ((card.quality, HUMAN), (advice, MUTE), (card.assists, HUMAN)):
            if words:
                rows.gap(3)
                rows.styled(words, SMALL, colour)
        rows.gap(12)
        self._write_figures(rows)
        self._write_rival(rows)
        self._write_scores(rows)
        self._write_share(rows)
        if card.rung is not None and card.climb:
            if rows.canvas:
                draw_ladder(rows.canvas, rows.left + 1, rows.in_style(SMALL).baseline, card.rung)
            rows.styled(card.climb, SMALL, INK, indent=LADDER + 8)
            rows.gap(4)

    def _write_title(self, rows: Cursor) -> None:
        card = self.card
        colour = INK if card.intact else rows.palette.good if card.good else rows.palette.warn
        if rows.canvas:
            mark: Shape = "check" if card.good else "diamond" if card.intact else "cross"
            place = rows.left + 10, rows.in_style(TITLE).baseline - 8
            rows.canvas.glow(place, 30, colour, 0.5 * self.shown)
            rows.canvas.marker(mark, place, 18, colour)
        rows.styled(card.title, TITLE, colour, indent=_SIGN)

    def _write_scores(self, rows: Cursor) -> None:
        card, small = self.card, rows.in_style(SMALL, MUTE)
        if card.score:
            if rows.canvas:
                last = rows.right - small.measured(card.score, tabular=True) - 14, small.baseline - 4
                if card.ring:
                    _draw_ring(rows.canvas, last)
                draw_lamps(rows.canvas, last, card.medal)
            small.pair(texts.CARD_SCORE, card.score, HUMAN)
        for words, figure in card.compared.items():
            small.pair(words, figure, INK)
        rows.y = small.y

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
                _figure(canvas, value, unit, (x, line), TITLE)
        rows.gap(_FIGURES + 4)

    def _write_rival(self, rows: Cursor) -> None:
        """Write a rival's name, result and figures, in the columns of the player's own."""
        rival, canvas = self.rival, rows.canvas
        if rival is None:
            return
        rows.gap(4)
        name = replace(rows, left=rows.left + 16, width=rows.width - 16).in_style(SMALL, NET)
        if canvas:
            canvas.dot((rows.left + 4, name.baseline - 4), 4, NET)
        name.pair(rival.name, rival.result, INK)
        rows.y = name.y
        column = rows.width / len(self.card.figures)
        for number, (label, _, _) in enumerate(self.card.figures):
            if canvas:
                value, unit = rival.figures.get(label, ("–", ""))
                _figure(canvas, value, unit, (rows.left + number * column, rows.baseline), TEXT)
        rows.gap(LEADING * TEXT + 4)

    def _write_share(self, rows: Cursor) -> None:
        card, canvas = self.card, rows.canvas
        if sentence := card.stepped_in_words:
            rows.gap(4)
            top = rows.y
            if canvas:
                canvas.marker("diamond", (rows.left + 6, rows.in_style(SMALL).baseline - 4), 8, NET)
            rows.styled(sentence, SMALL, MUTE, indent=18)
            if canvas and card.watched:
                canvas.explain((rows.left, top, rows.width, rows.y - top), texts.EXPLAIN_CARD_SAVED)
        if card.human == 1:  # nothing to share out
            return
        rows.gap(18)
        if canvas:
            draw_share(canvas, rows.left, rows.y, rows.width, card.human, card.who)
        rows.gap(22)


def _figure(canvas: Canvas, value: str, unit: str, place: Point, size: float) -> None:
    box = canvas.text(value, place, size=size, weight="light", tabular=True)
    canvas.text(unit, (box.right + 4, place[1]), size=LABEL, colour=MUTE)


def draw_lamps(canvas: Canvas, last: Point, medal: int) -> None:
    """Draw the lamps of a medal from right to left, three for gold."""
    for lamp in range(medal):
        canvas.glow((last[0] - _LAMP * lamp, last[1]), 14, MEDALS[medal], 0.35)
        canvas.dot((last[0] - _LAMP * lamp, last[1]), 4, MEDALS[medal])


def _draw_ring(canvas: Canvas, place: Point) -> None:
    for part in range(_RING_PARTS):
        angle = 2 * math.pi * (part + 0.5) / _RING_PARTS
        colour = HUMAN if math.cos(angle) < 0 else NET
        canvas.dot((place[0] + 5 * math.cos(angle), place[1] + 5 * math.sin(angle)), 1.3, colour)
