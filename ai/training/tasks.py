"""Tasks: what training must know of an environment to learn it, and how its pilots are measured. Our lander is here.

Environments of Gymnasium are in `ai.training.gym_task`.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Generator
from dataclasses import asdict, dataclass, replace
from typing import Any, Final, Generic, TypeVar

import numpy as np

from ai.agent.schedule import linear
from ai.agent.symmetry import Symmetry
from ai.environment import Doubles, Env, Ints, T
from ai.lander.anywhere import SITES, AnywhereEnv
from ai.lander.environment import LIMITS, NUM_ACTIONS, NUM_FEATURES, LanderEnv, Outcome
from ai.lander.pilots import Pilot
from ai.lander.rules import MIRROR_ACTIONS, MIRROR_FEATURES, MIRROR_SIGNS, engines_switched
from ai.lander.sensing import SURROUNDINGS, SURROUNDINGS_MIRROR
from ai.lander.spawns import CURRICULA, SPAWNS, TEACH_HARD
from ai.training.config import Config

VALIDATION_SEED: Final = 1_000_003  # episodes that choose the best checkpoint
TEST_SEED: Final = 2_000_003  # episodes that have no say in anything, to measure a finished network by
LANDER_SYMMETRY: Final = Symmetry(MIRROR_SIGNS, MIRROR_FEATURES, MIRROR_ACTIONS)
ANYWHERE_SYMMETRY: Final = Symmetry(
    np.concatenate([MIRROR_SIGNS, SURROUNDINGS_MIRROR]),
    np.concatenate([MIRROR_FEATURES, NUM_FEATURES + np.arange(len(SURROUNDINGS))]),
    MIRROR_ACTIONS,
)

S = TypeVar("S", bound="Score")
Trial = Generator[None, None, T]  # takes one decision a turn, and returns what came of them


class Score(ABC):
    """Score of a pilot over a number of episodes without random actions; a dataclass that a file can hold."""

    episodes: int
    success: float | None  # share that ended well; None where the environment does not define that
    mean_return: float  # sum of rewards

    @property
    @abstractmethod
    def figure(self) -> str:
        """Most important figure of the score, as a short text."""

    @abstractmethod
    def better_than(self, other: Any) -> bool:
        """Whether this beats another score of its kind, or None."""

    def to_json(self) -> dict[str, Any]:
        """Return the values as JSON can hold them."""
        return asdict(self)  # type: ignore[call-overload,no-any-return]


class Task(ABC, Generic[S]):
    """Environment as an agent is to learn it."""

    num_features: int  # of an observation
    num_actions: int
    symmetry: Symmetry | None = None  # how a mirror image looks; None if it looks different
    evaluate_every: int  # decisions between two validations
    validation_episodes: int
    test_episodes: int
    score: type[S]  # what its pilots are measured by

    def __init__(self, config: Config) -> None:
        self.config = config

    @property
    def action_chances(self) -> Doubles | None:
        """Chances of random actions, (actions,); None for uniform."""
        return None

    @abstractmethod
    def make_env(self, rng: np.random.Generator) -> Env:
        """Make the environment to train in."""

    def apply_live(self, config: Config, env: Any) -> None:  # noqa: ARG002 - of most, nothing is live
        """Take over the live knobs of another configuration, here and in an environment that `make_env` made."""
        self.config = config

    def update_env(self, decisions: int, env: Any) -> None:
        """Bring what changes with experience up to date in an environment that `make_env` made."""

    def close_env(self, env: Any) -> None:
        """Let go of what an environment that `make_env` made holds."""

    @abstractmethod
    def trial(self, pilot: Pilot, episodes: int, seed: int, frame_skip: int | None = None) -> Trial[S]:
        """Measure a pilot over so many episodes, which follow from `seed`, one decision at a time.

        A decision is held for as many steps as in training, unless `frame_skip` says otherwise.
        """


@dataclass(frozen=True)
class Evaluation(Score):
    """Evaluation of a pilot over a number of flights without random actions."""

    episodes: int
    success: float  # shares of the flights
    crash: float
    out_of_bounds: float
    time_out: float
    mean_return: float
    mean_time: float | None  # seconds, of the landings; None without any
    mean_fuel: float | None  # seconds of main engine, of the landings
    switches: float  # times a second that an engine goes on or off, of all flights
    hard: float | None = None  # share of further flights, from hard starts, that landed; None where none were flown

    def better_than(self, other: Evaluation | None) -> bool:
        """Whether more flights landed, random and hard starts together, or as many and the mean return is higher.

        Where hard starts were not flown, the mean return decides, a flight that did not land counting 1000 points less.
        """
        if other is None:
            return True
        if self.hard is None or other.hard is None:
            return self.mean_return + 1000 * self.success > other.mean_return + 1000 * other.success
        return (self.success + self.hard, self.mean_return) > (other.success + other.hard, other.mean_return)

    @property
    def figure(self) -> str:
        return f"{self.success:.1%}"

    def __str__(self) -> str:
        took = "" if self.mean_time is None else f", in {self.mean_time:.1f} s on average"
        return f"{self.figure} of {self.episodes} validation flights landed{took}"


def flown(pilot: Pilot, env: LanderEnv, measured: slice = slice(None)) -> Trial[Evaluation]:
    """Fly all slots of `env`, which has just been reset, to the end; return the score of the slots `measured`."""
    observation = env.observe()
    returns: Doubles = np.zeros(env.num_envs)
    switches: Ints = np.zeros(env.num_envs, dtype=np.intp)
    while (flying := env.outcome == Outcome.FLYING).any():
        held = env.actions
        # Asked for every slot, whether it still flies or not: each keeps its row, as a pilot with a memory needs.
        actions = np.where(flying, pilot.act(observation, held=held), held)
        switches += engines_switched(held, actions)
        result = env.step(actions)
        observation = result.observation
        returns += result.reward
        yield
    outcomes, seconds = env.outcome[measured], env.time[measured]
    landed = outcomes == Outcome.LANDED
    success, crash, out, late = (float((outcomes == each).mean()) for each in Outcome if each != Outcome.FLYING)
    took, burnt = (float(each[landed].mean()) if landed.any() else None for each in (seconds, env.fuel[measured]))
    earned, switched = float(returns[measured].mean()), float(switches[measured].sum() / seconds.sum())
    return Evaluation(len(outcomes), success, crash, out, late, earned, took, burnt, switched)


def flights(pilot: Pilot, episodes: int, seed: int, spawn: str = "random", frame_skip: int = 4) -> Trial[Evaluation]:
    """Fly `episodes` flights at once, without exploration, from spawns that follow from `seed`."""
    env = LanderEnv(episodes, seed, spawn, frame_skip)
    env.reset()
    return (yield from flown(pilot, env))


class LanderTask(Task[Evaluation]):
    """Task of learning to land."""

    num_features, num_actions = NUM_FEATURES, NUM_ACTIONS
    evaluate_every, validation_episodes, test_episodes = 100_000, 500, 1000
    score = Evaluation
    symmetry = LANDER_SYMMETRY
    landers: type[LanderEnv] = LanderEnv

    @property
    def action_chances(self) -> Doubles:
        main = self.config.random_main
        return np.array([1 - main] * 3 + [main] * 3) / 3

    def make_env(self, rng: np.random.Generator) -> LanderEnv:
        config = self.config
        spawn = CURRICULA.get(config.spawn, config.spawn)
        return self.landers(config.num_envs, rng, spawn, config.frame_skip, weights=config.reward_weights)

    def apply_live(self, config: Config, env: LanderEnv) -> None:
        self.config = config
        env.weights = config.reward_weights

    def update_env(self, decisions: int, env: LanderEnv) -> None:
        """Tighten the limits of a touchdown over the schedule, from the real ones to a share of them."""
        env.limits = LIMITS.stricter(self._strictness(decisions))

    def _strictness(self, decisions: int) -> float:
        """Return the limits of a touchdown after so many decisions, as a share of the real ones."""
        return linear(1.0, self.config.final_touchdown_limits, decisions, self.config.schedule_decisions)

    def trial(self, pilot: Pilot, episodes: int, seed: int, frame_skip: int | None = None) -> Trial[Evaluation]:
        """Fly so many flights at once from random spawns, one decision at a time.

        Where hard starts are taught, half as many from such ones fly beside them: much cheaper than after them.
        """
        beside = (episodes + 1) // 2 if self.config.spawn in TEACH_HARD else 0
        env = LanderEnv(episodes + beside, seed, "random", frame_skip or self.config.frame_skip)
        env.reset()
        if beside:
            rng, hard = np.random.default_rng(seed), np.arange(env.num_envs) >= episodes
            env.place(hard, np.array([SPAWNS["hard"](rng) for _ in range(beside)]))
        score = yield from flown(pilot, env, slice(episodes))
        return replace(score, hard=float((env.outcome[hard] == Outcome.LANDED).mean())) if beside else score


class AnywhereTask(LanderTask):
    """Task of learning to land at random sites, with what is around the lander as further inputs.

    It is measured at sites of each kind equally often.
    """

    num_features = AnywhereEnv.num_features
    evaluate_every, validation_episodes, test_episodes = 250_000, 720, 1800
    symmetry = ANYWHERE_SYMMETRY
    landers = AnywhereEnv

    def update_env(self, decisions: int, env: Any) -> None:
        """Tighten the limits of a touchdown over the schedule, from those that are observed to a share of them."""
        env.strictness = self._strictness(decisions)

    def trial(self, pilot: Pilot, episodes: int, seed: int, frame_skip: int | None = None) -> Trial[Evaluation]:
        env = AnywhereEnv(episodes, seed, "random", frame_skip or self.config.frame_skip, sites=tuple(SITES))
        env.reset()
        return (yield from flown(pilot, env))
