"""Parameters of layers: named arrays, each with its gradient, and their initialisation."""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.floating[Any]]
Initialise = Callable[[np.random.Generator, int, int], Array]  # draws weights (inputs, outputs)


class Parameter(NamedTuple):
    """One learned array, and the gradient of the cost with respect to it, of the same shape and dtype.

    In a network both are views of its flat vectors: write into them, as in `value[...] = 0`.
    """

    name: str
    value: Array
    gradient: Array


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
