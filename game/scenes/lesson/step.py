"""One learning step of the agent, with the names of all that it moves, and what it pulled."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Final, NamedTuple

import numpy as np

from ai.explain.inspection import Link, links
from ai.explain.learning_step import Step
from ai.nn import ActivationLayer, Array, DuelingLayer, FullyConnectedLayer, LayerNormalisation, NeuralNetwork
from game.core import texts

_SUM, _NORMALISED = "sum", "normalised"
# What optimizers remember of the slopes so far, by its name in `Optimizer.remembers`.
_RUNNING: Final = ("gradient_sum", "velocity")


class Weight(NamedTuple):
    """A weight: the link it belongs to, from 0, the units at its two ends, and its place in flat vectors."""

    link: int
    start: int
    end: int
    place: int


@dataclass(frozen=True, eq=False)
class LearningStep:
    """One step of an optimizer on a batch of examples, around one of them, and the names of all that it moves.

    Attributes:
        network: a network with the parameters from before the step.
        taken: the step as it was recorded.
        observation: (inputs,) that the network was given.
        inputs, outputs: names of the network's ends.
        scale: size of one point of reward in the unit of the network's outputs.
        examples: number of examples in the batch.

    """

    network: NeuralNetwork
    taken: Step
    observation: Array
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    scale: float
    examples: int

    @cached_property
    def stages(self) -> list[list[tuple[str, Array]]]:
        """For each link, the name and the values (units,) of each layer from it up to the next link."""
        found: list[list[tuple[str, Array]]] = []
        for layer, values in zip(self.network.layers, self.taken.activations, strict=True):
            if isinstance(layer, FullyConnectedLayer):
                found.append([(_SUM, values)])
            elif isinstance(layer, LayerNormalisation) and found:
                found[-1].append((_NORMALISED, values))
            elif isinstance(layer, ActivationLayer) and found:
                found[-1].append((str(layer.activation.name), values))
        return found

    def given(self, link: int) -> Array:
        """Return what a link is given: what the layers below make of the observation, (units,)."""
        return self.stages[link - 1][-1][1] if link else np.asarray(self.observation, float)

    @cached_property
    def weights(self) -> list[Link]:
        """The weights before the step, as the links between the network's stages."""
        twin = self.network.copy()
        twin.values = self.taken.values_before
        return [Link(link.weights.copy(), link.bias.copy(), link.gradient) for link in links(twin)]

    def steepest(self) -> Weight | None:
        """Return the weight with the steepest slope; none of a dueling layer, which mixes several."""
        found, first, link = list[Weight](), 0, 0
        for layer in self.network.layers:
            if isinstance(layer, FullyConnectedLayer):
                inputs, outputs = layer.shapes["weights"]
                slopes = np.abs(np.nan_to_num(self.taken.gradient[first : first + inputs * outputs]))
                at = int(slopes.argmax())
                if not isinstance(layer, DuelingLayer):
                    found.append(Weight(link, at // outputs, at % outputs, first + at))
                link += 1
            first += sum(parameter.value.size for parameter in layer.parameters)
        return max(found, key=lambda weight: abs(float(self.taken.gradient[weight.place])), default=None)

    def unit_name(self, column: int, unit: int) -> str:
        """Return the name of a unit of a column, by its number in the layer."""
        names = self.inputs if column == 0 else self.outputs if column == len(self.weights) else ()
        return names[unit] if unit < len(names) else texts.NETWORK_VIEW_UNIT.format(layer=column, unit=unit + 1)

    def weight_name(self, weight: Weight) -> str:
        """Return the names of the units that a weight connects."""
        start, end = self.unit_name(weight.link, weight.start), self.unit_name(weight.link + 1, weight.end)
        return texts.LESSON_WEIGHT_NAME.format(start=start, end=end)

    @property
    def _carried(self) -> str | None:
        """What the optimizer carries on of earlier slopes, by its name; None if it carries on nothing."""
        return next((name for name in _RUNNING if name in self.taken.optimizer_after), None)

    @cached_property
    def pace(self) -> Array:
        """Step for each unit of the slopes that the optimizer goes by, parameter by parameter: 0 where nothing moves.

        Those slopes are the running sum that it carries on, or this gradient alone.
        """
        kept = self._carried
        running = (self.taken.optimizer_after[kept] if kept else self.taken.gradient).astype(float)
        pace: Array = np.divide(self.taken.taken, running, out=np.zeros(len(running)), where=running != 0)
        return pace


class Pulls(NamedTuple):
    """Change of one output in a step, by its causes, in the unit of the network.

    The step of each of our optimizers is a pace times a sum of gradients, parameter by parameter, and the gradient of a
    batch is the sum of its examples' shares. So each part of the sum has its part of the step, and the slope of the
    output says how far that part alone would move it along a straight line.

    Attributes:
        own: by the gradient of its own example.
        others: by the gradients of the other examples in the batch.
        earlier: by what the optimizer still carries of the steps before.
        bend: the rest, since a network is no straight line.

    """

    own: float
    others: float
    earlier: float
    bend: float

    @classmethod
    def of(cls, step: LearningStep, derivative: float, moved: float) -> Pulls:
        """Return the pulls that moved an output by `moved`, by which the cost has that `derivative`.

        The share of the example in the gradient is that derivative times the slope of the output; without an error
        there is none, and all of it is bend.
        """
        taken = step.taken
        gradient, share, whole = (each.astype(float) for each in (taken.gradient, taken.share, taken.taken))
        clipped = float(np.linalg.norm(gradient)) / taken.gradient_length if taken.gradient_length > 0 else 1.0
        own, together = step.pace * share * clipped, step.pace * gradient
        pulls = [-float(share @ part) / (derivative or 1.0) for part in (own, together - own, whole - together)]
        own, others, earlier = pulls
        return cls(own, others, earlier, moved - sum(pulls))
