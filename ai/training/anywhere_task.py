"""The lander at random sites as a task to learn, with what is around it as further inputs."""

from __future__ import annotations

from collections.abc import Generator
from typing import Final

import numpy as np

from ai.agent.symmetry import Symmetry
from ai.common.environment import Env
from ai.files import array_like
from ai.lander.anywhere import SITES, AnywhereEnv
from ai.lander.environment import NUM_FEATURES
from ai.lander.pilots import Pilot
from ai.lander.rules import MIRROR_ACTIONS, MIRROR_FEATURES, MIRROR_SIGNS
from ai.lander.sensing import SURROUNDINGS, SURROUNDINGS_MIRROR
from ai.lander.spawns import CURRICULA
from ai.training.config import Config
from ai.training.lander_task import Evaluation, LanderTask, flown
from ai.training.schedule import touchdown_limits
from ai.training.state import State

ANYWHERE_SYMMETRY: Final = Symmetry(
    np.concatenate([MIRROR_SIGNS, SURROUNDINGS_MIRROR]),
    np.concatenate([MIRROR_FEATURES, NUM_FEATURES + np.arange(len(SURROUNDINGS))]),
    MIRROR_ACTIONS,
)


class AnywhereTask(LanderTask):
    """Task of learning to land at random sites; it is measured at sites of each kind equally often."""

    num_features = AnywhereEnv.num_features
    evaluate_every, validation_episodes, test_episodes = 250_000, 720, 1800

    def __init__(self, config: Config) -> None:
        super().__init__(config)
        self.symmetry = ANYWHERE_SYMMETRY

    def make_env(self, rng: np.random.Generator) -> AnywhereEnv:
        """Make the landers to train with."""
        config = self.config
        spawn = CURRICULA.get(config.spawn, config.spawn)
        return AnywhereEnv(config.num_envs, rng, spawn, config.frame_skip, weights=config.reward_weights)

    def update_env(self, decisions: int, env: Env) -> None:
        """Tighten the limits of a touchdown over the schedule, from those that are told to a share of them."""
        if isinstance(env, AnywhereEnv):
            env.strictness = touchdown_limits(self.config, decisions)

    def restore_env(self, env: Env, state: State) -> str:
        """Let new landers go on from what `env_state` gave, at the same sites."""
        assert isinstance(env, AnywhereEnv)
        env.settle(array_like(env.settled, state["flights"]["landers"]["settled"], "sites", finite=False))
        return super().restore_env(env, state)

    def trial(self, pilot: Pilot, episodes: int, seed: int) -> Generator[None, None, Evaluation]:
        """Fly so many flights at once from random spawns, one decision at a time."""
        return flown(pilot, AnywhereEnv(episodes, seed, "random", self.config.frame_skip, sites=tuple(SITES)))
