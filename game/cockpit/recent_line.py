"""Line of the last eight seconds: who flew, and where the co-pilot stepped in."""

from __future__ import annotations

from collections import deque
from itertools import groupby
from typing import Final

from game.core import texts
from game.drawing.canvas import Canvas
from game.drawing.tokens import HUMAN, NET, VIEW_SIZE, Colour
from game.flight.flight import DECISION_STEPS, Flight, StickHolder

_SAMPLES: Final = 120  # decisions on the line, eight seconds
_STRIP: Final = (VIEW_SIZE[0] / 2 - 90, 77.0, 180.0)  # left, middle, width
_REACH: Final = (10.0, 21.0)  # points above and below it that explain it
_THICK: Final = 7.0
_YOURS, _HANDED, _CHANGED = range(3)
_LOOKS: Final[tuple[tuple[Colour, float], ...]] = ((HUMAN, 0.8), (NET, 0.8), (NET, 1.0))


class RecentLine:
    """Line of one flight's last seconds; call `follow` once after every step."""

    def __init__(self) -> None:
        self._kinds: deque[int] = deque(maxlen=_SAMPLES)
        self._now = _YOURS

    def follow(self, flight: Flight) -> None:
        """Note a step."""
        if flight.overridden:
            self._now = _CHANGED
        if len(flight.recording.actions) % DECISION_STEPS == 0 and not flight.over:
            yours = flight.flown_by is StickHolder.HUMAN
            self._kinds.append(_CHANGED if self._now == _CHANGED else _YOURS if yours else _HANDED)
            self._now = _YOURS

    def draw(self, canvas: Canvas) -> None:
        """Draw the line; it is thick where the co-pilot stepped in."""
        left, middle, width = _STRIP
        step = width / _SAMPLES
        x = left + width - step * len(self._kinds)
        for kind, run in groupby(self._kinds):
            length, (colour, alpha) = step * len(list(run)), _LOOKS[kind]
            high = _THICK if kind == _CHANGED else 1.0
            canvas.fill(canvas.rect(x, middle - high / 2, max(length, 1.0), high), colour, alpha)
            x += length
        above, below = _REACH
        canvas.explain((left, middle - above, width, above + below), texts.EXPLAIN_RECENT)
