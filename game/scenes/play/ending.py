"""Ending of a flight: it is recorded, the camera pulls back to the whole path, and the outcome card appears."""

from __future__ import annotations

import math
from typing import Final

from game.core.clock import STEP
from game.core.pace import SlowMotion
from game.flight.flight import Flight
from game.flight.outcomes import OutcomeCard
from game.scenes.play.card import ShownCard
from game.scenes.play.ghost import Ghost
from game.ui.hints import Hint
from game.world.camera import CameraTarget

_CARD_AFTER: Final = 45  # steps from the end of a flight to its card
_CARD_RISE: Final = 16
_CRASH_SEEN: Final = 6  # steps of slow motion before a key can cut it short: thrust may still be held


class FlightEnding:
    """Ending of one flight; call `follow` once for every step since the flight is over.

    Attributes:
        calm: whether motion is reduced.
        card: the outcome card; None before the end, and where the flight restarts at once.
        whole: shot of the whole flight; None likewise.

    """

    def __init__(self, flight: Flight, pace: SlowMotion, reduced_motion: bool) -> None:
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
    def _lit(self) -> float:
        """Seconds that a medal has been lit; with reduced motion, always."""
        return math.inf if self.calm else (self._since - _CARD_AFTER - _CARD_RISE) * STEP

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

    def shown_card(self, hints: list[Hint], ghost: Ghost | None, *, advise: bool) -> ShownCard | None:
        """Return the card as it is seen now, with keys at its foot; None while there is none."""
        if self.card is None or self.shown == 0:
            return None
        rival = ghost.row(self._flight.env) if ghost else None
        return ShownCard(self.card, hints, self.shown, advise, rival, self._lit)
