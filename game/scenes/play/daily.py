"""Start of the day: its first attempt counts, later ones and those of past days are practice beside a ghost.

Also the page of the days: today's start, past days, and how their first attempts ended.
"""

from __future__ import annotations

from datetime import date, timedelta
from functools import partial
from typing import TYPE_CHECKING, Final

from ai.flights.verification import DAILY
from ai.lander.environment import Outcome
from game.core import texts
from game.core.scene import Transition, push
from game.drawing.tokens import INK, TITLE
from game.flight.credit import Credit
from game.flight.days import Attempt, Days
from game.flight.flight import Flight
from game.flight.flight_file import Entry, Record
from game.flight.friend import copy
from game.flight.networks import Policy
from game.flight.replay import ReplayedFlight
from game.scenes.play.challenge import Challenge
from game.scenes.play.ghost import Ghost
from game.ui.actions import Table
from game.ui.clipboard import give
from game.ui.listing import Row
from game.ui.panel_scene import PanelScene

if TYPE_CHECKING:
    from game.ui.context import Context
    from game.ui.panel import Column, Panel

_LEAST: Final = 320.0  # points of a column
_COLUMNS: Final = (112.0, 0.0)  # from the right end of the list: where ends and points end
_AROUND: Final = 100.0  # points above and below the list
_SHOWN: Final = 60  # days in the list
_DAY: Final = timedelta(days=1)


class DailyStart(Challenge):
    """Start of a day, the same for everybody, without a network to help.

    Args:
        day: the day.
        days: the player's first attempts.
        past: whether the day is over.

    """

    name = DAILY
    alone = eases = True

    def __init__(self, day: date, days: Days, *, past: bool = False) -> None:
        self.seed, self.line = day.toordinal(), day.isoformat()
        self._day, self._days, self._past = day, days, past
        self._begun = False
        self._look()

    def word(self) -> None:
        self.title, self.copy_hint, self.eased_line = texts.DAILY, texts.DAILY_HINT_COPY, texts.DAILY_EASED
        openings = {"day_past": texts.DAILY_PAST_BEGIN, "day_again": texts.DAILY_AGAIN_BEGIN}
        self.opening = openings.get(self.bar, texts.DAILY_FIRST_BEGIN)

    def _look(self) -> None:
        if self._past:
            self.bar = "day_past"
        elif self.line in self._days.attempts:
            self.bar = "day_again"
        self.word()

    def flight(self, seed: int, network: Policy | None, spawn: str = "") -> Flight:
        """Begin a flight with three pads among hills."""
        self._begun, self.stake = False, None
        self._look()
        return Flight(self.seed, pads=3, easing=self.easing)

    def ghost(self, seed: int, network: Policy | None) -> Ghost | None:
        """Begin the player's best flight of that day as a ghost, in practice only."""
        record = self._days.best_flight(self._day) if self.bar else None
        return Ghost(ReplayedFlight(record.recording), self._ghost_name) if record else None

    def _ghost_name(self) -> str:
        return texts.DAILY_GHOST if self._past else texts.DAILY_GHOST_TODAY

    def follow(self, flight: Flight) -> str:
        """Note the first attempt as soon as it begins; it is lost with another start."""
        if not (self._begun or self.bar):
            self._days.note(Attempt(self.line))
            self.stake = texts.DAILY_STAKE, texts.DAILY_STAKE_MORE
        self._begun = True
        return ""

    def note_end(self, flight: Flight, credit: Credit) -> None:
        self.stake = None

    def written(self, entry: Entry) -> str:
        """Note how the first attempt ended; return what went wrong with that."""
        self._days.add(entry)
        if self.bar:
            return ""
        self._days.note(self._attempt(entry))
        return self._days.problem

    def message(self, record: Record) -> tuple[str, str]:
        """Return the result in a line, which tells nothing of the way."""
        kind = "practice" if self.bar else "eased" if record.entry.barred else "first"
        line = self._attempt(record.entry).line_as(kind)
        return line, texts.CODE_LINE_COPIED.format(line=line)

    def _attempt(self, entry: Entry) -> Attempt:
        return Attempt(self.line, entry.outcome, entry.score, entry.barred, entry.file, entry.intact)


class DaysScene(PanelScene):
    """Days in a list, today first; beside it, or below, the chosen one.

    Attributes:
        days: what is listed.

    """

    def __init__(self, context: Context, today: date | None = None) -> None:
        super().__init__(context)
        self._today = self.chosen = today or date.today()
        self.enter()

    def enter(self) -> None:
        self._attempts = Days(self.context.user_dir)
        if self._attempts.problem:
            self.context.note(self._attempts.problem)
        known = {date.fromisoformat(day) for day in self._attempts.attempts} | {self._today, self._today - _DAY}
        self.days = sorted((day for day in known if day <= self._today), reverse=True)[:_SHOWN]
        self.build()

    def describe(self, panel: Panel) -> None:
        panel.title(texts.DAILY)
        panel.gap(8)
        left, self._beside = panel.beside((5, 4), _LEAST)
        rows, index = [self._row(day) for day in self.days], self.days.index(self.chosen)
        left.listing(rows, lambda _: self._fly(), around=_AROUND, index=index, on_choose=self._choose, columns=_COLUMNS)
        self._describe_day(self._beside)

    def _describe_day(self, column: Column) -> None:
        attempt, today = self._attempt(self.chosen), self.chosen == self._today
        self._flown = self._attempts.first_flight(self.chosen)
        column.title(self._name(self.chosen), TITLE + 6)
        column.text(attempt.line if attempt else texts.DAYS_ASKS if today else texts.DAYS_MISSED_LINE)
        column.gap(10)
        fly = (texts.DAYS_FLY_AGAIN if attempt else texts.DAYS_FLY) if today else texts.DAYS_FLY_PAST
        column.button(fly, self._fly, size=TITLE, colour=INK)
        if attempt:
            column.button(texts.DAYS_COPY, self._copy_line)
        if self._flown:
            column.button(texts.CODE_COPY, partial(copy, self.context, self._flown))
            column.button(texts.LOGBOOK_WATCH, self._watch)

    def actions(self) -> Table:
        return [self.form.moves, *super().actions()]

    def _choose(self, index: int) -> None:
        self.chosen = self.days[index]
        self._beside.clear()
        self._describe_day(self._beside)

    def _attempt(self, day: date) -> Attempt | None:
        return self._attempts.attempts.get(day.isoformat())

    def _row(self, day: date) -> Row:
        attempt = self._attempt(day)
        if attempt is None:
            return self._name(day), texts.DAYS_NOT_FLOWN if day == self._today else texts.DAYS_MISSED, "–"
        result = texts.DAYS_LEFT if attempt.outcome == Outcome.FLYING.name else attempt.result
        return self._name(day), result, f"{attempt.score}" if attempt.outcome == Outcome.LANDED.name else "–"

    def _name(self, day: date) -> str:
        return {self._today: texts.DAYS_TODAY, self._today - _DAY: texts.DAYS_YESTERDAY}.get(day, day.isoformat())

    def _fly(self) -> Transition:
        challenge = DailyStart(self.chosen, self._attempts, past=self.chosen != self._today)
        return push("play", challenge.seed, challenge=challenge)

    def _copy_line(self) -> None:
        if attempt := self._attempt(self.chosen):
            give(self.context, attempt.line, texts.CODE_LINE_COPIED.format(line=attempt.line))

    def _watch(self) -> Transition:
        return push("replay", self._flown)
