"""Fixed-step clock: turns uneven frame times into even steps, and those into steps at another pace."""

from __future__ import annotations

from typing import Final

STEP: Final = 1 / 60
_SLOW: Final = 0.35  # time scale in slow motion, as a share of the rate
_HELD: Final = 40  # updates of 1/60 s at full slow motion
_BACK: Final = 22  # updates in which the rate returns to normal


class FixedStep:
    """Fixed-timestep accumulator: counts the steps of 1/60 s that are due, and the fraction of the next one.

    A long frame is caught up with at most `limit` steps; the rest of it is dropped, so that a slow
    machine runs slowly instead of falling ever further behind.
    """

    def __init__(self, limit: int = 5) -> None:
        self.limit = limit
        self._remainder = 0.0

    @property
    def alpha(self) -> float:
        """Fraction of the next step that has passed, 0 to 1; for interpolation when drawing."""
        return min(self._remainder / STEP, 1.0)

    def advance(self, seconds: float) -> int:
        """Add the time that has passed, in seconds, and return the number of steps that are due."""
        self._remainder = min(self._remainder + max(seconds, 0.0), self.limit * STEP)
        # A hair of tolerance: sixty frames of 1/60 s are sixty steps, whatever the rounding.
        steps = int(self._remainder / STEP + 1e-9)
        self._remainder = max(self._remainder - steps * STEP, 0.0)
        return steps


class TimeScale:
    """Time scale of a scene: how many of its steps are due in an update of 1/60 s; and moments of slow motion.

    No step is left out; in slow motion, steps only come later.

    Attributes:
        rate: steps per update; may be a fraction.

    """

    def __init__(self, rate: float = 1.0) -> None:
        self.rate = rate
        self._due = 0.0
        self._slow = 0  # updates of slow motion that are left

    @property
    def slow(self) -> bool:
        """Whether slow motion is on."""
        return self._slow > 0

    @property
    def now(self) -> float:
        """Steps per update at this moment."""
        gone = 1 - min(self._slow, _BACK) / _BACK
        return self.rate * (_SLOW + (1 - _SLOW) * gone * gone * (3 - 2 * gone)) if self.slow else self.rate

    def begin(self) -> None:
        """Reset the fraction of the next step that has passed, and end slow motion."""
        self._due, self._slow = 0.0, 0

    def slow_down(self) -> None:
        """Begin slow motion."""
        self._slow = _HELD + _BACK

    def hurry(self) -> None:
        """End slow motion at once."""
        self._slow = 0

    def steps(self) -> int:
        """Count one update, and return the number of steps due in it."""
        self._due = self.now + (self._due if self.now % 1 else 0.0)  # whole steps leave nothing over
        steps = int(self._due)
        self._due -= steps
        self._slow -= self.slow
        return steps

    def between(self, alpha: float) -> float:
        """Interpolation between the last two steps, 0 to 1, once the fraction `alpha` of an update has passed."""
        return min(1.0, self._due + alpha * self.now)
