"""Inspection of a network: activations of each stage, weights between the stages, and dead units."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from ai.nn import ActivationLayer, Array, DuelingLayer, FullyConnectedLayer, Layer, NeuralNetwork

_WITNESSES: Final = 64  # observations, to find the silent units by
_LENGTHS: Final = 40  # gradients, to see how many were cut short: ten seconds of a live run
_CUT: Final = 0.999  # of the longest allowed: so long is one that was cut


@dataclass(frozen=True, eq=False)
class Link:
    """Weights, biases and gradient between one stage of units and the next.

    Of a dueling layer, these are the effective weights, from the units before it straight to the Q-values.
    """

    weights: Array  # (inputs, outputs)
    bias: Array  # (outputs,)
    gradient: Array  # (inputs, outputs) of the weights, as the last backward pass left it


def traces(network: NeuralNetwork, observation: npt.ArrayLike) -> list[Array]:
    """Return the values of each stage of units for one observation (inputs,), or for a batch of them.

    First what the lowest fully connected layer is given, then what becomes of each fully connected layer's
    outputs after normalisation and activation; the last is what the network answers. Nothing is kept in the
    network, and numbers that are not finite pass through.
    """
    data: Array = np.asarray(observation, network.dtype)
    with np.errstate(all="ignore"):
        if data.ndim % 2:  # one example
            return [values[0] for values in traces(network, data[None])]
        given = [data, *network.activations(data)]
    return [*(values for layer, values in zip(network.layers, given, strict=False) if _links(layer)), given[-1]]


def links(network: NeuralNetwork) -> list[Link]:
    """Return the link from each of the stages of `traces` to the next; views of the network where possible."""
    network.values  # noqa: B018 - packs the parameters, which makes their gradients views of the flat vector
    found = []
    for layer in network.layers:
        if not _links(layer):
            continue
        weights, bias = layer.parameters
        link = Link(weights.value, bias.value, weights.gradient)
        if isinstance(layer, DuelingLayer):
            with np.errstate(all="ignore"):
                link = Link(*(part @ layer.mixture for part in (link.weights, link.bias, link.gradient)))
        found.append(link)
    return found


def dead_units(network: NeuralNetwork, observations: npt.ArrayLike) -> float:
    """Return the share of rectified units, 0 to 1, that answer none of the observations (n, inputs).

    Such a unit passes no gradient either: unless its inputs change, it never learns again. 0 for a network
    without rectified units, and without observations.
    """
    data: Array = np.atleast_2d(np.asarray(observations, network.dtype))
    units = dead = 0
    with np.errstate(all="ignore"):
        for layer in network.layers if data.size else ():
            data = layer.predict(data)
            if isinstance(layer, ActivationLayer) and layer.activation.name == "relu":
                silent = ~data.reshape(len(data), -1).any(axis=0)
                units += silent.size
                dead += int(silent.sum())
    return dead / units if units else 0.0


class NetworkHealth:
    """Health of a network that learns, sampled now and then: dead units and clipped gradients.

    Attributes:
        dead_share: share of rectified units that answered none of the latest observations; None before there were
            enough of them.

    """

    def __init__(self) -> None:
        self.dead_share: float | None = None
        self._observations: deque[Array] = deque(maxlen=_WITNESSES)
        self._cut: deque[bool] = deque(maxlen=_LENGTHS)

    @property
    def clipped_share(self) -> float | None:
        """Share of the latest gradients that were cut short; None while there are few."""
        return float(np.mean(self._cut)) if len(self._cut) == _LENGTHS else None

    def look(self, network: NeuralNetwork, observation: Array, gradient_clip: float) -> None:
        """Sample a network with the gradients of its latest step, and an observation (inputs,) that it is given."""
        self._cut.append(bool(np.linalg.norm(network.gradients) >= _CUT * gradient_clip))
        self._observations.append(observation)
        if len(self._observations) == _WITNESSES:
            self.dead_share = dead_units(network, np.array(self._observations))
            self._observations.clear()


def _links(layer: Layer) -> bool:
    """Return whether a layer links units with units: a convolution links images."""
    return isinstance(layer, FullyConnectedLayer) and not isinstance(layer.inputs, tuple)
