"""A sitting: what a flight after others has on its card: the best score from its start, a record, an offer of help."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Final

from ai.flights.verification import landing_score
from ai.lander.environment import Outcome
from game.core import texts
from game.flight.flight_file import Entry
from game.flight.logbook import Goals
from game.scenes.play.free import rung_of

if TYPE_CHECKING:
    from game.flight.outcomes import OutcomeCard
    from game.scenes.play.flown_flight import FlownFlight

CRASHES: Final = 3  # in a row, after which help is offered


class Sitting:
    """Flights one after another; `entries` are the logbook before.

    Attributes:
        offers: whether the card in view offers help.

    """

    def __init__(self, entries: Iterable[Entry]) -> None:
        entries = list(entries)
        self._landed_before = any(entry.landed and not entry.bar for entry in entries)
        self._best = Goals(entries).best
        self._best_here: dict[str, int] = {}  # scores of one's own landings by their starts
        self._first = self._record = False
        self._score = self._before = 0  # of the flight that has ended last, and the best from its start before
        self.begin()

    def begin(self) -> None:
        """Count crashes anew."""
        self._crashes, self.offers = 0, False

    def add(self, flown: FlownFlight) -> None:
        """Count a flight that has ended."""
        flight, landed = flown.flight, flown.flight.outcome is Outcome.LANDED
        self._crashes = 0 if landed else self._crashes + flight.wrecked
        there = flight.chooser.copilot is not None and not flown.credit.alone
        self.offers = self._crashes >= CRASHES and there and flown.helped.help == "off"
        here, score = str(flight.recording.start()), landing_score(flight.env)
        counts = landed and flown.credit.counts and flown.challenge.rules.kept
        self._before, self._score = self._best_here.get(here, 0), score
        if counts:
            self._best_here[here] = max(score, self._before)
        ranked = counts and flown.challenge.rules.free and rung_of(flight) is None
        self._record = ranked and score > self._best > 0
        self._best = max(self._best, score) if ranked else self._best
        self._first, self._landed_before = counts and not self._landed_before, self._landed_before or counts

    def add_to(self, card: OutcomeCard) -> None:
        """Add to the card of that flight what those before it make of it."""
        if self._before:
            card.compared = {texts.CARD_BEST_HERE: texts.SCORE.format(count=self._before), **card.compared}
        if self._record:
            card.score = texts.SCORE_BEST.format(count=self._score)
        if self._first:
            card.title, card.reason = texts.FIRST_LANDING, texts.FIRST_LANDING_LINE
        if self.offers:
            card.advice = texts.HELP_OFFER
