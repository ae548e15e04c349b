"""Digit networks and test images that were read, kept for the next scene that needs them."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Final

from game.core.shelf import Kept
from game.training.library import NAMES

if TYPE_CHECKING:
    from ai.digits.classifier import DigitClassifier
    from ai.digits.mnist import Labels, Pixels

_MNIST: Final = "mnist"  # folder in the assets
_classifiers: Final = Kept["DigitClassifier"](most=4)
_images: Final = Kept["tuple[Pixels, Labels]"](most=1)


def classifier_in(folder: Path) -> DigitClassifier:
    """Read a network; raises what `DigitClassifier.load` raises."""
    from ai.digits.classifier import DigitClassifier

    return _classifiers.get(folder, lambda: DigitClassifier.load(folder))


def mnist_test(assets_dir: Path) -> tuple[Pixels, Labels]:
    """Read MNIST's test images, (10000, 28, 28) of 0 to 255, and their labels; raises MnistError."""
    from ai.digits.mnist import TEST, read_part

    folder = assets_dir / _MNIST
    return _images.get(folder / f"{TEST}.npz", lambda: read_part(TEST, folder))


def read_ahead(models_dir: Path, assets_dir: Path) -> None:
    """Read what scenes with digits begin with; they report what is missing or damaged."""
    from ai.digits.mnist import MnistError
    from ai.nn import ModelFormatError

    for name in NAMES:
        try:
            classifier_in(models_dir / "digits" / name)
        except (OSError, ModelFormatError):
            continue
    try:
        mnist_test(assets_dir)
    except MnistError:
        return


def forget() -> None:
    """Forget all that is kept."""
    _classifiers.clear()
    _images.clear()
