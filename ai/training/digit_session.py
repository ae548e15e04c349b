"""Live digit training, which can be watched and steered while it goes on; like `ai.training.session`."""

from __future__ import annotations

from collections.abc import Generator, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar, Final

import numpy as np

from ai.digits.checkpoints import resume_digit_run, save_digit_run
from ai.digits.config import DigitConfig
from ai.digits.filters import FilterMoment, first_filters, next_moment
from ai.digits.training import DigitTraining
from ai.digits.validation import Confusion, HeldOutScore, ValidationReading
from ai.explain.digit_lesson import DigitLesson, explain_digit
from ai.nn import Array
from ai.training.history import REVERTED
from ai.training.messages import ChangeSetting, Refused, Save, Saved, problem_of

POINT_SECONDS: Final = 0.1  # of learning, at least, between two points
KEEP_SECONDS: Final = 20.0
_LARGEST: Final = float(np.finfo(np.float16).max)
_SHARE: Final = 0.25  # of the time that goes into reading the images held out


@dataclass(frozen=True)
class DigitRunStarted:
    """First message of a run: its settings; of a resumed run, those it was begun with."""

    config: DigitConfig
    seed: int
    step: int
    steps: int  # there will be in all


@dataclass(frozen=True)
class DigitPoint:
    """Point of a run's curves; loss and accuracy are means of the batches since the last point."""

    may_thin: ClassVar = True

    seconds: float  # spent learning
    step: int
    epoch: float
    loss: float
    accuracy: float  # as they were learnt from: bent, and with dropout
    learning_rate: float
    images_per_second: float


@dataclass(frozen=True)
class DigitSettingChanged:
    """Message that a knob was turned, or (REVERTED) the best network restored: `after` is then its accuracy."""

    seconds: float
    name: str
    after: Any


@dataclass(frozen=True)
class DigitRunSaved(Saved):
    """Result of a save, with what has been measured of the network that was saved.

    Attributes:
        test: the accuracy on the test images, once it is finished.
        epoch: the epoch after which the kept and measured network was best; None if it is the last one.

    """

    test: float | None = None
    epoch: int | None = None


@dataclass(frozen=True)
class RestoreBest:
    """Command to restore the network that read the images held out best."""


@dataclass(frozen=True)
class ExplainImage:
    """Command to explain the next learning step around an image of its batch; a DigitLesson is the answer."""

    row: int = 0


@dataclass(frozen=True)
class Finish:
    """Command to take no more steps: save the run, measure it, and end."""


Message = (
    DigitRunStarted
    | DigitPoint
    | FilterMoment
    | HeldOutScore
    | Confusion
    | DigitSettingChanged
    | DigitRunSaved
    | DigitLesson
    | Refused
)
Command = ChangeSetting | Save | Finish | RestoreBest | ExplainImage


def live_digits(
    config: DigitConfig, seed: int = 0, *, keep: Path | None = None, resume: Path | None = None, data: Any = None
) -> Generator[list[Message], Command | None, None]:
    """Train to the last epoch; every turn is a learning step, and yields its messages.

    The steps are those of `ai.digits.training.run_digits`. A turn that is sent a `ChangeSetting` turns a live knob, a
    `Save` writes the run to one more folder, without a step, and a `Finish` ends it early. The run keeps itself in
    `keep` now and then, when it is over and when it is closed. With `resume`, it goes on from the run kept there, with
    its settings. Raises what `DigitTraining` and `resume_digit_run` raise, and FloatingPointError when training
    diverges.
    """
    early = yield []  # unpacking the images takes a while: show the caller first that the run is alive
    training = resume_digit_run(resume, data=data) if resume else DigitTraining(config, seed, data)
    run = _LiveDigits(training, keep)
    started = DigitRunStarted(training.config, training.seed, training.step, training.steps)
    command = (yield [started, run.filters()]) or early
    try:
        while not training.done and not isinstance(command, Finish):
            command = yield (run.advance() if command is None else run.carry_out(command))
        yield from run.finish(command)
    finally:
        run.end()


