"""Pilots other than the deep Q-network: a scripted one that lands, and imperfect ones made from a good one."""

from __future__ import annotations

from typing import Final, Protocol

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


class ScriptedPilot:
    """Hand-written controller: it leans towards the pad, and falls no faster than it can brake.

    It senses what the network senses, and nothing more.
    """

    def act(self, observation: Floats, *, held: Ints | None = None) -> Ints:  # noqa: ARG002
        """Actions (n,) for observations (n, 9)."""
        x, y, vx, vy, sin, cos, spin, *_ = (np.atleast_2d(observation)[:, :NUM_FEATURES] / OBSERVATION_SCALE).T
        angle = np.arctan2(sin, cos)
        wanted_vx = np.clip(-0.35 * x, -2.5, 2.5)  # m/s towards the pad for every metre aside
        lean = np.clip(0.35 * (vx - wanted_vx), -0.45, 0.45)  # rad for every m/s too much
        lean = np.where((y < 1.5) & (np.abs(x) < 2.0), np.clip(lean, -0.12, 0.12), lean)
        turn = 3.0 * (lean - angle) - 2.2 * spin
        steer = np.where(turn > 0.25, 1, np.where(turn < -0.25, 2, 0))
        # Off to the side, keep height until the pad is near.
        height = y - np.clip(np.abs(x) - 1.6, 0.0, 6.0) * 0.6
        wanted_vy = -np.clip(0.35 + 0.33 * height, -0.6, 3.2)  # falls faster the higher it is
        main = (vy < wanted_vy) & (np.abs(angle) < 1.0)
        at_rest = (y < 0.1) & (np.abs(x) < 2.0) & (np.abs(angle) < 0.15)
        action: Ints = np.where(at_rest, COAST, 3 * main + steer).astype(np.intp)
        return action


class LaggyPilot:
    """Repeats its last action with probability `chance`, else asks `pilot` (Reddy et al. 2018).

    Every slot has a last action of its own; with another number of slots, all begin anew.
    """

    def __init__(self, pilot: Pilot, rng: np.random.Generator, chance: float = 0.8) -> None:
        self.pilot, self.rng, self.chance = pilot, rng, chance
        self._last: Ints | None = None

    def act(self, observation: Floats, *, held: Ints | None = None) -> Ints:
        """Actions (n,) for observations (n, 9)."""
        fresh = self.pilot.act(observation, held=held)
        if self._last is None or self._last.shape != fresh.shape:
            self._last = fresh
        self._last = np.where(self.rng.random(fresh.shape) < self.chance, self._last, fresh)
        return self._last


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
