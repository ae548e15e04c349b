"""One learning step of any network, as the frames about networks, gradients and optimizers need it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from ai.explain.inspection import Link, links
from ai.explain.learning_step import Step
from ai.nn import ActivationLayer, Array, DuelingLayer, FullyConnectedLayer, Layer, LayerNormalisation, NeuralNetwork
from ai.nn.layers import DropoutLayer

_SUM, _NORMALISED, _DROPPED = "sum", "normalised", "dropout"
# What optimizers remember of the slopes so far, by its name in `Optimizer.remembers`.
_RUNNING: Final = ("gradient_sum", "velocity")


@dataclass(frozen=True)
class WeightPlace:
    """Place of a weight: the link it belongs to, from 0, and the units at its two ends."""

    link: int
    start: int
    end: int


@dataclass(frozen=True, eq=False)
class LearningStep:
    """One step of an optimizer on a batch of examples, around one of them, and the names of all that it moves.

    Attributes:
        network: a network with the parameters from before the step.
        taken: the step as it was recorded.
        observation: (inputs,) that the network was given.
        inputs, outputs: names of the network's ends.
        scale: size of one shown unit in the unit of the network's outputs: one point of reward, or 1.
        optimizer: name of the optimizer.
        examples: number of examples in the batch.

    """

    network: NeuralNetwork
    taken: Step
    observation: Array
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    scale: float
    optimizer: str
    examples: int

    @cached_property
    def stages(self) -> list[list[tuple[str, Array]]]:
        """Return, for each link, the name and the values (units,) of each layer from it up to the next link."""
        found: list[list[tuple[str, Array]]] = []
        for layer, values in zip(self.network.layers, self.taken.activations, strict=True):
            if _joins_units(layer):
                found.append([(_SUM, values)])
            elif isinstance(layer, LayerNormalisation) and found:
                found[-1].append((_NORMALISED, values))
            elif isinstance(layer, DropoutLayer) and found:
                found[-1].append((_DROPPED, values))
            elif isinstance(layer, ActivationLayer) and found:
                found[-1].append((str(layer.activation.name), values))
        return found

    @cached_property
    def given(self) -> Array:
        """Return the numbers that the first link is given, (units,): the observation, or what the layers below make."""
        given = np.asarray(self.observation).ravel()
        for layer, values in zip(self.network.layers, self.taken.activations, strict=True):
            if _joins_units(layer):
                break
            given = np.asarray(values).ravel()
        return given

    @cached_property
    def _twin(self) -> NeuralNetwork:
        return self.network.copy()

    def links(self, flat: npt.NDArray[Any]) -> list[Link]:
        """Return a flat vector of the parameters as the links between the network's stages; copies."""
        self._twin.values = flat
        return [Link(link.weights.copy(), link.bias.copy(), link.gradient) for link in links(self._twin)]

    @cached_property
    def weights(self) -> list[Link]:
        """The weights before the step."""
        return self.links(self.taken.values_before)

    @cached_property
    def _indices(self) -> list[npt.NDArray[np.intp] | None]:
        """For each link, where its weights lie in a flat vector; None where they are mixed, in a dueling layer."""
        twin = self.network.copy()
        found: list[npt.NDArray[np.intp] | None] = []
        first = 0
        for layer in twin.layers:
            size = sum(parameter.value.size for parameter in layer.parameters)
            if _joins_units(layer):
                shape = layer.shapes["weights"]
                whole = np.arange(first, first + int(np.prod(shape))).reshape(shape)
                found.append(None if isinstance(layer, DuelingLayer) else whole)
            first += size
        return found[-len(self.weights) :]

    def index(self, place: WeightPlace) -> int | None:
        """Return where a weight lies in the flat vectors; None for one of a dueling layer, which mixes several."""
        indices = self._indices[place.link]
        return None if indices is None else int(indices[place.start, place.end])

    def strongest(self, flat: Array, most: int) -> list[WeightPlace]:
        """Return the places of the weights for which a flat vector is largest, the largest first."""
        found = []
        for link, indices in enumerate(self._indices):
            if indices is None:
                continue
            sizes = np.nan_to_num(np.abs(flat[indices]), nan=np.inf)
            best = np.argsort(-sizes, axis=None, kind="stable")[:most]
            places = np.stack(np.unravel_index(best, sizes.shape), axis=1).tolist()
            found += [(float(sizes[start, end]), WeightPlace(link, start, end)) for start, end in places]
        found.sort(key=lambda each: -each[0])
        return [place for _, place in found[:most]]

    @property
    def carries_on(self) -> bool:
        """Whether the optimizer remembers earlier slopes: then a weight may move up its slope."""
        return any(name in self.taken.optimizer_after for name in _RUNNING)

    @property
    def running(self) -> Array:
        """What the step is proportional to, parameter by parameter: the slopes so far, or this gradient alone."""
        kept = self.taken.optimizer_after
        return next((kept[name] for name in _RUNNING if name in kept), self.taken.gradient)

    @cached_property
    def pace(self) -> Array:
        """Step for each unit of `running`, parameter by parameter: 0 where nothing moves."""
        running = self.running.astype(float)
        pace: Array = np.divide(self.taken.taken, running, out=np.zeros(len(running)), where=running != 0)
        return pace


def _joins_units(layer: Layer) -> bool:
    """Whether a layer is one of the links between units: a convolution joins images."""
    return isinstance(layer, FullyConnectedLayer) and not isinstance(layer.inputs, tuple)
