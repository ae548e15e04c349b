"""MNIST: 70,000 handwritten digits, kept compressed beside the program and checked each time they are read.

LeCun, Cortes and Burges; see assets/mnist/README.txt for where the data come from and their licence.
"""

from __future__ import annotations

import hashlib
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np
import numpy.typing as npt

from ai.files import described, problem_in, read_arrays

FOLDER: Final = Path(__file__).parents[2] / "assets" / "mnist"
SIDE: Final = 28  # pixels along an image
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


# How many examples, and the SHA-256 of images and labels as published: as IDX files, headers included.
PARTS: Final = {
    TRAIN: (
        60_000,
        "ba891046e6505d7aadcbbe25680a0738ad16aec93bde7f9b65e87a2fc25776db",
        "65a50cbbf4e906d70832878ad85ccda5333a97f0f4c3dd2ef09a8a9eef7101c5",
    ),
    TEST: (
        10_000,
        "0fa7898d509279e482958e8ce81c8e77db3f2f8254e26661ceb7762c4d494ce7",
        "ff7bcfd416de33731a308c3f266cc351222c34898ecbeaf847f06e48f7ec33f2",
    ),
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
    count, images_sum, labels_sum = PARTS[part]
    path = Path(folder) / f"{part}.npz"
    shapes = {"images": (count, SIDE, SIDE), "labels": (count,)}

    def expect(name: str, shape: tuple[int, ...], dtype: np.dtype[Any]) -> None:
        if shape != shapes.get(name) or dtype != np.uint8:
            raise ValueError(f"{name} is {described(shape, dtype)}")

    try:
        arrays = read_arrays(path, _LARGEST, expect)
        pixels, labels = arrays["images"], arrays["labels"]
    except FileNotFoundError as error:
        raise MnistError(f"MNIST: {path} is missing; install the program again") from error
    except (OSError, ValueError, KeyError) as error:
        raise MnistError(f"MNIST: {path} is damaged ({problem_in(error)}); install the program again") from error
    if (_checksum(pixels), _checksum(labels)) != (images_sum, labels_sum):
        raise MnistError(f"MNIST: {path} is damaged (a checksum differs); install the program again")
    return pixels, labels


def _checksum(array: npt.NDArray[np.uint8]) -> str:
    """Return the SHA-256 of the array as an IDX file: two zeros, 8 for bytes, the axes, their big-endian sizes."""
    digest = hashlib.sha256(bytes([0, 0, 8, array.ndim]) + np.array(array.shape, ">u4").tobytes())
    digest.update(np.ascontiguousarray(array).data)
    return digest.hexdigest()
