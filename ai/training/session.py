"""A run that is watched and steered while it goes on, of any kind.

A session is pulled as a generator (`conduct`): each turn takes one step of the run, and yields its messages. What is
around every run is here: how it begins and ends, knobs, history, files. `lander_session` and `digit_session` say what
is shown of each kind, and which further commands it knows.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Generator, Iterator
from operator import attrgetter
from pathlib import Path
from typing import Any, ClassVar, Final, Generic, TypeVar

from ai.training.history import Entry, History, SettingChange
from ai.training.keeping import Keeper
from ai.training.messages import AutosaveTo, ChangeSetting, Finish, Refused, RunStarted, Save
from ai.training.run import Run, RunKind
from ai.training.state import State

TURNING_SECONDS: Final = 1.0  # between two changes of a knob that is still being turned

Training = TypeVar("Training", bound=Run)
Messages = tuple[Any, ...]


class Session(ABC, Generic[Training]):
    """Session of one run: the run, its history, its messages, and the folder that it is kept in.

    Attributes:
        kind: the kind of run.
        commands: the method that carries out each command, by its class; a subclass adds its own.

    """

    kind: ClassVar[RunKind]
    commands: ClassVar[dict[type, Callable[..., None]]]

    def __init__(self, training: Training, history: History, keep: Path | None) -> None:
        self.training, self.history = training, history
        self.keeper = Keeper(training, self.kind, keep, history, self.state)
        self._turned_at: dict[str, float] = {}  # by the clock, when each knob was turned last
        self.messages: list[Any] = []

    # What a kind says

    @property
    def keeps_still(self) -> bool:
        """Whether the run is not to be kept as it is now."""
        return False

    @abstractmethod
    def show(self) -> None:
        """Tell how it stands, at the beginning."""

    def turned(self) -> None:
        """Tell what else has changed with a knob that was turned."""

    @abstractmethod
    def step(self) -> None:
        """Take one step of the run, and tell of it."""

    @abstractmethod
    def state(self) -> State:
        """Return what the session goes on from, besides the run."""

    def finish_measuring(self) -> None:
        """Bring a measurement that is under way to its end, before a save that was asked for."""

    def last_words(self) -> Iterator[None]:
        """Do what is left when no more steps are taken, in as many turns as it likes."""
        yield

    def go_back(self) -> None:
        """Put the networks back to the last good ones, when training has diverged."""
        self.training.restore_best()

    # What is around it

    def begin(self) -> Messages:
        """Say how the run begins."""
        training = self.training
        self.messages.append(RunStarted(training.config, training.seed, training.moment, training.lost, training.steps))
        self.show()
        return self._flush()

    def advance(self) -> Messages:
        """Take one step of the run; return the messages about it."""
        self.step()
        if not self.keeps_still:
            self.messages += self.keeper.go_on(self.training.clock())
        return self._flush()

    def carry_out(self, command: Any) -> Messages:
        """Carry out a command, without a step; return the answer."""
        self.commands[type(command)](self, command)
        return self._flush()

    def over(self, command: Any) -> bool:
        """Whether no more steps are to be taken."""
        return self.training.done or isinstance(command, Finish)

    def end(self) -> None:
        """Keep what has not been kept, and wait until it is on the disk."""
        self.keeper.end()

    def _flush(self) -> Messages:
        told, self.messages = tuple(self.messages), []
        return told

    def record(self, entry: Entry) -> None:
        """Add an entry to the history, and tell it."""
        self.history.append(entry)
        self.messages.append(entry)

    def record_change(self, name: str, before: Any, after: Any, amends: bool = False) -> None:
        """Record that a knob was turned, or what else was changed from outside."""
        training = self.training
        self.record(SettingChange(training.moment, name, before, after, amends, training.seconds))

    def amends(self, name: str, after: Any) -> bool:
        """Whether a knob is still being turned: a moment after the last time, or without a step in between."""
        now, last = self.training.clock(), self._turned_at.get(name)
        self._turned_at[name] = now
        earlier = next((each for each in reversed(self.history.setting_changes) if each.name == name), None)
        if last is None or earlier is None:
            return False
        amends = now - last < TURNING_SECONDS or earlier.decisions == self.training.moment
        if amends and earlier.before == after:  # back where it was: the mark will be gone
            del self._turned_at[name]
        return amends

    def change(self, command: ChangeSetting) -> None:
        """Turn a live knob."""
        before = self.training.config
        try:
            self.training.apply_live(before.turned(command.name, command.value))
        except ValueError as error:
            self.refuse(command, error)
            return
        name = before.name_now(command.name)
        value = attrgetter(name)
        after = value(self.training.config)
        if after != value(before):
            self.record_change(name, value(before), after, self.amends(name, after))
        self.turned()

    def refuse(self, command: Any, problem: object) -> None:
        """Tell that a command could not be carried out, and why."""
        self.messages.append(Refused(command, str(problem)))

    def _save(self, command: Save) -> None:
        self.finish_measuring()
        self.messages.append(self.keeper.save(command.folder))

    def _autosave_to(self, command: AutosaveTo) -> None:
        self.keeper.move_to(command.folder)


Session.commands = {
    ChangeSetting: Session.change, Save: Session._save, AutosaveTo: Session._autosave_to, Finish: lambda *_: None
}  # fmt: skip


def conduct(session: Session[Any], command: Any = None) -> Generator[Messages, Any, None]:
    """Take a run to its end, or without end; every turn yields the messages of one step.

    The first turn only says how the run begins. A turn that is sent a command carries that out, at once and without a
    step, and yields the answer; `command` is one that came before. The run is kept now and then, when it is over, and
    when the generator is closed. Raises FloatingPointError, which names the learning step and the likely cause, when
    training diverges.
    """
    try:
        command = (yield session.begin()) or command
        while not session.over(command):
            command = yield (session.advance() if command is None else session.carry_out(command))
        for _ in session.last_words():
            while command is not None:
                command = yield session.carry_out(command)
            command = yield session._flush()
        while command is not None:
            command = yield session.carry_out(command)
    except FloatingPointError:
        session.go_back()
        raise
    finally:
        session.end()
