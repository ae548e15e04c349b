"""Environments of Gymnasium as tasks: vector observations, discrete actions. Comes with the extra `gym`."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from ai.agent.symmetry import Symmetry
from ai.environment import SUCCESS, Bools, Doubles, Floats, Ints, StepResult
from ai.lander.pilots import Pilot
from ai.training.config import Config
from ai.training.tasks import Score, Task, Trial

if TYPE_CHECKING:
    import gymnasium

GOING_ON: Final = 0
FAILED: Final = 2
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

    def better_than(self, other: GymScore | None) -> bool:
        return other is None or self.mean_return > other.mean_return

    @property
    def figure(self) -> str:
        return f"{self.mean_return:.1f}"

    def __str__(self) -> str:
        return f"a mean return of {self.figure} over {self.episodes} validation episodes"


class GymEnv:
    """Several environments of Gymnasium as one of ours (`ai.environment.Env`), stepped one by one."""

    def __init__(
        self,
        make: Callable[[], gymnasium.Env[Any, Any]],
        num_envs: int,
        rng: np.random.Generator,
        threshold: float | None = None,
        frame_skip: int = 1,
    ) -> None:
        self.num_envs, self.threshold, self.frame_skip = num_envs, threshold, frame_skip
        self.landings, self.stage = 0, 0
        self._envs = [make() for _ in range(num_envs)]
        self._seeds: list[int | None] = rng.integers(2**31, size=num_envs).tolist()
        self._first_action = int(getattr(self._envs[0].action_space, "start", 0))
        shape = self._envs[0].observation_space.shape
        assert shape is not None
        self._observation: Floats = np.zeros((num_envs, int(np.prod(shape))), dtype=np.float32)
        self.returns: Doubles = np.zeros(num_envs)
        self.lengths: Ints = np.zeros(num_envs, dtype=np.intp)
        self.outcome: Ints = np.zeros(num_envs, dtype=np.intp)
        self._terminated, self._truncated = np.zeros((2, num_envs), dtype=bool)

    def reset(self, mask: Bools | None = None) -> Floats:
        for slot in range(self.num_envs) if mask is None else np.flatnonzero(mask).tolist():
            # Seeded once; from then on each environment goes on with its own stream.
            seed, self._seeds[slot] = self._seeds[slot], None
            observation, _ = self._envs[slot].reset(seed=seed)
            self._observation[slot] = np.ravel(observation)
            for kept in (self.returns, self.lengths, self.outcome, self._terminated, self._truncated):
                kept[slot] = 0
        return self._observation.copy()

    def step(self, actions: Ints) -> StepResult:
        reward = np.zeros(self.num_envs, dtype=np.float32)
        for slot in np.flatnonzero(self.outcome == GOING_ON).tolist():
            reward[slot] = self._step_one(slot, int(actions[slot]))
        return StepResult(
            self._observation.copy(), reward, self._terminated.copy(), self._truncated.copy(), self.outcome.copy()
        )

    def _step_one(self, slot: int, action: int) -> float:
        total, ended = 0.0, False
        for _ in range(self.frame_skip):
            observation, reward, terminated, truncated, _ = self._envs[slot].step(action + self._first_action)
            total += float(reward)
            if ended := terminated or truncated:
                break
        self._observation[slot] = np.ravel(observation)
        self._terminated[slot], self._truncated[slot] = terminated, truncated
        self.returns[slot] += total
        self.lengths[slot] += 1
        if ended:
            succeeded = self.threshold is not None and self.returns[slot] >= self.threshold
            self.outcome[slot] = SUCCESS if succeeded else FAILED
            self.landings += int(succeeded)
        return total


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
        self._gymnasium = gymnasium
        env = self._make()
        observations, actions, spaces = env.observation_space, env.action_space, gymnasium.spaces
        if not isinstance(observations, spaces.Box) or not isinstance(actions, spaces.Discrete):
            raise ValueError(
                f"{config.env} observes {observations} and acts in {actions}; "
                "deep Q-learning needs a Box of observations and Discrete actions"
            )
        self.num_features, self.num_actions = int(np.prod(observations.shape)), int(actions.n)
        self.threshold = env.spec.reward_threshold if env.spec else None
        env.close()

    def _make(self, patience: int | None = None) -> gymnasium.Env[Any, Any]:
        try:
            env: gymnasium.Env[Any, Any] = self._gymnasium.make(
                self.config.env, max_episode_steps=patience, disable_env_checker=True
            )
        except (self._gymnasium.error.Error, ImportError, ValueError) as error:
            hint = ""
            if isinstance(error, self._gymnasium.error.DependencyNotInstalled):
                # The advice of the error itself would bring plain pygame, which breaks pygame-ce.
                hint = ". Do not take Gymnasium's own extras; for Box2D, pip install box2d"
            raise ValueError(f"{self.config.env}: {error}{hint}") from error
        return env

    def make_env(self, rng: np.random.Generator) -> GymEnv:
        make = partial(self._make, PATIENCE.get(self.config.env))
        return GymEnv(make, self.config.num_envs, rng, self.threshold, self.config.frame_skip)

    def trial(self, pilot: Pilot, episodes: int, seed: int) -> Trial[GymScore]:
        """Play so many episodes side by side, without exploration.

        The pilot decides at every step of the environment: to hold an action for `frame_skip` of them makes learning
        faster, and the best one may change sooner.
        """
        env = GymEnv(self._make, episodes, np.random.default_rng(seed), self.threshold)
        observation, actions = env.reset(), np.zeros(episodes, dtype=np.intp)
        while (going_on := env.outcome == GOING_ON).any():
            actions = np.where(going_on, pilot.act(observation, held=actions), actions)
            observation = env.step(actions).observation
            yield
        success = None if self.threshold is None else float((env.outcome == SUCCESS).mean())
        return GymScore(episodes, success, float(env.returns.mean()), float(env.lengths.mean()))
