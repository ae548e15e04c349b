"""Clock of flights of which only observations are known: it counts decisions, and notices a new flight."""

from __future__ import annotations

from typing import Final

import numpy as np

from ai.common.environment import Bools, Doubles, Floats
from ai.copilot.critic import usual_surroundings
from ai.lander.environment import LIMITS, OBSERVATION_SCALE
from ai.lander.ground import NARROW
from ai.lander.sensing import SURROUNDINGS, SURROUNDINGS_SCALE

_DECISION: Final = 1 / 15  # seconds
_LEAP: Final = 1.5  # metres that nothing flies within a decision
_TIME, _WIDTH = SURROUNDINGS.index("time left"), SURROUNDINGS.index("pad width")


class FlightClock:
    """Clock of n flights on the moon, read once for every decision."""

    def __init__(self) -> None:
        self._seconds: Doubles = np.zeros(0)
        self._place: Doubles = np.zeros((0, 2))

    def forget(self, mask: Bools | None = None) -> None:
        """Begin a new flight in the slots of `mask` (n,), or in all."""
        if self._seconds.size:
            self._seconds[slice(None) if mask is None else mask] = 0.0

    def read(self, observation: Floats) -> tuple[Floats, Bools]:
        """Return the likely surroundings (n, pads, k) for observations (n, pads, 9), and where a flight is new, (n,).

        A lander that is suddenly elsewhere has begun another flight. Of several pads, each counts as narrow.
        """
        slots, pads, _ = observation.shape
        place = observation[:, 0, :2] / OBSERVATION_SCALE[:2]
        if self._seconds.shape != (slots,):
            self._seconds, self._place = np.zeros(slots), place
        new = (np.abs(place - self._place) > _LEAP).any(axis=1)
        self._seconds, self._place = np.where(new, 0.0, self._seconds + _DECISION), place
        surroundings = np.tile(usual_surroundings(), (slots, pads, 1))
        left = np.clip(LIMITS.time - self._seconds, 0.0, None)
        surroundings[:, :, _TIME] = np.minimum(surroundings[:, :, _TIME], (left * SURROUNDINGS_SCALE[_TIME])[:, None])
        if pads > 1:
            surroundings[:, :, _WIDTH] = NARROW[0] * SURROUNDINGS_SCALE[_WIDTH]
        return surroundings, new
