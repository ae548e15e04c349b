"""Digit classifier: a network that reads handwritten digits, with its files. The data are in `ai.digits.mnist`."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from ai.digits.preprocessing import SIDE
from ai.files.folder import CONFIG, OF_A_RUN, FolderKind, atomic_folder, recover_folder
from ai.files.folder import NETWORK as NETWORK_KIND
from ai.files.reading import inside, read_json
from ai.files.schema import check_header
from ai.nn import NeuralNetwork, softmax
from ai.nn.storage import reading

DIGITS_FILE: Final = CONFIG  # of a classifier's folder; its network is in a folder within
NETWORK: Final = "network"
FORMAT: Final = "tranquility digits"
VERSION: Final = 1
KIND: Final = FolderKind(FORMAT, (CONFIG, *OF_A_RUN, *NETWORK_KIND.within(NETWORK)))
DIGITS: Final = 10
_BATCH: Final = 250  # images that a large network reads at a time: more only need more memory


class DigitClassifier:
    """Classifier of preprocessed images: a network that gives the probability of each digit.

    The network takes rows of 784 numbers, or images of (28, 28, 1); it has ten outputs: logits if its cost is
    cross-entropy, else numbers that are near 1 for the digit and near 0 for the others.
    """

    def __init__(self, network: NeuralNetwork) -> None:
        self.network = network
        shape = next((layer.inputs for layer in network.layers if layer.inputs is not None), None)
        if shape not in (SIDE * SIDE, (SIDE, SIDE, 1)):
            raise ValueError(f"the network takes {shape}, not {SIDE * SIDE} numbers or images ({SIDE}, {SIDE}, 1)")
        self.input_shape = shape if isinstance(shape, tuple) else (shape,)

    def shaped(self, images: npt.ArrayLike) -> npt.NDArray[np.float32]:
        """Return images (n, 28, 28) in the shape that the network takes; raises ValueError for others."""
        array = np.asarray(images, np.float32)
        if array.shape[-2:] != (SIDE, SIDE) or array.ndim not in (2, 3):
            raise ValueError(f"images are (n, {SIDE}, {SIDE}), not {array.shape}")
        return array.reshape(-1, *self.input_shape)

    def predict(self, images: npt.ArrayLike) -> npt.NDArray[np.float32]:
        """Return the probability of each digit, (n, 10), for images (n, 28, 28) or a single one (28, 28)."""
        shaped = self.shaped(images)
        if not len(shaped):
            return np.empty((0, DIGITS), np.float32)
        parts = [self.network.predict(shaped[first : first + _BATCH]) for first in range(0, len(shaped), _BATCH)]
        return self.probabilities(np.concatenate(parts))

    def probabilities(self, outputs: npt.NDArray[np.floating[Any]]) -> npt.NDArray[np.float32]:
        """Return the network's outputs as probabilities, (n, 10).

        Outputs trained by squared error estimate probabilities already (Bishop 1995, section 6.1), but nothing
        keeps them between 0 and 1 nor their sum at 1.
        """
        if self.network.cost.logits:
            return np.asarray(softmax(outputs), np.float32)
        bounded = np.clip(outputs, 0, 1) + 1e-3
        return np.asarray(bounded / bounded.sum(axis=-1, keepdims=True), np.float32)

    def save(self, folder: str | Path, **described: Any) -> None:
        """Write the classifier, whole or not at all, with anything else that JSON can say of it.

        Raises what `NeuralNetwork.save` raises.
        """
        with atomic_folder(folder, KIND) as temporary:
            self.write(temporary, **described)

    def write(self, folder: Path, **described: Any) -> None:
        """Write the classifier's files into a new folder; `save` does so safely."""
        self.network.save(folder / NETWORK)
        said = {"format": FORMAT, "version": VERSION, "inputs": "0 to 1, ink bright", **described}
        text = json.dumps(said, indent=2, allow_nan=False)
        (folder / DIGITS_FILE).write_text(text + "\n", encoding="utf-8")

    @classmethod
    def load(cls, folder: str | Path) -> DigitClassifier:
        """Read what `save` wrote; raises ModelFormatError, which names what is wrong."""
        folder = Path(folder)
        recover_folder(folder)
        with reading(folder, DIGITS_FILE):
            check_header(read_json(inside(folder, DIGITS_FILE)), FORMAT, VERSION)
        with reading(folder, NETWORK):
            classifier = cls(NeuralNetwork.load(inside(folder, NETWORK)))
            if classifier.predict(np.zeros((1, SIDE, SIDE))).shape != (1, DIGITS):
                raise ValueError(f"the network has not {DIGITS} outputs")
        return classifier
