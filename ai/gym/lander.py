"""The lander as an environment of Gymnasium, one at a time or many. Needs the extra `gym`.

    env = gymnasium.make("ai.gym.lander:tranquility/Lander-v0")
    envs = gymnasium.make_vec("ai.gym.lander:tranquility/Lander-v0", num_envs=256)

The part before the colon imports this module, which registers the rest of the name.
"""

from __future__ import annotations

from typing import Any, Final

import gymnasium
import numpy as np
from gymnasium.spaces import Box, Discrete
from gymnasium.utils import seeding
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space

from ai.environment import Bools, Doubles, Floats, Ints, StepResult
from ai.lander.environment import NUM_ACTIONS, NUM_FEATURES, OBSERVATION_SCALE, LanderEnv
from engine import DT

LANDER_ID: Final = "tranquility/Lander-v0"
# Metres, m/s, sine and cosine, rad/s, contacts: further than any flight gets before it ends.
_REACH: Final = np.array([40.0, 40.0, 40.0, 40.0, 1.0, 1.0, 40.0, 1.0, 1.0])
_HIGH: Final = (_REACH * OBSERVATION_SCALE).astype(np.float32)
_LOW: Final = np.where(np.arange(NUM_FEATURES) < 7, -_HIGH, 0).astype(np.float32)


class GymLander(gymnasium.Env[Floats, np.int64]):
    """One lander. `spawn` names a distribution of `ai.lander.spawns`; `info` tells the outcome so far."""

    metadata = {"render_modes": []}  # noqa: RUF012 - Gymnasium's own declaration

    def __init__(self, spawn: str = "random", frame_skip: int = 4, render_mode: None = None) -> None:
        self.render_mode = render_mode
        self.metadata = GymLander.metadata | {"render_fps": round(1 / (DT * frame_skip))}
        self.observation_space, self.action_space = Box(_LOW, _HIGH), Discrete(NUM_ACTIONS)
        self.landers = LanderEnv(1, 0, spawn, frame_skip)

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
        return {name: values.item() for name, values in _told(self.landers).items()}


class GymLanders(VectorEnv[Floats, Ints, Any]):
    """Many landers, flown together. A slot given a seed flies as a `GymLander` given the same.

    `autoreset_mode` is one of Gymnasium's. When it is DISABLED, ended slots wait for a reset with
    `options={"reset_mask": mask}`.
    """

    def __init__(
        self,
        num_envs: int = 1,
        spawn: str = "random",
        frame_skip: int = 4,
        autoreset_mode: str | AutoresetMode = AutoresetMode.NEXT_STEP,
        render_mode: None = None,
    ) -> None:
        self.num_envs, self.render_mode = num_envs, render_mode
        self.autoreset_mode = AutoresetMode(autoreset_mode)
        self.metadata = {"render_modes": [], "autoreset_mode": self.autoreset_mode}
        self.single_observation_space, self.single_action_space = Box(_LOW, _HIGH), Discrete(NUM_ACTIONS)
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self.landers = LanderEnv(num_envs, None, spawn, frame_skip)
        self._ended: Bools = np.zeros(num_envs, dtype=bool)

    def reset(
        self, *, seed: int | list[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Floats, dict[str, Any]]:
        """Begin flights in all slots, or in those of `options["reset_mask"]`; seed k is for slot k."""
        everyone: Bools = np.ones(self.num_envs, dtype=bool)
        mask = (options or {}).get("reset_mask", everyone)
        seeds = [seed + slot for slot in range(self.num_envs)] if isinstance(seed, int) else seed or []
        for slot, own in enumerate(seeds):
            if own is not None and mask[slot]:
                self.landers.streams[slot] = seeding.np_random(own)[0]
        self._ended &= ~mask
        return self.landers.reset(mask), _marked(_told(self.landers), mask)

    def step(self, actions: Ints) -> tuple[Floats, Doubles, Bools, Bools, dict[str, Any]]:
        """Fly one decision in every slot; slots that end begin anew as `autoreset_mode` says."""
        begin_anew = self._ended
        result = self.landers.step(actions)
        observation, infos = result.observation, {}
        terminated, truncated = result.terminated & ~begin_anew, result.truncated & ~begin_anew
        self._ended = terminated | truncated
        if self.autoreset_mode == AutoresetMode.SAME_STEP:
            begin_anew = self._ended
            infos = self._final(result, begin_anew)
        if begin_anew.any() and self.autoreset_mode != AutoresetMode.DISABLED:
            observation = self.landers.reset(begin_anew)
        infos |= _marked(_told(self.landers), np.ones(self.num_envs, dtype=bool))
        return observation, result.reward.astype(float), terminated, truncated, infos

    def _final(self, result: StepResult, ended: Bools) -> dict[str, Any]:
        """Return the final observations and info, which a reset in the same step would lose."""
        if not ended.any():
            return {}
        seen = np.full(self.num_envs, None)
        for slot in np.flatnonzero(ended):
            seen[slot] = result.observation[slot]
        told = {name: np.where(ended, values, np.zeros_like(values)) for name, values in _told(self.landers).items()}
        return _marked({"final_obs": seen, "final_info": _marked(told, ended)}, ended)


def _told(landers: LanderEnv) -> dict[str, Any]:
    return {"outcome": landers.outcome.copy(), "is_success": landers.outcome == 1}


def _marked(values: dict[str, Any], mask: Bools) -> dict[str, Any]:
    """Say of each value, as Gymnasium does, which slots it is told of."""
    return values | {f"_{name}": mask.copy() for name in values}


if LANDER_ID not in gymnasium.registry:
    gymnasium.register(
        LANDER_ID,
        entry_point="ai.gym.lander:GymLander",
        vector_entry_point="ai.gym.lander:GymLanders",
        reward_threshold=170.0,
    )
