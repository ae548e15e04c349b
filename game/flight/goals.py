"""Goals of a player who has left the ladder, which grow with their landings, and their bests of the day and week."""

from __future__ import annotations

from collections.abc import Iterable
from datetime import date
from typing import Final

from game.core import texts
from game.flight.flight_file import Entry

# A figure of a landing's line in the logbook, and what it is to reach: points at least, engine and time at most.
GOALS: Final = (
    ("score", 80.0), ("fuel", 4.5), ("seconds", 12.0), ("score", 90.0), ("fuel", 3.5), ("seconds", 10.0),
    ("score", 95.0), ("fuel", 3.0), ("seconds", 9.0), ("score", 98.0),
)  # fmt: skip


class Goals:
    """The player's own landings in free flights from anywhere, and what is to be reached next."""

    def __init__(self, entries: Iterable[Entry] = ()) -> None:
        self._landings: list[Entry] = []
        for entry in entries:
            self.add(entry)

    def add(self, entry: Entry) -> bool:
        """Count a flight; return whether it is a landing that counts here."""
        counts = entry.landed and entry.alone and not (entry.course or entry.on_ladder)
        if counts:
            self._landings.append(entry)
        return counts

    @property
    def next(self) -> str:
        """The first goal that no landing has reached yet, as a sentence; empty after the last."""
        for name, value in GOALS:
            figures = [getattr(each, name) for each in self._landings]
            if not any(figure >= value if name == "score" else figure <= value for figure in figures):
                return texts.GOALS[name].format(value=value)
        return ""

    def bests(self, now: float) -> dict[str, str]:
        """Return the best scores of this day and week, by their names on the card."""
        today = date.fromtimestamp(now)
        days = [(date.fromtimestamp(each.when), each.score) for each in self._landings]
        spans = {
            texts.CARD_TODAY: [score for day, score in days if day == today],
            texts.CARD_WEEK: [score for day, score in days if day.isocalendar()[:2] == today.isocalendar()[:2]],
        }
        return {name: texts.SCORE.format(count=max(scores)) for name, scores in spans.items() if scores}
