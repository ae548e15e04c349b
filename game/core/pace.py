"""Pace of a flight: the time scale the player chose, and moments of slow motion, in whole physics steps."""

from __future__ import annotations

from typing import Final

from game.core.clock import TimeScale

_SLOW: Final = 0.35  # time scale in slow motion, as a share of the pace
_HELD: Final = 40  # updates of 1/60 s at full slow motion
_BACK: Final = 22  # updates in which the pace returns to normal


class SlowMotion(TimeScale):
    """Time scale with slow motion. No step is left out; steps only come later."""

    def __init__(self, rate: float = 1.0) -> None:
        super().__init__(rate)
        self._left = 0

    @property
    def slow(self) -> bool:
        """Whether slow motion is on."""
        return self._left > 0

    @property
    def now(self) -> float:
        """Steps per update at this moment."""
        if not self.slow:
            return self.rate
        gone = 1 - min(self._left, _BACK) / _BACK
        return self.rate * (_SLOW + (1 - _SLOW) * gone * gone * (3 - 2 * gone))

    def begin(self) -> None:
        """Reset the fraction of the next step, and end slow motion."""
        super().begin()
        self.hurry()

    def slow_down(self) -> None:
        """Begin slow motion."""
        self._left = _HELD + _BACK

    def hurry(self) -> None:
        """End slow motion at once."""
        self._left = 0

    def steps(self) -> int:
        """Count one update, and return the number of steps due in it."""
        steps = super().steps()
        self._left -= self.slow
        return steps
