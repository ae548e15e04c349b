"""Days scene: today's start, past days with how their first attempts ended, and a small calendar."""

from __future__ import annotations

from datetime import date, timedelta
from typing import TYPE_CHECKING, Final

import pygame

from ai.lander.environment import Outcome
from game.core import texts
from game.core.scene import Transition, push
from game.drawing.tokens import FAINT, HUMAN, INK, LABEL, MUTE, TITLE
from game.flight import sharing
from game.flight.days import Attempt, Days
from game.scenes.play.daily import DailyStart
from game.ui.actions import Table
from game.ui.clipboard import give
from game.ui.listing import Row
from game.ui.panel_scene import PanelScene

if TYPE_CHECKING:
    from game.drawing.canvas import Canvas
    from game.ui.context import Context
    from game.ui.panel import Column, Panel

_LEAST: Final = 320.0  # points of a column
_COLUMNS: Final = (112.0, 0.0)  # from the right end of the list: where ends and points end
_AROUND: Final = 100.0  # points above and below the list
_SHOWN: Final = 60  # days in the list
_WEEKS: Final = 5
_CELL: Final = (34.0, 26.0)
_DAY: Final = timedelta(days=1)


class DaysScene(PanelScene):
    """Days scene: days in a list, today first; beside it, or below, the chosen one and the last weeks.

    Attributes:
        days: what is listed.

    """

    def __init__(self, context: Context, today: date | None = None) -> None:
        super().__init__(context)
        self._today = self.chosen = today or date.today()
        self.enter()

    def enter(self) -> None:
        """Read the attempts again."""
        self._attempts = Days(self.context.user_dir)
        if self._attempts.problem:
            self.context.note(self._attempts.problem)
        known = {date.fromisoformat(day) for day in self._attempts.attempts} | {self._today, self._today - _DAY}
        self.days = sorted((day for day in known if day <= self._today), reverse=True)[:_SHOWN]
        self.build()

    def describe(self, panel: Panel) -> None:
        """Add the list, and the chosen day."""
        panel.title(texts.DAILY)
        panel.aside(texts.DAYS_LINE)
        panel.gap(8)
        left, self._beside = panel.beside((5, 4), _LEAST)
        rows, index = [self._row(day) for day in self.days], self.days.index(self.chosen)
        left.listing(rows, lambda _: self._fly(), around=_AROUND, index=index, on_choose=self._choose, columns=_COLUMNS)
        self._describe_day(self._beside)

    def _describe_day(self, column: Column) -> None:
        """Add what there is to say of the chosen day, and to do with it."""
        attempt, today = self._attempt(self.chosen), self.chosen == self._today
        self._flown = self._attempts.first_flight(self.chosen)
        column.title(self._name(self.chosen), TITLE + 6)
        column.text(attempt.line if attempt else texts.DAYS_ASKS if today else texts.DAYS_MISSED_LINE)
        if (attempt or not today) and self._attempts.best_flight(self.chosen):
            column.aside(texts.DAYS_BESIDE)
        column.gap(10)
        fly = (texts.DAYS_FLY_AGAIN if attempt else texts.DAYS_FLY) if today else texts.DAYS_FLY_PAST
        column.button(fly, self._fly, size=TITLE, colour=INK)
        if attempt:
            column.button(texts.DAYS_COPY, self._copy_line)
        if self._flown:
            column.button(texts.CODE_COPY, self._copy_code)
            column.button(texts.LOGBOOK_WATCH, self._watch)
        column.gap(10)
        column.caption(texts.DAYS_WEEKS)
        column.picture(_CELL[1] * (_WEEKS + 1), self._draw_weeks)

    def actions(self) -> Table:
        """Move, choose, go back."""
        return [self.form.moves, *super().actions()]

    def _choose(self, index: int) -> None:
        self.chosen = self.days[index]
        self._beside.clear()
        self._describe_day(self._beside)

    # In words

    def _attempt(self, day: date) -> Attempt | None:
        return self._attempts.attempts.get(day.isoformat())

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
        return texts.DAYS_LEFT if attempt.outcome == Outcome.FLYING.name else attempt.result

    # What can be done

    def _fly(self) -> Transition:
        challenge = DailyStart(self.chosen, self._attempts, past=self.chosen != self._today)
        return push("play", challenge.seed, challenge=challenge)

    def _copy_line(self) -> None:
        if attempt := self._attempt(self.chosen):
            give(self.context, attempt.line, texts.CODE_LINE_COPIED.format(line=attempt.line))

    def _copy_code(self) -> None:
        assert self._flown
        code = sharing.code(self._flown)
        give(self.context, code, texts.CODE_COPIED.format(count=len(code)))

    def _watch(self) -> Transition:
        return push("replay", self._flown)

    def _draw_weeks(self, canvas: Canvas, box: pygame.FRect) -> None:
        """Draw the last weeks, Monday first: a disc for a landing, a ring for another end, a speck for none."""
        first = self._today - _DAY * (self._today.weekday() + 7 * (_WEEKS - 1))
        for column, word in enumerate(texts.DAYS_WEEKDAYS):
            spot = (box.left + _CELL[0] * (column + 0.3), box.top + LABEL)
            canvas.text(word, spot, size=LABEL, colour=MUTE, align="centre")
        for number in range((self._today - first).days + 1):
            day, (row, column) = first + _DAY * number, divmod(number, 7)
            spot = (box.left + _CELL[0] * (column + 0.3), box.top + _CELL[1] * (row + 1.1))
            attempt = self._attempt(day)
            if attempt is None:
                canvas.dot(spot, 2, FAINT)
            elif attempt.outcome == Outcome.LANDED.name:
                canvas.dot(spot, 6, HUMAN)
            else:
                canvas.outline((spot[0] - 6, spot[1] - 6, 12, 12), 6, HUMAN)
            if day == self.chosen:
                canvas.line((spot[0] - 8, spot[1] + 11), (spot[0] + 8, spot[1] + 11), INK)
