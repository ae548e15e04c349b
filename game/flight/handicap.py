"""Hands to fly with: one's own, or another pilot's, which get the keys late, wrong, or only in part."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np

from ai.common.environment import Floats, Ints
from ai.lander.pilots import LaggyPilot, NoisyPilot, Pilot

OWN: Final = "own"


class Keys:
    """A pilot who does what the keys ask for."""

    def __init__(self) -> None:
        self.held = 0

    def act(self, observation: Floats, *, held: Ints | None = None) -> Ints:  # noqa: ARG002
        """The action (1,) that the keys ask for."""
        return np.array([self.held])


class SteersOnly:
    """Another pilot without the main engine, which is all that the sensor pilot lacks."""

    def __init__(self, pilot: Pilot) -> None:
        self.pilot = pilot

    def act(self, observation: Floats, *, held: Ints | None = None) -> Ints:
        """Actions (n,) for observations (n, 9)."""
        return self.pilot.act(observation, held=held) % 3


HANDS: Final[dict[str, Callable[[Pilot, np.random.Generator], Pilot]]] = {
    OWN: lambda keys, _: keys,
    "laggy": LaggyPilot,
    "noisy": NoisyPilot,
    "sensor": lambda keys, _: SteersOnly(keys),
}


class Hands:
    """What hands of that name make of the keys; others than one's own do so anew every `every` steps.

    The same seed and keys make the same mishaps.
    """

    def __init__(self, name: str, seed: int, every: int) -> None:
        self._keys = Keys()
        self._pilot = HANDS[name](self._keys, np.random.default_rng([seed, len(name)]))
        self._every = 1 if name == OWN else every
        self._step = self._action = 0

    def ask(self, held: int, observation: Floats) -> int:
        """Return what a step is flown with, given what is held down; call once in every step flown by hand."""
        self._keys.held = held
        if self._step % self._every == 0:
            self._action = int(self._pilot.act(observation)[0])
        self._step += 1
        return self._action
