"""Training loop: what goes on around an agent's decisions, with validation and the choice of the best network.

What happens in one decision, from the observation to the update of the target network, is on one page of
`ai.agent.agent`: `DeepQAgent.train_step`, with the list of all that differs from the papers. Here is what goes on
around it: schedules of the environment, episodes that end and begin, statistics, measurements.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Generator
from copy import deepcopy
from dataclasses import dataclass
from itertools import repeat
from pathlib import Path
from typing import Any, Final, Self, TypeVar

import numpy as np

from ai.agent.agent import DeepQAgent
from ai.agent.normalizer import Normalizer
from ai.agent.replay import ReplayBuffer, make_replay
from ai.agent.schedule import exploration, exploration_of_each
from ai.agent.storage import KIND, LAST, write_agent
from ai.environment import Env, Floats, StepResult
from ai.files.reading import count_of, inside, number_of, read_json
from ai.files.schema import read_as
from ai.lander.rewards import REWARDS
from ai.nn.storage import reading
from ai.run import TRAINING_FILE, Measured, Run
from ai.training.config import ANYWHERE, LANDER, Config, load_agent, presets_of
from ai.training.gym_task import GymTask
from ai.training.state import MOST, State
from ai.training.statistics import EpisodeStatistics
from ai.training.tasks import TEST_SEED, VALIDATION_SEED, AnywhereTask, LanderTask, Score, Task, Trial

PARTS: Final = tuple(REWARDS)
A = TypeVar("A", bound=DeepQAgent)
Network = tuple[Floats, Normalizer | None]  # parameters, and the scale of its observations


@dataclass(frozen=True)
class Progress(Measured):
    """Progress of a run after one decision in every environment.

    Unknown are shares and means before the first episode has ended, and what is learned before the first learning step,
    which after a resumption waits for new memories.
    """

    decisions: int  # of single landers
    steps: int  # of their physics: a decision is several
    updates: int  # learning steps
    episodes: int  # that have ended
    success_rate: float  # of the last hundred episodes, random actions included; so are the next four
    mean_return: float  # points of reward
    crashed: float  # shares: that ended in outcome 2, 3 and 4
    out_of_bounds: float
    timed_out: float
    loss: float  # error of the last learning step
    mean_q: float  # what the network expects, in scaled points
    epsilon: float  # share of random actions
    stage: int  # of the curriculum
    steps_per_second: float  # over the last hundred decisions
    parts: tuple[float, ...] = (0.0,) * len(PARTS)  # of the mean return, what each part of the reward has paid


class Training(Run):
    """Training run of the lander, or of another task: all state that changes as it goes on.

    New flights follow from the seed and from the moment `since` when they begin: 0, or when a run goes on.

    Attributes:
        evaluate_every: decisions between two validations, 0 for never; by default, as often as suits the task.
        validation_episodes: episodes of one; by default, as many as suit the task.
        validation_pace: decisions of its flights after one of the run's; None for all at once.
        evaluated: how many decisions the network had taken that was measured last.
        evaluation: the score of a validation that ended with the last step, or None.
        best_network: the network of the best score.
        on_step: is shown every step, before ended slots begin anew.

    """

    kind = KIND

    def __init__(
        self,
        config: Config,
        seed: int = 0,
        *,
        evaluate_every: int | None = None,
        validation_episodes: int | None = None,
        since: int = 0,
    ) -> None:
        super().__init__(config, seed)
        self.task = task = task_of(config)
        self.evaluate_every = task.evaluate_every if evaluate_every is None else evaluate_every
        self.validation_episodes = task.validation_episodes if validation_episodes is None else validation_episodes
        self.validation_pace: int | None = None
        self.evaluated: int | None = None
        self.evaluation: Score | None = None
        self.on_step: Callable[[StepResult], None] | None = None
        agent_rng, env_rng = np.random.default_rng([seed, since] if since else seed).spawn(2)
        self.agent = self._new_learner(config, agent_rng)
        self.env: Env = task.make_env(env_rng)
        try:
            self.observation = self.env.reset()
        except BaseException:
            self.task.close_env(self.env)
            raise
        self.episodes = 0
        self.statistics = EpisodeStatistics(self.env.num_envs)
        self.best: Score | None = None
        self.best_network: Network | None = None
        self._clocked: deque[float] = deque(maxlen=100)  # `seconds` at the last decisions
        self._began_learning = 0  # gradient steps that were taken before the run began, or went on
        self._held = np.zeros(self.env.num_envs, dtype=np.intp)
        self._trial: Trial[Score] | None = None  # a measurement that is under way

    def _new_learner(self, config: Config, rng: np.random.Generator) -> DeepQAgent:
        return self._new_agent(DeepQAgent, config, rng, replay=make_replay(config, self.task.num_features))

    def _new_agent(self, kind: type[A], config: Config, rng: np.random.Generator | None = None, **parts: Any) -> A:
        task = self.task
        parts |= {"symmetry": task.symmetry, "action_chances": task.action_chances}
        return kind(task.num_features, task.num_actions, config, rng, **parts)

    @property
    def config(self) -> Config:
        """The agent's: there is no other."""
        return Config.of(self.agent)

    @property
    def moment(self) -> int:
        return self.agent.decisions

    @property
    def epsilon(self) -> float:
        """Share of random actions now."""
        return exploration(self.config, self.agent.decisions, self.episodes)

    def take_step(self) -> None:
        """Let every lander take one decision, learn from it, and evaluate if it is time.

        Raises DivergenceError, a FloatingPointError, when a number is no longer finite.
        """
        agent, statistics, before = self.agent, self.statistics, self.agent.decisions
        self._clocked.append(self.seconds)
        self.task.update_env(agent.decisions, self.env)
        each = exploration_of_each(agent.config, self.epsilon, self.env.num_envs)
        actions, result = agent.train_step(self.env, self.observation, each, self._held)
        statistics.add(result)
        if self.on_step is not None:
            self.on_step(result)
        self.observation = result.observation
        if result.ended.any():
            self.episodes += int(result.ended.sum())
            statistics.finish(result)
            self.observation = self.env.reset(result.ended)
        self._held = np.where(result.ended, 0, actions)
        self.evaluation = self._measure(before)

    @property
    def progress(self) -> Progress:
        agent, statistics, skip = self.agent, self.statistics, self.config.frame_skip
        flown = 1.0 if statistics.known else np.nan
        learnt = 1.0 if agent.gradient_steps > self._began_learning else np.nan
        landed, crashed, out_of_bounds, timed_out = (flown * share for share in statistics.shares)
        return Progress(
            self.seconds, agent.decisions, agent.decisions * skip, agent.gradient_steps, self.episodes, landed,
            flown * statistics.mean_return, crashed, out_of_bounds, timed_out, learnt * agent.loss,
            learnt * agent.mean_q, self.epsilon, self.env.stage, self._pace(), statistics.parts or Progress.parts,
        )  # fmt: skip

    def _pace(self) -> float:
        """Physics steps a second, by the time that the last hundred decisions took."""
        spent = self.seconds - self._clocked[0] if self._clocked else 0.0
        return len(self._clocked) * self.env.num_envs * self.config.frame_skip / spent if spent > 0 else 0.0

    def __str__(self) -> str:
        """Say how it stands."""
        progress, best = self.progress, f" best {self.best.figure}" if self.best else ""
        if not self.statistics.known:
            recent = "no episode has ended"
        elif self.config.env in (LANDER, ANYWHERE):
            recent = f"landed {progress.success_rate:.0%} of the last 100"
        else:
            recent = f"return {progress.mean_return:.1f}, mean of the last 100"
        return f"{recent}, ε {progress.epsilon:.2f}, {progress.decisions:,} decisions{best}"

    def apply_live(self, config: Config) -> None:
        """Take over the live knobs of another configuration; what was paid otherwise is forgotten."""
        before, config = self.config, self.config.with_live(config)
        if config.reward_weights != before.reward_weights:
            for buffer in self.buffers.values():
                buffer.clear()
        self.task.apply_live(config, self.env)
        self.agent.apply_live(config)
        self.agent.action_chances = self.task.action_chances

    # Validation

    def _measure(self, before: int) -> Score | None:
        """Begin the validation that is due, and go on with it; return the score once there is one."""
        # It depends on decisions alone: not on the clock, and not on whether a run was interrupted.
        every, now = self.evaluate_every, self.agent.decisions
        if not every or now // every == before // every:
            return self.validate(self.validation_pace)
        score = self.validate()  # of the one before, if it is still under way
        self._trial = self._validation(self.last_agent())
        return score if self.validation_pace else self.validate()

    def _validation(self, agent: DeepQAgent) -> Trial[Score]:
        """Fly validation episodes; keep the network if it is the best so far."""
        score: Score = yield from self.task.trial(agent, self.validation_episodes, VALIDATION_SEED)
        self.evaluated = agent.decisions
        if score.better_than(self.best):
            self.best, self.best_network = score, _network(agent)
        return score

    def validate(self, decisions: int | None = None) -> Score | None:
        """Go on with the validation that is under way, for so many decisions of its flights, or to its end.

        Returns the score once there is one.
        """
        trial, self._trial = self._trial, None
        if trial is None:
            return None
        for _ in range(decisions) if decisions else repeat(None):
            if self.stopping():
                trial.close()
                return None
            try:
                next(trial)
            except StopIteration as done:
                score: Score = done.value
                return score
        self._trial = trial
        return None

    def evaluate(self) -> Score | None:
        """Try the validation episodes, and keep the network if it is the best so far; None if that was stopped."""
        self._end_trial()
        self._trial = self._validation(self.last_agent())
        return self.validate()

    def _end_trial(self) -> None:
        if self._trial is not None:
            self._trial.close()

    def best_agent(self) -> DeepQAgent:
        """Return an agent that flies with the best network found so far."""
        agent = self._new_agent(DeepQAgent, self.config)
        agent.restore(*deepcopy(self.best_network or _network(self.agent)))
        agent.decisions, agent.gradient_steps = self.agent.decisions, self.agent.gradient_steps
        return agent

    def last_agent(self) -> DeepQAgent:
        """Return a copy of the agent that learns, with an empty replay buffer."""
        agent = self._new_agent(DeepQAgent, self.config)
        agent.copy_from(self.agent)
        return agent

    def restore_best(self) -> None:
        self.diverged = True
        if self.best_network is not None:
            self.agent.restore(*deepcopy(self.best_network))

    # On disk

    def snapshot(self, final: bool = False) -> tuple[dict[str, Any], Callable[[Path], None]]:
        """Return what its training file says now, and what writes its networks as they are now into a new folder.

        One that has not been evaluated yet has its latest network for its best. This measures nothing: the clock may
        decide when it is called, but never which network is best. But a `final` one considers the latest network for
        the best too, and measures the best one on test spawns, which neither trained nor chose it.
        """
        if final and self.evaluated != self.agent.decisions:
            self.evaluate()
        agent, config = self.agent, self.config
        described = {
            "env": config.env, **config.described(presets_of(config.env)), "seed": self.seed,
            "decisions": agent.decisions, "updates": agent.gradient_steps, "episodes": self.episodes,
            "landings": self.env.landings, "seconds": round(self.seconds, 3),
            "best": self.best.to_json() if self.best else None,
        }  # fmt: skip
        best, last = self.best_agent(), self.last_agent()

        def write(folder: Path) -> None:
            write_agent(best, folder)
            write_agent(last, folder / LAST)

        if final:
            self._trial = self.task.trial(best, self.task.test_episodes, TEST_SEED)
            if score := self.validate():
                described["evaluation"] = score.to_json()
        return described, write

    def close(self) -> None:
        self._end_trial()
        self.task.close_env(self.env)

    @classmethod
    def begun(cls, folder: Path, *, env: str | None = None, **_: Any) -> Self:
        best = load_agent(folder, env=env)[0]
        with reading(folder, LAST):
            last, config = load_agent(inside(folder, LAST), env=env)
        with reading(folder, TRAINING_FILE):
            described = read_json(inside(folder, TRAINING_FILE))
            run = cls(config, count_of(described["seed"], most=10**40), since=last.decisions)
            run._go_on_from(best, last, described)
        return run

    def _go_on_from(self, best: DeepQAgent, last: DeepQAgent, described: Any) -> None:
        """Take over what a folder holds; raises KeyError, TypeError or ValueError where it makes no sense."""
        task = self.task
        for agent in (best, last):
            if (agent.num_features, agent.num_actions) != (task.num_features, task.num_actions):
                raise ValueError(f"its network is not made for {self.config.env}")
        if described["best"] is not None:
            if best.network.values.shape != self.agent.network.values.shape:
                raise ValueError("the best network and the last one are of different sizes")
            self.best, self.best_network = read_as(task.score, described["best"]), _network(best)
        self.episodes, self.env.landings = count_of(described["episodes"]), count_of(described["landings"])
        self.observation = self.env.reset()  # where flights begin depends on the landings
        self.seconds = float(number_of(described["seconds"], 0))
        self.agent.copy_from(last)
        self._began_learning = self.agent.gradient_steps

    @property
    def buffers(self) -> dict[str, ReplayBuffer]:
        """Replay buffers that there are, by name."""
        agent = self.agent
        return {name: getattr(agent, name) for name in ("replay", "successes") if name in vars(agent)}

    def state(self) -> State:
        state: State = {"rng": self.agent.rng.bit_generator.state}
        room = MOST
        for name, buffer in self.buffers.items():
            held = buffer.state(room // buffer.records.itemsize)
            room -= len(held["action"]) * buffer.records.itemsize
            state |= {f"{name}.{part}": array for part, array in held.items()}
        return state

    def load_state(self, state: State) -> None:
        self.agent.rng.bit_generator.state = state["rng"]
        for name in ("replay", "successes"):
            held = {
                part.removeprefix(f"{name}."): array for part, array in state.items() if part.startswith(f"{name}.")
            }
            if held:
                getattr(self.agent, name).load_state(held, self.task.num_actions)


def _network(agent: DeepQAgent) -> Network:
    return agent.network.values.copy(), deepcopy(agent.normalizer)


def task_of(config: Config) -> Task[Any]:
    """Make the task that a configuration names.

    Raises ValueError for an environment that does not exist or cannot be learnt by Q-learning, and ImportError
    where Gymnasium is needed and not installed.
    """
    if config.env in (LANDER, ANYWHERE):
        return LanderTask(config) if config.env == LANDER else AnywhereTask(config)
    return GymTask(config)


def run(config: Config, seed: int = 0, **options: Any) -> Generator[Progress, Config | None, None]:
    """Train without end, yielding after each decision of all landers; send a Config to change the live knobs.

    `options` are those of `Training`. Raises what `task_of` raises, and DivergenceError when a number is no longer
    finite.
    """
    training = Training(config, seed, **options)
    while True:
        changed = yield training.advance()
        if changed is not None:
            training.apply_live(changed)
