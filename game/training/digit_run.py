"""Digit training run on the window's side: messages from its worker, and requests to it."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

from ai.digits.checkpoints import LAST_FILE, read_summary
from ai.digits.config import DigitConfig
from ai.digits.filters import FilterMoment
from ai.digits.validation import Confusion, HeldOutScore
from ai.explain.digit_lesson import DigitLesson
from ai.files import CONFIG, brief
from ai.training.digit_session import (
    DigitPoint,
    DigitRunSaved,
    DigitRunStarted,
    DigitSettingChanged,
    ExplainImage,
    Finish,
    RestoreBest,
    live_digits,
)
from ai.training.history import REVERTED, TURNING_SECONDS
from ai.training.messages import Refused, Save
from game.core import texts
from game.core.names import LONGEST_NAME, LibraryError
from game.core.worker import Worker
from game.training.digit_models import PATIENCE, DigitModels
from game.training.training_run import EarlierRun, TrainingRun, put_beside

CurveMessage = DigitPoint | FilterMoment | HeldOutScore | DigitSettingChanged
FALLEN: Final = 0.15  # drop of validation accuracy below its best at which a return to the best is offered
_MOST_POINTS: Final = 4000


@dataclass
class DigitCurves:
    """Learning curves of a run."""

    points: list[DigitPoint] = field(default_factory=list)
    scores: list[HeldOutScore] = field(default_factory=list)
    turns: list[DigitSettingChanged] = field(default_factory=list)
    filters: list[FilterMoment] = field(default_factory=list)

    @property
    def fallen(self) -> tuple[float, float] | None:
        """Best and present accuracy, if the present one is far lower; None otherwise, or right after a return."""
        back = max((turn.seconds for turn in self.turns if turn.name == REVERTED), default=-1.0)
        read = [score.accuracy for score in self.scores if score.seconds > back]
        best = max((score.accuracy for score in self.scores), default=0.0)
        return (best, read[-1]) if read and best - read[-1] > FALLEN else None

    def append(self, told: CurveMessage) -> None:
        """Append a message; beyond a limit, every other point is dropped.

        Changes of one knob in quick succession count as one, with the last value.
        """
        if isinstance(told, HeldOutScore):
            self.scores.append(told)
            return
        if isinstance(told, FilterMoment):
            self.filters.append(told)
            return
        if isinstance(told, DigitSettingChanged):
            last = self.turns[-1] if self.turns else None
            if last and last.name == told.name != REVERTED and told.seconds - last.seconds < TURNING_SECONDS:
                self.turns.pop()
            self.turns.append(told)
            return
        self.points.append(told)
        if len(self.points) > _MOST_POINTS:
            self.points = self.points[1::2]

    @property
    def seconds(self) -> float:
        """Length of the training in seconds."""
        return self.points[-1].seconds if self.points else 0.0


class DigitRun(TrainingRun):
    """Digit training runs, one after another, each in its own child process; call `poll` once a frame.

    A run saves itself in the player's folder without a name, until `save` names it.

    Attributes:
        config, seed, steps: those of the current or last run; `begun` is whether it has reported them.
        curves, confusion: its learning curves and confusion matrix.
        test: accuracy on the test images, once it has finished or was stopped.
        stopping: whether it was asked to end, and is being tested.
        kept: whether there is a saved network.
        kept_epoch: epoch of the tested network, the best one, if that is not the last.
        earlier: the runs shown beside it, the latest first.
        lesson: the latest lesson that was asked for; None before the first.

    """

    grace = 1.0

    def __init__(self, folder: Path) -> None:
        super().__init__()
        self.collection = DigitModels(folder)
        self.config, self.seed, self.steps = DigitConfig(), 0, 0
        self.begun = False
        self.curves = DigitCurves()
        self.confusion: Confusion | None = None
        self.test: float | None = None
        self.kept_epoch: int | None = None
        self.lesson: DigitLesson | None = None
        self.earlier: list[EarlierRun[DigitCurves]] = []
        self.stopping = False
        self._saving: list[Path] = []  # folders it was asked to save to, without an answer yet

    @property
    def unsaved(self) -> Path:
        """Folder of a run that has no name yet."""
        return self.collection.unsaved

    @property
    def unfinished(self) -> bool:
        """Whether `unsaved` holds a run that can be resumed; false while another runs or is ending."""
        if self.alive or (self._worker and not self._worker.gone):  # to look there repairs what it writes
            return False
        return self.collection.left_behind and (self.unsaved / LAST_FILE).exists()

    @property
    def kept(self) -> bool:
        """Whether `unsaved` holds a usable network."""
        return (self.unsaved / CONFIG).exists()

    @property
    def nameless(self) -> bool:
        """Whether there is an unnamed run that a new one would replace."""
        return self.kept or (self.alive and self.steps > 0)

    def described(self) -> tuple[str, float, float | None]:
        """Return the unnamed run's preset, its training time in seconds, and its accuracy, as far as known."""
        scores = self.curves.scores
        preset, seconds, part = "", self.curves.seconds, scores[-1].accuracy if scores else None
        if self.alive:
            return preset, seconds, part
        with suppress(OSError, ValueError):
            summary = read_summary(self.unsaved)
            preset, seconds = brief(summary.preset, LONGEST_NAME), summary.seconds
            known = summary.held_out if summary.test is None else summary.test
            part = part if known is None else known
        return preset, seconds, part

    def begin(self, config: DigitConfig, seed: int, *, resume: bool = False, name: str = "") -> str:
        """Start a run, or resume the unfinished one, as soon as the previous one has ended.

        `name` is the name of its settings. Returns a note for the player, or ""; for a run that must wait, the note
        comes from `poll`.
        """
        if self.curves.points:
            put_beside(self.earlier, self.name, self.curves)
        self.curves, self.confusion, self.test, self.kept_epoch = DigitCurves(), None, None, None
        self.lesson = None
        self.config, self.seed, self.steps = config, seed, 0
        self.stopping = False
        self.runs += 1
        self.call(name)
        return self._start(lambda: self._begin(config, seed, resume))

    def _begin(self, config: DigitConfig, seed: int, resume: bool) -> str:
        notes = self._name_ended()
        if not resume:
            notes += filter(None, [self._put_aside()])
        self._worker = Worker(live_digits, config, seed, keep=self.unsaved, resume=self.unsaved if resume else None)
        self._worker.patience = PATIENCE
        return " ".join(notes)

    def go_back(self) -> None:
        """Revert the network to its best checkpoint."""
        if not self.stopping:
            self._send(RestoreBest())

    def explain(self, row: int) -> None:
        """Ask for the lesson of an image of the next batch; `poll` puts it in `lesson`."""
        self._send(ExplainImage(row))

    def stop(self) -> None:
        """End the run, save its network and test it. A second call ends it without the test."""
        if self.waiting:
            self._launch = None
        elif self.alive and self.steps and not self.stopping:
            self.stopping = True
            self._send(Finish())
            self.resume()
        elif self._worker:
            self._worker.stop()

    def save(self, name: str) -> str:
        """Name the run; return why that failed, or "". Later notes come from `poll`."""
        if self.waiting:  # nothing has been saved yet
            return texts.DIGIT_RUN_NOTHING
        try:
            if self.alive:
                folder = self.collection.new_folder(name)
                self._saving.append(folder)
                self._send(Save(folder))
            else:
                self.collection.keep_rescued(name)
        except LibraryError as error:
            return str(error)
        return ""

    def poll(self) -> list[str]:
        """Handle all messages of the worker; return notes for the player."""
        notes: list[str] = []
        for told in self._worker.poll() if self._worker else ():
            if self.waiting and not isinstance(told, DigitRunSaved):  # from the previous run, only where it was saved
                continue
            match told:
                case DigitPoint() | FilterMoment() | HeldOutScore() | DigitSettingChanged():
                    self.curves.append(told)
                    self.config = _turned(self.config, told)
                case Confusion():
                    self.confusion = told
                case DigitLesson():
                    self.lesson = told
                case DigitRunStarted(config, seed, _, steps):
                    self.config, self.seed, self.steps, self.begun = config, seed, steps, True
                case DigitRunSaved():
                    notes += filter(None, [self._hear_of(told)])
                case Refused(_, problem):
                    notes.append(problem)
        if not self.alive:
            self.stopping = False
            notes += self._name_ended()
        if note := self._start_waiting():
            notes.append(note)
        return notes

    def _hear_of(self, kept: DigitRunSaved) -> str:
        """Handle a report on where the run was saved, or why not; return a note for the player, or ""."""
        if kept.folder == self.unsaved and kept.test is not None and not self.waiting:
            self.test, self.kept_epoch = kept.test, kept.epoch
        if kept.folder in self._saving:
            self._saving.remove(kept.folder)
        if kept.problem:
            return texts.TRAIN_NOT_SAVED.format(problem=kept.problem)
        return "" if kept.folder == self.unsaved else texts.DIGIT_RUN_SAVED.format(name=kept.folder.name)

    def _name_ended(self) -> list[str]:
        """Name a run that ended before it received its name; return notes for the player."""
        notes = []
        while self._saving:
            name = self._saving.pop().name
            notes.append(self.save(name) or texts.DIGIT_RUN_SAVED.format(name=name))
        return notes

    def _put_aside(self) -> str:
        """Move an unnamed run aside, to where it can be restored by hand; return why that failed, or ""."""
        if self.kept:
            try:
                self.collection.discard_rescued()
            except LibraryError as error:
                return str(error)
        return ""


def _turned(config: DigitConfig, told: CurveMessage) -> DigitConfig:
    """Return the configuration of a run after one of its messages."""
    if not isinstance(told, DigitSettingChanged) or told.name == REVERTED:
        return config
    return config.changed(**{told.name: told.after})
