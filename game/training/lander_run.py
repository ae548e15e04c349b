"""A training run as the window knows it: what its worker has told, and what may be asked of it."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Final

from ai.agent.config import Config
from ai.agent.schedule import InForce
from ai.nn import ModelFormatError
from ai.training.history import Alteration, Checkpoint, History, Point, Validation
from ai.training.session import TAUGHT, Begun, Insight, Refused, Revert, Save, Saved, Sight, Teach, live, turned
from game.core import texts
from game.core.collection import LibraryError
from game.core.worker import Worker
from game.training.library import Library
from game.training.training_run import EARLIER, Beside, Learner, put_beside

# Decisions of all landers a second: one lasts 1/15 s of their own time. None is as fast as it can.
PACES: Final[tuple[float | None, ...]] = (15.0, 60.0, None)


class Student(Learner):
    """One run after another, each in a child process of its own; `poll` once a frame.

    A run keeps itself in the library under no name, until `save` gives it one.

    Attributes:
        history: what has been told of the run that goes on, or of the last one.
        sight, insight, in_force: the latest of their kind; None until a run has told of any.
        earlier: the runs that stand beside it, the latest first.

    """

    grace = 3.0  # for it keeps itself at the end, which takes longer on a busy machine

    def __init__(self, library: Library) -> None:
        super().__init__()
        self.library = library
        self.config, self.seed = Config(), 0
        self.history = History()
        self.sight: Sight | None = None
        self.insight: Insight | None = None
        self.in_force: InForce | None = None
        self.earlier: list[Beside[History]] = []
        self.begun = False  # whether a run has said with what it was begun, since this was last set to False
        self.pace = len(PACES) - 1

    @property
    def kept(self) -> bool:
        """Whether there is a run without a name that could be given one."""
        return self.alive or self.library.rescued() is not None

    def begin(self, config: Config, seed: int, resume: Path | None = None, name: str = "") -> str:
        """Start a run, or go on with a saved one, as soon as the one before has ended.

        `name` is what its settings are called; a run that was saved under a name has that. Returns what the player
        should know; of a run that must wait, that comes from `poll`.
        """
        note = self._put_beside(self.name, self.history) if len(self.history) else ""
        self.history = History()
        self.config, self.seed = config, seed
        self.sight = self.insight = self.in_force = None
        self.runs += 1
        self._named = resume is not None and resume != self.library.unsaved
        self.name = resume.name if resume else ""
        self.call(name)
        started = self._start(lambda: self._begin(config, seed, resume))
        return " ".join(filter(None, [note, started]))

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
        told = self._worker.poll() if self._worker else ()
        if self.waiting:  # of the run before, only where it is
            told = [message for message in told if isinstance(message, Saved)]
        notes = [self._hear(message) for message in told]
        return [note for note in [*notes, self._start_waiting()] if note]

    def _hear(self, message: Any) -> str:
        """Take in one thing that the worker has told; returns what the player should know."""
        match message:
            case Sight():
                self.sight = message
            case Insight():
                self.insight = message
            case InForce():
                self.in_force = message
            case Point() | Checkpoint() | Validation():
                self.history.append(message)
            case Alteration(_, name, _, after):
                self.history.append(message)
                self.config = _turned(self.config, name, after)
                if name == TAUGHT:
                    return texts.TRAIN_TAUGHT.format(count=after)
            case Begun(config, seed, _):
                self.config, self.seed, self.begun = config, seed, True
                self.history.reward_scale = config.reward_scale
            case Saved(folder, problem) if problem:
                return texts.TRAIN_NOT_SAVED.format(problem=problem)
            case Saved(folder, _) if folder != self.library.unsaved:
                return texts.TRAIN_SAVED.format(name=folder.name)
            case Refused(_, problem):
                return str(problem)
        return ""

    def compare(self, name: str, folder: Path) -> str:
        """Put a saved run's curves beside this one's; returns what the player should know."""
        try:
            history = History.read(folder)
        except ModelFormatError as error:
            return str(error)
        if not len(history):
            return texts.TRAIN_NO_CURVES.format(name=name)
        return self._put_beside(name, history)

    def _put_beside(self, name: str, history: History) -> str:
        gone = put_beside(self.earlier, name, history)
        return texts.TRAIN_MADE_ROOM.format(name=gone, count=EARLIER) if gone else ""


def _turned(config: Config, name: str, value: Any) -> Config:
    try:
        return turned(config, name, value)
    except ValueError:  # what the worker took, it took: only the knob's face is at stake
        return config
