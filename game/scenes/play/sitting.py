"""A sitting: what a flight after others has on its card: their scores, the first landing, an offer of help."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import Final

from ai.flights.verification import landing_score
from ai.lander.environment import Outcome
from game.core import texts
from game.flight.choosers import Crew
from game.flight.flight import Flight
from game.flight.flight_file import Entry
from game.flight.outcomes import OutcomeCard
from game.scenes.play.flown_flight import FlownFlight

CRASHES: Final = 3  # in a row, after which help is offered


class Sitting:
    """Flights one after another; `entries` are the logbook before.

    Attributes:
        offers: whether the card in view offers help.
        first: whether it is that of the player's first landing alone.

    """

    def __init__(self, entries: Iterable[Entry]) -> None:
        self._landed_before = any(entry.landed and not entry.bar for entry in entries)
        self._best_here: dict[tuple[int, str, int], int] = {}  # scores of one's own landings by their starts
        self.first = False
        self.begin()

    def begin(self) -> None:
        """Count crashes anew."""
        self._crashes, self.offers = 0, False

    def best_here(self, flight: Flight[Crew]) -> int:
        return self._best_here.get(_start(flight), 0)

    def add(self, flown: FlownFlight) -> None:
        landed = flown.flight.outcome is Outcome.LANDED
        counts = flown.credit.counts and landed and flown.challenge.kept
        self.first = counts and not self._landed_before
        if counts:
            score, here = landing_score(flown.flight.env), _start(flown.flight)
            self._best_here[here] = max(score, self.best_here(flown.flight))
            self._landed_before = True
        self._crashes = 0 if landed else self._crashes + (not flown.flight.intact)
        there = flown.flight.chooser.copilot is not None and not flown.credit.alone
        self.offers = self._crashes >= CRASHES and there and flown.helped.help == "off"

    def card(self, card: OutcomeCard) -> OutcomeCard:
        """Return the flight's card, with what is to be said after those before."""
        if self.first:
            card = replace(card, title=texts.FIRST_LANDING, reason=texts.FIRST_LANDING_LINE)
        return replace(card, advice=texts.HELP_OFFER) if self.offers else card


def _start(flight: Flight[Crew]) -> tuple[int, str, int]:
    return flight.recording.seed, flight.recording.spawn, flight.recording.pads
