"""Free flights, and the ladder of their starts: a new player's begin above the pad, farther out with every landing.

The ladder is a curriculum, as networks have one: a landing leads a rung up, two misses in a row a rung down. A player
who has reached its top flies from anywhere, and has left it.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import Final

from ai.lander.environment import Outcome
from ai.lander.spawns import LADDER, RUNGS
from game.core import texts
from game.core.settings import TOP_RUNG, Settings
from game.flight.choosers import Crew
from game.flight.credit import Credit
from game.flight.flight import Flight, Recording, StickHolder, begin
from game.flight.flight_file import Entry
from game.flight.logbook import ladder_rung
from game.flight.networks import Network, Policy, titled
from game.flight.outcomes import OutcomeCard
from game.scenes.play.challenge import Challenge

COUNT: Final = len(RUNGS)
MISSES: Final = 2  # in a row, after which the next flight begins nearer


class FreeFlight(Challenge):
    """One free flight after another, as the player has chosen; their place on the ladder is kept in the settings."""

    free = eases = guides = shadows = True
    fixed = False

    def __init__(self, settings: Settings) -> None:
        self._settings = settings
        self._misses = 0  # in a row, on this rung
        self._climbed = False
        self.word()

    def word(self) -> None:
        self.opening = texts.BEGIN

    def recall(self, entries: Iterable[Entry]) -> None:
        """Give players of before a place on the ladder, by their landings."""
        ladder_rung(self._settings, entries)

    def chosen(self) -> tuple[int, str]:
        """Return the number of pads, and the kind of start."""
        if self._settings.three_pads:
            return 3, "random"
        return 1, LADDER.spawn(max(0, self._settings.rung))  # progress can be put away during a flight

    def flight(self, seed: int, network: Policy | None, spawn: str = "") -> Flight[Crew]:
        pads, usual = self.chosen()
        return begin(Recording(seed, spawn or usual, pads, easing=self.easing), network)

    def dial(self, settings: Settings) -> Settings:
        return settings

    def titles(self, flight: Flight[Crew], network: Network, *, whole: bool) -> tuple[str, str]:
        """Return the rung or the number of pads, and who can take over."""
        helper = texts.WITH_NETWORK.format(network=titled(network.name)) if whole else ""  # else, a key says so
        flown = helper if flight.chooser.network else texts.ALONE
        if (rung := rung_of(flight)) is not None:
            return texts.LADDER_TITLE.format(number=rung + 1, count=COUNT), flown
        return texts.THREE_PADS if flight.recording.pads > 1 else texts.FREE_FLIGHT, flown

    def note_end(self, flight: Flight[Crew], credit: Credit) -> None:
        """Move a rung up after a landing, and down after two misses in a row.

        Only flights that the player has brought to their end move it, with help or without.
        """
        rung, settings = rung_of(flight), self._settings
        if rung is None:
            return
        mine, landed = flight.chooser.hand is StickHolder.HUMAN, flight.outcome is Outcome.LANDED
        if mine and landed:
            settings.rung, self._misses = rung + 1, 0
        elif mine and not flight.intact:
            self._misses += 1
            if self._misses >= MISSES:
                settings.rung, self._misses = max(0, rung - 1), 0
        self._climbed = settings.rung != rung

    def card(self, card: OutcomeCard, flight: Flight[Crew], credit: Credit) -> OutcomeCard:
        """Return the card, which says how the ladder was moved on."""
        rung, now = rung_of(flight), self._settings.rung
        if rung is None:
            return card
        # What a landing counts for, helped or not, is said once, by the line of the ladder.
        mine = flight.chooser.hand is StickHolder.HUMAN or not card.good
        reason = texts.OUTCOMES[Outcome.LANDED.name][1] if card.good else card.reason
        return replace(card, reason=reason, rung=now, climb=_words(rung, now) if mine else texts.LADDER_NOT_FLOWN)

    def remember(self, settings: Settings) -> bool:
        climbed, self._climbed = self._climbed, False
        return climbed


def rung_of(flight: Flight[Crew]) -> int | None:
    """Return on which rung a flight has begun, from 0; None if it was on none."""
    return LADDER.stage_of(flight.recording.spawn) if flight.recording.spawn in RUNGS else None


def _words(before: int, now: int) -> str:
    """Return what a flight has changed."""
    if now == TOP_RUNG:
        return texts.LADDER_TOP
    if now == before:
        return (texts.LADDER_STAYS if now else texts.LADDER_LOWEST).format(number=now + 1)
    return (texts.LADDER_UP if now > before else texts.LADDER_DOWN).format(number=now + 1)
