"""Parameters of layers: named arrays, each with its gradient, and their initialisation."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.floating[Any]]
Initialise = Callable[[np.random.Generator, int, int], Array]  # draws weights (inputs, outputs)


class Parameter:
    """One learned array, and the gradient of the cost with respect to it, of the same shape and dtype.

    Assigning to either writes into the array that is there, since a network has it in its flat vector.
    """

    def __init__(self, name: str, value: Array) -> None:
        self.name = name
        self._value, self._gradient = value, np.zeros_like(value)

    @property
    def value(self) -> Array:
        """What is learned."""
        return self._value

    @value.setter
    def value(self, value: npt.ArrayLike) -> None:
        self._value[...] = self._fitting(value)

    @property
    def gradient(self) -> Array:
        """What the last backward pass left."""
        return self._gradient

    @gradient.setter
    def gradient(self, gradient: npt.ArrayLike) -> None:
        self._gradient[...] = self._fitting(gradient)

    def _fitting(self, given: npt.ArrayLike) -> npt.NDArray[Any]:
        array = np.asarray(given)
        if array.shape != self._value.shape or array.dtype.kind not in "fiub":
            raise ValueError(f"{self.name} are numbers of shape {self._value.shape}, not {array.dtype} {array.shape}")
        return array

    def move(self, value: Array, gradient: Array) -> None:
        """Write both into other arrays of this shape, and keep them there from now on."""
        value[...], gradient[...] = self._value, self._gradient
        self._value, self._gradient = value, gradient


def pack(parameters: Sequence[Parameter], dtype: npt.DTypeLike) -> tuple[Array, Array]:
    """Move the parameters into two flat vectors, values and gradients, of which they become views."""
    size = sum(parameter.value.size for parameter in parameters)
    values, gradients = np.zeros(size, dtype), np.zeros(size, dtype)
    start = 0
    for parameter in parameters:
        shape, part = parameter.value.shape, slice(start, start + parameter.value.size)
        parameter.move(values[part].reshape(shape), gradients[part].reshape(shape))
        start = part.stop
    return values, gradients


def glorot_uniform(rng: np.random.Generator, inputs: int, outputs: int) -> Array:
    """Draw (inputs, outputs) weights from U(-b, b), b = 1/√(inputs + outputs).

    After Glorot & Bengio 2010, with their scaling but a bound of 1 where they have √6: smaller first outputs,
    which keeps tanh in its straight part.
    """
    bound = 1.0 / np.sqrt(inputs + outputs)
    return rng.uniform(-bound, bound, (inputs, outputs))


def he_normal(rng: np.random.Generator, inputs: int, outputs: int) -> Array:
    """Draw (inputs, outputs) weights from N(0, 2/inputs), for rectifiers (He et al. 2015, eq. 10)."""
    return rng.normal(0.0, np.sqrt(2.0 / inputs), (inputs, outputs))
