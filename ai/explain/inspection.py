"""Inspection of a network: activations of each stage, and weights between the stages."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ai.nn import Array, DuelingLayer, FullyConnectedLayer, Layer, NeuralNetwork


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


def _links(layer: Layer) -> bool:
    """Return whether a layer links units with units: a convolution links images."""
    return isinstance(layer, FullyConnectedLayer) and not isinstance(layer.inputs, tuple)
