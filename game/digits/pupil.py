"""A network that learns to read digits, as the window knows it: what its process has told, and what may be asked."""

from __future__ import annotations

import shutil
import unicodedata
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

from ai.digit_config import DigitConfig
from ai.digit_live import Confusion, DigitPoint, DigitsBegun, Kept, Score, live_digits
from ai.digit_runs import LAST_FILE
from ai.messages import Change, Refused, Save
from ai.nn.folder import CONFIG, recover_folder
from game import texts
from game.library import name_problem
from game.worker import State, Worker

UNSAVED: Final = ".training"  # where a run that has no name yet keeps itself
_BEFORE: Final = ".before"  # and the one before it, in case somebody wants it back
_EARLIER: Final = 3  # runs of this visit that stay to be compared with
_MOST_POINTS: Final = 4000
_PATIENCE: Final = 120.0  # seconds: reading all test images in one go takes a slow machine long


@dataclass
class Curves:
    """What a run has told of how it stands."""

    points: list[DigitPoint] = field(default_factory=list)
    scores: list[Score] = field(default_factory=list)

    def append(self, told: DigitPoint | Score) -> None:
        """Take one more; of very many points every other one is forgotten."""
        if isinstance(told, Score):
            self.scores.append(told)
            return
        self.points.append(told)
        if len(self.points) > _MOST_POINTS:
            self.points = self.points[1::2]

    @property
    def seconds(self) -> float:
        """How long the run has learnt."""
        return self.points[-1].seconds if self.points else 0.0


class Pupil:
    """One run after another, each in a child process of its own; `poll` once a frame.

    A run keeps itself in the player's folder under no name, until `save` gives it one.

    Attributes:
        config, seed, steps: of the run that goes on, or of the last one; `begun` says that it has told of them.
        curves, confusion: what has been told of it.
        test: its accuracy on the test images, once it is finished.
        kept: where it is, once it has been written.
        earlier: the runs before it, by name, the latest first.

    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self.config, self.seed, self.steps = DigitConfig(), 0, 0
        self.begun = False
        self.curves = Curves()
        self.confusion: Confusion | None = None
        self.test: float | None = None
        self.earlier: list[tuple[str, Curves]] = []
        self.runs = 0
        self._worker: Worker | None = None

    @property
    def unsaved(self) -> Path:
        """Where a run keeps itself until it has a name."""
        return self._folder / UNSAVED

    @property
    def unfinished(self) -> bool:
        """Whether a run lies there that can go on."""
        recover_folder(self.unsaved)
        return (self.unsaved / LAST_FILE).exists()

    @property
    def kept(self) -> bool:
        """Whether a network lies there that can be used."""
        return (self.unsaved / CONFIG).exists()

    @property
    def state(self) -> State | None:
        """How the run stands; None before the first."""
        return self._worker.state if self._worker else None

    @property
    def alive(self) -> bool:
        """Whether there is a run to pause, to stop and to change."""
        return self.state in (State.STARTING, State.RUNNING, State.PAUSED)

    @property
    def problem(self) -> str:
        """Why the run failed, in words; empty if it did not."""
        return self._worker.problem if self._worker and self.state is State.FAILED else ""

    def begin(self, config: DigitConfig, seed: int, *, resume: bool = False) -> str:
        """Start a run, or go on with the unfinished one. Returns what the player should know, if anything."""
        self.close()
        note = "" if resume else self._put_aside()
        if self.curves.points:
            self.earlier.insert(0, (texts.TRAIN_RUN.format(number=self.runs), self.curves))
            del self.earlier[_EARLIER:]
        self.curves, self.confusion, self.test = Curves(), None, None
        self.config, self.seed, self.steps = config, seed, 0
        self.runs += 1
        self._worker = Worker(live_digits, config, seed, keep=self.unsaved, resume=self.unsaved if resume else None)
        self._worker.patience = _PATIENCE
        return note

    def pause(self) -> None:
        """Let it rest."""
        if self._worker and self.alive:
            self._worker.pause()

    def resume(self) -> None:
        """Let it learn on."""
        if self._worker and self.alive:
            self._worker.resume()

    def step(self) -> None:
        """Learn from one batch, and rest after it."""
        if self._worker and self.alive:
            self._worker.pause()
            self._worker.step()

    def stop(self) -> None:
        """End the run; what it has learnt is kept."""
        if self._worker:
            self._worker.stop()

    def change(self, name: str, value: Any) -> None:
        """Turn a live knob."""
        if self._worker and self.alive:
            self._worker.send(Change(name, value))

    def save(self, name: str) -> str:
        """Give the run a name; returns why that can't be, and later news come from `poll`."""
        if problem := name_problem(name):
            return problem
        folder = self._folder / unicodedata.normalize("NFC", name)
        if folder.exists():
            return texts.NAME_TAKEN.format(name=name)
        if self._worker and self.alive:
            self._worker.send(Save(folder))
            return ""
        try:
            self.unsaved.rename(folder)
        except OSError as error:
            return texts.TRAIN_NOT_SAVED.format(problem=error.strerror or error)
        return ""

    def poll(self) -> list[str]:
        """Take in what the worker has told; returns what the player should know."""
        notes: list[str] = []
        for told in self._worker.poll() if self._worker else ():
            match told:
                case DigitPoint() | Score():
                    self.curves.append(told)
                case Confusion():
                    self.confusion = told
                case DigitsBegun(config, seed, _, steps):
                    self.config, self.seed, self.steps, self.begun = config, seed, steps, True
                case Kept(folder, problem, test):
                    self.test = test if folder == self.unsaved else self.test
                    if problem:
                        notes.append(texts.TRAIN_NOT_SAVED.format(problem=problem))
                    elif folder != self.unsaved:
                        notes.append(texts.PUPIL_SAVED.format(name=folder.name))
                case Refused(_, problem):
                    notes.append(problem)
        return notes

    def close(self) -> None:
        """End the run, and its process for certain."""
        if self._worker:
            self._worker.close(grace=1.0)

    def _put_aside(self) -> str:
        """Move an unnamed run out of the way of a new one; it can be had back by hand until the next."""
        if not self.kept:
            return ""
        before = self._folder / _BEFORE
        try:
            shutil.rmtree(before, ignore_errors=True)
            self.unsaved.rename(before)
        except OSError as error:
            return texts.TRAIN_NOT_SAVED.format(problem=error.strerror or error)
        return ""
