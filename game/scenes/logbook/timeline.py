"""Timeline of a replay: who flew when, where the main engine fired, and the moment that is shown."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from itertools import groupby
from typing import Final, TypeVar

from ai.flights.recording import Recording, StickHolder
from game.core.scene import Transition
from game.drawing.canvas import Canvas
from game.drawing.cursor import Cursor
from game.drawing.paint_cache import PaintCache
from game.drawing.tokens import FAINT, HUMAN, INK, LINE, NET
from game.ui.widget import NOWHERE, RowWidget

V = TypeVar("V")
_HEIGHT: Final = 28.0
_MIDDLE: Final = 12.0  # of the strip, from the upper edge
_THIN, _THICK = 2.0, 8.0  # without and with the main engine
_STEP: Final = 6  # physics steps per press of an arrow key


class Timeline(RowWidget):
    """Strip of a flight in the colours of who flew, thick where the main engine fired.

    `on_go_to` is called with the step to show, `on_press` where keys or gamepad press it.
    """

    pad = 2.0

    def __init__(self, recording: Recording, on_go_to: Callable[[int], None], on_press: Callable[[], None]) -> None:
        super().__init__(NOWHERE, "")
        self.key = "strip"
        self._still = PaintCache()
        self._on_go_to, self._on_press = on_go_to, on_press
        self.length = max(1, len(recording.pushes))
        self.at = self.reached = 0
        self._runs = runs(zip(recording.hands, (push.main > 0 for push in recording.pushes), strict=True))

    def press(self) -> Transition | None:
        """Pause or resume; the mouse only goes to another step."""
        if self.ringed:
            self._on_press()
        return None

    def shift(self, direction: int) -> bool:
        self._on_go_to(self.at + _STEP * direction)
        return True

    def drag(self, x: float) -> None:
        self._on_go_to(round(self.length * (x - self.box.left) / self.box.width))

    def place(self, step: float) -> float:
        return self.box.left + self.box.width * min(max(step / self.length, 0.0), 1.0)

    def write(self, cursor: Cursor) -> None:
        cursor.take(_HEIGHT)
        if cursor.canvas:
            self._paint(cursor.canvas)

    def _paint(self, canvas: Canvas) -> None:
        middle, far, x = self.box.top + _MIDDLE, self.place(self.reached), self.place(self.at)
        self._still.draw(canvas, self.box, tuple(self.box), self._paint_runs)
        if far < self.box.right - 1:  # the part that is not computed yet
            canvas.fill(canvas.rect(far, middle - _THICK / 2, self.box.right - far, _THICK), LINE, 0.7)
        canvas.line((x, middle - 9), (x, middle + 9), INK, 1)
        canvas.dot((x, middle), 4.5 + self.warmth, INK)

    def _paint_runs(self, canvas: Canvas) -> None:
        """Draw what stays the same until the end; there can be many stretches."""
        share = self.box.width / self.length
        canvas.pill((0, _MIDDLE - _THIN / 2, self.box.width, _THIN), FAINT, 0.5)
        for start, stop, (hand, fires) in self._runs:
            high = _THICK if fires else _THIN
            colour = HUMAN if hand is StickHolder.HUMAN else NET
            place = canvas.rect(start * share, _MIDDLE - high / 2, max(1.0, (stop - start) * share), high)
            canvas.surface.fill(colour, place)


def runs(values: Iterable[V]) -> list[tuple[int, int, V]]:
    """Return the start, end and value of each run of equal values (run-length encoding)."""
    found, start = [], 0
    for value, same in groupby(values):
        stop = start + len(list(same))
        found.append((start, stop, value))
        start = stop
    return found
