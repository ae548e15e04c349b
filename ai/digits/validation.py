"""Validation of a digit network while it trains: a part of the images held out at a time, and those misread."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Final

import numpy as np
import numpy.typing as npt

from ai.digits.classifier import DIGITS, DigitClassifier
from ai.digits.training import DigitTraining, confusion
from ai.nn import Array

EXAMPLES: Final = 12  # misread images of a kind that are shown
_SLICE: Final = 100  # images that are read between two steps


@dataclass(frozen=True, eq=False)
class Confusion:
    """Confusion matrix of the images held out, with some that were misread."""

    newest_only: ClassVar = True

    table: npt.NDArray[np.int64]  # (10, 10), how often each digit (row) was read as which (column)
    cells: npt.NDArray[np.int64]  # (n, 2), row and column of some that were misread, at most EXAMPLES of each kind
    images: npt.NDArray[np.uint8]  # (n, 28, 28), those images


class ValidationReading:
    """Validation on the images held out, a slice at a time, of the network as it was at the start."""

    def __init__(self, training: DigitTraining, classifier: DigitClassifier | None = None) -> None:
        self._classifier = classifier or training.current()
        self._images, self._labels = training.held_images, training.held_labels
        self._read: list[npt.NDArray[np.intp]] = []
        self._at = 0

    def go_on(self) -> bool:
        """Read a slice; return whether that was the last."""
        part = self._images[self._at : self._at + _SLICE]
        self._read.append(self._classifier.predict(part).argmax(axis=1))
        self._at += _SLICE
        return self._at >= len(self._images)

    @property
    def values(self) -> Array:
        """The network's parameters."""
        return self._classifier.network.values

    def result(self) -> tuple[float, Confusion]:
        """Return accuracy and confusion matrix of the network."""
        labels, read = self._labels.astype(np.int64), np.concatenate(self._read)
        table, kinds = confusion(labels, read), labels * DIGITS + read
        wrong = np.flatnonzero(labels != read)
        chosen = np.sort(
            np.concatenate([wrong[:0], *(wrong[kinds[wrong] == kind][:EXAMPLES] for kind in np.unique(kinds[wrong]))])
        )
        images = (self._images[chosen] * 255).astype(np.uint8)
        cells = np.stack([labels[chosen], read[chosen]], axis=1)
        return float(table.trace() / len(labels)), Confusion(table, cells, images)
