"""Lander training run on the window's side: messages from its worker, and requests to it."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Final

from ai.explain.agent_lesson import Lesson
from ai.nn import ModelFormatError
from ai.training.config import Config
from ai.training.edits import EditCommand, NetworkEdits
from ai.training.history import Checkpoint, History, Point, SettingChange, Validation
from ai.training.messages import (
    AddDemonstrations,
    Explain,
    NetworkState,
    Refused,
    RestoreCheckpoint,
    RunStarted,
    Save,
    Saved,
    SwarmState,
)
from ai.training.schedule import InForce
from ai.training.session import TAUGHT, live
from game.core import texts
from game.core.names import LibraryError
from game.core.worker import Worker
from game.training.library import Library
from game.training.record import Record
from game.training.training_run import EarlierRun, TrainingRun, put_beside

# Decisions of all landers per second; one takes 1/15 s of simulated time. None is as fast as possible.
PACES: Final[tuple[float | None, ...]] = (15.0, 60.0, None)
SWARM_BYTES: Final = 8 << 20  # of landers' states kept to rewind to
NETWORK_BYTES: Final = 16 << 20  # of networks


class LanderRun(TrainingRun):
    """Lander training runs, one after another, each in its own child process; call `poll` once a frame.

    A run saves itself in the library without a name, until `save` names it.

    Attributes:
        history: history of the current or last run.
        swarm_state, network_state, in_force, lesson: the latest message of each kind; None before the first.
        swarms, networks: those of the whole run, as far as they were kept.
        edits: what was edited of its network by hand.
        earlier: the runs shown beside it, the latest first.

    """

    grace = 3.0  # it saves itself at the end, which takes longer on a busy machine

    def __init__(self, library: Library) -> None:
        super().__init__()
        self.library = library
        self.config, self.seed = Config(), 0
        self.history = History()
        self.swarm_state: SwarmState | None = None
        self.network_state: NetworkState | None = None
        self.swarms, self.networks = Record[SwarmState](SWARM_BYTES), Record[NetworkState](NETWORK_BYTES)
        self.in_force: InForce | None = None
        self.lesson: Lesson | None = None
        self.edits = NetworkEdits()
        self.earlier: list[EarlierRun[History]] = []
        self.begun = False  # whether a run has reported its configuration since this was last set to False
        self.pace = len(PACES) - 1

    @property
    def kept(self) -> bool:
        """Whether there is an unnamed run that `save` could name."""
        return self.alive or self.library.rescued() is not None

    def begin(self, config: Config, seed: int, resume: Path | None = None, name: str = "") -> str:
        """Start a run, or resume a saved one, as soon as the previous one has ended.

        `name` is the name of its settings; a run that was saved under a name keeps that. Returns a note for the
        player, or ""; for a run that must wait, the note comes from `poll`.
        """
        if len(self.history):
            self._put_beside(self.name, self.history)
        self.history = History()
        self.config, self.seed = config, seed
        self.swarm_state = self.network_state = self.in_force = self.lesson = None
        self.edits = NetworkEdits()
        self.swarms.clear()
        self.networks.clear()
        self.runs += 1
        self._named = resume is not None and resume != self.library.unsaved
        self.name = resume.name if resume else ""
        self.call(name)
        return self._start(lambda: self._begin(config, seed, resume))

    def _begin(self, config: Config, seed: int, resume: Path | None) -> str:
        note = ""
        try:
            if resume is not None:
                self.history = History.read(resume)
            if resume != self.library.unsaved:
                self.library.discard_rescued()  # from where it can still be restored
        except (ModelFormatError, LibraryError) as error:
            note = str(error)
        self._worker = Worker(live, config, seed, keep=self.library.unsaved, resume=resume)
        self._worker.set_pace(PACES[self.pace])
        return note

    @property
    def measured(self) -> bool:
        """Whether there are figures to show: a point of the history, and a state of the swarm."""
        return len(self.history) > 0 and self.swarm_state is not None

    @property
    def demonstrations(self) -> int:
        """Number of demonstrations this run has learnt from."""
        return sum(
            each.after for each in self.history.setting_changes if each.name == TAUGHT and type(each.after) is int
        )

    def teach(self, demonstrations: Path) -> None:
        """Let the run also learn from a file of demonstrations; `poll` reports it."""
        self._send(AddDemonstrations(demonstrations))

    def set_pace(self, index: int) -> None:
        """Choose one of `PACES` by its index."""
        self.pace = index
        self._ask(lambda worker: worker.set_pace(PACES[index]))

    def revert(self, checkpoint: Checkpoint) -> None:
        """Revert the network to a checkpoint."""
        self._send(RestoreCheckpoint(checkpoint.decisions))

    def explain(self, slot: int, decisions: int | None = None) -> None:
        """Ask for the lesson of a lander's latest memory, now or at a time in the past; `poll` puts it in `lesson`."""
        self._send(Explain(slot, decisions))

    def edit(self, command: EditCommand) -> None:
        """Edit the run's network by hand, or take an edit back; its `edits` say how it stands then."""
        self._send(command)

    def save(self, name: str) -> str:
        """Name the run in the library; raises LibraryError if that fails.

        Returns a note for the player, or ""; for a run that goes on, the note comes from `poll`.
        """
        if self.alive:
            self._send(Save(self.library.new_folder(name)))
            return ""
        self.library.keep_rescued(name)
        return texts.TRAIN_SAVED.format(name=name)

    def poll(self) -> list[str]:
        """Handle all messages of the worker; return notes for the player."""
        told = self._worker.poll() if self._worker else ()
        if self.waiting:  # from the previous run, only where it was saved
            told = [message for message in told if isinstance(message, Saved)]
        notes = [self._hear(message) for message in told]
        return [note for note in [*notes, self._start_waiting()] if note]

    def _hear(self, message: Any) -> str:
        """Handle one message of the worker; return a note for the player, or ""."""
        match message:
            case SwarmState():
                self.swarm_state = message
                self.swarms.append(message)
            case NetworkState():
                self.network_state = message
                self.networks.append(message)
            case NetworkEdits():
                self.edits = message
            case InForce():
                self.in_force = message
            case Lesson():
                self.lesson = message
            case Point() | Checkpoint() | Validation():
                self.history.append(message)
            case SettingChange(_, name, _, after):
                self.history.append(message)
                self.config = _turned(self.config, name, after)
                if name == TAUGHT:
                    return texts.TRAIN_TAUGHT.format(count=after)
            case RunStarted(config, seed, _):
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
        """Show a saved run's curves beside this one's; return a note for the player, or ""."""
        try:
            history = History.read(folder)
        except ModelFormatError as error:
            return str(error)
        if not len(history):
            return texts.TRAIN_NO_CURVES.format(name=name)
        self._put_beside(name, history)
        return ""

    def _put_beside(self, name: str, history: History) -> None:
        history.checkpoints.clear()  # only its curves are shown, and there may be many such runs
        put_beside(self.earlier, name, history)


def _turned(config: Config, name: str, value: Any) -> Config:
    try:
        return config.turned(name, value)
    except ValueError:  # the worker has accepted the value already: only the display is concerned
        return config
