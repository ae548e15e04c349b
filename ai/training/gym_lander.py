"""The lander as an environment of Gymnasium. Needs the extra `gym`.

    env = gymnasium.make("ai.training.gym_lander:tranquility/Lander-v0")

The part before the colon imports this module, which registers the rest of the name.
"""

from __future__ import annotations

from typing import Any, Final

import gymnasium
import numpy as np
from gymnasium.spaces import Box, Discrete

from ai.environment import SUCCESS, Floats
from ai.lander.environment import NUM_ACTIONS, NUM_FEATURES, OBSERVATION_SCALE, LanderEnv
from engine import DT

LANDER_ID: Final = "tranquility/Lander-v0"
# Metres, m/s, sine and cosine, rad/s, contacts: further than any flight gets before it ends.
_REACH: Final = np.array([40.0, 40.0, 40.0, 40.0, 1.0, 1.0, 40.0, 1.0, 1.0])
_HIGH: Final = (_REACH * OBSERVATION_SCALE).astype(np.float32)
_LOW: Final = np.where(np.arange(NUM_FEATURES) < 7, -_HIGH, 0).astype(np.float32)


class GymLander(gymnasium.Env[Floats, np.int64]):
    """One lander. `spawn` names a distribution of `ai.lander.spawns`; `info` has the outcome so far."""

    metadata = {"render_modes": []}  # noqa: RUF012 - Gymnasium's own declaration

    def __init__(self, spawn: str = "random", frame_skip: int = 4, render_mode: None = None) -> None:
        if render_mode is not None:
            raise ValueError(f"nothing is shown here, so render_mode is None, not {render_mode!r}")
        self.landers = LanderEnv(1, 0, spawn, frame_skip)
        self.render_mode = render_mode
        self.metadata = GymLander.metadata | {"render_fps": round(1 / (DT * frame_skip))}
        self.observation_space, self.action_space = Box(_LOW, _HIGH), Discrete(NUM_ACTIONS)

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Floats, dict[str, Any]]:
        """Begin a flight; the same seed gives the same flights."""
        super().reset(seed=seed, options=options)
        self.landers.streams[0] = self.np_random
        return self.landers.reset()[0], self._info()

    def step(self, action: np.int64) -> tuple[Floats, float, bool, bool, dict[str, Any]]:
        """Fly one decision."""
        result = self.landers.step(np.array([action]))
        ended = bool(result.terminated[0]), bool(result.truncated[0])
        return result.observation[0], float(result.reward[0]), *ended, self._info()

    def _info(self) -> dict[str, Any]:
        outcome = int(self.landers.outcome[0])
        return {"outcome": outcome, "is_success": outcome == SUCCESS}


if LANDER_ID not in gymnasium.registry:
    gymnasium.register(LANDER_ID, entry_point="ai.training.gym_lander:GymLander", reward_threshold=170.0)
