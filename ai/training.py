"""Training as a generator, evaluation, and the rule of the best checkpoint."""

from __future__ import annotations

from collections import deque
from collections.abc import Generator
from dataclasses import asdict, dataclass, field
from typing import Any, Final

import numpy as np

from ai.agent import DeepQAgent, Symmetry
from ai.config import CURRICULUM, Config
from ai.env import Bools, Doubles, Floats
from ai.lander import (
    MIRROR_ACTIONS,
    MIRROR_FEATURES,
    MIRROR_SIGNS,
    NUM_ACTIONS,
    NUM_FEATURES,
    LanderEnv,
    Outcome,
)
from ai.pilots import Pilot
from ai.schedule import geometric, linear
from ai.spawns import Curriculum

LANDER_SYMMETRY: Final = Symmetry(MIRROR_SIGNS, MIRROR_FEATURES, MIRROR_ACTIONS)
VALIDATION_SEED: Final = 1_000_003  # spawns that choose the best checkpoint
TEST_SEED: Final = 2_000_003  # spawns that have no say in anything, to measure a finished network by


@dataclass(frozen=True)
class Evaluation:
    """What became of a number of flights with no random actions in them."""

    episodes: int
    success: float  # shares of the flights
    crash: float
    out_of_bounds: float
    time_out: float
    mean_return: float
    mean_time: float | None  # seconds, of the landings; None without any
    mean_fuel: float | None  # seconds of main engine, of the landings
    switches: float  # times a second that an engine goes on or off, of all flights

    def to_json(self) -> dict[str, float | None]:
        """Plain values."""
        return asdict(self)

    def better_than(self, other: Evaluation | None) -> bool:
        """Whether more flights landed or, if as many did, they earned more."""
        return other is None or (self.success, self.mean_return) > (other.success, other.mean_return)


def evaluate(pilot: Pilot, episodes: int, seed: int, spawn: str = "random", frame_skip: int = 4) -> Evaluation:
    """Fly `episodes` flights at once, without exploration, from spawns that follow from `seed`."""
    env = LanderEnv(episodes, seed, spawn, frame_skip)
    observation = env.reset()
    returns: Doubles = np.zeros(episodes)
    switches, last = 0, np.zeros(episodes, dtype=np.intp)
    while (flying := env.outcome == Outcome.FLYING).any():
        actions = np.zeros(episodes, dtype=np.intp)
        actions[flying] = pilot.act(observation[flying])
        switches += int(((actions >= 3) != (last >= 3))[flying].sum() + ((actions % 3) != (last % 3))[flying].sum())
        last = actions
        result = env.step(actions)
        observation = result.observation
        returns += result.reward
    share = {outcome: float((env.outcome == outcome).mean()) for outcome in Outcome}
    landed = env.outcome == Outcome.LANDED
    return Evaluation(
        episodes, share[Outcome.LANDED], share[Outcome.CRASHED], share[Outcome.OUT_OF_BOUNDS],
        share[Outcome.TIMED_OUT], float(returns.mean()),
        float(env.time[landed].mean()) if landed.any() else None,
        float(env.fuel[landed].mean()) if landed.any() else None,
        switches / float(env.time.sum()),
    )  # fmt: skip


@dataclass
class Progress:
    """How a run stands after one decision of all landers."""

    decisions: int  # of single landers
    updates: int
    episodes: int
    success_rate: float  # of the last 100 episodes, exploration included
    mean_return: float  # of the same
    loss: float
    mean_q: float
    epsilon: float
    stage: int  # of the curriculum
    evaluation: Evaluation | None = None  # when one was due
    best: Evaluation | None = None


