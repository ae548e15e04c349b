"""Environments of Gymnasium as tasks: vector observations, discrete actions. Comes with the extra `gym`."""

from __future__ import annotations

import math
from contextlib import suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from ai.agent.symmetry import Symmetry
from ai.environment import SUCCESS, ForeignEnvError, Ints
from ai.files.reading import brief, parse_json, shown
from ai.files.schema import Count
from ai.lander.pilots import Pilot
from ai.training.config import Config
from ai.training.gym_env import GOING_ON, GymEnv, asked, features_of
from ai.training.tasks import Score, Task, Trial

if TYPE_CHECKING:
    import gymnasium

AT_ONCE: Final = 16  # environments of a measurement, at most
LIMIT: Final = 1000  # steps of an episode where an environment names no limit of its own
LONGEST: Final = 10_000  # steps of one, whatever it names
# Steps after which an episode of training is cut short: a lander that hovers teaches nothing new. Measuring cuts none.
PATIENCE: Final = {"LunarLander-v3": 400}
MIRRORS: Final = {  # of environments that look the same in a mirror
    "LunarLander-v3": Symmetry(
        np.array([-1, 1, -1, 1, -1, -1, 1, 1], np.float32), np.array([0, 1, 2, 3, 4, 5, 7, 6]), np.array([0, 3, 2, 1])
    ),
}


@dataclass(frozen=True)
class GymScore(Score):
    """Score of a number of episodes without random actions."""

    episodes: int
    success: float | None  # share that reached the environment's own threshold; None if it names none
    mean_return: float
    mean_length: float  # decisions
    cut: Count  # episodes that had no end of their own, and were ended after `limit` steps
    limit: Count
    frame_skip: Count  # steps for which each decision was held

    def better_than(self, other: GymScore | None) -> bool:
        return math.isfinite(self.mean_return) and (other is None or not other.mean_return >= self.mean_return)

    @property
    def figure(self) -> str:
        return f"{self.mean_return:.1f}"

    def __str__(self) -> str:
        cut = f", {self.cut} of them ended after {self.limit:,} steps" if self.cut else ""
        return f"a mean return of {self.figure} over {self.episodes} validation episodes{cut}"


class GymTask(Task[GymScore]):
    """Task of learning the environment of Gymnasium that `config.env` names."""

    evaluate_every, validation_episodes, test_episodes = 40_000, 100, 100
    score = GymScore

    def __init__(self, config: Config) -> None:
        super().__init__(config)
        try:
            import gymnasium
        except ImportError as error:
            raise ImportError('this needs Gymnasium: pip install -e ".[gym]"') from error
        self.symmetry = MIRRORS.get(config.env)
        self._gymnasium, self.arguments = gymnasium, env_arguments(config)
        env = self._make()
        try:
            observations, actions = asked(config.env, "its spaces", lambda: (env.observation_space, env.action_space))
            spaces, spec = gymnasium.spaces, env.spec
            if not isinstance(observations, spaces.Box | spaces.Discrete) or not isinstance(actions, spaces.Discrete):
                raise ValueError(
                    f"{config.env} observes {brief(observations)} and acts in {brief(actions)}; "
                    "deep Q-learning needs a Box or Discrete observations, and Discrete actions"
                )
            self.num_features, self.num_actions = features_of(observations), int(actions.n)
        finally:
            with suppress(Exception, SystemExit):
                env.close()
        self.threshold = spec.reward_threshold if spec else None
        named = spec.max_episode_steps if spec else None
        self.limit = named if named and "max_episode_steps" in self.arguments else min(named or LIMIT, LONGEST)

    def _make(self) -> gymnasium.Env[Any, Any]:
        name, errors = self.config.env, self._gymnasium.error
        module, colon, _ = name.partition(":")
        if colon and not all(part.isidentifier() for part in module.split(".")):
            raise ValueError(f"{name}: {module} is no name of a module, as in --env module:Name-v0")
        try:
            env: gymnasium.Env[Any, Any] = self._gymnasium.make(name, disable_env_checker=True, **self.arguments)
        except errors.DependencyNotInstalled as error:
            # The advice of the error itself would bring plain pygame, which breaks pygame-ce.
            hint = "Do not take Gymnasium's own extras; for Box2D, pip install box2d"
            raise ValueError(f"{name}: {error}. {hint}") from error
        except (errors.Error, ImportError) as error:
            raise ValueError(f"{name}: {' '.join(str(error).split())}") from error
        except (Exception, SystemExit) as error:
            said = brief(" ".join(str(error).split()), 300)
            raise ForeignEnvError(f"{name} cannot be made: {type(error).__name__}: {said}") from error
        return env

    def _environment(self, count: int, seeds: Ints, frame_skip: int, limit: int) -> GymEnv:
        return GymEnv(
            self.config.env, self._make, count, seeds, threshold=self.threshold, frame_skip=frame_skip, limit=limit
        )

    def make_env(self, rng: np.random.Generator) -> GymEnv:
        config = self.config
        seeds, limit = rng.integers(2**31, size=config.num_envs), PATIENCE.get(config.env, self.limit)
        return self._environment(config.num_envs, seeds, config.frame_skip, limit)

    def close_env(self, env: GymEnv) -> None:
        env.close()

    def trial(self, pilot: Pilot, episodes: int, seed: int, frame_skip: int | None = None) -> Trial[GymScore]:
        """Play so many episodes without exploration, each from a seed of its own, some side by side.

        A decision is held for as many steps as in training, unless `frame_skip` says otherwise.
        """
        seeds, skip = np.random.default_rng(seed).integers(2**31, size=episodes), frame_skip or self.config.frame_skip
        begun = min(episodes, AT_ONCE)
        env, played = self._environment(begun, seeds[:begun], skip, self.limit), []
        try:
            observation, actions = env.reset(), np.zeros(begun, dtype=np.intp)
            while (going_on := env.outcome == GOING_ON).any():
                actions = np.where(going_on, pilot.act(observation, held=actions), actions)
                result = env.step(actions)
                for slot in np.flatnonzero(result.ended & going_on).tolist():
                    succeeded, cut = env.outcome[slot] == SUCCESS, env.cut[slot]
                    played.append((env.returns[slot], env.lengths[slot], succeeded, cut))
                    if begun < episodes:
                        env.begin(slot, int(seeds[begun]))
                        actions[slot], begun = 0, begun + 1
                observation = env.observe()
                yield
        finally:
            env.close()
        returns, lengths, succeeded, cut = np.array(played, dtype=float).T
        success = None if self.threshold is None else float(succeeded.mean())
        return GymScore(
            episodes, success, float(returns.mean()), float(lengths.mean()), int(cut.sum()), self.limit, skip
        )


def env_arguments(config: Config) -> dict[str, Any]:
    """Return the arguments that an environment is made with; raises ValueError where they make no sense."""
    arguments = parse_json(config.env_arguments or "{}")
    if not isinstance(arguments, dict):
        raise ValueError(f"env_arguments are values by name, not {shown(arguments)}")
    return arguments
