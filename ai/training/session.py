"""A run that is watched and steered while it goes on, of any kind.

A session is an iterator (`Session.live`): each turn carries out the commands of its inbox, or takes one step of the
run, and returns its messages. What is around every run is here: how it begins and ends, knobs, history, files.
`lander_session` and `digit_session` say what is shown of each kind, and which further commands it knows.
"""

from __future__ import annotations

import time
from abc import ABC, abstractmethod
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from operator import attrgetter
from pathlib import Path
from typing import Any, ClassVar, Generic, Self, TypeVar

from ai.files.reading import problem_in
from ai.run import Run
from ai.training.history import Entry, History, SettingChange
from ai.training.messages import Command, Refused, RunStarted
from ai.training.run import Keeper
from ai.training.run import resume as resume_run

R = TypeVar("R", bound=Run)
Commands = dict[str, Callable[..., None]]


class Session(ABC, Generic[R]):
    """Session of one run, which is kept in the folder `keep`; one that goes on has its history in `source`.

    Attributes:
        kind: the class of its run.
        columns: what its history measures.
        commands: the method that carries out each command, by its name; a subclass adds its own. One that raises
            OSError, ValueError or FloatingPointError has changed nothing.
        inbox: commands that wait for their turn.
        messages: to be returned with the next turn.

    """

    kind: type[R]
    columns: ClassVar[Sequence[str]]

    def __init__(self, training: R, keep: Path | None, source: Path | None) -> None:
        self.training, self.keep = training, keep
        self.history = History.read(source, self.columns) if source else History(self.columns)
        self.keeper = Keeper(training, keep, self.history)
        self.inbox: deque[Command] = deque()
        self.messages: list[Any] = []
        self._begun = self._finished = self._closed = False
        self._ending: Iterator[None] | None = None

    @classmethod
    def live(
        cls, config: Any, seed: int = 0, *, keep: Path | None = None, resume: Path | None = None,
        clock: Callable[[], float] = time.monotonic, **options: Any,
    ) -> Self:  # fmt: skip
        """Return the session of a new run, or of the one kept in `resume`, which has its own settings and seed.

        `clock` counts seconds; `options` are those of the run. Raises what its run does, and ModelFormatError if there
        is nothing to go on from.
        """
        kind = cls.kind
        training = resume_run(kind, resume, **options) if resume else kind(config, seed, **options)
        training.clock = clock
        return cls(training, keep, resume)

    # What a kind says

    @abstractmethod
    def show(self) -> None:
        """Tell how it stands, at the beginning and when a command has changed it."""

    @abstractmethod
    def tell(self, progress: Any) -> None:
        """Tell of a step that was taken."""

    def last_words(self) -> Iterator[None]:
        """Do what is left when no more steps are taken, in as many turns as it likes."""
        yield

    def go_back(self) -> None:
        """Put the networks back to the last good ones, when training has diverged."""
        self.training.restore_best()

    # What is around it

    def __iter__(self) -> Self:
        return self

    def __next__(self) -> tuple[Any, ...]:
        """Carry out the commands of the inbox, or take a step of the run or of its end; return the messages.

        The first turn only says how the run begins. The run is kept now and then, when it is over, and when the session
        is closed. Raises FloatingPointError, which names the learning step and the likely cause, when training
        diverges.
        """
        training = self.training
        try:
            if self._closed:
                raise StopIteration
            if self.inbox:
                while self.inbox:
                    self._carry_out(self.inbox.popleft())
            elif not self._begun:
                self._begin()
            elif self._ending is None and not (training.done or self._finished):
                self.tell(training.advance())
                self.messages += self.keeper.go_on(training.clock())
            else:
                self._ending = self._ending or self.last_words()
                next(self._ending)
        except FloatingPointError:
            self.go_back()
            self.close()
            raise
        except BaseException:
            self.close()
            raise
        messages, self.messages = tuple(self.messages), []
        return messages

    def send(self, command: Command) -> tuple[Any, ...]:
        """Take the turn of a command; return the messages."""
        self.inbox.append(command)
        return next(self)

    def close(self) -> None:
        """Keep what has not been kept, and wait until it is on the disk."""
        if not self._closed:
            self._closed = True
            self.keeper.end()

    def _begin(self) -> None:
        training, self._begun = self.training, True
        self.messages.insert(
            0, RunStarted(training.config, training.seed, training.moment, training.lost, training.steps)
        )
        self.show()

    def _carry_out(self, command: Command) -> None:
        """Carry out a command, or tell why it cannot be."""
        name, *arguments = command
        try:
            self.commands[name](self, *arguments)
        except (OSError, ValueError, FloatingPointError) as error:
            self.messages.append(Refused(command, problem_in(error)))

    def record(self, entry: Entry) -> None:
        """Add an entry to the history, and tell it."""
        self.history.append(entry)
        self.messages.append(entry)

    def record_change(self, name: str, before: Any, after: Any) -> None:
        """Record that a knob was turned, or what else was changed from outside."""
        self.record(SettingChange(self.training.moment, name, before, after, self.training.seconds))

    # Commands

    def change(self, name: str, value: Any) -> None:
        """Turn a live knob, by its field's name, or "reward_weights.time"; raises ValueError for what cannot be."""
        before = self.training.config
        self.training.apply_live(before.turned(name, value))
        read = attrgetter(name)
        if read(self.training.config) != read(before):
            self.record_change(name, read(before), read(self.training.config))
        self.show()

    def save(self, folder: Path) -> None:
        """Save the run, as it is now, to a folder."""
        self.messages.append(self.keeper.save(folder))

    def _finish(self) -> None:
        """Take no more steps: keep the run, measure it, and end."""
        self._finished = True

    commands: ClassVar[Commands] = {"change": change, "save": save, "finish": _finish}
