"""Digit reader: the networks' probabilities for a drawing, with preprocessing stages, activations and saliency."""

from __future__ import annotations

import logging
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from enum import Enum, auto
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np

from ai.digits.classifier import DIGITS
from ai.digits.preprocessing import SIDE, Image, Stages, redrawn, stroke_stages, stroke_width
from ai.files import brief
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
    """Reading of one drawing: `probabilities` (10,) by the name of each network that could be loaded."""

    stages: Stages
    probabilities: dict[str, Numbers]

    def verdict(self, name: str) -> Verdict:
        """Return the confidence in a network's answer: full only if the others agree, for a 1 if it is one stroke."""
        ink = float(self.stages.centred.sum())
        if ink == 0 or name not in self.probabilities:
            return Verdict.EMPTY
        surest = round(float(self.probabilities[name].max()), 2)  # rounded as it is displayed beside the verdict
        if surest < LIKELY or not LEAST_INK < ink < MOST_INK:
            return Verdict.UNSURE
        agreed = len({int(values.argmax()) for values in self.probabilities.values()}) == 1
        if not agreed:
            return Verdict.DISPUTED
        if int(self.probabilities[name].argmax()) == 1 and stroke_width(self.stages.centred > 0.5) > ONE_STROKE:
            return Verdict.LIKELY
        return Verdict.SURE if surest >= SURE else Verdict.LIKELY


@dataclass
class Reader:
    """The loaded networks. One that can't be loaded is left out; `problems` says why, by name."""

    classifiers: dict[str, DigitClassifier] = field(default_factory=dict)
    sources: dict[str, Path] = field(default_factory=dict)
    problems: dict[str, str] = field(default_factory=dict)

    def load(self, name: str, *folders: Path) -> bool:
        """Load a network from the first folder with a sound one; `problems` tells what was wrong with earlier folders.

        Never raises. Returns False if no folder has one; a network loaded before then stays.
        """
        self.problems.pop(name, None)
        for folder in folders:
            problem = self._load(name, folder)
            if not problem:
                self.sources[name] = folder
                return True
            self.problems.setdefault(name, problem)
        return False

    def _load(self, name: str, folder: Path) -> str:
        """Load one network; return what is wrong with it, empty if nothing."""
        from ai.nn import ModelFormatError

        try:
            self.classifiers[name] = classifier_in(folder)
        except ModelFormatError as error:
            return brief(error.problem)
        except Exception as error:  # a damaged folder may fail in any way, and none may end the game
            _log.exception("reading %s", folder)
            return brief(str(error) or type(error).__name__)
        return ""

    def read(self, seen: Stages, names: Iterable[str] | None = None) -> Reading:
        """Read a preprocessed drawing with the named networks; with all of them if `names` is None."""
        wanted = self.classifiers if names is None else names
        return Reading(seen, {name: self.classifiers[name].predict(seen.centred)[0] for name in wanted})

    def saliency(self, name: str, image: Image) -> Image:
        """Return (28, 28) what each pixel's ink says for a network's best answer against its second, -1 to 1."""
        classifier = self.classifiers[name]
        shaped = classifier.shaped(image)
        output = classifier.network.activations(shaped)[-1]
        first, second = best_two(output[0])
        between = np.zeros((1, output.shape[-1]), np.float32)
        between[0, first], between[0, second] = 1, -1
        said = classifier.network.input_gradient(shaped, between).reshape(SIDE, SIDE) * image
        return visible(said / max(float(np.abs(said).max()), 1e-9))


class LiveReading:
    """Reading of what is drawn on a pad, kept up to date.

    Args:
        pad: what is drawn on.
        chosen: name of the network that is explained.
        on_read: called after each reading.

    Attributes:
        reader: the networks that could be loaded.
        reading: the latest reading.
        why: (28, 28) what ink says for the chosen network's answer, -1 to 1; None if it could not be loaded.

    """

    def __init__(self, pad: DrawingPad, chosen: str, on_read: Callable[[], None]) -> None:
        self._pad, self.chosen, self._on_read = pad, chosen, on_read
        self.reader = Reader()
        self._seen = -1  # revision of the drawing that was read last
        self._looking: Iterator[None] = iter(())
        self.why: Image | None = None

    @property
    def known(self) -> bool:
        """Whether the chosen network could be loaded."""
        return self.chosen in self.reader.classifiers

    @property
    def other(self) -> str:
        """Name of the network to compare with: Modern, or Classic beside Modern; empty if it can't be loaded."""
        return next((name for name in NAMES if name != self.chosen and name in self.reader.classifiers), "")

    @property
    def pair(self) -> list[str]:
        """Names of both networks, as far as they could be loaded."""
        return [name for name in (self.chosen, self.other) if name in self.reader.classifiers]

    @property
    def probabilities(self) -> Numbers | None:
        """The chosen network's probabilities (10,); None while nothing is drawn, or it can't be loaded."""
        self.catch_up()
        return None if self.reading.verdict(self.chosen) is Verdict.EMPTY else self.reading.probabilities[self.chosen]

    def bars(self) -> tuple[list[tuple[float, float]], int | None]:
        """Return both networks' probabilities digit by digit, and the chosen one's answer; zeros and None without."""
        drawn, nothing = bool(self.reading.stages.centred.any()), np.zeros(DIGITS)
        values = [self.reading.probabilities.get(name, nothing) * drawn for name in (self.chosen, self.other)]
        best = int(values[0].argmax()) if values[0].any() else None
        return list(zip(*(value.tolist() for value in values), strict=True)), best

    def update(self) -> None:
        """Read the drawing if it has changed, a part per frame."""
        if next(self._looking, True) and self._seen != self._pad.revision:
            self._looking = self._look()
            next(self._looking)

    def catch_up(self) -> None:
        """Finish reading the current drawing."""
        if self._seen != self._pad.revision:
            self._looking = self._look()
        deque(self._looking, maxlen=0)

    def anew(self) -> None:
        """Read the current drawing again, by networks that have changed."""
        self._seen = -1
        self.catch_up()

    def _look(self) -> Iterator[None]:
        """Preprocess the drawing, read it with both networks, and explain the chosen one's answer.

        A generator that does a part at a time: while the pen moves, all of it would take too long for one frame.
        """
        self._seen = self._pad.revision
        strokes = redrawn(self._pad.strokes)
        yield
        seen = stroke_stages(strokes, self._pad.ink)
        self.reading = self.reader.read(seen, self.pair)
        self._on_read()
        yield
        known = self.chosen in self.reading.probabilities
        self.why = self.reader.saliency(self.chosen, seen.centred) if known else None
        yield
