"""Timeline of a replay: who flew when, which engines fired, and the moment that is shown."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from itertools import groupby
from typing import Final, TypeVar

from game.core.scene import Transition
from game.drawing.canvas import Canvas
from game.drawing.cursor import Cursor
from game.drawing.paint_cache import PaintCache
from game.drawing.tokens import FAINT, HUMAN, INK, LABEL, LINE, MUTE, NET, Colour
from game.flight.flight import StickHolder
from game.ui.widget import NOWHERE, RowWidget, mix

V = TypeVar("V")
_LABELS: Final = 84.0  # room for the lanes' names
_LANE: Final = 15.0  # points from one lane to the next
_BAR: Final = 3.0
_TOP: Final = 6.0  # of the strip, from the upper edge
_STEP: Final = 6  # physics steps per press of an arrow key
_LIT: Final = mix(MUTE, INK, 0.5)
_COLOURS: Final = {StickHolder.HUMAN: HUMAN, StickHolder.NETWORK: NET}


class Timeline(RowWidget):
    """Lanes of a flight's actions (steps,) and who flew them; `on_go_to` is called with the step to show."""

    pad = 2.0

    def __init__(
        self,
        words: Sequence[str],
        actions: Sequence[int],
        hands: Sequence[StickHolder],
        on_go_to: Callable[[int], None],
        on_press: Callable[[], None],
    ) -> None:
        super().__init__(NOWHERE, "")
        self.key = "strip"
        self._still = PaintCache()
        self._words, self._on_go_to, self._on_press = words, on_go_to, on_press
        self.length = max(1, len(actions))
        self.at = self.reached = 0
        self._hands = runs([_COLOURS[hand] for hand in hands])
        lit = (
            [action >= 3 for action in actions],
            [action % 3 == 1 for action in actions],
            [action % 3 == 2 for action in actions],
        )
        self._lanes = [[(start, stop, _LIT) for start, stop, on in runs(lane) if on] for lane in lit]

    def press(self) -> Transition | None:
        """Pause or resume; the mouse only goes to another step."""
        if self.ringed:
            self._on_press()
        return None

    def shift(self, direction: int) -> bool:
        self._on_go_to(self.at + _STEP * direction)
        return True

    def drag(self, x: float) -> None:
        left, width = self.track
        self._on_go_to(round(self.length * (x - left) / width))

    @property
    def track(self) -> tuple[float, float]:
        """Left end and width of the strip, in points."""
        return self.box.left + _LABELS, self.box.width - _LABELS

    def place(self, step: float) -> float:
        """Return where a step is on the strip, in points."""
        left, width = self.track
        return left + width * min(max(step / self.length, 0.0), 1.0)

    def write(self, cursor: Cursor) -> None:
        cursor.take(_TOP + 12 + len(self._lanes) * _LANE)
        if cursor.canvas:
            self._paint(cursor.canvas)

    def _paint(self, canvas: Canvas) -> None:
        (left, width), top = self.track, self.box.top + _TOP
        self._still.draw(canvas, self.box, tuple(self.box), self._paint_runs)
        far = self.place(self.reached)
        if far < left + width - 1:  # the part that is not computed yet
            canvas.fill(canvas.rect(far, top - 1, left + width - far, _BAR + 2), LINE, 0.7)
        x = self.place(self.at)
        canvas.line((x, top - 5), (x, self.box.bottom - 7), INK, 1)
        canvas.dot((x, top + 1.5), 4.5 + self.warmth, INK)

    def _paint_runs(self, canvas: Canvas) -> None:
        """Draw the lanes, which stay the same until the end; they can have many stretches."""
        left, width = _LABELS, self.track[1]

        def lay(stretches: Sequence[tuple[int, int, Colour]], top: float) -> None:
            for start, stop, colour in stretches:
                x, end = (left + width * min(step / self.length, 1.0) for step in (start, stop))
                canvas.surface.fill(colour, canvas.rect(x, top, max(1.0, end - x), _BAR))

        canvas.pill((left, _TOP, width, _BAR), FAINT, 0.5)
        lay(self._hands, _TOP)
        for number, (word, lane) in enumerate(zip(self._words, self._lanes, strict=True)):
            y = _TOP + 12 + number * _LANE
            canvas.text(word, (0, y + 4), size=LABEL, colour=MUTE)
            canvas.line((left, y + 1), (left + width, y + 1), LINE)
            lay(lane, y - 0.5)


def runs(values: Iterable[V]) -> list[tuple[int, int, V]]:
    """Return the start, end and value of each run of equal values (run-length encoding)."""
    found, start = [], 0
    for value, same in groupby(values):
        stop = start + len(list(same))
        found.append((start, stop, value))
        start = stop
    return found
