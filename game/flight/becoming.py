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
    """Whether a flight tells how often the player would land alone.

    It does if it was flown alone and counts, or if nothing but a guardian helped, from beginning to end; in missions
    guardians have not been measured.
    """
    if entry.practice:
        return False
    return entry.alone or (entry.barred == "helped" and entry.guarded > 0 and not entry.course)


class Becoming:
    """Estimates from the player's flights, oldest first.

    Attributes:
        flights: for each kind of start, the flights that tell something.
        curves: the estimate after each of them.

    """

    def __init__(self, entries: Iterable[Entry] = ()) -> None:
        self._beliefs = {kind: LandingAlone() for kind in KINDS}
        self.flights: dict[str, list[Entry]] = {kind: [] for kind in KINDS}
        self.curves: dict[str, list[Estimate]] = {kind: [] for kind in KINDS}
        told = [entry for entry in entries if tells(entry)]
        for kind in KINDS:
            for entry in [entry for entry in told if kind_of(entry) == kind][-_MOST:]:
                self._add(entry)

    def estimate(self, kind: str) -> Estimate:
        """Return the latest estimate for a kind of start."""
        return self._beliefs[kind].estimate

    def _add(self, entry: Entry) -> None:
        """Learn from a flight that tells something."""
        kind = kind_of(entry)
        belief = self._beliefs[kind]
        if entry.alone:
            belief.add_alone(landed=entry.landed)
        else:
            changed = (1.0 - entry.human) * entry.seconds
            belief.add_helped(landed=entry.landed, changed=changed, assist=entry.guarded)
        self.flights[kind].append(entry)
        self.curves[kind].append(belief.estimate)


def said(estimate: Estimate) -> str:
    """Return an estimate in words, with its uncertainty."""
    if not estimate.known:
        return texts.BECOMING_TOO_FEW.format(count=estimate.alone)
    low, mean, high = (round(10 * share) for share in (estimate.low, estimate.mean, estimate.high))
    if low == high:
        return texts.BECOMING_SURE.format(share=mean)
    return texts.BECOMING_ESTIMATE.format(share=mean, low=low, high=high)
