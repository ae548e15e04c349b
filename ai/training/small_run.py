"""Small runs of deep Q-learning, a few seconds long: one-engine landers, looked into after every decision."""

from __future__ import annotations

from collections import deque
from collections.abc import Generator, Sequence
from dataclasses import dataclass, replace
from typing import Final, NamedTuple

import numpy as np

from ai.agent.agent import DeepQAgent
from ai.agent.decision import in_points
from ai.agent.replay import ReplayBuffer, Transition
from ai.agent.schedule import exploration
from ai.environment import Bools, Doubles, Floats, Ints, StepResult
from ai.lander.environment import Outcome
from ai.lander.one_engine import OneEngineEnv
from ai.lander.rewards import RewardWeights
from ai.training.config import Config

# Plain deep Q-learning: a hard copy of the target network every 100 gradient steps, as Mnih et al. 2015 had it.
SMALL_RUN: Final = Config(
    learning_rate=3e-3, final_learning_rate=3e-3, schedule_decisions=600_000, discount=0.99, n_step=1, batch_size=64,
    gradient_steps=4, cost="mse", hidden=(32, 32), activation="relu", layer_normalisation=False, replay_size=20_000,
    learning_starts=300, mirror=False, target_judges=True, target_update_interval=100, tau=1.0, final_tau=1.0,
    fly_target=False, epsilon_decisions=8_000, epsilon_spread=0.0, num_envs=16, steadiness=0.0,
    reward_weights=RewardWeights(),
)  # fmt: skip
RECENT: Final = 40  # latest flights whose share of landings is shown
TESTED: Final = 12  # landers that are tested
RECENT_TESTS: Final = 24


@dataclass(frozen=True)
class Flown:
    """Landers of a small run after a decision, all (n,)."""

    height: Doubles  # of the feet above the pad, metres
    speed: Doubles  # upwards, m/s
    main: Bools  # whether the main engine burns
    outcome: Ints  # an `Outcome` each


@dataclass(frozen=True)
class Memory:
    """Replay buffer of a small run after a decision. Memories are counted from 0 as they come, for ever."""

    oldest: int  # number of the oldest that is still held
    newest: int  # number of the next that comes
    drawn: Ints  # numbers of those drawn in this decision's learning step; empty before the first


@dataclass(frozen=True)
class SmallState:
    """State of a small run after one decision."""

    decisions: int  # so far, of all landers together as one
    flights: int  # that have ended
    landed: float | None  # share of the latest `RECENT` flights; None before the first has ended
    value: float  # what the network expects of its landers' present moments, in points; the mean of all
    flown: Flown
    memory: Memory
    tested: Flown | None = None  # who fly the present network without random actions, and teach it nothing
    passed: float | None = None  # share of the latest `RECENT_TESTS` of those that landed
    problem: str = ""  # why it cannot go on; empty while it can


class Plan(NamedTuple):
    """Heights, in metres above the pad, at which the flights of a small run begin.

    With `change`, flights begin within `later` after so many decisions, and with `keep` only so many memories are held
    from then on. With `tested`, there are tests that begin there.
    """

    heights: tuple[float, float] = (1.0, 8.0)
    change: int | None = None
    later: tuple[float, float] = (0.3, 1.0)
    keep: int | None = None
    tested: tuple[float, float] | None = None


class WatchedReplay(ReplayBuffer):
    """Replay buffer that keeps which rows were drawn last."""

    drawn: Ints = np.zeros(0, dtype=np.intp)

    def sample(self, count: int, rng: np.random.Generator) -> tuple[Transition, Ints, Floats]:
        cells, self.drawn, weights = super().sample(count, rng)
        return cells, self.drawn, weights


