"""Parameters of layers: named arrays, each with its gradient, and their initialisation."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.floating[Any]]
Initialise = Callable[[np.random.Generator, int, int], Array]  # draws weights (inputs, outputs)


@dataclass(slots=True)
class Parameter:
    """One learned array and the gradient of the cost with respect to it, of the same shape and dtype."""

    name: str
    value: Array
    gradient: Array


def pack(parameters: Iterable[Parameter], dtype: npt.DTypeLike) -> tuple[Array, Array]:
    """Move the parameters into two flat vectors, values and gradients, of which they become views."""
    parameters = list(parameters)
    size = sum(parameter.value.size for parameter in parameters)
    values, gradients = np.zeros(size, dtype), np.zeros(size, dtype)
    start = 0
    for parameter in parameters:
        part = slice(start, start + parameter.value.size)
        values[part] = parameter.value.ravel()
        gradients[part] = parameter.gradient.ravel()
        parameter.value = values[part].reshape(parameter.value.shape)
        parameter.gradient = gradients[part].reshape(parameter.value.shape)
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
