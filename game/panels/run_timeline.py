"""Timeline of a run, from its beginning to now: a thin track with the moment that is shown."""

from __future__ import annotations

from typing import Final, Protocol

from game.core.scene import Transition
from game.drawing.canvas import Canvas
from game.drawing.tokens import FAINT, HUMAN, INK
from game.ui.widget import PointsManager, Widget

_END: Final = 8.0  # points from the box to the track, so that the handle stays inside


class Seekable(Protocol):
    """Run that can be shown at a share of its time, 0 to 1, which is now."""

    @property
    def share(self) -> float:
        """Place of what is shown."""

    def seek_share(self, share: float) -> None:
        """Show the moment there."""

    def shift(self, direction: int) -> None:
        """Go a step back (-1) or on (1)."""

    def clear(self) -> None:
        """Show now."""


class RunTimeline(Widget):
    """Timeline of a run: the mouse drags the handle, left and right step, and a press leads back to now."""

    def __init__(self, manager: PointsManager, box: tuple[float, float, float, float], run: Seekable) -> None:
        super().__init__(manager, box, "")
        self._run = run

    def press(self) -> Transition | None:
        """Show now; the mouse only drags."""
        if self.ringed:
            self._run.clear()
        return None

    def shift(self, direction: int) -> bool:
        """Go a step back or on."""
        self._run.shift(direction)
        return True

    def drag(self, x: float) -> None:
        """Show the moment under the mouse."""
        left, width = self._track
        self._run.seek_share(min(max((x - left) / width, 0.0), 1.0))

    @property
    def _track(self) -> tuple[float, float]:
        return self.box.left + _END, self.box.width - 2 * _END

    def paint(self, canvas: Canvas) -> None:
        """Draw the track and its handle: amber for a chosen moment, hollow for now."""
        super().paint(canvas)
        (left, width), y, share = self._track, self.box.centery, self._run.share
        canvas.pill((left, y - 1, width, 2), FAINT)
        if share < 1.0:
            canvas.dot((left + share * width, y), 5 + self.warmth, HUMAN)
        else:
            canvas.marker("ring", (left + width, y), 10 + 2 * self.warmth, INK)
