"""Handicaps: simulated hands that pass on the player's keys late, wrongly, or only in part."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np

from ai.environment import Floats, Ints
from ai.lander.pilots import LaggyPilot, NoisyPilot, Pilot

OWN: Final = "own"


class _Keys:
    """Pilot that flies the action of the keys; without the main engine if it only `steers`."""

    def __init__(self, *, steers: bool) -> None:
        self.held, self._steers = 0, steers

    def act(self, observation: Floats, *, held: Ints | None = None) -> Ints:  # noqa: ARG002
        return np.array([self.held % 3 if self._steers else self.held])


HANDS: Final[dict[str, Callable[[Pilot, np.random.Generator], Pilot]]] = {
    OWN: lambda keys, _: keys,
    "laggy": LaggyPilot,
    "noisy": NoisyPilot,
    "sensor": lambda keys, _: keys,
}


class Handicap:
    """Handicap by name, applied to the keys; any but the player's own hands choose anew every `every` steps.

    The same seed and keys give the same mistakes.
    """

    def __init__(self, name: str, seed: int, every: int) -> None:
        self._keys = _Keys(steers=name == "sensor")
        self._pilot = HANDS[name](self._keys, np.random.default_rng([seed, len(name)]))
        self._every = 1 if name == OWN else every
        self._step = self._action = 0

    def ask(self, held: int, observation: Floats) -> int:
        """Return the action of a step, given the held one; call once in every step flown by hand."""
        self._keys.held = held
        if self._step % self._every == 0:
            self._action = int(self._pilot.act(observation)[0])
        self._step += 1
        return self._action
