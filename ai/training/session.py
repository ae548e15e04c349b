"""Live lander training, which can be inspected and steered while it goes on."""

from __future__ import annotations

import time
from collections.abc import Callable, Generator
from concurrent.futures import Future, ThreadPoolExecutor
from itertools import repeat
from operator import attrgetter
from pathlib import Path
from typing import Any, Final

import numpy as np

from ai.agent.agent import DeepQAgent
from ai.agent.config import Config
from ai.agent.normalizer import Normalizer
from ai.agent.schedule import InForce, in_force
from ai.common.environment import Ints, StepResult
from ai.lander.environment import NUM_ACTIONS, NUM_FEATURES, LanderEnv
from ai.training.checkpoints import resume_run, snapshot
from ai.training.demonstrations import Demonstration, read, taught, teach
from ai.training.history import (
    PARTS,
    REVERTED,
    TURNING_SECONDS,
    Checkpoint,
    Entry,
    History,
    Point,
    SettingChange,
    Validation,
)
from ai.training.lander_task import Evaluation, trial
from ai.training.loop import Progress, Training, passed
from ai.training.messages import (
    AddDemonstrations,
    ChangeSetting,
    Command,
    Message,
    NetworkState,
    Refused,
    RestoreCheckpoint,
    RunStarted,
    Save,
    Saved,
    SwarmState,
)
from ai.training.task import VALIDATION_SEED

__all__ = [
    "CAREFUL", "REVERTED", "TAUGHT", "AddDemonstrations", "ChangeSetting", "NetworkState", "Refused",
    "RestoreCheckpoint", "RunStarted", "Save", "Saved", "SwarmState", "agent_of", "live",
]  # fmt: skip

POINT_DECISIONS: Final = 256  # at least so many between two points
INSIGHT_SECONDS: Final = 0.25
KEEP_SECONDS: Final = 10.0
TAUGHT: Final = "demonstrations"  # the name of the alteration that gives it some to learn from
NOTHING_PAID: Final = (0.0,) * len(PARTS)
CAREFUL: Final = 0  # the lander with the fewest random actions; the last one has the most (Config.epsilon_spread)


def live(
    config: Config,
    seed: int = 0,
    *,
    keep: Path | None = None,
    resume: Path | None = None,
    clock: Callable[[], float] = time.monotonic,
) -> Generator[tuple[Message, ...], Command | None, None]:
    """Train landers without end; every turn is one decision of all landers, and yields its messages.

    The first turn only says how the run begins. A turn that is sent a command carries that out, at once and
    without a decision, and yields the answer. The run saves itself to `keep` now and then and when it is closed.
    With `resume`, it goes on from a saved run, with the settings, seed and history of that. `clock` counts seconds.

    Raises ModelFormatError if there is nothing to resume from, ValueError for settings that are not a lander's, and
    FloatingPointError, which names the learning step and the likely cause, when training diverges.
    """
    if resume is None:
        run = _LiveRun(Training(config, seed), History(), keep, clock)
    else:
        run = _LiveRun(resume_run(resume), History.read(resume), keep, clock)
    try:
        told = run.begin()
        while True:
            command = yield told
            told = run.advance() if command is None else run.carry_out(command)
    except FloatingPointError:
        run.rewind()
        raise
    finally:
        run.end()


def agent_of(config: Config, checkpoint: Checkpoint) -> DeepQAgent:
    """Return an agent that flies as the run did at that checkpoint; raises ValueError if it does not fit."""
    agent = DeepQAgent(NUM_FEATURES, NUM_ACTIONS, config)
    if agent.online.values.shape != checkpoint.values.shape:
        raise ValueError(
            f"the checkpoint has {len(checkpoint.values)} parameters, the network {len(agent.online.values)}"
        )
    agent.restore(checkpoint.values, _normalizer_of(agent, checkpoint))
    agent.decisions = checkpoint.decisions
    return agent


class _ValidationFlights:
    """Validation flights of a network as it is at the start, a few decisions at a time."""

    def __init__(self, training: Training) -> None:
        assert training.validation_episodes is not None
        self.agent = training.last_agent()
        self.score: Evaluation | None = None
        self._flights = trial(self.agent, training.validation_episodes, VALIDATION_SEED, "random",
                              training.config.frame_skip)  # fmt: skip

    def go_on(self, decisions: int | None = None) -> bool:
        """Take so many decisions, or all that are left; return whether the trial is done."""
        if self.score is None:  # flights that are over would have no score a second time
            try:
                for _ in range(decisions) if decisions else repeat(None):
                    next(self._flights)
            except StopIteration as done:
                self.score = done.value
        return self.score is not None


