"""One-engine lander: straight above the pad, it can fire its main engine or coast; small enough to learn in seconds."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np

from ai.environment import Bools, Doubles, Floats, Ints, StepResult
from ai.lander.environment import LanderEnv
from ai.lander.rewards import RewardWeights

FRAME_SKIP: Final = 6  # physics steps of a decision
_SENSED: Final = (1, 3)  # height and vertical speed, in an observation of the lander
_MAIN: Final = 3  # the lander's action for this one's action 1
_SPEEDS: Final = (-1.5, 0.5)  # m/s at the start, upwards


class OneEngineEnv:
    """`num_envs` landers of `LanderEnv` that move up and down alone: the same engine, rules and pay.

    Observations (num_envs, 2) are height and vertical speed, scaled as the lander's. Actions are 0, coast, and 1, main
    engine. Flights begin with the feet at a height within `heights`, in metres above the pad.
    """

    num_features, num_actions, stage = 2, 2, 0

    def __init__(
        self,
        num_envs: int,
        rng: np.random.Generator,
        heights: tuple[float, float],
        weights: RewardWeights | None = None,
    ) -> None:
        self.num_envs, self.heights = num_envs, heights
        self.lander = LanderEnv(num_envs, rng, "fixed", FRAME_SKIP, weights=weights)
        self.landings = 0
        self._rng = rng

    @property
    def height(self) -> Doubles:
        """Height of the feet above the pad, (num_envs,) in metres."""
        height: Doubles = self.lander.position[:, 1] - self.lander.params.pad_top - self.lander.params.stand
        return height

    def reset(self, mask: Bools | None = None) -> Floats:
        """Begin a new flight in the slots of `mask` (num_envs,), or in all; return every slot's observation."""
        mask = np.ones(self.num_envs, dtype=bool) if mask is None else mask
        params, count = self.lander.params, int(mask.sum())
        start = np.zeros((count, 6))
        start[:, 1] = params.pad_top + params.stand + self._rng.uniform(*self.heights, count)
        start[:, 3] = self._rng.uniform(*_SPEEDS, count)
        self.lander.place(mask, start)
        return _sensed(self.lander.observe())

    def step(self, actions: Ints) -> StepResult:
        """Fly one decision in every slot that has not ended."""
        result = self.lander.step(_MAIN * actions)
        self.landings = self.lander.landings
        return replace(result, observation=_sensed(result.observation))


def _sensed(observation: Floats) -> Floats:
    return np.ascontiguousarray(observation[:, _SENSED])
