"""Flight conditions harder than those of training: wind, a small tank, engine failures, a moving pad."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np

from ai.environment import Bools, Doubles


@dataclass(frozen=True)
class Conditions:
    """Conditions as functions of the time since a flight began; the defaults change nothing, bit for bit.

    Each number may also be an array (n,), with one for each slot.
    """

    wind: float = 0.0  # N to the right
    gust: float = 0.0  # N, amplitude of the gusts around that
    gust_period: float = 5.0  # seconds
    tank: float = math.inf  # fuel there is, in seconds of main engine
    outage: tuple[float, float] = (math.inf, math.inf)  # seconds from and to which the main engine is dead
    swing: float = 0.0  # metres that the pad moves to both sides of its place
    swing_period: float = 14.0  # seconds

    def __post_init__(self) -> None:
        numbers = (self.wind, self.gust, self.swing)
        positive = np.greater(self.gust_period, 0) & np.greater(self.swing_period, 0) & np.greater_equal(self.tank, 0)
        if not (all(np.isfinite(number).all() for number in numbers) and np.all(positive)):
            raise ValueError(f"forces and distances are finite, periods more than 0 and tanks not negative: {self}")

    @cached_property
    def pushes(self) -> bool:
        """Whether there is any wind."""
        return bool(np.any(self.wind) or np.any(self.gust))

    @cached_property
    def fails(self) -> bool:
        """Whether an engine may do nothing when it is asked to fire."""
        return bool(np.isfinite(self.tank).any() or np.isfinite(self.outage[0]).any())

    @cached_property
    def moves(self) -> bool:
        """Whether the pad moves."""
        return bool(np.any(self.swing))

    def push(self, time: Doubles | float) -> Doubles:
        """Force of the wind to the right in N, at times (n,) in seconds."""
        push: Doubles = self.wind + self.gust * np.sin(2 * np.pi / self.gust_period * time)
        return push

    def impulse(self, time: Doubles) -> Doubles:
        """Impulse of the wind until times (n,) in seconds, to the right in N s: the integral of `push`."""
        rate = 2 * np.pi / self.gust_period
        given: Doubles = self.wind * time + self.gust / rate * (1 - np.cos(rate * time))
        return given

    def main_works(self, time: Doubles | float) -> Bools:
        """Whether the main engine fires when it is asked to, (n,)."""
        start, end = self.outage
        works: Bools = np.logical_or(time < start, time >= end)
        return works

    def shift(self, time: Doubles | float) -> tuple[Doubles, Doubles]:
        """Displacement of the pad to the right of its place, in metres, and its velocity in m/s, each (n,)."""
        rate = 2 * np.pi / self.swing_period
        return self.swing * np.sin(rate * time), self.swing * rate * np.cos(rate * time)


CALM: Final = Conditions()
