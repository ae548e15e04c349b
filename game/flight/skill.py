"""The player's skill according to the logbook, for check flights and a skill curve."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

from ai.copilot.alone import Estimate
from game.core import texts
from game.flight.becoming import Becoming, Change, kind_of
from game.flight.flight_file import Entry

CHECK_EVERY: Final = 5
CHECK_SELDOM: Final = 10  # where it is well known how often the player would land alone
_WELL_KNOWN: Final = 0.2  # width of the estimate's interval


class Skill:
    """Skill of a player from their free flights, oldest first; missions have their own figures.

    Attributes:
        becoming: how often the player would land alone, from all flights that tell something of it.
        change: what the latest flight has changed in that; None if nothing.

    """

    def __init__(self, entries: Iterable[Entry]) -> None:
        entries = list(entries)
        self.entries = [entry for entry in entries if _counts(entry)]
        self.becoming = Becoming(entries)
        self.change: Change | None = None
        self._since = 0  # flights before the last check flight that was skipped

    def add(self, entry: Entry) -> None:
        """Add a flight that has just ended."""
        self.entries += [entry] * _counts(entry)
        self.change = self.becoming.add(entry)

    def skip_check(self) -> None:
        """Leave out the check flight that is due; the next one comes after as many flights as usual."""
        self._since = len(self.entries)

    @property
    def check_due(self) -> bool:
        """Whether the next flight is a check flight: all flights since the last one were helped, and they were enough.

        Where it is well known how often the player would land alone, it takes more of them.
        """
        if not self.entries:
            return False
        estimate = self.becoming.estimate(kind_of(self.entries[-1]))
        every = CHECK_SELDOM if estimate.high - estimate.low <= _WELL_KNOWN else CHECK_EVERY
        last = self.entries[self._since :][1 - every :]
        return len(last) == every - 1 and not any(entry.alone for entry in last)

    @property
    def best(self) -> int:
        """Highest score without help so far; 0 before any landing."""
        return max((entry.score for entry in self.entries if entry.alone), default=0)

    @property
    def own(self) -> list[bool]:
        """Results of the flights without help: whether each landed."""
        return [entry.landed for entry in self.entries if entry.alone]


def _counts(entry: Entry) -> bool:
    return not (entry.course or entry.practice or entry.on_ladder)


def said(estimate: Estimate) -> str:
    """Return an estimate in words, with its uncertainty."""
    if not estimate.known:
        return texts.BECOMING_TOO_FEW.format(count=estimate.alone)
    low, high = tenths_of(estimate.low), tenths_of(estimate.high)
    mean = tenths_of(estimate.mean)
    if low == high:
        return texts.BECOMING_SURE.format(share=mean)
    return texts.BECOMING_ESTIMATE.format(share=mean, low=low, high=high)


def tenths_of(share: float) -> int:
    """Return of how many flights out of ten a share tells."""
    return round(10 * share)
