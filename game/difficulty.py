"""What makes a flight easier or harder than flights are: another gravity, another pace of time."""

from __future__ import annotations

from game import texts
from game.flight import Flight
from game.settings import Settings


class Difficulty:
    """Heeds the settings while one flight is flown. In a course only the pace can be chosen.

    Attributes:
        slowest: the slowest pace that any of the flight was flown at.

    """

    def __init__(self, settings: Settings, flight: Flight, *, free: bool) -> None:
        self._settings, self._flight, self._free = settings, flight, free
        self.slowest = 1.0

    def heed(self) -> None:
        """Let the next step be flown as the player has chosen."""
        if self._free:
            self._flight.set_gravity(self._settings.gravity)
        self.slowest = min(self.slowest, self._settings.pace)

    @property
    def practice(self) -> bool:
        """Whether the flight is not to be counted among the best."""
        return self.slowest != 1 or bool(self._flight.recording.gravity)

    @property
    def words(self) -> str:
        """What differs now, or did; empty if nothing does."""
        gravity = self._flight.recording.gravity_at(len(self._flight.recording.actions))
        shares = ((texts.PRACTICE_GRAVITY, self._settings.gravity if self._free else gravity),
                  (texts.PRACTICE_PACE, self._settings.pace))  # fmt: skip
        told = [text.format(percent=round(100 * share)) for text, share in shares if share != 1]
        return texts.DIAL_JOIN.join([texts.PRACTICE, *told]) if told or self.practice else ""
