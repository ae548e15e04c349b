"""Days scene: today's start, past days with how their first attempts ended, and a small calendar."""

from __future__ import annotations

from datetime import date, timedelta
from typing import Final

import pygame

from ai.lander.environment import Outcome
from game.core import texts
from game.core.scene import Transition, push
from game.drawing.canvas import Canvas
from game.drawing.prose import draw_wrapped
from game.drawing.tokens import FAINT, HUMAN, INK, LABEL, MARGIN, MUTE, SMALL, TEXT, TITLE, VIEW_SIZE
from game.flight import sharing
from game.flight.days import Attempt, Days
from game.scenes.play.daily import DailyStart
from game.ui.clipboard import give
from game.ui.context import Context
from game.ui.list_scene import ListLayout, ListScene
from game.ui.listing import Row
from game.ui.widget import OnPress, Widget

_LEFT: Final = 720
_WIDTH: Final = VIEW_SIZE[0] - MARGIN - _LEFT
_LAYOUT: Final = ListLayout(
    box=pygame.Rect(MARGIN, 164, 560, 416),
    columns=(112.0, 0.0),
    headings=texts.DAYS_COLUMNS,
    pitch=32,
    verbs=(_LEFT, 504),
    foot=608,
)
_SHOWN: Final = 60  # days in the list
_WEEKS: Final = 5
_CALENDAR: Final = (_LEFT + 10.0, 340.0)  # middle of its first day
_CELL: Final = (34.0, 26.0)
_DAY: Final = timedelta(days=1)


class DaysScene(ListScene[date]):
    """Days scene: days on the left, today first; on the right the chosen one and the last weeks."""

    def __init__(self, context: Context, today: date | None = None) -> None:
        super().__init__(context, texts.DAILY, _LAYOUT)
        self._today = today or date.today()
        self._line = texts.DAYS_LINE
        self._reload()

    def _reload(self) -> None:
        """Read the attempts again."""
        self._days = Days(self.context.user_dir)
        if self._days.problem:
            self.context.note(self._days.problem)
        recent = {self._today, self._today - _DAY}
        known = recent | {day for each in self._days.attempts if (day := date.fromisoformat(each)) <= self._today}
        self._show(sorted(known, reverse=True)[:_SHOWN], self.chosen)

    def _attempt(self, day: date) -> Attempt | None:
        return self._days.attempts.get(day.isoformat())

    def _row(self, day: date) -> Row:
        attempt = self._attempt(day)
        points = f"{attempt.score}" if attempt and attempt.outcome == Outcome.LANDED.name else "–"
        return self._name(day), self._result(day), points

    def _name(self, day: date) -> str:
        named = {self._today: texts.DAYS_TODAY, self._today - _DAY: texts.DAYS_YESTERDAY}
        return f"{named[day]}, {day.isoformat()}" if day in named else day.isoformat()

    def _result(self, day: date) -> str:
        """Return in words how the first attempt of a day ended."""
        attempt = self._attempt(day)
        if attempt is None:
            return texts.DAYS_NOT_FLOWN if day == self._today else texts.DAYS_MISSED
        if attempt.outcome == Outcome.FLYING.name:
            return texts.DAYS_LEFT
        return attempt.result

    def _make_verbs(self) -> list[Widget]:
        if self.chosen is None:
            return []
        self._first = self._days.first_flight(self.chosen)
        today, attempt = self.chosen == self._today, self._attempt(self.chosen)
        self._beside_ghost = (attempt is not None or not today) and self._days.best_flight(self.chosen) is not None
        fly = (texts.DAYS_FLY_AGAIN if attempt else texts.DAYS_FLY) if today else texts.DAYS_FLY_PAST
        rows: list[tuple[str, OnPress]] = [(fly, self._fly)]
        if attempt:
            rows.append((texts.DAYS_COPY, self._copy_line))
        if self._first:
            rows += [(texts.CODE_COPY, self._copy_code), (texts.LOGBOOK_WATCH, self._watch)]
        return self._buttons(rows)

    # What can be done

    def _press_row(self) -> Transition | None:
        return self._fly()

    def _fly(self) -> Transition | None:
        if self.chosen is None:
            return None
        challenge = DailyStart(self.chosen, self._days, past=self.chosen != self._today)
        return push("play", challenge.seed, challenge=challenge)

    def _copy_line(self) -> None:
        if self.chosen and (attempt := self._attempt(self.chosen)):
            give(self.context, attempt.line, texts.CODE_LINE_COPIED.format(line=attempt.line))

    def _copy_code(self) -> None:
        if self._first:
            code = sharing.code(self._first)
            give(self.context, code, texts.CODE_COPIED.format(count=len(code)))

    def _watch(self) -> Transition | None:
        return push("replay", self._first) if self._first else None

    # The picture

    def _draw_chosen(self, canvas: Canvas) -> None:
        """Draw the chosen day, and the calendar."""
        if self.chosen is None:
            return
        canvas.text(self._name(self.chosen), (_LEFT, 190), size=TITLE + 6, weight="light")
        attempt = self._attempt(self.chosen)
        told = attempt.line if attempt else texts.DAYS_ASKS if self.chosen == self._today else texts.DAYS_MISSED_LINE
        y = draw_wrapped(canvas, told, (_LEFT, 224), _WIDTH, size=TEXT, leading=22)
        if self._beside_ghost:
            draw_wrapped(canvas, texts.DAYS_BESIDE, (_LEFT, y + 4), _WIDTH, size=SMALL, colour=MUTE, leading=19)
        self._draw_calendar(canvas)

    def _draw_calendar(self, canvas: Canvas) -> None:
        """Draw the last weeks, Monday first: a disc for a landing, a ring for another end, a speck for none."""
        left, top = _CALENDAR
        canvas.text(texts.DAYS_WEEKS, (_LEFT, top - 34), size=LABEL, weight="medium", colour=MUTE)
        for column, word in enumerate(texts.DAYS_WEEKDAYS):
            canvas.text(word, (left + _CELL[0] * column, top - 14), size=LABEL, colour=MUTE, align="centre")
        first = self._today - _DAY * (self._today.weekday() + 7 * (_WEEKS - 1))
        for number in range((self._today - first).days + 1):
            day, (row, column) = first + _DAY * number, divmod(number, 7)
            spot = (left + _CELL[0] * column, top + _CELL[1] * row + 4)
            attempt = self._attempt(day)
            if attempt is None:
                canvas.dot(spot, 2, FAINT)
            elif attempt.outcome == Outcome.LANDED.name:
                canvas.dot(spot, 6, HUMAN)
            else:
                canvas.outline((spot[0] - 6, spot[1] - 6, 12, 12), 6, HUMAN)
            if day == self.chosen:
                canvas.line((spot[0] - 8, spot[1] + 12), (spot[0] + 8, spot[1] + 12), INK)
