"""Live lander training, which can be inspected and steered while it goes on."""

from __future__ import annotations

import time
from collections.abc import Callable, Generator
from operator import attrgetter
from pathlib import Path
from typing import Any, Final

import numpy as np

from ai.common.environment import Ints, StepResult
from ai.lander.environment import LanderEnv
from ai.training.autosave import Autosave
from ai.training.checkpoints import restore_checkpoint, resume_run
from ai.training.config import Config
from ai.training.demonstrations import Demonstration, read, taught, teach
from ai.training.edits import EDITED, EditCommand, NetworkEditor
from ai.training.explanations import Explanations
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
from ai.training.loop import Progress, Training
from ai.training.messages import (
    AddDemonstrations,
    AutosaveTo,
    ChangeSetting,
    Command,
    Explain,
    Message,
    NetworkState,
    Refused,
    RestoreCheckpoint,
    RunStarted,
    Save,
    SwarmState,
    problem_of,
)
from ai.training.schedule import InForce, in_force
from ai.training.validation_flights import ValidationFlights

POINT_DECISIONS: Final = 256  # at least so many between two points
NETWORK_SECONDS: Final = 0.25
TAUGHT: Final = "demonstrations"  # the name of the change that gives it some to learn from
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
        run.restore_last_checkpoint()
        raise
    finally:
        run.end()


