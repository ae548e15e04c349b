"""What makes a flight easier or harder than flights are: another gravity, another pace of time."""

from __future__ import annotations

from game.core import texts
from game.core.settings import Settings
from game.flight.flight import Flight


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
        """Whether the flight is not to be counted among the best, or will not be once its next step is flown."""
        return self.slowest != 1 or bool(self._flight.recording.gravity) or bool(self._eased)

    @property
    def words(self) -> str:
        """What differs now, or did; empty if nothing does."""
        return texts.DIAL_JOIN.join([texts.PRACTICE, *self._eased]) if self.practice else ""

    @property
    def _eased(self) -> list[str]:
        """What differs in the next step; once the flight is over, in its last one, and at its slowest."""
        over, recording = self._flight.over, self._flight.recording
        gravity = self._settings.gravity if self._free and not over else recording.gravity_at(len(recording.actions))
        shares = ((texts.PRACTICE_GRAVITY, gravity),
                  (texts.PRACTICE_PACE, self.slowest if over else self._settings.pace))  # fmt: skip
        return [text.format(percent=round(100 * share)) for text, share in shares if share != 1]
