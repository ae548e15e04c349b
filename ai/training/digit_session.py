"""Session of digits: batches, and the images held out as they are read."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Final

import numpy as np

from ai.digits.training import DigitProgress, DigitTraining
from ai.digits.validation import ValidationReading
from ai.nn import Array
from ai.training.history import DIGIT_COLUMNS, REVERTED, Validation
from ai.training.session import Session

POINT_SECONDS: Final = 0.1  # of learning, at least, between two points
_SHARE: Final = 0.25  # of the time that goes into reading the images held out


class DigitSession(Session[DigitTraining]):
    """Session of digits. Some of the images held out are read between two steps."""

    kind, columns = DigitTraining, DIGIT_COLUMNS

    def __init__(self, training: DigitTraining, keep: Path | None, source: Path | None) -> None:
        super().__init__(training, keep, source)
        self._batches: list[tuple[float, float]] = []  # loss and accuracy
        self._began = self._point_at = training.seconds
        self._reading: ValidationReading | None = None
        self._best: tuple[float, Array] | None = None  # of all that was read, the accuracy and the values
        if training.best is not None and training.best_values is not None:
            self._best = training.best, training.best_values.copy()
        self._looking = 0.0  # seconds

    def show(self) -> None:
        """Show nothing: its history says it all."""

    def tell(self, progress: DigitProgress) -> None:
        training = self.training
        self._batches.append((progress.loss, progress.accuracy))
        if training.seconds >= self._point_at:
            self._point_at = training.seconds + POINT_SECONDS
            loss, accuracy = np.mean(self._batches, axis=0).tolist()
            self._batches.clear()
            self.record(replace(progress, loss=loss, accuracy=accuracy))
        if self._looking <= _SHARE * (training.seconds - self._began) and len(training.held_images):
            began = training.clock()
            self._reading = self._reading or ValidationReading(training)
            if self._reading.go_on():
                reading, self._reading = self._reading, None
                self._tell_reading(reading)
            self._looking += training.clock() - began

    def _tell_reading(self, reading: ValidationReading) -> None:
        """Tell what came of a reading, and keep its network if it is the best so far."""
        training = self.training
        accuracy, confusion = reading.result()
        best = self._best is None or accuracy >= self._best[0]
        if best:
            self._best = accuracy, reading.values.copy()
        self.record(Validation(training.step, accuracy, accuracy, best, training.seconds))
        self.messages.append(confusion)

    def last_words(self) -> Iterator[None]:
        """Read all images held out once more, and measure the test images."""
        training = self.training
        if self.keep:  # measuring takes a while, and a user who does not wait must lose nothing
            self.keeper.save(self.keep)
        yield
        if len(training.held_images):
            reading = ValidationReading(training)
            while not reading.go_on():
                yield
            self._tell_reading(reading)
            yield
            if training.best_epoch is not None:  # another network is kept: its misread images are shown
                reading = ValidationReading(training, training.best_classifier())
                while not reading.go_on():
                    yield
                self.messages.append(reading.result()[1])
        if self.keep:
            self.messages.append(self.keeper.save(self.keep, final=True))
        yield

    # Commands

    def _restore_best(self) -> None:
        """Restore the network that read the images held out best."""
        if self._best is not None:
            accuracy, values = self._best
            self.training.restore(values)
            self._reading = None  # it was reading for the network that is gone
            self.record_change(REVERTED, None, accuracy)

    commands = Session.commands | {"restore_best": _restore_best}
