"""Training run on the window's side, of any kind: messages from its worker, and requests to it."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any, Final

import numpy as np

from ai.digits.training import DigitProgress
from ai.digits.validation import Confusion
from ai.explain.agent_lesson import Lesson
from ai.files.folder import CONFIG, STATE_FILE
from ai.nn import ModelFormatError
from ai.training.history import Checkpoint, History, SettingChange, Validation
from ai.training.loop import Progress
from ai.training.messages import FirstLanding, NetworkState, Refused, RunStarted, Saved, SwarmState
from ai.training.upbringing import Asked
from game.core import texts
from game.core.shelf import Collection, LibraryError
from game.core.worker import Worker, WorkerState
from game.training.record import Record
from game.training.run_kind import RunKind

# Decisions of each lander per second: slow, so that `modern` lands nine of ten after a minute, and as fast as possible.
PACES: Final[tuple[float | None, ...]] = (3.5, None)
SWARM_BYTES: Final = 8 << 20  # of landers' states kept to rewind to
NETWORK_BYTES: Final = 16 << 20  # of networks
AHEAD: Final = 12  # turns that either of two may be ahead of the slower: enough to work on between two frames
# Where the latest message of a kind is found, and where all of them.
_LATEST: Final = {
    SwarmState: "swarm_state", NetworkState: "network_state", Lesson: "lesson",
    Confusion: "confusion", FirstLanding: "first_landing", Asked: "asked",
}  # fmt: skip
_ENTRIES: Final[dict[type, str]] = dict.fromkeys(
    (Progress, DigitProgress, Checkpoint, Validation, SettingChange), "history"
)
_KEPT: Final = {SwarmState: "swarms", NetworkState: "networks"} | _ENTRIES
_BOTH: Final = ("change", "restore")  # commands that the experiment is asked for as well


class TrainingRun:
    """Training runs in child processes, one after another; call `poll` once a frame.

    A run saves itself in the player's collection without a name, until `save` names it. They write to the same folder,
    so the next one waits until the last one has ended, and so do requests to it.

    Beside a run there can be an experiment, its `twin`, from the same seed. The faster of the two waits, so that on any
    machine what differs is what was changed. If one of them ends, the other goes on alone, and at full pace.

    Attributes:
        config, seed: of the run.
        swarm_state, network_state, lesson, first_landing, confusion, asked: the latest message of each kind.
        swarms, networks: those of the whole run, as far as they were kept.
        earlier: curves of the run before it, if it had any.
        begun: whether a run has reported its configuration since this was last set to False.
        keeps: whether a run is kept while it has no name.
        stopping: whether it was asked to end, and is being measured.
        differing: names of the settings in which the experiment differs.

    """

    def __init__(self, kind: RunKind, collection: Collection[Any], *, keeps: bool = True) -> None:
        self.kind, self.collection, self.keeps = kind, collection, keeps
        self.pace = PACES[-1]
        self._worker: Worker | None = None
        self._next: tuple[Any, int, Path | None] | None = None  # the waiting run's configuration, seed and source
        self._orders: list[Callable[[Worker], None]] = []  # for the waiting run
        self.config: Any = kind.of()
        self.seed, self.begun = 0, False
        self.earlier: History | None = None
        self.twin: TrainingRun | None = None
        self.differing: tuple[str, ...] = ()
        self._saving: list[Path] = []  # folders it was asked to save to, without an answer yet
        self._notes: list[str] = []  # for the player
        self._limit: int | None = None
        self._clear()

    def _clear(self) -> None:
        """Forget all that a run has reported."""
        self.history = History(self.kind.session.columns)
        self.swarm_state: SwarmState | None = None
        self.network_state: NetworkState | None = None
        self.lesson: Any = None
        self.first_landing: FirstLanding | None = None
        self.confusion: Confusion | None = None
        self.asked: Asked | None = None
        self.swarms, self.networks = Record[SwarmState](SWARM_BYTES), Record[NetworkState](NETWORK_BYTES)
        self.steps, self.stopping = 0, False  # 0 before it has reported them, or without end
        self.test: float | None = None  # accuracy on the test images, of digits that were measured
        self.kept_epoch: int | None = None  # of the tested network, if that is not the last one

    # How it stands

    @property
    def waiting(self) -> bool:
        """Whether a run waits for the previous one to end."""
        return self._next is not None

    @property
    def state(self) -> WorkerState | None:
        """State of the run; None before the first."""
        if self.waiting:
            return WorkerState.STARTING
        return self._worker.state if self._worker else None

    @property
    def alive(self) -> bool:
        """Whether there is a run that can be paused, stopped and changed."""
        return self.state in (WorkerState.STARTING, WorkerState.RUNNING, WorkerState.PAUSED)

    @property
    def problem(self) -> str:
        """Reason why the run failed; empty if it did not."""
        return self._worker.problem if self._worker and self.state is WorkerState.FAILED else ""

    @property
    def kept(self) -> bool:
        """Whether there is a network of a run without a name."""
        return self.keeps and (self.collection.unsaved / CONFIG).exists()

    @property
    def unfinished(self) -> bool:
        """Whether a run without a name was left that can be resumed; false while another runs or is ending."""
        if self.alive or (self._worker and not self._worker.gone):  # to look there repairs what it writes
            return False
        return self.keeps and self.collection.left_behind and (self.collection.unsaved / STATE_FILE).exists()

    @property
    def turns(self) -> int:
        """Turns that a run of landers has taken."""
        return self.swarm_state.decisions // self.config.num_envs if self.swarm_state else 0

    # Beginning and end

    def begin(self, config: Any, seed: int, resume: Path | None = None) -> None:
        """Start a run alone, or resume a saved one, as soon as the previous one has ended."""
        self.leave()
        again = (config, seed) == (self.config, self.seed) and not self.history.setting_changes
        if (resume is not None or not again) and self._has_curves:  # or else both curves would be the same
            self.earlier = self.history
            self.earlier.checkpoints.clear()  # only its curves are shown
        self._clear()
        self.config, self.seed = config, seed
        self._next = config, seed, resume
        self._orders.clear()
        if self._worker:
            self._worker.stop()
        self._start_waiting()

    @property
    def _has_curves(self) -> bool:
        share = "success_rate" if "success_rate" in self.history.columns else "loss"
        return bool(np.isfinite(self.history[share]).any())

    def _start_waiting(self) -> None:
        """Start the waiting run, if the previous process has ended."""
        if self._next is None or (self._worker and not self._worker.gone):
            return
        begun, self._next = self._next, None
        self._launch(*begun)
        while self._orders:
            self._order(self._orders.pop(0))

    def _launch(self, config: Any, seed: int, resume: Path | None) -> None:
        self._name_ended()
        keep = self.collection.unsaved if self.keeps else None
        try:
            if resume is not None:
                self.history = History.read(resume, self.kind.session.columns)
            if keep is not None and resume != keep:
                self.collection.discard_rescued()
        except (ModelFormatError, LibraryError) as error:
            self._notes.append(str(error))
        self._worker = Worker(self.kind.session.live, config, seed, keep=keep, resume=resume)
        self._worker.patience = self.kind.patience
        self._worker.set_pace(self.pace)

    def stop(self) -> None:
        """End the run, save its network and measure it. A second call ends it without that."""
        if self.waiting:
            self._next = None
        elif self.alive and self.steps and not self.stopping:
            self.stopping = True
            self.ask("finish")
            self.resume()
        elif self._worker:
            self._worker.stop()

    def save(self, name: str) -> str:
        """Name the run in the collection; return why that failed, or "". That it is saved is a note of `poll`."""
        try:
            if self.alive and not self.waiting:
                folder = self.collection.new_folder(name)
                self._saving.append(folder)
                self.ask("save", folder)
            elif self.kept and not self.waiting:
                self.collection.keep_rescued(name)
                self._notes.append(texts.TRAIN_SAVED.format(name=name))
            else:
                return texts.TRAIN_NOTHING
        except LibraryError as error:
            return str(error)
        return ""

    def _name_ended(self) -> None:
        """Name a run that ended before it received its name."""
        while self._saving:
            self._notes.append(self.save(self._saving.pop().name))

    def close(self) -> None:
        """End the runs and their processes for certain."""
        self._next = None
        if self.twin:
            self.twin.close()
        if self._worker:
            self._worker.close(self.kind.grace)

    # Messages

    def poll(self) -> list[str]:
        """Handle all messages of the worker, and of the experiment's; return notes for the player."""
        messages = self._worker.poll() if self._worker else ()
        if self.waiting:  # from the previous run, only where it was saved
            messages = [message for message in messages if isinstance(message, Saved)]
        for message in messages:
            self._hear(message)
        if not self.alive:
            self.stopping = False
            self._name_ended()
        self._start_waiting()
        if self.twin is not None:
            self._notes += self.twin.poll()
        self._keep_in_step()
        notes, self._notes = [note for note in self._notes if note], []
        return notes

    def _hear(self, message: Any) -> None:
        """Keep one message of the worker."""
        if name := _LATEST.get(type(message)):
            setattr(self, name, message)
        if name := _KEPT.get(type(message)):
            getattr(self, name).append(message)
        match message:
            case SettingChange(_, name, _, after):
                with suppress(ValueError):  # what is no knob, such as a way back
                    self.config = self.config.turned(name, after)
            case RunStarted(config, seed, _, lost, steps):
                self.config, self.seed, self.steps, self.begun = config, seed, steps or 0, True
                self.history.reward_scale = getattr(config, "reward_scale", 1.0)
                self._notes.append(lost)
            case Saved():
                self._hear_saved(message)
            case Refused(_, problem):
                self._notes.append(problem)

    def _hear_saved(self, saved: Saved) -> None:
        if saved.folder in self._saving:
            self._saving.remove(saved.folder)
        if saved.problem:
            self._notes.append(texts.TRAIN_NOT_SAVED.format(problem=saved.problem))
        elif saved.folder != self.collection.unsaved:
            self._notes.append(texts.TRAIN_SAVED.format(name=saved.folder.name))
        elif saved.test is not None and not self.waiting:
            self.test, self.kept_epoch = saved.test, saved.epoch

    # Requests

    def ask(self, name: str, *arguments: Any) -> None:
        """Send a command of the kind's session; `poll` brings the answer.

        What the experiment can do as well, it is asked for too, but for the settings in which it differs.
        """
        both = name in _BOTH and not (name == "change" and arguments[0] in self.differing)
        self._order(lambda worker: worker.send((name, *arguments)), both=both)

    def _order(self, order: Callable[[Worker], None], *, both: bool = False) -> None:
        """Give an order to the current run, if any, or keep it for the waiting one; `both`: and to the experiment."""
        if self.waiting:
            self._orders.append(order)
        elif self._worker and self.alive:
            order(self._worker)
        if both and self.twin:
            self.twin._order(order)

    def pause(self) -> None:
        """Pause the run and the experiment."""
        self._order(Worker.pause, both=True)

    def resume(self) -> None:
        """Go on with both."""
        self._order(Worker.resume, both=True)

    def set_pace(self, pace: float | None) -> None:
        """Let both take so many turns a second; None for as many as they can."""
        self.pace = pace
        self._order(lambda worker: worker.set_pace(pace), both=True)

    # The experiment

    def split(self, config: Any, seed: int, experiment: Any, differing: tuple[str, ...]) -> None:
        """Start a run, and an experiment beside it."""
        self.begin(config, seed)
        # It writes nothing to the disk: its twin has the place of the run without a name.
        self.twin, self.differing = TrainingRun(self.kind, self.collection, keeps=False), differing
        self.twin.pace = self.pace
        self.twin.begin(experiment, seed)
        self._keep_in_step()

    def leave(self) -> None:
        """End the experiment; the run goes on."""
        if self.twin is not None:
            self.twin.close()
            self.twin, self.differing = None, ()
            self._keep_in_step()

    def _keep_in_step(self) -> None:
        """Allow both runs as many turns, a few more than the slower one has taken."""
        twin = self.twin
        limit = min(self.turns, twin.turns) + AHEAD if twin and self.alive and twin.alive else None
        if limit != self._limit:
            self._limit = limit
            self._order(lambda worker: worker.set_limit(limit), both=True)
