"""MNIST: 70,000 handwritten digits, kept compressed beside the program and checked each time they are read.

LeCun, Cortes and Burges; see assets/mnist/README.txt for where the data come from and their licence.
"""

from __future__ import annotations

import hashlib
from pathlib import Path
from typing import Final, NamedTuple

import numpy as np
import numpy.typing as npt

from ai.files.reading import problem_in, read_arrays, read_bytes

FOLDER: Final = Path(__file__).parents[2] / "assets" / "mnist"
TRAIN, TEST = "train", "test"
_LARGEST: Final = 100_000_000  # bytes of a file

Images = npt.NDArray[np.float32]  # (n, 28, 28), 0 to 1, ink bright
Pixels = npt.NDArray[np.uint8]  # (n, 28, 28), 0 to 255
Labels = npt.NDArray[np.uint8]  # (n,), 0 to 9


class MnistError(ValueError):
    """The data are missing or damaged; the message names the file and what is wrong with it."""


class Mnist(NamedTuple):
    """Both parts: images float32 (n, 28, 28) in 0 to 1, ink bright, and labels uint8 (n,)."""

    train_images: Images
    train_labels: Labels
    test_images: Images
    test_labels: Labels


CHECKSUMS: Final = {  # SHA-256 of the file
    TRAIN: "33e9753a8d3ed06561a816bf46d6d686b20801696e497f092853c1634577f43f",
    TEST: "af5595f05f0cc260498196e07655cfa443d2d96874d5ba0dcfeaea06defbda81",
}


def load_mnist(folder: str | Path = FOLDER) -> Mnist:
    """Read training and test data; raises MnistError if a file is missing or damaged."""
    return Mnist(*load_part(TRAIN, folder), *load_part(TEST, folder))


def load_part(part: str, folder: str | Path = FOLDER) -> tuple[Images, Labels]:
    """Read the images and labels of "train" or "test" alone; raises MnistError like `load_mnist`."""
    pixels, labels = read_part(part, folder)
    return bright(pixels), labels


def bright(pixels: Pixels) -> Images:
    """Return images as networks read them, 0 to 1."""
    return np.divide(pixels, np.float32(255), dtype=np.float32)


def read_part(part: str, folder: str | Path = FOLDER) -> tuple[Pixels, Labels]:
    """Read the same as `load_part`, the images in whole numbers: a quarter of the memory."""
    path = Path(folder) / f"{part}.npz"
    try:
        if hashlib.sha256(read_bytes(path, _LARGEST)).hexdigest() != CHECKSUMS[part]:
            raise ValueError("its checksum differs")
        arrays = read_arrays(path, _LARGEST)
    except FileNotFoundError as error:
        raise MnistError(f"MNIST: {path} is missing; install the program again") from error
    except (OSError, ValueError) as error:
        raise MnistError(f"MNIST: {path} is damaged ({problem_in(error)}); install the program again") from error
    return arrays["images"], arrays["labels"]
