"""Ending of a flight: the camera pulls back to the whole path in the colours of who flew, and the card appears."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby
from typing import Final

import numpy as np

from ai.environment import Doubles
from ai.lander.environment import Outcome
from game.core.clock import TimeScale
from game.drawing.canvas import Canvas
from game.drawing.tokens import HUMAN, NET
from game.flight.choosers import Crew
from game.flight.flight import Flight, StickHolder
from game.flight.outcomes import OutcomeCard
from game.world.camera import CameraTarget, ClearArea, View
from game.world.paths import draw_faint

_CARD_AFTER: Final = 45  # steps from the end of a flight to its card
_CARD_RISE: Final = 16
_RETRACED_AFTER, _RETRACED = 40, 60  # steps from a landing's card, and in which its path is drawn once more
_CRASH_SEEN: Final = 6  # steps of slow motion before a key can cut it short: thrust may still be held
_STRIDE: Final = 4  # steps between points of a path
_DIM: Final = 0.62  # as the past must not outshine the present


class FlightEnding:
    """Ending of one flight; call `follow` once for every step since the flight is over.

    Attributes:
        calm: whether motion is reduced.
        card: the outcome card; None before the end, and where the flight restarts at once.
        whole: shot of the whole flight, beside the card; None likewise.

    """

    def __init__(self, flight: Flight[Crew], pace: TimeScale, reduced_motion: bool) -> None:
        self._flight, self._pace, self.calm = flight, pace, reduced_motion
        self._since = 0
        self.whole: CameraTarget | None = None
        self.card: OutcomeCard | None = None

    @property
    def due(self) -> bool:
        """Whether the pause after the end is over."""
        return self._since > _CARD_AFTER

    @property
    def shown(self) -> float:
        """Progress of the card's appearance, 0 to 1."""
        since = self._since - _CARD_AFTER
        if since <= 0:
            return 0.0
        return 1.0 if self.calm else 1 - (1 - min(1.0, since / _CARD_RISE)) ** 3

    @property
    def retraced(self) -> float:
        """How much of the path is drawn, 0 to 1: beside a landing's card, it is drawn once more in a second."""
        since = self._since - _CARD_AFTER - _RETRACED_AFTER
        landed = self._flight.outcome is Outcome.LANDED
        return min(1.0, since / _RETRACED) if landed and since > 0 and not self.calm else 1.0

    @property
    def shot(self) -> CameraTarget | None:
        """Shot for the camera instead of the craft; None to keep following the craft."""
        return self.whole if self.due else None

    def follow(self) -> None:
        """Advance by one step; the first step after a crash starts slow motion."""
        self._since += 1
        if self._since == 1 and self._flight.wrecked and not self.calm:
            self._pace.slow_down()

    def hurry(self) -> None:
        """End the slow motion early, and show the card."""
        if self._pace.slow and self._since > _CRASH_SEEN:
            self._pace.hurry()
            self._since = _CARD_AFTER


class FlownPath:
    """Path of one flight, recorded step by step and drawn once the flight is over."""

    def __init__(self, flight: Flight[Crew]) -> None:
        self._flight = flight
        self._points: list[Doubles] = [flight.env.position[0].copy()]
        self._hands: list[StickHolder] = []

    def follow(self) -> None:
        """Record a step."""
        if self._flight.at % _STRIDE == 0 or self._flight.over:
            self._points.append(self._flight.env.position[0].copy())
            self._hands.append(self._flight.flown_by)

    @property
    def places(self) -> Doubles:
        """The path so far: positions (k, 2) in metres."""
        return np.array(self._points)

    def draw(self, canvas: Canvas, view: View, moments: Sequence[Doubles], share: float = 1.0) -> None:
        """Draw that share of the path and a light at its tip; or all, and a diamond where the co-pilot stepped in."""
        count = max(2, round(share * len(self._points)))
        pixels, start, colour = view.pixels(self.places[:count]), 0, HUMAN
        for hand, run in groupby(self._hands[: count - 1]):
            end = start + len(list(run))
            colour = HUMAN if hand is StickHolder.HUMAN else NET
            draw_faint(canvas.surface, pixels[start : end + 1], colour, _DIM, canvas.scale * ClearArea.head)
            start = end
        if share < 1:
            tip = view.points(self.places[count - 1]).tolist()
            canvas.glow(tip, 16, colour, 0.6)
            canvas.dot(tip, 3.5, colour)
            return
        for place in moments:
            spot = view.points(place).tolist()
            if spot[1] > canvas.view.top + ClearArea.head:
                canvas.marker("diamond", spot, 8, NET)
