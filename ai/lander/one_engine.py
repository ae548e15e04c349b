"""One-engine lander: straight above the pad, it can fire its main engine or coast; small enough to learn in seconds."""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from ai.environment import Bools, Floats, StepResult
from ai.lander.environment import LanderEnv
from ai.lander.rewards import RewardWeights

FRAME_SKIP: Final = 6  # physics steps of a decision
_SENSED: Final = (1, 3)  # height and vertical speed, in an observation of the lander
_MAIN: Final = 3  # the lander's action for this one's action 1
_SPEEDS: Final = (-1.5, 0.5)  # m/s at the start, upwards


class OneEngineEnv(LanderEnv):
    """LanderEnv whose landers move up and down alone: the same engine, rules and pay.

    Observations (num_envs, 2) are height and vertical speed, scaled as the lander's. Actions are 0, coast, and 1, main
    engine. Flights begin with the feet at a height within `heights`, in metres above the pad.
    """

    num_features, num_actions = 2, 2

    def __init__(
        self,
        num_envs: int,
        rng: np.random.Generator,
        heights: tuple[float, float],
        weights: RewardWeights | None = None,
    ) -> None:
        super().__init__(num_envs, rng, frame_skip=FRAME_SKIP, weights=weights)
        self.heights, self._rng = heights, rng

    def reset(self, mask: Bools | None = None) -> Floats:
        """Begin a new flight in the slots of `mask` (num_envs,), or in all; return every slot's observation."""
        mask = np.ones(self.num_envs, dtype=bool) if mask is None else mask
        count = int(mask.sum())
        start = np.zeros((count, 6))
        start[:, 1] = self.params.pad_top + self.params.stand + self._rng.uniform(*self.heights, count)
        start[:, 3] = self._rng.uniform(*_SPEEDS, count)
        self.place(mask, start)
        return self.observe()

    def observe(self, pad: Any = None, *, wide: bool | None = None) -> Floats:
        """Return height and vertical speed, (num_envs, 2)."""
        return np.ascontiguousarray(super().observe(pad, wide=wide)[:, _SENSED])

    def step(self, actions: Any) -> StepResult:
        """Fly one decision in every slot that has not ended; raises as the lander's does, and truths are no actions."""
        actions = np.asarray(actions)
        return super().step(actions if actions.dtype.kind == "b" else _MAIN * actions)
