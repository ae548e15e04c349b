"""Start of the day: its first attempt counts, later ones and those of past days are practice beside a ghost."""

from __future__ import annotations

from datetime import date

from ai.flights.verification import DAILY
from game.core import texts
from game.flight.days import Attempt, Days
from game.flight.flight import Flight
from game.flight.flight_file import Entry, Record
from game.flight.networks import Policy
from game.flight.replay import ReplayedFlight
from game.scenes.play.challenge import Challenge
from game.scenes.play.ghost import Ghost


class DailyStart(Challenge):
    """Start of a day, the same for everybody, without a network to help.

    Args:
        day: the day.
        days: the player's first attempts.
        past: whether the day is over.

    Attributes:
        bar: why the present flight is practice; empty for the first attempt of today.

    """

    name = DAILY
    alone = True
    eases = True

    def __init__(self, day: date, days: Days, *, past: bool = False) -> None:
        self.title, self.copy_hint = texts.DAILY, texts.DAILY_HINT_COPY
        self.seed, self.line = day.toordinal(), day.isoformat()
        self._day, self._days, self._past = day, days, past
        self._begun = False
        self._look()

    def _look(self) -> None:
        """See whether the next flight is the first attempt."""
        self.bar = "day_past" if self._past else "day_again" if self.line in self._days.attempts else ""
        self.opening = {
            "": texts.DAILY_FIRST_BEGIN, "day_again": texts.DAILY_AGAIN_BEGIN, "day_past": texts.DAILY_PAST_BEGIN,
        }[self.bar]  # fmt: skip

    def flight(self, seed: int, network: Policy | None) -> Flight:
        """Begin a flight with three pads among hills."""
        self._begun = False
        self._look()
        return Flight(self.seed, pads=3, easing=self.easing)

    def ghost(self, seed: int, network: Policy | None) -> Ghost | None:
        """Begin the player's best flight of that day as a ghost, in practice only."""
        record = self._days.best_flight(self._day) if self.bar else None
        name = texts.DAILY_GHOST if self._past else texts.DAILY_GHOST_TODAY
        return Ghost(ReplayedFlight(record.recording), name) if record else None

    def follow(self, flight: Flight) -> str:
        """Note the first attempt as soon as it begins."""
        if not self._begun and not self.bar:
            self._days.note(Attempt(self.line))
        self._begun = True
        return ""

    @property
    def stake(self) -> tuple[str, str] | None:
        """The first attempt is lost with another start."""
        return (texts.DAILY_STAKE, texts.DAILY_STAKE_MORE) if self._begun and not self.bar else None

    def written(self, entry: Entry) -> str:
        """Note how the first attempt ended; return what went wrong with that."""
        self._days.add(entry)
        if self.bar:
            return ""
        self._days.note(self._attempt(entry))
        return self._days.problem

    def message(self, record: Record) -> tuple[str, str]:
        """Return the result in a line, which tells nothing of the way."""
        entry = record.entry
        attempt = "practice" if self.bar else "eased" if entry.barred else "first"
        told = self._attempt(entry).told(attempt)
        return told, texts.CODE_LINE_COPIED.format(line=told)

    def _attempt(self, entry: Entry) -> Attempt:
        return Attempt(self.line, entry.outcome, entry.score, entry.barred, entry.file, entry.intact)
