"""Ablation of preprocessing: the share of drawings that a network still reads when a step is left out."""

from __future__ import annotations

from collections.abc import Generator
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
import numpy.typing as npt

from ai.digits.classifier import DigitClassifier, Image, load_part
from ai.digits.preprocessing import distance, enlarge, stages

COUNT: Final = 300
_CANVAS: Final = 160  # pixels along a canvas
_SIZES: Final = (70.0, 140.0)  # that a test image, with its margin, is enlarged to
_GROWTH: Final = (-1.4, 1.6)  # of strokes that are some 2.4 pixels wide in MNIST, in such pixels


Steps = dict[str, bool]  # of `ai.digits.preprocessing.stages`, whether each is taken


@dataclass(frozen=True)
class StageAccuracy:
    """Accuracy of each network, by name, on `count` drawings with some steps taken."""

    steps: tuple[tuple[str, bool], ...]
    read: dict[str, float]
    count: int


Answers = list[StageAccuracy]


def drawings(images: npt.NDArray[np.float32], rng: np.random.Generator) -> list[Image]:
    """Return images of MNIST as people might have drawn them: anywhere on a canvas, of any size, with any pen."""
    return [_drawn(image, rng) for image in images]


def stage_accuracy(folders: dict[str, Path], count: int = COUNT) -> Generator[Answers, Steps | None, None]:
    """Measure the networks in the folders with each choice of steps that is sent; for a worker.

    The drawings are made of test images, the same each time. Raises ModelFormatError or MnistError at the start.
    """
    classifiers = {name: DigitClassifier.load(folder) for name, folder in folders.items()}
    images, labels = load_part("test")
    rng = np.random.default_rng(0)
    chosen = rng.choice(len(images), count, replace=False)
    canvases, labels = drawings(images[chosen], rng), labels[chosen]
    told: Answers = []
    while True:
        steps = yield told
        told = []
        if steps is not None:
            seen = np.stack([stages(canvas, **steps).centred for canvas in canvases])
            read = {
                name: float((classifier.predict(seen).argmax(axis=1) == labels).mean())
                for name, classifier in classifiers.items()
            }
            told = [StageAccuracy(tuple(steps.items()), read, count)]


def _drawn(image: Image, rng: np.random.Generator) -> Image:
    size = int(rng.uniform(*_SIZES))
    ink = enlarge(image, size)
    grows = rng.uniform(*_GROWTH) / 2 * size / len(image)
    inked, reach = ink > 0.5, int(abs(grows)) + 2
    edge = 1 - distance(inked, reach) + grows if grows > 0 else distance(~inked, reach) + grows
    ink = np.asarray(np.clip(edge, 0, 1), np.float32)
    canvas = np.zeros((_CANVAS, _CANVAS), np.float32)
    top, left = rng.integers(0, _CANVAS - size + 1, 2)
    canvas[top : top + size, left : left + size] = ink
    return canvas