class _Landers:
    """Landers that fly side by side and begin anew; `recent` are whether the latest flights landed."""

    def __init__(self, env: OneEngineEnv, recent: int) -> None:
        self.env, self.flights = env, 0
        self.observation = env.reset()
        self.recent: deque[bool] = deque(maxlen=recent)
        self._look(env.outcome)

    @property
    def landed(self) -> float | None:
        """Share of the latest flights; None before the first has ended."""
        return sum(self.recent) / len(self.recent) if self.recent else None

    def _look(self, outcome: Ints) -> None:
        env = self.env
        self.flown = Flown(env.altitude, env.velocity[:, 1].copy(), env.actions >= 3, outcome.copy())

    def take(self, result: StepResult) -> None:
        """Take what came of a decision, and begin flights anew that have ended."""
        ended = result.ended
        self._look(result.outcome)
        self.recent.extend((result.outcome[ended] == Outcome.LANDED).tolist())
        self.flights += int(ended.sum())
        self.observation = self.env.reset(ended) if ended.any() else result.observation


class SmallRun:
    """Small run, the same for the same configuration, seed and plan."""

    def __init__(self, config: Config, seed: int, plan: Plan | None = None) -> None:
        agent_rng, env_rng, test_rng = np.random.default_rng(seed).spawn(3)
        self.config, self.plan, pay = config, plan or Plan(), config.reward_weights
        self.env = OneEngineEnv(config.num_envs, env_rng, self.plan.heights, pay)
        self.learners, tested = _Landers(self.env, RECENT), self.plan.tested
        self.tests = _Landers(OneEngineEnv(TESTED, test_rng, tested, pay), RECENT_TESTS) if tested else None
        self.replay = WatchedReplay(config.replay_size, self.env.num_features, config.replay_prune)
        self.agent = DeepQAgent(self.env.num_features, self.env.num_actions, config, agent_rng, replay=self.replay)
        self._held: Ints = np.zeros(config.num_envs, dtype=np.intp)
        self._decisions = 0
        self.state = self._look(self.learners.observation)

    def _change(self) -> None:
        """Begin flights elsewhere, and drop all but the newest memories if so planned."""
        self.env.heights = self.plan.later
        self.learners.observation, self._held = self.env.reset(), np.zeros_like(self._held)
        if self.plan.keep is not None and len(self.replay):
            old = self.replay
            self.replay = self.agent.replay = WatchedReplay(self.plan.keep, self.env.num_features)
            self.replay.load_state(old.state(self.plan.keep), self.env.num_actions)
            self.replay.added = old.added

    @np.errstate(over="ignore", invalid="ignore")
    def advance(self) -> SmallState:
        """Let every lander take one decision, and learn; return the state. A run that has diverged stays as it is."""
        if self.state.problem:
            return self.state
        if self._decisions == self.plan.change:
            self._change()
        learners = self.learners
        epsilon = exploration(self.config, self.agent.decisions, learners.flights)
        try:
            actions, result = self.agent.train_step(self.env, learners.observation, epsilon, self._held)
        except FloatingPointError as error:
            self.state = replace(self.state, problem=str(error))
            return self.state
        self._decisions += 1
        learners.take(result)
        if self.tests:
            self.tests.take(self.tests.env.step(self.agent.act(self.tests.observation)))
        self._held = np.where(result.ended, 0, actions)
        self.state = self._look(result.observation)
        return self.state

    def _look(self, observation: Floats) -> SmallState:
        values = in_points(self.agent.q_values(observation).max(axis=1), self.config.reward_scale)
        learners, tests, replay = self.learners, self.tests, self.replay
        oldest = replay.added - len(replay)
        memory = Memory(oldest, replay.added, oldest + (replay.drawn - replay.start) % replay.capacity)
        tested, passed = (tests.flown, tests.landed) if tests else (None, None)
        done, value = (self._decisions, learners.flights, learners.landed), float(values.mean())
        return SmallState(*done, value, learners.flown, memory, tested, passed)


def small_runs(
    configs: Sequence[Config], seed: int, plan: Plan | None = None
) -> Generator[tuple[tuple[SmallState, ...]], None, None]:
    """Run some configurations side by side from the same seed, without end; each turn yields their states."""
    runs = [SmallRun(config, seed, plan) for config in configs]
    yield (tuple(run.state for run in runs),)
    while True:
        yield (tuple(run.advance() for run in runs),)
