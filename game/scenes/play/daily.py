"""Start of the day: its first attempt counts, later ones are practice beside a ghost."""

from __future__ import annotations

from datetime import date

from ai.flights.verification import DAILY
from game.core import texts
from game.flight.choosers import Crew
from game.flight.credit import Credit
from game.flight.days import Attempt, Days
from game.flight.flight import Flight, Recording, begin
from game.flight.flight_file import Entry, Record
from game.flight.networks import Policy
from game.flight.replay import replayed
from game.scenes.play.challenge import Challenge
from game.scenes.play.ghost import Ghost


class DailyStart(Challenge):
    """Start of a day, the same for everybody, without a network to help.

    Args:
        day: the day.
        days: the player's first attempts.

    """

    name = DAILY
    alone = eases = True

    def __init__(self, day: date, days: Days) -> None:
        self.seed, self.line = day.toordinal(), day.isoformat()
        self._day, self._days = day, days
        self._begun = False
        self._look()

    def word(self) -> None:
        self.title, self.copy_hint, self.eased_line = texts.DAILY, texts.DAILY_HINT_COPY, texts.DAILY_EASED
        self.opening = texts.DAILY_AGAIN_BEGIN if self.bar else texts.DAILY_FIRST_BEGIN

    def _look(self) -> None:
        if self.line in self._days.attempts:
            self.bar = "day_again"
        self.word()

    def flight(self, seed: int, network: Policy | None, spawn: str = "") -> Flight[Crew]:
        """Begin a flight with three pads among hills."""
        self._begun, self.stake = False, None
        self._look()
        return begin(Recording(self.seed, "random", 3, easing=self.easing))

    def ghost(self, seed: int, network: Policy | None) -> Ghost | None:
        """Begin the player's best flight of the day as a ghost, in practice only."""
        record = self._days.best_flight(self._day) if self.bar else None
        return Ghost(replayed(record.recording), lambda: texts.DAILY_GHOST) if record else None

    def follow(self, flight: Flight[Crew]) -> str:
        """Note the first attempt as soon as it begins; it is lost with another start."""
        if not (self._begun or self.bar):
            self._days.note(Attempt(self.line))
            self.stake = texts.DAILY_STAKE, texts.DAILY_STAKE_MORE
        self._begun = True
        return ""

    def note_end(self, flight: Flight[Crew], credit: Credit) -> None:
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
