"""A player's own skill, as the logbook tells it: for check flights, and a curve."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

from game.flight.flight_file import Entry
from game.flight.logbook import RECENT_OWN, skill

CHECK_EVERY: Final = 5


class Skill:
    """What a player's free flights say of them, oldest first; missions have figures of their own."""

    def __init__(self, entries: Iterable[Entry]) -> None:
        self.entries = [entry for entry in entries if _counts(entry)]

    def add(self, entry: Entry) -> None:
        """Count a flight that has just ended, too."""
        self.entries += [entry] * _counts(entry)

    @property
    def check_due(self) -> bool:
        """Whether the flights before the next one were all helped, as many as may be."""
        last = self.entries[1 - CHECK_EVERY :]
        return len(last) == CHECK_EVERY - 1 and not any(entry.alone for entry in last)

    @property
    def best(self) -> int:
        """The highest score without help so far, 0 before any landing."""
        return max((entry.score for entry in self.entries if entry.alone), default=0)

    @property
    def own(self) -> list[bool]:
        """Whether each flight without help landed."""
        return [entry.landed for entry in self.entries if entry.alone]

    @property
    def curve(self) -> list[float]:
        """Share of landings, 0 to 1, among the last few flights without help, after each of them."""
        return skill(self.entries, RECENT_OWN)


def _counts(entry: Entry) -> bool:
    return not (entry.course or entry.practice)
