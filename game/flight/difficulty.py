"""Difficulty of a flight: changes of gravity and of the pace of time."""

from __future__ import annotations

from game.core import texts
from game.core.settings import Settings
from game.flight.flight import Flight


class Difficulty:
    """Difficulty of one flight, from the settings. In a mission only the pace can be chosen.

    Attributes:
        slowest: slowest pace so far in the flight.

    """

    def __init__(self, settings: Settings, flight: Flight, *, free: bool) -> None:
        self._settings, self._flight, self._free = settings, flight, free
        self.slowest = 1.0

    def heed(self) -> None:
        """Apply the player's settings to the next step."""
        if self._free:
            self._flight.set_gravity(self._settings.gravity)
        self.slowest = min(self.slowest, self._settings.pace)

    @property
    def practice(self) -> bool:
        """Whether the flight is not to be ranked, or will not be after its next step."""
        return self.slowest != 1 or bool(self._flight.recording.gravity) or bool(self._eased)

    @property
    def words(self) -> str:
        """Sentence on what differs from normal, now or before; empty if nothing does."""
        return texts.DIAL_JOIN.join([texts.PRACTICE, *self._eased]) if self.practice else ""

    @property
    def _eased(self) -> list[str]:
        """Differences in the next step; after the flight, the last step's gravity and the slowest pace."""
        over, recording = self._flight.over, self._flight.recording
        gravity = self._settings.gravity if self._free and not over else recording.gravity_at(len(recording.actions))
        shares = (
            (texts.PRACTICE_GRAVITY, gravity),
            (texts.PRACTICE_PACE, self.slowest if over else self._settings.pace),
        )
        return [text.format(percent=round(100 * share)) for text, share in shares if share != 1]