class _LiveRun:
    """Live run: a Training, its history, its messages, and the folder it is saved to."""

    def __init__(self, training: Training, history: History, keep: Path | None, clock: Callable[[], float]) -> None:
        if not isinstance(training.env, LanderEnv):
            raise ValueError(f"only landers can be looked into, not {training.config.env}")
        self.training, self.history, self.env = training, history, training.env
        history.reward_scale = training.config.reward_scale
        training.clock = clock
        training.on_step = self._see
        training.evaluate_every = 0  # that is done here, bit by bit, so that the landers never stand still for it
        self._trial: _ValidationFlights | None = None
        self._sight = self._seen(self.env.outcome)
        self._folder = keep
        self._kept = training.agent.decisions
        self._keep_at = training.clock() + KEEP_SECONDS
        self._insight_at = 0.0
        self._point_at = 0
        self._checkpoint_at = training.agent.decisions + self._checkpoint_every
        self._trouble = ""
        self._began_learning = training.agent.train_count
        self._turned_at: dict[str, float] = {}  # by the clock, when each knob was turned last
        self._lessons: set[Demonstration] = set()
        self._writer = ThreadPoolExecutor(max_workers=1)
        self._writing: Future[None] | None = None
        self._told: list[Message] = []

    @property
    def _checkpoint_every(self) -> int:
        """Decisions between checkpoints: sparser as the run gets longer, so that the first hours keep them all."""
        return max(40 * self.env.num_envs, 2_500, self.training.agent.decisions // 50)

    def begin(self) -> tuple[Message, ...]:
        """Say how the run begins."""
        training = self.training
        self._told = [RunStarted(training.config, training.seed, training.agent.decisions), self._sight, *self._look()]
        if not self.history.checkpoints:
            self._note(self._checkpoint(0.0))
        return self._flush()

    def advance(self) -> tuple[Message, ...]:
        """Let every lander take one decision; return the messages about it."""
        training = self.training
        began, before = training.clock(), training.agent.decisions
        progress = training.advance()
        self._try_the_network(before)
        now = training.clock()
        training.seconds += now - began
        self._told.append(self._sight)
        if now >= self._insight_at:
            self._insight_at = now + INSIGHT_SECONDS
            self._told += self._look()
        if progress.decisions >= self._point_at:
            self._point_at = progress.decisions + POINT_DECISIONS
            self._note(self._point(progress))
        if progress.decisions >= self._checkpoint_at:
            self._note(self._checkpoint(progress.success_rate))
            self._checkpoint_at = progress.decisions + self._checkpoint_every
        if self._folder is not None:
            self._keep_if_due(self._folder, now)
        return self._flush()

    def carry_out(self, command: Command) -> tuple[Message, ...]:
        """Carry out a command, without a decision; return the answer."""
        match command:
            case ChangeSetting():
                self._change(command)
            case RestoreCheckpoint():
                self._revert(command)
            case AddDemonstrations():
                self._teach(command)
            case Save(folder):
                self._finish_trial()
                self._told.append(Saved(folder, self._save(folder)))
        return self._flush()

    def rewind(self) -> None:
        """Restore the networks from the last checkpoint, when training has diverged since."""
        self._go_back(self.history.checkpoints[-1])

    def end(self) -> None:
        """Save what has not been saved, and wait until it is on the disk."""
        if self._folder is not None and self._kept != self.training.agent.decisions:
            self._save(self._folder)
        self._writer.shutdown()

    def _flush(self) -> tuple[Message, ...]:
        told, self._told = tuple(self._told), []
        return told

    def _note(self, entry: Entry) -> None:
        self.history.append(entry)
        self._told.append(entry)

    def _see(self, result: StepResult) -> None:
        self._sight = self._seen(result.outcome)

    def _seen(self, outcome: Ints) -> SwarmState:
        env, training = self.env, self.training
        return SwarmState(
            env.position.astype(np.float32), env.angle.astype(np.float32), env.actions.astype(np.int8),
            outcome.astype(np.int8), training.flights.earned.astype(np.float32), training.agent.decisions,
        )  # fmt: skip

    def _insight(self) -> NetworkState:
        agent = self.training.agent
        return NetworkState(
            agent.online.values.copy(), agent.online.gradients.copy(), self.training.observation[CAREFUL].copy(),
            agent.decisions,
        )  # fmt: skip

    def _look(self) -> tuple[NetworkState, InForce]:
        """Return what is sent a few times a second, and whenever a command has changed it."""
        training = self.training
        return self._insight(), in_force(training.config, training.agent.decisions, training.episodes)

    def _point(self, progress: Progress) -> Point:
        flown = 1.0 if self.training.flights.known else np.nan
        learnt = 1.0 if self.training.agent.train_count > self._began_learning else np.nan
        landed, crashed, out_of_bounds, timed_out = (flown * share for share in progress.shares)
        return Point(
            self.training.seconds, progress.decisions, progress.episodes, flown * progress.success_rate,
            flown * progress.mean_return, learnt * progress.loss, learnt * progress.mean_q, progress.epsilon,
            progress.stage, progress.steps_per_second, landed, crashed, out_of_bounds,
            timed_out, progress.parts or NOTHING_PAID,
        )  # fmt: skip

    def _checkpoint(self, success: float) -> Checkpoint:
        agent = self.training.agent
        values = agent.network.values.copy()
        if not np.isfinite(values).all():
            raise FloatingPointError(
                f"the network was not finite after learning step {agent.train_count}; "
                f"most likely the learning rate of {agent.optimizer.learning_rate:g} is too high"
            )
        normalizer = agent.normalizer.to_json() if agent.normalizer else None
        return Checkpoint(self.training.seconds, agent.decisions, success, values, normalizer)

    def _try_the_network(self, before: int) -> None:
        """Fly a little of the validation flights, if it is time for them; the networks are those of `Training`."""
        training = self.training
        if passed(before, training.agent.decisions, training.task.evaluate_every):
            self._finish_trial()
            self._trial = _ValidationFlights(training)
        elif self._trial is not None and self._trial.go_on(1 + self.env.num_envs // 256):
            self._finish_trial()

    def _finish_trial(self) -> None:
        if self._trial is None:
            return
        trial, self._trial = self._trial, None
        trial.go_on()
        assert trial.score is not None
        best = self.training.keep_if_best(trial.score, trial.agent)
        self._note(Validation(trial.agent.decisions, trial.score.success, trial.score.mean_return, best))

    def _change(self, command: ChangeSetting) -> None:
        before = self.training.config
        try:
            self.training.apply_live(before.turned(command.name, command.value))
        except ValueError as error:
            self._told.append(Refused(command, str(error)))
            return
        name = before.name_now(command.name)
        value = attrgetter(name)
        after = value(self.training.config)
        if after != value(before):
            self._alter(name, value(before), after, self._amends(name, after))
        self._told.append(self._look()[1])

    def _teach(self, command: AddDemonstrations) -> None:
        agent = self.training.agent
        try:
            new = [lesson for lesson in read(command.path) if lesson not in self._lessons]
            used = teach(agent, new)
        except (OSError, ValueError) as error:
            self._told.append(Refused(command, getattr(error, "strerror", None) or str(error)))
            return
        self._lessons.update(new)
        if not used:
            self._told.append(Refused(command, "there are no landings that this run has not learnt from already"))
            return
        if not self.training.config.success_pass:
            self._change(ChangeSetting("success_pass", taught(self.training.config).success_pass))
        self._alter(TAUGHT, None, used)

    def _alter(self, name: str, before: Any, after: Any, amends: bool = False) -> None:
        self._note(SettingChange(self.training.agent.decisions, name, before, after, amends))

    def _amends(self, name: str, after: Any) -> bool:
        """Whether a knob is still being turned: a moment after the last time, or without a decision in between."""
        now, last = self.training.clock(), self._turned_at.get(name)
        self._turned_at[name] = now
        if last is None:
            return False
        earlier = next(each for each in reversed(self.history.alterations) if each.name == name)
        amends = now - last < TURNING_SECONDS or earlier.decisions == self.training.agent.decisions
        if amends and earlier.before == after:  # back where it was: the mark will be gone
            del self._turned_at[name]
        return amends

    def _revert(self, command: RestoreCheckpoint) -> None:
        checkpoint = self.history.checkpoint_at(command.decisions)
        if checkpoint is None:
            self._told.append(Refused(command, "this run has no checkpoints yet"))
            return
        self._go_back(checkpoint)
        self._alter(REVERTED, None, checkpoint.decisions)
        self._told += self._look()

    def _go_back(self, checkpoint: Checkpoint) -> None:
        agent = self.training.agent
        agent.restore(checkpoint.values, _normalizer_of(agent, checkpoint))

    def _keep_if_due(self, folder: Path, now: float) -> None:
        """Start a save in a thread when it is time, and tell when one did not succeed."""
        if self._writing is not None and self._writing.done():
            trouble = _trouble(self._writing)
            if trouble and trouble != self._trouble:
                self._told.append(Saved(folder, trouble))
            self._trouble, self._writing = trouble, None
        if self._writing is None and now >= self._keep_at:
            self._keep_at = now + KEEP_SECONDS
            self._writing = self._write(folder)

    def _write(self, folder: Path) -> Future[None]:
        if folder == self._folder:
            self._kept = self.training.agent.decisions
        return self._writer.submit(snapshot(self.training, self.history).save, folder)

    def _save(self, folder: Path) -> str:
        """Save, wait until it is done, and return what went wrong."""
        return _trouble(self._write(folder))


def _normalizer_of(agent: DeepQAgent, checkpoint: Checkpoint) -> Normalizer | None:
    if checkpoint.normalizer is None:
        return None
    normalizer = Normalizer(agent.num_features)
    try:
        normalizer.load(checkpoint.normalizer)
    except (KeyError, TypeError) as error:
        raise ValueError(f"the checkpoint's scale of observations makes no sense: {error}") from error
    return normalizer


def _trouble(writing: Future[None]) -> str:
    """Wait for a save, and return why it failed, if it did."""
    try:
        writing.result()
    except OSError as error:
        return error.strerror or str(error)
    except ValueError as error:
        return str(error)
    return ""