@dataclass
class Training:
    """A run of the lander: everything that changes as it goes on."""

    config: Config
    seed: int = 0
    evaluate_every: int = 50_000  # decisions; 0 for never
    validation_episodes: int = 500
    agent: DeepQAgent = field(init=False)
    env: LanderEnv = field(init=False)
    best: Evaluation | None = None
    best_values: Floats | None = None
    seconds: float = 0.0  # spent, as whoever runs it counts them

    def __post_init__(self) -> None:
        config = self.config
        agent_rng, env_rng = np.random.default_rng(self.seed).spawn(2)
        main = config.random_main
        chances = np.array([1 - main] * 3 + [main] * 3) / 3
        self.agent = DeepQAgent(
            NUM_FEATURES, NUM_ACTIONS, config, agent_rng, symmetry=LANDER_SYMMETRY, action_chances=chances
        )
        spawn = Curriculum() if config.spawn == CURRICULUM else config.spawn
        self.env = LanderEnv(config.num_envs, env_rng, spawn, config.frame_skip, weights=config.weights)
        self.observation = self.env.reset()
        self.episodes = 0
        self._evaluated = 0
        self._landed: deque[bool] = deque(maxlen=100)
        self._returns: deque[float] = deque(maxlen=100)
        self._earned: Doubles = np.zeros(config.num_envs)

    @property
    def epsilon(self) -> float:
        """Share of random actions now."""
        config = self.agent.config
        start, end = config.epsilon_start, config.epsilon_end
        start = geometric(start, end, config.epsilon_decay, self.episodes)
        return linear(start, end, self.agent.decisions, config.epsilon_decisions) if config.epsilon_decisions else start

    def _spread(self, epsilon: float) -> Floats:
        """Each lander's share of random actions: bold ones go on finding what the careful ones never try."""
        reach = np.linspace(1.0, 1.0 - self.agent.config.epsilon_spread, self.env.num_envs)
        return np.asarray(epsilon**reach)

    def advance(self) -> Progress:
        """Let every lander take one decision, learn from it, and evaluate if it is time."""
        agent, env = self.agent, self.env
        epsilon = self.epsilon
        actions = agent.act(self.observation, self._spread(epsilon))
        result = env.step(actions)
        agent.remember(self.observation, actions, result, result.outcome == Outcome.LANDED)
        self.observation = result.observation
        self._earned += result.reward
        if result.ended.any():
            self._finish(result.ended)
            self.observation = env.reset(result.ended)
        agent.learn()
        evaluation = self._evaluate_if_due()
        count = max(1, len(self._landed))
        return Progress(
            agent.decisions, agent.train_count, self.episodes, sum(self._landed) / count,
            sum(self._returns) / count, agent.loss, agent.mean_q, epsilon, env.stage, evaluation, self.best,
        )  # fmt: skip

    def _finish(self, ended: Bools) -> None:
        self.episodes += int(ended.sum())
        self._landed.extend((self.env.outcome[ended] == Outcome.LANDED).tolist())
        self._returns.extend(self._earned[ended].tolist())
        self._earned[ended] = 0.0

    def _evaluate_if_due(self) -> Evaluation | None:
        if not self.evaluate_every or self.agent.decisions - self._evaluated < self.evaluate_every:
            return None
        self._evaluated = self.agent.decisions
        return self.evaluate()

    def evaluate(self) -> Evaluation:
        """Fly the validation spawns, and keep the network if it is the best so far."""
        frame_skip = self.config.frame_skip
        evaluation = evaluate(self.agent, self.validation_episodes, VALIDATION_SEED, "random", frame_skip)
        if evaluation.better_than(self.best):
            self.best, self.best_values = evaluation, self.agent.network.values.copy()
        return evaluation

    def best_agent(self) -> DeepQAgent:
        """Return an agent that flies with the best network found so far."""
        agent = DeepQAgent(NUM_FEATURES, NUM_ACTIONS, self.agent.config)
        values = self.agent.network.values if self.best_values is None else self.best_values
        agent.online.values = agent.target.values = values
        agent.decisions, agent.train_count = self.agent.decisions, self.agent.train_count
        return agent


def run(config: Config, seed: int = 0, **options: Any) -> Generator[Progress, Config | None, None]:
    """Train without end, yielding after each decision of all landers; send a Config to change the live knobs."""
    training = Training(config, seed, **options)
    while True:
        changed = yield training.advance()
        if changed is not None:
            training.agent.config = changed
