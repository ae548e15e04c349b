"""Rescues of a flight: how often a guardian that holds a plan has changed what the person asked for."""

from __future__ import annotations

from typing import Final

from ai.lander.environment import Outcome
from game.flight.flight import Flight

_CALM: Final = 60  # steps without a change after which another one is another rescue


class Rescues:
    """Rescues of one flight; call `follow` once after every step.

    A rescue is a stretch in which a guardian changes actions after which the flight was lost; within a second of each
    other they are the same one.

    Attributes:
        times: how many there were.
        guarded: whether the flight, or a part of it, was watched over by a guardian that goes by futures.
        throughout: assist of the guardian that watched over every step alike, 0 to 1; 0 if there was none.

    """

    def __init__(self) -> None:
        self.times, self.guarded = 0, False
        self.throughout: float = -1.0  # before the first step
        self._since = _CALM

    def follow(self, flight: Flight) -> bool:
        """Count the step just flown; return whether a rescue begins with it."""
        guards = flight.shared and flight.guarded
        self._since += 1
        assist = flight.decision.assist if guards and flight.decision is not None else 0.0
        self.throughout = assist if self.throughout in (-1.0, assist) else 0.0
        self.guarded |= guards
        if guards and flight.overridden and (flight.guard is None or flight.guard.saves):
            begins, self._since = self._since >= _CALM, 0
            self.times += begins
            return begins
        return False

    def saved(self, flight: Flight) -> int | None:
        """Return how often the person was saved in a flight that is over; None unless it was guarded and landed.

        None as well if something else was flown only because answers came late: nobody knows whether that was needed.
        """
        if not self.guarded or flight.outcome is not Outcome.LANDED:
            return None
        late = flight.guard.late if flight.guard else 0
        return None if late and not self.times else self.times
