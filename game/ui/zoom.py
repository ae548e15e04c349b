"""Zoom of charts: the part of their common x axis that is shown."""

from __future__ import annotations

from typing import Final

from game.ui.plotting import Limits

MOST: Final = 64.0  # times that the axis can be stretched
STEP: Final = 1.25  # times for a notch of the wheel, or a press of + or -
_WORD_MOST: Final = 8.0  # times to which a press of the word leads, by doubling; the next shows the whole axis


class Zoom:
    """Part of an axis from 0 to its `end`, which grows as a run goes on; a part that reaches the end goes with it."""

    def __init__(self) -> None:
        self.end = 1.0
        self.reset()

    def reset(self) -> None:
        """Show the whole axis."""
        self.factor, self._middle = 1.0, 1.0  # the middle in units of the axis; the end, if it is beyond that

    @property
    def shown(self) -> Limits:
        """Ends of the part that is shown."""
        half = self.end / self.factor / 2
        middle = min(max(self._middle, half), self.end - half)
        return middle - half, middle + half

    def by(self, factor: float, about: float | None = None) -> None:
        """Stretch the axis by a factor; `about`, by default the middle, stays where it is."""
        start, end = self.shown
        held = (start + end) / 2 if about is None else about
        share = (held - start) / (end - start)
        follows = end >= self.end and about is None
        self.factor = min(max(self.factor * factor, 1.0), MOST)
        width = self.end / self.factor
        self._middle = held + (0.5 - share) * width
        if follows or self._middle + width / 2 >= self.end:
            self._middle = float("inf")
        if self.factor == 1.0:
            self.reset()

    def double(self, about: float | None = None) -> None:
        """Stretch the axis to the next double, and after a few of them show the whole of it again."""
        if self.factor >= _WORD_MOST:
            self.reset()
        else:
            self.by(2.0, about)

    def reach(self, x: float) -> None:
        """Move the part so that x is in it."""
        start, end = self.shown
        if not start <= x <= end:
            self._middle = x
