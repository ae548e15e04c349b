"""The player's skill according to the logbook, for check flights and a skill curve."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

from game.flight.flight_file import Entry
from game.flight.logbook import RECENT_OWN, skill

CHECK_EVERY: Final = 5


class Skill:
    """Skill of a player from their free flights from anywhere, oldest first; missions have their own figures."""

    def __init__(self, entries: Iterable[Entry]) -> None:
        self.entries = [entry for entry in entries if _counts(entry)]

    def add(self, entry: Entry) -> None:
        """Add a flight that has just ended."""
        self.entries += [entry] * _counts(entry)

    @property
    def check_due(self) -> bool:
        """Whether the next flight is a check flight: all flights of the last `CHECK_EVERY` - 1 were helped."""
        last = self.entries[1 - CHECK_EVERY :]
        return len(last) == CHECK_EVERY - 1 and not any(entry.alone for entry in last)

    @property
    def best(self) -> int:
        """Highest score without help so far; 0 before any landing."""
        return max((entry.score for entry in self.entries if entry.alone), default=0)

    @property
    def own(self) -> list[bool]:
        """Results of the flights without help: whether each landed."""
        return [entry.landed for entry in self.entries if entry.alone]

    @property
    def curve(self) -> list[float]:
        """Skill curve: share of landings, 0 to 1, among the last `RECENT_OWN` flights without help, after each."""
        return skill(self.entries, RECENT_OWN)


def _counts(entry: Entry) -> bool:
    return not (entry.course or entry.practice or entry.on_ladder)
