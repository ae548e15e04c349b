"""Prediction of one example at a time, as in flight: all arrays are at hand, and little is left but arithmetic."""

from collections.abc import Callable, Sequence
from typing import Final

import numpy as np

from ai.nn.layer import Layer
from ai.nn.parameter import Array


class SingleExample:
    """What the `predict` of layers in a row does for one example, in half the time.

    Each layer writes into memory that the next one reads; there a 1 stands behind the values, for a bias to be
    multiplied by. `values` are the parameters of all layers, flat.

    Attributes:
        shape: of what it takes, (1, inputs); None for layers that take images, which it does not serve.

    """

    def __init__(self, layers: Sequence[Layer], values: Array) -> None:
        self.shape: tuple[int, int] | None = None
        sizes = [size for layer in layers for size in (layer.inputs, layer.outputs) if isinstance(size, int)]
        if not sizes or any(isinstance(layer.inputs, tuple) for layer in layers):
            return
        self.shape = (1, sizes[0])
        memory = np.ones(sizes[0] + 1, values.dtype)
        self._example: Final = memory[None, :-1]
        self._steps: Final[list[Callable[[], object]]] = []
        for layer in layers:
            outputs = layer.outputs if isinstance(layer.outputs, int) else len(memory) - 1
            following = np.ones(outputs + 1, values.dtype)
            size = sum(parameter.value.size for parameter in layer.parameters)
            self._steps.append(layer.single_step(memory, values[:size], following[:-1]))
            memory, values = following, values[size:]
        self._answer: Final = memory[None, :-1]

    def predict(self, example: Array) -> Array:
        """Return the output (1, outputs) for an example of `shape`, as a new array."""
        self._example[...] = example
        for step in self._steps:
            step()
        answer: Array = self._answer.copy()
        return answer
