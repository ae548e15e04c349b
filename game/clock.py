"""Turns the frames' uneven time into even steps."""

from __future__ import annotations

from typing import Final

STEP: Final = 1 / 60


class FixedStep:
    """Counts the steps of 1/60 s that are due, and how far the next one has come.

    A long frame is caught up with at most `limit` steps; the rest of it is forgotten, so that a slow
    machine runs slowly instead of falling ever further behind.
    """

    def __init__(self, limit: int = 5) -> None:
        self.limit = limit
        self._remainder = 0.0

    @property
    def alpha(self) -> float:
        """Fraction, 0 to 1, of the next step that has passed."""
        return min(self._remainder / STEP, 1.0)

    def advance(self, seconds: float) -> int:
        """Let time pass and return how many steps are due."""
        self._remainder = min(self._remainder + max(seconds, 0.0), self.limit * STEP)
        # A hair of tolerance: sixty frames of 1/60 s are sixty steps, whatever the rounding.
        steps = int(self._remainder / STEP + 1e-9)
        self._remainder = max(self._remainder - steps * STEP, 0.0)
        return steps
