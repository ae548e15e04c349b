"""A sitting: what a flight after others has on its card: their scores, the first landing, an offer of help."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Final

from ai.flights.verification import landing_score
from ai.lander.environment import Outcome
from game.core import texts
from game.flight.flight_file import Entry
from game.flight.logbook import best_alone
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
        self._best = best_alone(entries)
        self._best_here: dict[str, int] = {}  # scores of one's own landings by their starts
        self.begin()

    def begin(self) -> None:
        """Count crashes anew."""
        self._crashes, self.offers = 0, False

    def add(self, flown: FlownFlight, card: OutcomeCard) -> bool:
        """Count a flight that has ended, and add to its card; return whether it is the player's first landing alone."""
        flight, landed = flown.flight, flown.flight.outcome is Outcome.LANDED
        self._crashes = 0 if landed else self._crashes + flight.wrecked
        there = flight.chooser.copilot is not None and not flown.credit.alone
        self.offers = self._crashes >= CRASHES and there and flown.helped.help == "off"
        if self.offers:
            card.advice = texts.HELP_OFFER
        if not flown.challenge.rules.kept:
            return False
        here, score = str(flight.recording.start()), landing_score(flight.env)
        if best := self._best_here.get(here, 0):
            card.compared = {texts.CARD_BEST_HERE: texts.SCORE.format(count=best), **card.compared}
        if not (landed and flown.credit.counts):
            return False
        if flown.challenge.rules.free and rung_of(flight) is None:
            if score > self._best > 0:
                card.score = texts.SCORE_BEST.format(count=score)
            self._best = max(self._best, score)
        self._best_here[here] = max(score, best)
        first, self._landed_before = not self._landed_before, True
        if first:
            card.title, card.reason = texts.FIRST_LANDING, texts.FIRST_LANDING_LINE
        return first