class _LiveRun:
    """Live run: a Training, its history, its messages, and the folder it is saved to."""

    def __init__(self, training: Training, history: History, keep: Path | None, clock: Callable[[], float]) -> None:
        if not isinstance(training.env, LanderEnv):
            raise ValueError(f"only landers can be looked into, not {training.config.env}")
        self.training, self.history, self.env = training, history, training.env
        history.reward_scale = training.config.reward_scale
        training.clock = clock
        training.on_step = self._on_step
        training.evaluate_every = 0  # that is done here, bit by bit, so that the landers never stand still for it
        self._validation = ValidationFlights(training)
        self._autosave = Autosave(training, history, keep)
        self._explanations = Explanations(training)
        self._editor = NetworkEditor(training.agent)
        self._swarm_state = self._swarm_state_of(self.env.outcome)
        self._network_state_at = 0.0
        self._point_at = 0
        self._checkpoint_at = training.agent.decisions + self._checkpoint_every
        self._began_learning = training.agent.gradient_steps
        self._turned_at: dict[str, float] = {}  # by the clock, when each knob was turned last
        self._learned_from: set[Demonstration] = set()
        self._messages: list[Message] = []

    @property
    def _checkpoint_every(self) -> int:
        """Decisions between checkpoints: sparser as the run gets longer, so that the first hours keep them all."""
        return max(40 * self.env.num_envs, 2_500, self.training.agent.decisions // 50)

    def begin(self) -> tuple[Message, ...]:
        """Say how the run begins."""
        training = self.training
        self._messages = [
            RunStarted(training.config, training.seed, training.agent.decisions),
            self._swarm_state,
            *self._state_messages(),
        ]
        if not self.history.checkpoints:
            self._record(self._checkpoint(0.0))
        return self._flush()

    def advance(self) -> tuple[Message, ...]:
        """Let every lander take one decision; return the messages about it."""
        training = self.training
        began, before = training.clock(), training.agent.decisions
        progress = training.advance()
        self._record_validation(self._validation.go_on(before, 1 + self.env.num_envs // 256))
        now = training.clock()
        training.seconds += now - began
        self._messages.append(self._swarm_state)
        if now >= self._network_state_at:
            self._network_state_at = now + NETWORK_SECONDS
            self._messages += self._state_messages()
        if progress.decisions >= self._point_at:
            self._point_at = progress.decisions + POINT_DECISIONS
            self._record(self._point(progress))
        if progress.decisions >= self._checkpoint_at and not training.agent.paused:
            self._record(self._checkpoint(progress.success_rate))
            self._checkpoint_at = progress.decisions + self._checkpoint_every
        self._explanations.keep()
        if not training.agent.paused:  # what is edited is only looked at, until it learns on from there
            self._messages += self._autosave.go_on(now)
        return self._flush()

    def carry_out(self, command: Command) -> tuple[Message, ...]:
        """Carry out a command, without a decision; return the answer."""
        match command:
            case ChangeSetting():
                self._change(command)
            case RestoreCheckpoint():
                self._restore_checkpoint(command)
            case AddDemonstrations():
                self._teach(command)
            case Explain():
                self._explain(command)
            case AutosaveTo(folder):
                self._autosave.move_to(folder)
            case Save(folder):
                self._record_validation(self._validation.finish())
                self._messages.append(self._autosave.save(folder))
            case _:
                self._edit(command)
        return self._flush()

    def restore_last_checkpoint(self) -> None:
        """Restore the networks from the last checkpoint, when training has diverged since."""
        self._editor.forget()
        restore_checkpoint(self.training.agent, self.history.checkpoints[-1])

    def end(self) -> None:
        """Save what has not been saved, without an edit that was only looked at; wait until it is on the disk."""
        if self.training.agent.paused:
            self._editor.restore()
        self._autosave.end()

    def _flush(self) -> tuple[Message, ...]:
        told, self._messages = tuple(self._messages), []
        return told

    def _record(self, entry: Entry) -> None:
        self.history.append(entry)
        self._messages.append(entry)

    def _on_step(self, result: StepResult) -> None:
        self._swarm_state = self._swarm_state_of(result.outcome)
        self._explanations.follow(self.env.actions, result)

    def _swarm_state_of(self, outcome: Ints) -> SwarmState:
        env, training = self.env, self.training
        return SwarmState(
            env.position.astype(np.float32),
            env.angle.astype(np.float32),
            env.actions.astype(np.int8),
            outcome.astype(np.int8),
            training.statistics.earned.astype(np.float32),
            training.agent.decisions,
        )

    def _network_state(self) -> NetworkState:
        agent = self.training.agent
        return NetworkState(
            agent.online.values.copy(),
            agent.online.gradients.copy(),
            self.training.observation[CAREFUL].copy(),
            agent.decisions,
        )

    def _state_messages(self) -> tuple[NetworkState, InForce]:
        """Return what is sent a few times a second, and whenever a command has changed it."""
        training = self.training
        return self._network_state(), in_force(training.config, training.agent.decisions, training.episodes)

    def _point(self, progress: Progress) -> Point:
        flown = 1.0 if self.training.statistics.known else np.nan
        agent = self.training.agent
        learnt = 1.0 if agent.gradient_steps > self._began_learning and not agent.paused else np.nan
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
                f"the network was not finite after learning step {agent.gradient_steps}; "
                f"most likely the learning rate of {agent.optimizer.learning_rate:g} is too high"
            )
        normalizer = agent.normalizer.to_json() if agent.normalizer else None
        return Checkpoint(self.training.seconds, agent.decisions, success, values, normalizer)

    def _record_validation(self, validation: Validation | None) -> None:
        if validation is not None:
            self._record(validation)

    def _change(self, command: ChangeSetting) -> None:
        before = self.training.config
        try:
            self.training.apply_live(before.turned(command.name, command.value))
        except ValueError as error:
            self._messages.append(Refused(command, str(error)))
            return
        name = before.name_now(command.name)
        value = attrgetter(name)
        after = value(self.training.config)
        if after != value(before):
            self._record_change(name, value(before), after, self._amends(name, after))
        self._messages.append(self._state_messages()[1])

    def _teach(self, command: AddDemonstrations) -> None:
        agent = self.training.agent
        try:
            new = [each for each in read(command.path) if each not in self._learned_from]
            used = teach(agent, new)
        except (OSError, ValueError) as error:
            self._messages.append(Refused(command, problem_of(error)))
            return
        self._learned_from.update(new)
        if not used:
            self._messages.append(Refused(command, "there are no landings that this run has not learnt from already"))
            return
        if not self.training.config.success_pass:
            self._change(ChangeSetting("success_pass", taught(self.training.config).success_pass))
        self._record_change(TAUGHT, None, used)

    def _explain(self, command: Explain) -> None:
        try:
            self._messages.append(self._explanations.explain(command.slot, command.decisions))
        except (ValueError, FloatingPointError) as error:
            self._messages.append(Refused(command, str(error)))

    def _record_change(self, name: str, before: Any, after: Any, amends: bool = False) -> None:
        self._record(SettingChange(self.training.agent.decisions, name, before, after, amends))

    def _amends(self, name: str, after: Any) -> bool:
        """Whether a knob is still being turned: a moment after the last time, or without a decision in between."""
        now, last = self.training.clock(), self._turned_at.get(name)
        self._turned_at[name] = now
        if last is None:
            return False
        earlier = next(each for each in reversed(self.history.setting_changes) if each.name == name)
        amends = now - last < TURNING_SECONDS or earlier.decisions == self.training.agent.decisions
        if amends and earlier.before == after:  # back where it was: the mark will be gone
            del self._turned_at[name]
        return amends

    def _edit(self, command: EditCommand) -> None:
        editor, before = self._editor, self._editor.count
        try:
            editor.carry_out(command)
        except ValueError as error:
            self._messages.append(Refused(command, str(error)))
            return
        if editor.count != before:
            self._record_change(EDITED, before, editor.count, self._amends(EDITED, editor.count))
        self._messages += (editor.edits, *self._state_messages())

    def _restore_checkpoint(self, command: RestoreCheckpoint) -> None:
        checkpoint = self.history.checkpoint_at(command.decisions)
        if checkpoint is None:
            self._messages.append(Refused(command, "this run has no checkpoints yet"))
            return
        self._editor.forget()
        restore_checkpoint(self.training.agent, checkpoint)
        self._record_change(REVERTED, None, checkpoint.decisions)
        self._messages += (self._editor.edits, *self._state_messages())
