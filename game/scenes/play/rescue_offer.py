"""Offer of help after three crashes in a row: one key sets it to guard."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

from ai.lander.environment import Outcome
from game.core import texts
from game.core.settings import Settings
from game.flight.credit import Credit
from game.flight.flight import Flight
from game.flight.outcomes import OutcomeCard
from game.scenes.play.help_words import choose

CRASHES: Final = 3


class RescueOffer:
    """Counts the crashes in a row, of flights that the player brought to their end.

    Attributes:
        made: whether the card in view makes the offer.

    """

    def __init__(self) -> None:
        self._crashes = 0
        self.made = False

    def follow(self, flight: Flight, credit: Credit, card: OutcomeCard, helped: Settings) -> OutcomeCard:
        """Count a finished flight; return its card, which makes the offer once it is time and there is help."""
        self._crashes = 0 if flight.outcome is Outcome.LANDED else self._crashes + (not flight.intact)
        there = flight.copilot is not None and not credit.alone
        self.made = self._crashes >= CRASHES and there and helped.assist == 0
        return replace(card, advice=texts.HELP_OFFER) if self.made else card

    def accept(self, helped: Settings) -> None:
        """Set the help, and count anew."""
        choose(helped, "guard")
        self._crashes, self.made = 0, False
