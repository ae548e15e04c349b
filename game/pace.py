"""The pace of time: slower for a moment, or as long as the player wishes; in whole physics steps as ever."""

from __future__ import annotations

from typing import Final

_SLOW: Final = 0.35  # of time's pace, in slow motion
_HELD: Final = 40  # updates of 1/60 s
_BACK: Final = 22  # updates in which it comes back


class Pace:
    """Says in which updates a step of the world is due. Nothing is left out: a step is only waited for.

    Attributes:
        usual: steps to an update outside of slow motion, at most 1.

    """

    def __init__(self, usual: float = 1.0) -> None:
        self.usual = usual
        self._left = 0
        self._due = 0.0

    @property
    def slow(self) -> bool:
        """Whether it is slow motion now."""
        return self._left > 0

    @property
    def rate(self) -> float:
        """Steps to an update."""
        if not self.slow:
            return self.usual
        gone = 1 - min(self._left, _BACK) / _BACK
        return self.usual * (_SLOW + (1 - _SLOW) * gone * gone * (3 - 2 * gone))

    def slow_down(self) -> None:
        """Begin slow motion."""
        self._left = _HELD + _BACK

    def hurry(self) -> None:
        """Be done with it."""
        self._left = 0

    def due(self) -> bool:
        """Let an update pass; whether a step of the world is due in it."""
        rate = self.rate
        self._left -= self.slow
        if rate >= 1:
            self._due = 0.0
            return True
        self._due += rate
        step = self._due >= 1
        self._due -= step
        return step

    def between(self, alpha: float) -> float:
        """How far to draw from the last step but one to the last, where `alpha` of an update has passed."""
        return min(1.0, self._due + alpha * self.rate)
