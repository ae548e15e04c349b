"""Why a network reads one digit and not another: the evidence of its units, and of ink taken away or put there.

Ink is judged by occlusion (Zeiler & Fergus 2014): a small square of the image is emptied, or filled, and the network
reads the changed image. Every number is thus an answer of the network itself, not an estimate of one.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from itertools import product
from typing import Final

import numpy as np
import numpy.typing as npt

from ai.digits.classifier import DIGITS, DigitClassifier
from ai.digits.preprocessing import SIDE, Image
from ai.nn import Array, FullyConnectedLayer
from ai.nn.layer import Layer

SQUARE: Final = 3  # pixels along a square that is emptied or filled: a stroke is 2.4 wide
_LEAST_CHANGE: Final = 1.0  # pixels of ink: a square with less of it to take, or to put, is left out
_WORK: Final = 64_000_000  # multiplications at a time: some 3 ms
_MOST: Final = 64  # images at a time


@dataclass(frozen=True)
class InkChange:
    """Effect of emptying or filling one square of the image."""

    row: int  # the pixel in the square's middle
    column: int
    ink: int  # what the square holds afterwards, 0 or 1
    before: float  # the asked digit's score
    after: float


class Contrast:
    """Evidence in one image (28, 28), measured a part at a time: call `advance` until none is `left`.

    A digit's *score* is what the last fully connected layer gives for it, before any activation.
    Raises ValueError for a network that has no such layer of ten outputs.

    Attributes:
        image: the image.
        scores: (10,) of the image as it is.
        answer: the digit with the highest score.
        taken, put: (28, 28, 10) change of every score when the square around a pixel is emptied, or filled; NaN where
            that is not measured yet, or the square has nothing to take, or no room.

    """

    def __init__(self, classifier: DigitClassifier, image: Image) -> None:
        self._classifier = classifier
        last = next((each for each in reversed(classifier.network.layers) if each.parameters), None)
        if type(last) is not FullyConnectedLayer or last.outputs != DIGITS:
            raise ValueError("the network's last layer is not fully connected to ten outputs")
        self._at = classifier.network.layers.index(last)
        self.image: Image = np.array(image, np.float32)
        activations = classifier.network.activations(classifier.shaped(self.image))
        self.scores: Array = activations[self._at][0]
        self.answer = int(self.scores.argmax())
        self.taken: Array = np.full((SIDE, SIDE, DIGITS), np.nan, np.float32)
        self.put = self.taken.copy()
        self._ahead = self._squares()

    @property
    def left(self) -> int:
        """How many squares are still to be measured."""
        return len(self._ahead)

    @cached_property
    def batch(self) -> int:
        """Number of images read at a time, so that it takes some 3 ms of one core."""
        work = sum(_multiplications(layer) for layer in self._classifier.network.layers)
        return min(max(1, _WORK // max(work, 1)), _MOST)

    def advance(self) -> bool:
        """Measure the next squares; return whether those were the last."""
        now, self._ahead = self._ahead[: self.batch], self._ahead[self.batch :]
        if now:
            images = np.stack([self.changed(row, column, ink) for ink, row, column in now])
            for (ink, row, column), change in zip(now, self._read(images) - self.scores, strict=True):
                (self.put if ink else self.taken)[row, column] = change
        return not self._ahead

    def changed(self, row: int, column: int, ink: int) -> Image:
        """Return the image with the square around a pixel emptied (0) or filled (1)."""
        image = self.image.copy()
        image[_around(row), _around(column)] = ink
        return image

    def best(self, asked: int, ink: int) -> InkChange | None:
        """Return the change that brings the asked digit nearest to the answer, of all that raise its own score.

        None if none does, of those measured so far.
        """
        changes = self.put if ink else self.taken
        raised, gained = changes[..., asked], changes[..., asked] - changes[..., self.answer]
        gained = np.where((raised > 0) & (gained > 0), gained, -np.inf)
        row, column = map(int, np.unravel_index(int(gained.argmax()), gained.shape))
        if not math.isfinite(gained[row, column]):
            return None
        before = float(self.scores[asked])
        return InkChange(row, column, ink, before, before + float(raised[row, column]))

    def _read(self, images: npt.NDArray[np.float32]) -> Array:
        """Return the scores of images (n, 28, 28), (n, 10)."""
        data: Array = self._classifier.shaped(images)
        for layer in self._classifier.network.layers[: self._at + 1]:
            data = layer.predict(data)
        return data

    def _squares(self) -> list[tuple[int, int, int]]:
        """Return the squares to measure, as what they are to hold, row and column; those with the most to change first.

        Ink that is there comes before ink that is not.
        """
        room = [
            (ink, -float(np.abs(ink - self.image[_around(row), _around(column)]).sum()), row, column)
            for ink, row, column in product((0, 1), range(SIDE), range(SIDE))
        ]
        found = [(ink, row, column) for ink, change, row, column in sorted(room) if -change >= _LEAST_CHANGE]
        return found if self.image.any() else []


def _around(pixel: int) -> slice:
    return slice(max(0, pixel - SQUARE // 2), pixel + SQUARE // 2 + 1)


def _multiplications(layer: Layer) -> int:
    """Return how many multiplications a layer needs for one example."""
    if not layer.parameters:
        return 0
    outputs = layer.outputs if isinstance(layer.outputs, tuple) else (1, 1, 0)
    return layer.parameters[0].value.size * outputs[0] * outputs[1]
