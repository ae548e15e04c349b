"""A friend's claim, checked by the replay that flies it again."""

from __future__ import annotations

from typing import Final

from ai.flights.recording import SharedFlight
from ai.flights.verification import is_true
from game.core import texts
from game.drawing.canvas import Canvas
from game.drawing.tokens import MARGIN, MUTE, TEXT
from game.explain.readouts import draw_corner
from game.flight import sharing
from game.flight.replay import FlightReplay
from game.world.camera import ClearArea

BELOW_CLAIM: Final = ClearArea(head=262.0)  # keeps the world clear of what comes of the check
_ROW: Final = 236.0  # baseline of that, under the sentence on where the chance fell


class Claimed:
    """A friend's claim, checked by the replay that flies it again, a few steps in every frame.

    Attributes:
        line: where it was flown, and what is claimed.

    """

    def __init__(self, flight: SharedFlight, flight_replay: FlightReplay) -> None:
        self.flight, self._flight_replay = flight, flight_replay
        claim = sharing.words(flight.claim)
        self.line = texts.FRIEND_LINE.format(where=sharing.where(flight), claim=claim)

    @property
    def true(self) -> bool | None:
        """Whether the claim is true; None until the flight is flown to its end."""
        real = self._flight_replay.earned
        return None if real is None else is_true(self.flight, real)

    @property
    def words(self) -> str:
        """How far the check is, or its result."""
        real = self._flight_replay.earned
        if real is None:
            percent = 100 * self._flight_replay.reached // max(1, self._flight_replay.length)
            return texts.FRIEND_CHECKING.format(percent=percent)
        if self.true:
            return texts.FRIEND_TRUE
        why = sharing.why_wrong(self.flight, real)
        return texts.FRIEND_WRONG.format(earned=sharing.words(real), why=why)

    def draw(self, canvas: Canvas) -> None:
        draw_corner(canvas, texts.FRIEND_TITLE, self.line)
        canvas = canvas.at(0, -1)
        true, left = self.true, MARGIN
        colour = MUTE if true is None else canvas.palette.good if true else canvas.palette.warn
        if true is not None:
            canvas.marker("check" if true else "cross", (left + 6, _ROW - 5), 11, colour)
            left += 20
        canvas.text(self.words, (left, _ROW), size=TEXT, colour=colour)
