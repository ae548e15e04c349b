"""The pace of a flight: as the player wishes it, and slower for a moment; in whole physics steps as ever."""

from __future__ import annotations

from typing import Final

from game.core.clock import Tempo

_SLOW: Final = 0.35  # of time's pace, in slow motion
_HELD: Final = 40  # updates of 1/60 s
_BACK: Final = 22  # updates in which it comes back


class Pace(Tempo):
    """A tempo with slow motion. Nothing is left out: a step is only waited for."""

    def __init__(self, rate: float = 1.0) -> None:
        super().__init__(rate)
        self._left = 0

    @property
    def slow(self) -> bool:
        """Whether it is slow motion now."""
        return self._left > 0

    @property
    def now(self) -> float:
        """Steps to an update at this moment."""
        if not self.slow:
            return self.rate
        gone = 1 - min(self._left, _BACK) / _BACK
        return self.rate * (_SLOW + (1 - _SLOW) * gone * gone * (3 - 2 * gone))

    def begin(self) -> None:
        """Forget what has passed of the next step, and slow motion."""
        super().begin()
        self.hurry()

    def slow_down(self) -> None:
        """Begin slow motion."""
        self._left = _HELD + _BACK

    def hurry(self) -> None:
        """Be done with it."""
        self._left = 0

    def steps(self) -> int:
        """Let an update pass, and return how many steps are due in it."""
        steps = super().steps()
        self._left -= self.slow
        return steps
