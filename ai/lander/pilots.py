"""Pilots other than the deep Q-network: a scripted one that lands, and imperfect ones made from a good one."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final, Protocol

import numpy as np

from ai.environment import Floats, Ints
from ai.lander.environment import NUM_FEATURES, OBSERVATION_SCALE

COAST: Final = 0
MARGIN: Final = 0.1  # metres


class Pilot(Protocol):
    """Protocol of a pilot, which chooses actions for one lander or for many at once.

    Row k of a call is always the same slot, ended or not: a pilot may remember what it did in each.
    """

    def act(self, observation: Floats, *, held: Ints | None = None) -> Ints:
        """Actions (n,) for observations (n, 9); `held` (n,) are the actions until now, for pilots that use them."""


@dataclass(frozen=True)
class Gains:
    """Gains of the scripted controller, each one number or one for every slot (n,)."""

    approach: Any = 0.35  # m/s towards the pad for every metre aside
    lean: Any = 0.35  # rad for every m/s too much
    turn: Any = 3.0  # wish to turn for every rad off
    calm: Any = 2.2  # and against every rad/s of turning
    touch: Any = 0.35  # m/s of falling at the pad
    fall: Any = 0.33  # m/s more for every metre above
    fastest: Any = 3.2  # m/s of falling, anywhere


GAINS: Final = Gains()


class ScriptedPilot:
    """Hand-written controller: it leans towards the pad, and falls no faster than it can brake.

    It senses what the network senses, and nothing more.
    """

    def __init__(self, gains: Gains = GAINS) -> None:
        self.gains = gains

    def act(self, observation: Floats, *, held: Ints | None = None) -> Ints:  # noqa: ARG002
        """Actions (n,) for observations (n, 9)."""
        x, y, vx, vy, sin, cos, spin, *_ = (np.atleast_2d(observation)[:, :NUM_FEATURES] / OBSERVATION_SCALE).T
        gains = self.gains
        angle = np.arctan2(sin, cos)
        wanted_vx = np.clip(-gains.approach * x, -2.5, 2.5)
        lean = np.clip(gains.lean * (vx - wanted_vx), -0.45, 0.45)
        lean = np.where((y < 1.5) & (np.abs(x) < 2.0), np.clip(lean, -0.12, 0.12), lean)
        turn = gains.turn * (lean - angle) - gains.calm * spin
        steer = np.where(turn > 0.25, 1, np.where(turn < -0.25, 2, 0))
        # Off to the side, keep height until the pad is near.
        height = y - np.clip(np.abs(x) - 1.6, 0.0, 6.0) * 0.6
        wanted_vy = -np.clip(gains.touch + gains.fall * height, -0.6, gains.fastest)
        main = (vy < wanted_vy) & (np.abs(angle) < 1.0)
        at_rest = (y < 0.1) & (np.abs(x) < 2.0) & (np.abs(angle) < 0.15)
        action: Ints = np.where(at_rest, COAST, 3 * main + steer).astype(np.intp)
        return action


class LaggyPilot:
    """Repeats its last action with probability `chance`, else asks `pilot` (Reddy et al. 2018).

    Every slot has a last action of its own, so `act` raises ValueError for another number of slots than before,
    unless `forget` is called in between.
    """

    def __init__(self, pilot: Pilot, rng: np.random.Generator, chance: float = 0.8) -> None:
        self.pilot, self.rng, self.chance = pilot, rng, chance
        self._last: Ints | None = None

    def act(self, observation: Floats, *, held: Ints | None = None) -> Ints:
        """Actions (n,) for observations (n, 9)."""
        fresh = self.pilot.act(observation, held=held)
        if self._last is None:
            self._last = fresh
        if self._last.shape != fresh.shape:
            raise ValueError(f"the last actions are those of {self._last.size} slots, and here are {fresh.size}")
        self._last = np.where(self.rng.random(fresh.shape) < self.chance, self._last, fresh)
        return self._last

    def forget(self) -> None:
        """Begin new flights with no action to repeat."""
        self._last = None


class NoisyPilot:
    """Flips `pilot`'s main engine, and changes its steering to another, each with probability `chance`."""

    def __init__(self, pilot: Pilot, rng: np.random.Generator, chance: float = 0.15) -> None:
        self.pilot, self.rng, self.chance = pilot, rng, chance

    def act(self, observation: Floats, *, held: Ints | None = None) -> Ints:
        """Actions (n,) for observations (n, 9)."""
        main, steer = np.divmod(self.pilot.act(observation, held=held), 3)
        flip, change = self.rng.random((2, *main.shape)) < self.chance
        main = np.where(flip, 1 - main, main)
        steer = np.where(change, (steer + self.rng.integers(1, 3, main.shape)) % 3, steer)
        return 3 * main + steer


class SensorPilot:
    """Steers towards the pad when it is more than `MARGIN` metres aside; never fires the main engine."""

    def act(self, observation: Floats, *, held: Ints | None = None) -> Ints:  # noqa: ARG002
        """Actions (n,) for observations (n, 9)."""
        x = np.atleast_2d(observation)[:, 0] / OBSERVATION_SCALE[0]
        return np.where(x > MARGIN, 1, np.where(x < -MARGIN, 2, 0)).astype(np.intp)


class NoPilot:
    """Pilot that never fires an engine."""

    def act(self, observation: Floats, *, held: Ints | None = None) -> Ints:  # noqa: ARG002
        """Actions (n,) for observations (n, 9)."""
        return np.zeros(len(np.atleast_2d(observation)), dtype=np.intp)
