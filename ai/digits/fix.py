"""Fine-tuning on one misread drawing: a few learning steps, and what they cost on the test images."""

from __future__ import annotations

from collections.abc import Generator
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar, Final

import numpy as np

from ai.digits.augmentation import Strength, augment
from ai.digits.classifier import DIGITS, DigitClassifier
from ai.digits.mnist import TEST, TRAIN, Images, Labels, load_part
from ai.digits.preprocessing import Image
from ai.digits.training import accuracy
from ai.files.folder import CONFIG
from ai.files.reading import read_json
from ai.files.schema import Share, read_as
from ai.nn import Adam
from ai.run import TRAINING_FILE

STEPS: Final = 60  # at the most
ENOUGH: Final = 0.9  # how probable the right digit shall be
COPIES: Final = 16  # of the drawing in each batch, bent a little; and training images beside them
REHEARSED: Final = 112
LEARNING_RATE: Final = 3e-4


@dataclass(frozen=True)
class FixStep:
    """Progress of a fix: the probability of the right digit by now."""

    newest_only: ClassVar = True

    step: int
    probability: float


@dataclass(frozen=True)
class Fixed:
    """Result of a fix."""

    digit: int  # what the drawing is
    probability: tuple[float, float]  # of that digit before, and now
    accuracy: tuple[float, float]  # on the test images before, and now
    steps: int  # how many were taken; none if it was sure already
    folder: Path | None = None  # where the fixed network is; None if it was not kept
    problem: str = ""  # why it was not kept


def fix(
    folder: Path,
    image: Image,
    digit: int,
    keep: Path,
    *,
    train: tuple[Images, Labels] | None = None,
    test: tuple[Images, Labels] | None = None,
) -> Generator[list[FixStep | Fixed], Any, None]:
    """Fine-tune the network in a folder on a drawing (28, 28), and write the fixed one to `keep`; for a worker.

    Each step learns from the drawing, bent a little, and from training images at the same time: a network that sees
    the new alone forgets the old (rehearsal, Robins 1995). It ends as soon as it is sure of the digit. Images are
    MNIST's, unless others are given. Raises ValueError for a digit that is none, or an image that is empty or not
    finite, FloatingPointError if training diverges, and what `DigitClassifier.load` and `load_part` raise.
    """
    image = np.asarray(image, np.float32)
    if digit not in range(DIGITS):
        raise ValueError(f"a digit is a number from 0 to 9, not {digit!r}")
    if not np.isfinite(image).all() or not image.any():
        raise ValueError("there is nothing to learn from: the image is empty, or not finite")
    classifier, rng, optimizer = DigitClassifier.load(folder), np.random.default_rng(digit), Adam(LEARNING_RATE)
    first = now = _probability(classifier, image, digit)
    yield [FixStep(0, first)]
    tested, (images, labels) = test or load_part(TEST), train or load_part(TRAIN)
    before = after = _known_accuracy(folder) or accuracy(classifier, *tested)
    taken = 0
    while now < ENOUGH and taken < STEPS:
        chosen = rng.choice(len(images), min(REHEARSED, len(images)), replace=False)
        copies = np.repeat(image[None], COPIES, axis=0)
        copies[1:] = augment(copies[1:], rng, Strength().times(0.5))
        batch = np.concatenate([copies, images[chosen]])
        targets = np.eye(DIGITS, dtype=np.float32)[np.concatenate([np.full(COPIES, digit), labels[chosen]])]
        classifier.network.train_batch(classifier.shaped(batch), targets, optimizer)
        now, taken = _probability(classifier, image, digit), taken + 1
        yield [FixStep(taken, now)]
    kept, problem = None, ""
    if taken:
        after = accuracy(classifier, *tested)
        try:
            classifier.save(keep, test=after, fixed={"digit": digit, "steps": taken, "before": before})
            kept = keep
        except (OSError, ValueError) as error:
            problem = getattr(error, "strerror", None) or str(error)
    yield [Fixed(digit, (first, now), (before, after), taken, kept, problem)]


@dataclass(frozen=True)
class _Tested:
    test: Share | None = None


def _known_accuracy(folder: Path) -> float | None:
    """Return the test accuracy stored in a network's folder, if there is one."""
    for file in (CONFIG, TRAINING_FILE):  # of a fix, and of a training
        with suppress(OSError, ValueError):
            if (test := read_as(_Tested, read_json(folder / file)).test) is not None:
                return test
    return None


def _probability(classifier: DigitClassifier, image: Image, digit: int) -> float:
    return float(classifier.predict(image)[0, digit])
