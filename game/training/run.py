"""Training run on the window's side, of any kind: messages from its worker, and requests to it."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path
from typing import Any, Final

from ai.digits.filters import FilterMoment
from ai.digits.validation import Confusion
from ai.explain.agent_lesson import Lesson
from ai.explain.digit_lesson import DigitLesson
from ai.files import CONFIG, state_folder
from ai.nn import ModelFormatError
from ai.training.config import InForce
from ai.training.edits import NetworkEdits
from ai.training.history import Checkpoint, DigitPoint, History, Point, SettingChange, Validation
from ai.training.lander_session import TAUGHT
from ai.training.messages import NetworkState, Refused, RunStarted, Saved, SwarmState
from game.core import texts
from game.core.collection import Collection
from game.core.names import LibraryError
from game.core.worker import Worker
from game.training.beside import EarlierRun, put_beside
from game.training.record import Record
from game.training.workers import PACES, OneAfterAnother, WorkedRun

SWARM_BYTES: Final = 8 << 20  # of landers' states kept to rewind to
NETWORK_BYTES: Final = 16 << 20  # of networks
AHEAD: Final = 12  # turns that either of two may be ahead of the slower: enough to work on between two frames
# Where the latest message of each kind is found.
_LATEST: Final = {
    SwarmState: "swarm_state", NetworkState: "network_state", InForce: "in_force", Lesson: "lesson",
    DigitLesson: "lesson", Confusion: "confusion", NetworkEdits: "edits",
}  # fmt: skip


class TrainingRun(OneAfterAnother):
    """Training runs, one after another; call `poll` once a frame.

    A run saves itself in the player's collection without a name, until `save` names it.

    Beside a run there can be an experiment, its `twin`, from the same seed. The faster of the two waits, so that both
    have taken as many turns: on any machine, what differs is what was changed. If one of them ends or fails, the other
    goes on alone, and at full pace.

    Attributes:
        name: of the run, to tell it from others.
        runs: number of runs so far.
        pay: the player's own file that pays the runs that begin from now on; None for the usual pay.
        pays: all such files, one of which may have paid a run that goes on.
        config, seed, steps: of the current or last run; `steps` are 0 before it has reported them, or without end.
        history: of the current or last run.
        swarm_state, network_state, in_force, lesson, confusion: the latest message of each kind; None before the first.
        swarms, networks, filters: those of the whole run, as far as they were kept.
        edits: what was edited of its network by hand.
        earlier: the runs shown beside it, the latest first.
        begun: whether a run has reported its configuration since this was last set to False.
        test, kept_epoch: accuracy on the test images of a run of digits that was measured, and the epoch of the tested
            network, if that is not the last one.
        stopping: whether it was asked to end, and is being measured.
        twin: the experiment; None without one.
        differing: names of the settings in which the experiment differs.

    """

    def __init__(self, kind: WorkedRun, collection: Collection[Any], *, keeps: bool = True) -> None:
        super().__init__()
        self.kind, self.collection, self._keeps = kind, collection, keeps
        self.name, self.runs = "", 0
        self.pay: Path | None = None
        self.pays: tuple[Path, ...] = ()
        self.config: Any = kind.config
        self.seed = 0
        self.earlier: list[EarlierRun] = []
        self.twin: TrainingRun | None = None
        self.differing: tuple[str, ...] = ()
        self.begun = False
        self._named = False  # whether the run was saved under its name
        self._saving: list[Path] = []  # folders it was asked to save to, without an answer yet
        self._leaving: Worker | None = None  # of a healthy run whose place the experiment takes
        self._limit: int | None = None
        self._clear()

    def _clear(self) -> None:
        """Forget all that a run has told."""
        self.history = History(self.kind.columns)
        self.swarm_state: SwarmState | None = None
        self.network_state: NetworkState | None = None
        self.in_force: InForce | None = None
        self.lesson: Any = None
        self.confusion: Confusion | None = None
        self.swarms, self.networks = Record[SwarmState](SWARM_BYTES), Record[NetworkState](NETWORK_BYTES)
        self.filters: list[FilterMoment] = []
        self.edits = NetworkEdits()
        self.steps, self.stopping = 0, False
        self.test: float | None = None
        self.kept_epoch: int | None = None

    # How it stands

    @property
    def kept(self) -> bool:
        """Whether there is a network of a run without a name."""
        return (self.collection.unsaved / CONFIG).exists()

    @property
    def unfinished(self) -> bool:
        """Whether a run without a name was left that can be resumed; false while another runs or is ending."""
        if self.alive or (self._worker and not self._worker.gone):  # to look there repairs what it writes
            return False
        return self.collection.left_behind and state_folder(self.collection.unsaved).is_dir()

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

    @property
    def turns(self) -> tuple[int, int]:
        """Turns that this run and the experiment have taken."""
        runs = (self, self.twin) if self.twin else (self, self)
        first, second = (each.swarm_state.decisions // each.config.num_envs if each.swarm_state else 0 for each in runs)
        return first, second

    # Beginning and end

    def begin(self, config: Any, seed: int, resume: Path | None = None, name: str = "") -> str:
        """Start a run, or resume a saved one, as soon as the previous one has ended, without an experiment beside it.

        `name` is the name of its settings; a run that was saved under a name keeps that. Returns a note for the
        player, or ""; for a run that must wait, the note comes from `poll`.
        """
        self.leave()
        again = (config, seed) == (self.config, self.seed) and not self.history.setting_changes
        if resume is not None or not again:  # or else both curves would be the same
            put_beside(self.earlier, self.name, self.history)
        self._clear()
        self.config, self.seed = config, seed
        self.runs += 1
        self._named = resume is not None and resume != self.collection.unsaved
        self.name = resume.name if resume else ""
        self.call(name)
        return self._start(lambda: self._begin(config, seed, resume))

    def _begin(self, config: Any, seed: int, resume: Path | None) -> str:
        keep, notes = self.collection.unsaved if self._keeps else None, self._name_ended()
        try:
            if resume is not None:
                self.history = History.read(resume, self.kind.columns)
            if keep is not None and resume != keep:
                self.collection.discard_rescued()  # from where it can still be restored
        except (ModelFormatError, LibraryError) as error:
            notes.append(str(error))
        pay: dict[str, Any] = {"pay": self.pay} if self.pay and resume is None else {}
        if resume is not None and self.pays:
            pay = {"pays": self.pays}
        self._worker = Worker(self.kind.live, config, seed, keep=keep, resume=resume, **pay)
        self._worker.patience = self.kind.patience
        self._worker.set_pace(PACES[self.pace])
        return " ".join(notes)

    def call(self, settings: str) -> None:
        """Name the run after its settings, with a number, unless it was saved under a name."""
        if not self._named:
            self.name = texts.TRAIN_RUN.format(name=settings or texts.TRAIN_THIS, number=self.runs)

    def stop(self) -> None:
        """End the run, save its network and measure it. A second call ends it without that."""
        if self.waiting:
            self._launch = None
        elif self.alive and self.steps and not self.stopping:
            self.stopping = True
            self._send("finish")
            self.resume()
        elif self._worker:
            self._worker.stop()

    def save(self, name: str) -> str:
        """Name the run in the collection; raises LibraryError if that fails.

        Returns a note for the player, or ""; for a run that goes on, the note comes from `poll`.
        """
        if self.waiting:
            raise LibraryError(texts.TRAIN_NOTHING)
        if self.alive:
            folder = self.collection.new_folder(name)
            self._saving.append(folder)
            self._send("save", folder)
            return ""
        self.collection.keep_rescued(name)
        return texts.TRAIN_SAVED.format(name=name)

    def _name_ended(self) -> list[str]:
        """Name a run that ended before it received its name; return notes for the player."""
        notes = []
        while self._saving:
            try:
                notes.append(self.save(self._saving.pop().name))
            except LibraryError as error:
                notes.append(str(error))
        return notes

    def close(self) -> None:
        """End the runs and their processes for certain."""
        self._launch = None
        if self._leaving is not None:
            self._leaving.close(self.kind.grace)
            self._take_place()
        if self.twin:
            self.twin.close()
        if self._worker:
            self._worker.close(self.kind.grace)

    # Messages

    def poll(self) -> list[str]:
        """Handle all messages of the worker, and of the experiment's; return notes for the player."""
        told = self._worker.poll() if self._worker else ()
        if self.waiting:  # from the previous run, only where it was saved
            told = [message for message in told if isinstance(message, Saved)]
        notes = [self._hear(message) for message in told]
        if not self.alive:
            self.stopping = False
            notes += self._name_ended()
        notes.append(self._start_waiting())
        if self.twin is not None:
            notes += self.twin.poll()
        if self._leaving is not None:
            self._leaving.poll()
            if self._leaving.gone:
                self._take_place()
        self._keep_in_step()
        return [note for note in notes if note]

    def _hear(self, message: Any) -> str:
        """Handle one message of the worker; return a note for the player, or ""."""
        if name := _LATEST.get(type(message)):
            setattr(self, name, message)
        match message:
            case SwarmState():
                self.swarms.append(message)
            case NetworkState():
                self.networks.append(message)
            case FilterMoment():
                self.filters.append(message)
            case Point() | DigitPoint() | Checkpoint() | Validation():
                self.history.append(message)
            case SettingChange(_, name, _, after):
                self.history.append(message)
                with suppress(ValueError):  # what is no knob, such as a way back
                    self.config = self.config.turned(name, after)
                if name == TAUGHT:
                    return texts.TRAIN_TAUGHT.format(count=after)
            case RunStarted(config, seed, _, lost, steps):
                self.config, self.seed, self.steps, self.begun = config, seed, steps or 0, True
                self.history.reward_scale = getattr(config, "reward_scale", 1.0)
                return str(lost)
            case Saved():
                return self._hear_saved(message)
            case Refused(_, problem):
                return str(problem)
        return ""

    def _hear_saved(self, saved: Saved) -> str:
        """Handle a report on where the run was saved, or why not; return a note for the player, or ""."""
        if saved.folder in self._saving:
            self._saving.remove(saved.folder)
        if saved.problem:
            return texts.TRAIN_NOT_SAVED.format(problem=saved.problem)
        if saved.folder != self.collection.unsaved:
            return texts.TRAIN_SAVED.format(name=saved.folder.name)
        if saved.test is not None and not self.waiting:
            self.test, self.kept_epoch = saved.test, saved.epoch
        return ""

    def compare(self, name: str, folder: Path) -> str:
        """Show a saved run's curves beside this one's; return a note for the player, or ""."""
        try:
            history = History.read(folder, self.kind.columns)
        except ModelFormatError as error:
            return str(error)
        if not len(history):
            return texts.TRAIN_NO_CURVES.format(name=name)
        put_beside(self.earlier, name, history)
        return ""

    # Requests: to the run, and where both can do it, to the experiment; `poll` brings the answers

    def change(self, name: str, value: Any) -> None:
        """Change a live setting; one in which the experiment differs, of the run alone."""
        self._send("change", name, value, both=name not in self.differing)

    def teach(self, demonstrations: Path) -> None:
        """Learn from a file of demonstrations as well."""
        self._send("teach", demonstrations, both=True)

    def revert(self, checkpoint: Checkpoint) -> None:
        """Revert the network to the checkpoint of a moment."""
        self._send("restore", checkpoint.decisions, both=True)

    def go_back(self) -> None:
        """Revert a digit network to its best."""
        if not self.stopping:
            self._send("restore_best")

    def explain(self, slot: int, decisions: int | None = None) -> None:
        """Ask for the `lesson` of a lander's latest memory, now or at a time in the past, or of an image of digits."""
        self._send("explain", slot, decisions)

    def edit(self, name: str, *arguments: Any) -> None:
        """Edit the run's network by hand, or take an edit back, by a command of `ai.training.lander_session`."""
        self._send(name, *arguments)

    # The experiment

    def split(self, config: Any, seed: int, experiment: Any, differing: tuple[str, ...], name: str) -> str:
        """Start a run, and an experiment beside it; return a note for the player, or ""."""
        note = self.begin(config, seed, name=name)
        # It writes nothing to the disk: its twin has the place of the run without a name.
        self.twin, self.differing = TrainingRun(self.kind, self.collection, keeps=False), differing
        self.twin.pace, self.twin.pay = self.pace, self.pay
        self.twin.begin(experiment, seed)
        self._keep_in_step()
        return note

    def leave(self) -> None:
        """End the experiment; the run goes on."""
        if self.twin is not None:
            self.twin.close()
            self.twin, self.differing = None, ()
            self._keep_in_step()

    def keep_twin(self) -> str:
        """Go on with the experiment in place of the run, whose curves stay beside; its network can be restored.

        Returns a note for the player, or "": an experiment that has ended cannot be kept, and nothing changes then.
        """
        twin = self.twin
        if twin is None or not twin.alive or twin._worker is None or self._worker is None:
            return texts.SPLIT_OVER
        put_beside(self.earlier, self.name, self.history)
        self._leaving, self._worker = self._worker, twin._worker
        self._leaving.stop()
        self.runs += 1
        self._named = False
        for told in ("history", "config", "seed", "swarm_state", "network_state", "swarms", "networks", "edits",
                     "in_force"):  # fmt: skip
            setattr(self, told, getattr(twin, told))
        self.lesson, self.begun = None, True
        twin._worker, self.twin, self.differing = None, None, ()
        self._keep_in_step()
        return ""

    def _take_place(self) -> None:
        """Let the experiment save itself in place of the run that has ended."""
        self._leaving = None
        with suppress(LibraryError):  # then it replaces what is there
            self.collection.discard_rescued()
        self._send("autosave_to", self.collection.unsaved)

    def _keep_in_step(self) -> None:
        """Allow both runs as many turns, a few more than the slower one has taken."""
        together = self.twin is not None and self.alive and self.twin.alive
        limit = min(self.turns) + AHEAD if together else None
        if limit != self._limit:
            self._limit = limit
            self._ask(lambda worker: worker.set_limit(limit), both=True)
