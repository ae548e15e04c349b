"""Filters of a digit network's first layer as images, and how they form while it trains."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from ai.digits.preprocessing import SIDE
from ai.nn import ConvolutionLayer, FullyConnectedLayer, NeuralNetwork

MOST_FILTERS: Final = 32  # as many as there is room for
_SHORTEST: Final = 0.25  # seconds between two moments of a run at first
_SHARE: Final = 1 / 60  # of a run's length, later: a run of a minute has 140 moments, one of an hour 390


@dataclass(frozen=True, eq=False)
class FilterMoment:
    """Filters at one moment of a training run."""

    seconds: float  # spent learning until then
    step: int  # learning steps until then
    images: npt.NDArray[np.float16]  # (n, height, width), as `first_filters` returns them


def first_filters(network: NeuralNetwork) -> npt.NDArray[np.float32]:
    """Return the first learned layer's weights as images (n, height, width), of its first filters or units.

    An empty array of (0, 1, 1) for a network whose first learned layer reads no image.
    """
    first = next((layer for layer in network.layers if layer.parameters), None)
    if isinstance(first, ConvolutionLayer):
        images = first.kernels[:, :, 0].transpose(2, 1, 0)
    elif isinstance(first, FullyConnectedLayer) and first.inputs == SIDE * SIDE:
        images = first.weights.T.reshape(-1, SIDE, SIDE)
    else:
        return np.empty((0, 1, 1), np.float32)
    return np.array(images[:MOST_FILTERS], np.float32)


def next_moment(seconds: float) -> float:
    """Return after how many seconds of learning the next moment is kept, after one at `seconds`."""
    return seconds + max(_SHORTEST, _SHARE * seconds)
