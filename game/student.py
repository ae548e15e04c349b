"""A training run as the window knows it: what its worker has told, and what may be asked of it."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Final

from ai.config import Config
from ai.history import Alteration, Checkpoint, History, Point, Validation
from ai.live import TAUGHT, Begun, Insight, Refused, Revert, Save, Saved, Sight, Teach, live, turned
from ai.nn import ModelFormatError
from game import texts
from game.collection import LibraryError
from game.learner import EARLIER, Learner
from game.library import Library
from game.worker import Worker

# Decisions of all landers a second: one lasts 1/15 s of their own time. None is as fast as it can.
PACES: Final[tuple[float | None, ...]] = (15.0, 60.0, None)


class Student(Learner):
    """One run after another, each in a child process of its own; `poll` once a frame.

    A run keeps itself in the library under no name, until `save` gives it one.

    Attributes:
        history: what has been told of the run that goes on, or of the last one.
        sight, insight: the latest of their kind; None until a run has told of any.
        earlier: the runs before it, by name, the latest first.

    """

    grace = 3.0  # for it keeps itself at the end, which takes longer on a busy machine

    def __init__(self, library: Library) -> None:
        super().__init__()
        self.library = library
        self.config, self.seed = Config(), 0
        self.history = History()
        self.sight: Sight | None = None
        self.insight: Insight | None = None
        self.earlier: list[tuple[str, History]] = []
        self.runs = 0
        self.begun = False  # whether a run has said with what it was begun, since this was last set to False
        self.pace = len(PACES) - 1

    @property
    def kept(self) -> bool:
        """Whether there is a run without a name that could be given one."""
        return self.alive or self.library.rescued() is not None

    def begin(self, config: Config, seed: int, resume: Path | None = None) -> str:
        """Start a run, or go on with a saved one, as soon as the one before has ended.

        Returns what the player should know; of a run that must wait, that comes from `poll`.
        """
        if len(self.history):
            self.earlier.insert(0, (texts.TRAIN_RUN.format(number=self.runs), self.history))
            del self.earlier[EARLIER:]
        self.history = History()
        self.config, self.seed = config, seed
        self.sight = self.insight = None
        self.runs += 1
        return self._start(lambda: self._begin(config, seed, resume))

    def _begin(self, config: Config, seed: int, resume: Path | None) -> str:
        note = ""
        try:
            if resume is not None:
                self.history = History.read(resume)
            if resume != self.library.unsaved:
                self.library.discard_rescued()  # to where it can still be brought back from
        except (ModelFormatError, LibraryError) as error:
            note = str(error)
        self._worker = Worker(live, config, seed, keep=self.library.unsaved, resume=resume)
        self._worker.set_pace(PACES[self.pace])
        return note

    @property
    def lessons(self) -> int:
        """Of how many demonstrations this run has learnt."""
        return sum(each.after for each in self.history.alterations if each.name == TAUGHT and type(each.after) is int)

    def teach(self, demonstrations: Path) -> None:
        """Let the run learn from a file of demonstrations as well; that is told by `poll`."""
        self._send(Teach(demonstrations))

    def set_pace(self, index: int) -> None:
        """Choose one of the paces."""
        self.pace = index
        self._ask(lambda worker: worker.set_pace(PACES[index]))

    def revert(self, checkpoint: Checkpoint) -> None:
        """Let the network be what it was."""
        self._send(Revert(checkpoint.decisions))

    def save(self, name: str) -> str:
        """Give the run a name in the library, or raise LibraryError.

        Returns what the player should know; of a run that goes on, that comes from `poll`.
        """
        if self.alive:
            self._send(Save(self.library.new_folder(name)))
            return ""
        self.library.keep_rescued(name)
        return texts.TRAIN_SAVED.format(name=name)

    def poll(self) -> list[str]:
        """Take in what the worker has told; returns what the player should know."""
        notes: list[str] = []
        for message in self._worker.poll() if self._worker else ():
            if self.waiting and not isinstance(message, Saved):  # of the run before, only where it is
                continue
            match message:
                case Sight():
                    self.sight = message
                case Insight():
                    self.insight = message
                case Alteration(_, name, _, after):
                    self.history.append(message)
                    self.config = _turned(self.config, name, after)
                    if name == TAUGHT:
                        notes.append(texts.TRAIN_TAUGHT.format(count=after))
                case Point() | Checkpoint() | Validation():
                    self.history.append(message)
                case Begun(config, seed, _):
                    self.config, self.seed, self.begun = config, seed, True
                case Saved(folder, problem):
                    told = texts.TRAIN_NOT_SAVED.format(problem=problem) if problem else texts.TRAIN_SAVED
                    if folder != self.library.unsaved or problem:
                        notes.append(told.format(name=folder.name))
                case Refused(_, problem):
                    notes.append(problem)
        if note := self._start_waiting():
            notes.append(note)
        return notes

    def compare(self, name: str, folder: Path) -> str:
        """Put a saved run's curves beside this one's; returns what the player should know."""
        try:
            history = History.read(folder)
        except ModelFormatError as error:
            return str(error)
        if not len(history):
            return texts.TRAIN_NO_CURVES.format(name=name)
        self.earlier = [(name, history), *(run for run in self.earlier if run[0] != name)][:EARLIER]
        return ""


def _turned(config: Config, name: str, value: Any) -> Config:
    try:
        return turned(config, name, value)
    except ValueError:  # what the worker took, it took: only the knob's face is at stake
        return config
