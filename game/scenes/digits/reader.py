"""Digit reader: the networks' probabilities for a drawing, and what its ink says for the answer."""

from __future__ import annotations

import logging
from dataclasses import dataclass
from enum import Enum, auto
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np

from ai.digits.classifier import DIGITS
from ai.digits.preprocessing import SIDE, Image, preprocess_strokes, stroke_width
from ai.files.reading import brief
from game.digits.kept import classifier_in
from game.digits.pictures import Numbers, visible
from game.scenes.digits.pad import DrawingPad
from game.training.library import NAMES

if TYPE_CHECKING:
    from ai.digits.classifier import DigitClassifier


SURE: Final = 0.9  # nine in ten rightly read test images have a higher probability
LIKELY: Final = 0.75  # and 99 in a hundred of those that Modern reads
ONE_STROKE: Final = 3.5  # pixels of width: ones have 2.0 to 3.1, what is wider may be a ring that has closed
LEAST_INK, MOST_INK = 18.0, 200.0  # pixels: test images have 25 to 257, 99 in a hundred up to 186, a dot has 5
_log = logging.getLogger("tranquility")


class Verdict(Enum):
    """Confidence in an answer."""

    EMPTY = auto()
    SURE = auto()
    LIKELY = auto()
    DISPUTED = auto()  # another network reads another digit
    UNSURE = auto()


def best_two(probabilities: Numbers) -> tuple[int, int]:
    """Return the most probable digit and the next."""
    first, second = np.argsort(-probabilities, kind="stable")[:2].tolist()
    return first, second


@dataclass(frozen=True, eq=False)
class Reading:
    """Reading of a drawing, prepared as `image`: `probabilities` (10,) by the name of each network that read it."""

    image: Image
    probabilities: dict[str, Numbers]

    def verdict(self, name: str) -> Verdict:
        """Return the confidence in a network's answer: full only if the others agree, for a 1 if it is one stroke."""
        ink = float(self.image.sum())
        if ink == 0 or name not in self.probabilities:
            return Verdict.EMPTY
        surest = round(float(self.probabilities[name].max()), 2)  # rounded as it is displayed beside the verdict
        if surest < LIKELY or not LEAST_INK < ink < MOST_INK:
            return Verdict.UNSURE
        agreed = len({int(values.argmax()) for values in self.probabilities.values()}) == 1
        if not agreed:
            return Verdict.DISPUTED
        if int(self.probabilities[name].argmax()) == 1 and stroke_width(self.image > 0.5) > ONE_STROKE:
            return Verdict.LIKELY
        return Verdict.SURE if surest >= SURE else Verdict.LIKELY


class LiveReading:
    """Reading of what is drawn on a pad, kept up to date.

    Args:
        pad: what is drawn on.
        chosen: name of the network that is explained.

    Attributes:
        classifiers: the networks that could be loaded, by name.
        problems: why others could not, or were loaded without their latest fixes.
        reading: the latest reading.
        why: (28, 28) what ink says for the chosen network's answer, -1 to 1; None if it could not be loaded.

    """

    def __init__(self, pad: DrawingPad, chosen: str) -> None:
        self._pad, self.chosen = pad, chosen
        self.classifiers: dict[str, DigitClassifier] = {}
        self.problems: dict[str, str] = {}
        self._seen = -1  # revision of the drawing that was read last
        self.why: Image | None = None
        self._explained = True

    def load(self, name: str, *folders: Path) -> bool:
        """Load a network from the first folder with a sound one; `problems` tells what was wrong with earlier folders.

        Never raises. Returns False if no folder has one; a network loaded before then stays.
        """
        self.problems.pop(name, None)
        for folder in folders:
            try:
                self.classifiers[name] = classifier_in(folder)
            except Exception as error:  # a damaged folder may fail in any way, and none may end the game
                _log.info("reading %s", folder, exc_info=True)
                problem = getattr(error, "problem", "") or str(error) or type(error).__name__
                self.problems.setdefault(name, brief(problem))
            else:
                return True
        return False

    @property
    def other(self) -> str:
        """Name of the network to compare with: Modern, or Classic beside Modern; empty if it can't be loaded."""
        return next((name for name in NAMES if name != self.chosen and name in self.classifiers), "")

    @property
    def probabilities(self) -> Numbers | None:
        """The chosen network's probabilities (10,); None while nothing is drawn, or it can't be loaded."""
        self.catch_up()
        return None if self.reading.verdict(self.chosen) is Verdict.EMPTY else self.reading.probabilities[self.chosen]

    def update(self) -> None:
        """Read the drawing if it has changed, and explain the answer a frame later: both take long."""
        if not self._explained:
            self._explain()
        else:
            self.catch_up()

    def catch_up(self) -> None:
        """Read the current drawing."""
        if self._seen == self._pad.revision:
            return
        self._seen, self._explained = self._pad.revision, False
        image = preprocess_strokes(self._pad.strokes)
        names = [name for name in (self.chosen, self.other) if name in self.classifiers]
        self.reading = Reading(image, {name: self.classifiers[name].predict(image)[0] for name in names})

    def anew(self) -> None:
        """Read and explain the current drawing again, by networks that have changed."""
        self._seen = -1
        self.catch_up()
        self._explain()

    def _explain(self) -> None:
        self._explained = True
        classifier = self.classifiers.get(self.chosen)
        self.why = saliency(classifier, self.reading.image) if classifier else None


def saliency(classifier: DigitClassifier, image: Image) -> Image:
    """Return (28, 28) what each pixel's ink says for a network's best answer against its second, -1 to 1."""
    shaped = classifier.shaped(image)
    output = classifier.network.activations(shaped)[-1]
    first, second = best_two(output[0])
    between = np.zeros((1, DIGITS), np.float32)
    between[0, first], between[0, second] = 1, -1
    said = classifier.network.input_gradient(shaped, between).reshape(SIDE, SIDE) * image
    return visible(said / max(float(np.abs(said).max()), 1e-9))
