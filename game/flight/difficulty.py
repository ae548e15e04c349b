"""Difficulty of a flight: changes of gravity, and assists."""

from __future__ import annotations

from game.core import texts
from game.core.settings import Settings
from game.flight.assists import Assists
from game.flight.flight import Flight


class Difficulty:
    """Difficulty of one flight, from the settings. Gravity can be chosen in free flights alone.

    Attributes:
        assists: what makes it easier to fly.

    """

    def __init__(self, settings: Settings, flight: Flight, *, free: bool) -> None:
        self._settings, self._flight, self._free = settings, flight, free
        self.assists = Assists(settings, flight)

    def heed(self) -> None:
        """Apply the player's settings to the next step."""
        if self._free:
            self._flight.set_gravity(self._settings.gravity)
        self.assists.heed()

    @property
    def practice(self) -> bool:
        """Whether the flight is not to be ranked, or will not be after its next step, for its gravity is another."""
        return bool(self._flight.recording.gravity) or self._gravity != 1

    @property
    def words(self) -> str:
        """Sentence on what differs from normal, now or before; empty if nothing does."""
        words = [self.assists.line] if self.assists.line else []
        if self.practice:
            words.insert(0, texts.PRACTICE)
        if self._gravity != 1:
            words.insert(1, texts.PRACTICE_GRAVITY.format(percent=round(100 * self._gravity)))
        return texts.DIAL_JOIN.join(words)

    @property
    def _gravity(self) -> float:
        """Share of normal gravity in the next step; after the flight, in the last."""
        recording = self._flight.recording
        if self._free and not self._flight.over:
            return self._settings.gravity
        return recording.gravity_at(len(recording.actions))
