"""Who the player is becoming: how often they would land alone, by kind of start, after each of their flights."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

from ai.copilot.alone import Estimate, LandingAlone
from game.core import texts
from game.flight.flight_file import Entry

KINDS: Final = ("plain", "ladder", "hills", "missions")  # keys of `texts.BECOMING_KINDS`
_MOST: Final = 300  # latest flights of a kind that are looked at: older ones are forgotten anyway


def kind_of(entry: Entry) -> str:
    """Return the kind of start of a flight, one of `KINDS`."""
    if entry.course:
        return "missions"
    return "hills" if entry.pads > 1 else "ladder" if entry.on_ladder else "plain"


def tells(entry: Entry) -> bool:
    """Whether a flight tells how often the player would land alone: they flew all of it, under the usual rules."""
    return entry.alone and not entry.practice


def curves(entries: Iterable[Entry]) -> dict[str, list[Estimate]]:
    """Return for each kind of start the estimate before any flight, and after each that tells something."""
    told = [entry for entry in entries if tells(entry)]
    return {kind: _curve([entry for entry in told if kind_of(entry) == kind][-_MOST:]) for kind in KINDS}


def _curve(flights: Iterable[Entry]) -> list[Estimate]:
    belief = LandingAlone()
    found = [belief.estimate]
    for entry in flights:
        belief.add(landed=entry.landed)
        found.append(belief.estimate)
    return found


def said(estimate: Estimate) -> str:
    """Return an estimate in words, with its uncertainty."""
    if not estimate.known:
        return texts.BECOMING_TOO_FEW.format(count=estimate.flights)
    low, mean, high = (round(10 * share) for share in (estimate.low, estimate.mean, estimate.high))
    if low == high:
        return texts.BECOMING_SURE.format(share=mean)
    return texts.BECOMING_ESTIMATE.format(share=mean, low=low, high=high)
