"""Turns the frames' uneven time into even steps, and those into steps at another pace."""

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


class Tempo:
    """A scene's own time: how many of its steps are due in an update of 1/60 s.

    Attributes:
        rate: steps to an update; may be a fraction.

    """

    def __init__(self, rate: float = 1.0) -> None:
        self.rate = rate
        self._due = 0.0

    @property
    def now(self) -> float:
        """Steps to an update at this moment."""
        return self.rate

    def begin(self) -> None:
        """Forget what has passed of the next step."""
        self._due = 0.0

    def steps(self) -> int:
        """Let an update pass, and return how many steps are due in it."""
        self._due = self.now + (self._due if self.now % 1 else 0.0)  # whole steps leave nothing over
        steps = int(self._due)
        self._due -= steps
        return steps

    def between(self, alpha: float) -> float:
        """How far to draw from the last step but one to the last, where `alpha` of an update has passed."""
        return min(1.0, self._due + alpha * self.now)
