"""Today's flight: its first attempt counts, later ones are practice beside a ghost."""

from __future__ import annotations

from datetime import date
from typing import TYPE_CHECKING

from ai.flights.recording import Recording
from ai.flights.verification import DAILY
from game.core import texts
from game.flight.days import Attempt, Days
from game.flight.flight_file import Entry
from game.flight.replay import replayed
from game.scenes.play.challenge import Challenge, Start, Wanted, Words
from game.scenes.play.ghost import Ghost

if TYPE_CHECKING:
    from game.scenes.play.flown_flight import FlownFlight


class DailyStart(Challenge):
    """Today's flight, the same for everybody, without a network to help.

    Args:
        day: the day.
        days: the player's first attempts.

    """

    name = DAILY

    def __init__(self, day: date, days: Days) -> None:
        super().__init__(alone=True)
        self.seed, self.line = day.toordinal(), day.isoformat()
        self._day, self._days = day, days
        self._begun = False
        self._look()

    def _look(self) -> None:
        if self.line in self._days.attempts:
            self.rules.bar = "day_again"

    def words(self, flown: FlownFlight) -> Words:
        kind = "practice" if self.rules.bar else "eased" if flown.credit.bar else "first"
        result = self._attempt(flown.record.entry).line_as(kind) if flown.record else ""
        return Words(
            texts.DAILY, self.line, opening=texts.DAILY_AGAIN_BEGIN if self.rules.bar else texts.DAILY_FIRST_BEGIN,
            stake=(texts.DAILY_STAKE, texts.DAILY_STAKE_MORE), result=result,
            card=lambda card: card.compared.update({texts.DAILY: texts.DAILY_ATTEMPTS[kind]}),
        )  # fmt: skip

    def start(self, wanted: Wanted) -> Start:
        """Begin with three pads among hills; in practice, beside the player's best flight of the day."""
        self._begun = self.rules.staked = False
        self._look()
        record = self._days.best_flight(self._day) if self.rules.bar else None
        ghost = Ghost(replayed(record.recording), lambda: texts.DAILY_GHOST) if record else None
        return Start(Recording(self.seed, "random", 3, easing=wanted.easing), ghost)

    def stepped(self, flown: FlownFlight) -> str:
        """Note the first attempt as soon as it begins; it is lost with another start."""
        if not (self._begun or self.rules.bar):
            self._days.note(Attempt(self.line))
            self.rules.staked = True
        self._begun = True
        return ""

    def ended(self, flown: FlownFlight) -> None:
        """Note how the first attempt ended."""
        self.rules.staked = False
        entry = flown.keep()
        if not self.rules.bar:
            self._days.note(self._attempt(entry))
            if self._days.problem:
                flown.context.note(self._days.problem)

    def _attempt(self, entry: Entry) -> Attempt:
        return Attempt(self.line, entry.outcome, entry.score, entry.barred, entry.file, entry.intact)
