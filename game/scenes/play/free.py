"""Free flights, and the ladder of their starts: a new player's begin above the pad, farther out with every landing.

The ladder is a curriculum, as networks have one: a landing leads a rung up, two misses in a row a rung down. A player
who has reached its top flies from anywhere, has left it, and has goals that grow.
"""

from __future__ import annotations

import time
from functools import partial
from typing import TYPE_CHECKING, Any, Final

from ai.flights.recording import Recording
from ai.lander.environment import Outcome
from ai.lander.spawns import LADDER, RUNGS
from game.core import texts
from game.core.settings import TOP_RUNG, Settings
from game.flight.flight import Flight
from game.flight.logbook import Goals
from game.flight.outcomes import OutcomeCard
from game.scenes.play.challenge import Challenge, Start, Wanted, Words

if TYPE_CHECKING:
    from game.scenes.play.flown_flight import FlownFlight

COUNT: Final = len(RUNGS)
MISSES: Final = 2  # in a row, after which the next flight begins nearer


class FreeFlight(Challenge):
    """One free flight after another, as the player has chosen; their place on the ladder is kept in the settings."""

    def __init__(self, settings: Settings, goals: Goals | None = None) -> None:
        super().__init__(free=True, fixed=False)
        self._settings, self._goals = settings, goals or Goals()
        self._counted = self._reached = False  # whether the last flight counts for the goals, and has reached one
        self._misses = self._now = 0  # misses in a row, on this rung; the rung after the last flight

    def words(self, flown: FlownFlight) -> Words:
        flight = flown.flight
        title, goal = texts.THREE_PADS if flight.recording.pads > 1 else texts.FREE_FLIGHT, self._goals.next
        if (rung := rung_of(flight)) is not None:
            title, goal = texts.LADDER_TITLE.format(number=rung + 1, count=COUNT), ""
        line = "" if flight.chooser.network else texts.ALONE
        return Words(title, line, goal, texts.BEGIN, card=partial(self._add_to, flown))

    def start(self, wanted: Wanted) -> Start:
        three, rung = self._settings.three_pads, max(0, self._settings.rung)  # progress can be put away in a flight
        usual = "random" if three else LADDER.spawn(rung)
        return Start(Recording(wanted.seed, wanted.spawn or usual, 3 if three else 1, easing=wanted.easing))

    def ended(self, flown: FlownFlight) -> None:
        """Move a rung up after an own landing, down after two misses in a row; off the ladder, count it for goals."""
        entry, before = flown.keep(), self._goals.next
        flight, settings = flown.flight, self._settings
        rung = rung_of(flight)
        if rung is None:
            self._counted = self._goals.add(entry)
            self._reached = self._goals.next != before
            return
        mine, landed = flown.credit.own, flight.outcome is Outcome.LANDED
        if mine and landed:
            settings.rung, self._misses = rung + 1, 0
        elif mine and not flight.intact:
            self._misses += 1
            if self._misses >= MISSES:
                settings.rung, self._misses = max(0, rung - 1), 0
        if settings.rung != rung:
            flown.context.apply_settings()
        self._now = settings.rung

    def _add_to(self, flown: FlownFlight, card: OutcomeCard) -> None:
        """Say how that has moved the player on."""
        rung = rung_of(flown.flight)
        if rung is not None:
            card.climb = _words(rung, self._now)
        elif self._counted:
            card.compared |= self._goals.bests(time.time())
            card.climb = texts.GOAL_REACHED.format(goal=self._goals.next).strip() if self._reached else ""


def rung_of(flight: Flight[Any]) -> int | None:
    """Return on which rung a flight has begun, from 0; None if it was on none."""
    return LADDER.stage_of(flight.recording.spawn) if flight.recording.spawn in RUNGS else None


def _words(before: int, now: int) -> str:
    """Return what a flight has changed."""
    if now == TOP_RUNG:
        return texts.LADDER_TOP
    if now == before:
        return (texts.LADDER_STAYS if now else texts.LADDER_LOWEST).format(number=now + 1)
    return (texts.LADDER_UP if now > before else texts.LADDER_DOWN).format(number=now + 1)