class _LiveDigits:
    """Live digit training: a DigitTraining, what it has not reported yet, and its folder."""

    def __init__(self, training: DigitTraining, keep: Path | None) -> None:
        self.training, self._folder = training, keep
        self._batches: list[tuple[float, float]] = []  # loss and accuracy
        self._point_at = training.seconds
        self._keep_at = training.seconds + KEEP_SECONDS
        self._filters_at = training.seconds
        self._kept = training.step
        self._trouble = ""
        self._reading: ValidationReading | None = None
        self._best: tuple[float, Array] | None = None  # of all that was read, the accuracy and the values
        self._learning = self._looking = 0.0  # seconds

    def advance(self) -> list[Message]:
        """Take one step; return its messages."""
        training, told = self.training, list[Message]()
        began = training.clock()
        progress = training.advance()
        stepped = training.clock()
        training.seconds += stepped - began
        self._learning += stepped - began
        self._batches.append((progress.loss, progress.accuracy))
        if training.seconds >= self._point_at:
            self._point_at = training.seconds + POINT_SECONDS
            loss, accuracy = np.mean(self._batches, axis=0).tolist()
            self._batches.clear()
            told.append(DigitPoint(training.seconds, progress.step, progress.epoch, loss, accuracy,
                                   progress.learning_rate, progress.images_per_second))  # fmt: skip
        if training.seconds >= self._filters_at:
            told.append(self.filters())
        if self._looking <= _SHARE * self._learning:
            told += self._look()
            self._looking += training.clock() - stepped
        if self._folder and training.seconds >= self._keep_at:
            self._keep_at = training.seconds + KEEP_SECONDS
            told += self._keep()
        return told

    def filters(self) -> FilterMoment:
        """Return the first layer's filters as they are now, of the weights that learn."""
        training = self.training
        self._filters_at = next_moment(training.seconds)
        images = np.clip(first_filters(training.classifier.network), -_LARGEST, _LARGEST).astype(np.float16)
        return FilterMoment(training.seconds, training.step, images)

    def carry_out(self, command: Command) -> list[Message]:
        """Turn a live knob, for which the answer is a refusal or nothing, or save."""
        if isinstance(command, Save):
            return [DigitRunSaved(command.folder, self._written(command.folder)[0])]
        if isinstance(command, Finish):
            return []
        if isinstance(command, RestoreBest):
            return self._go_back()
        if isinstance(command, ExplainImage):
            try:
                return [explain_digit(self.training, command.row)]
            except (ValueError, FloatingPointError) as error:
                return [Refused(command, str(error))]
        try:
            self.training.apply_live(self.training.config.turned(command.name, command.value))
        except ValueError as error:
            return [Refused(command, str(error))]
        name = self.training.config.name_now(command.name)
        return [DigitSettingChanged(self.training.seconds, name, command.value)]

    def _go_back(self) -> list[Message]:
        if self._best is None:
            return []
        accuracy, values = self._best
        self.training.restore(values)
        self._reading = None  # it was reading for the network that is gone
        return [DigitSettingChanged(self.training.seconds, REVERTED, accuracy)]

    def finish(self, command: Command | None) -> Generator[list[Message], Command | None, None]:
        """Read all images held out once more, measure the test images, and save the run.

        What is asked for meanwhile is done as well.
        """
        for told in self._last_words():
            while command is not None:
                command = yield self.carry_out(command)
            command = yield told
        while command is not None:
            command = yield self.carry_out(command)

    def _last_words(self) -> Iterator[list[Message]]:
        yield self._keep()  # measuring takes a while, and a user who does not wait must lose nothing
        if len(self.training.held_images):
            reading = ValidationReading(self.training)
            while not reading.go_on():
                yield []
            score, misread = reading.told(self.training.seconds)
            yield [score, misread]
            if self.training.best_epoch is not None:  # another network is kept: its misread images are shown
                reading = ValidationReading(self.training, self.training.best_classifier())
                while not reading.go_on():
                    yield []
                yield [reading.told(self.training.seconds)[1]]
        yield self._keep(final=True)

    def end(self) -> None:
        """Save what has not been saved."""
        if self._folder and self._kept != self.training.step:
            self._keep()

    def _look(self) -> list[Message]:
        """Read some of the images held out; return the messages if that completes them."""
        if not len(self.training.held_images):
            return []
        self._reading = self._reading or ValidationReading(self.training)
        if not self._reading.go_on():
            return []
        reading, self._reading = self._reading, None
        score, misread = reading.told(self.training.seconds)
        if self._best is None or score.accuracy >= self._best[0]:
            self._best = score.accuracy, reading.values.copy()
        return [score, misread]

    def _keep(self, final: bool = False) -> list[Message]:
        """Write the run; tell of it when it is final, or when something new went wrong."""
        if self._folder is None:
            return []
        problem, test = self._written(self._folder, final)
        if not problem:
            self._kept = self.training.step
        new, self._trouble = problem != self._trouble, problem
        return [DigitRunSaved(self._folder, problem, test, self.training.best_epoch)] if final or new else []

    def _written(self, folder: Path, final: bool = False) -> tuple[str, float | None]:
        """Write the run; return what went wrong, and the accuracy on the test images if it is final."""
        try:
            return "", save_digit_run(self.training, folder, final=final).get("test")
        except (OSError, ValueError) as error:
            return problem_of(error), None
