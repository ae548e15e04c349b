"""Activation functions, and their derivatives by hand."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import Self

import numpy as np
import numpy.typing as npt

from ai.nn.parameter import Array, Initialise, glorot_uniform, he_normal

Function = Callable[[Array], Array]


@dataclass(frozen=True)
class Activation:
    """An elementwise function with its derivative.

    `function(x)` returns f(x) as a new array, `function(x, out=...)` in the one given, which is not `x` itself.
    `slope(x, y, out)` fills `out` with f'(x), given also y = f(x): most slopes come cheaper from the output, as
    1 - y² does for tanh.

    Unpacks as the pair (function, derivative) of which the first is the activation itself: it can be called,
    and takes its name and options along to `config.json`.
    """

    function: Callable[..., Array]
    slope: Callable[[Array, Array, Array], object]
    name: str | None = None
    options: Mapping[str, float] = field(default_factory=dict, hash=False)
    initialise: Initialise = glorot_uniform  # draws weights that suit this activation

    @classmethod
    def of(cls, function: Function, derivative: Function | None = None) -> Self:
        """Return `function` if it is an activation, or make one of a plain pair, which then has no name."""
        if isinstance(function, cls):
            return function
        if derivative is None:
            raise TypeError("an activation is a function and its derivative; the derivative is missing")

        def with_out(x: Array, out: Array | None = None) -> Array:
            return np.positive(function(x), out=out)

        return cls(with_out, lambda x, _y, out: np.copyto(out, derivative(x)))

    def __call__(self, x: npt.ArrayLike) -> Array:
        """Return f of each element, as a new array."""
        return self.function(_floating(x))

    def derivative(self, x: npt.ArrayLike) -> Array:
        """Return f' of each element, as a new array."""
        x = _floating(x)
        slope = np.empty_like(x)
        self.slope(x, self(x), slope)
        return slope

    def __iter__(self) -> Iterator[Function]:
        yield self
        yield self.derivative


class ActivationFunctions:
    """The activations that can be saved by name; each `use_` method returns one."""

    @staticmethod
    def use_tanh() -> Activation:
        """Hyperbolic tangent: outputs in -1..1."""
        return Activation(np.tanh, _tanh_slope, "tanh")

    @staticmethod
    def use_sigmoid() -> Activation:
        """Logistic function 1 / (1 + e⁻ˣ): outputs in 0..1."""
        return Activation(_sigmoid, _sigmoid_slope, "sigmoid")

    @staticmethod
    def use_relu() -> Activation:
        """Rectified linear unit max(0, x) (Nair & Hinton 2010); its derivative at 0 counts as 0."""
        return Activation(_relu, _relu_slope, "relu", initialise=he_normal)

    @staticmethod
    def use_leaky_relu(slope: float = 0.01) -> Activation:
        """Leaky rectifier max(slope·x, x) (Maas et al. 2013), for 0 < slope < 1."""
        if not 0 < slope < 1:
            raise ValueError(f"the slope of a leaky ReLU lies between 0 and 1, not {slope}")
        return Activation(
            partial(_leaky_relu, slope), partial(_leaky_slope, slope), "leaky_relu", {"slope": slope}, he_normal
        )


ACTIVATIONS: dict[str, Callable[..., Activation]] = {
    "tanh": ActivationFunctions.use_tanh,
    "sigmoid": ActivationFunctions.use_sigmoid,
    "relu": ActivationFunctions.use_relu,
    "leaky_relu": ActivationFunctions.use_leaky_relu,
}


def _floating(x: npt.ArrayLike) -> Array:
    x = np.asarray(x)
    return x if np.issubdtype(x.dtype, np.floating) else x.astype(np.float64)


def _tanh_slope(_x: Array, y: Array, out: Array) -> None:
    """Fill `out` with 1 - y²."""
    np.multiply(y, y, out=out)
    np.subtract(1, out, out=out)


def _sigmoid(x: Array, out: Array | None = None) -> Array:
    # (1 + tanh(x/2)) / 2 is the same function, and cannot overflow.
    y: Array = np.tanh(x * 0.5, out=out)
    y += 1
    y *= 0.5
    return y


def _sigmoid_slope(_x: Array, y: Array, out: Array) -> None:
    """Fill `out` with y · (1 - y)."""
    np.subtract(1, y, out=out)
    out *= y


def _relu(x: Array, out: Array | None = None) -> Array:
    # NumPy compares two arrays three times faster than an array and a number.
    y = np.empty_like(x) if out is None else out
    y.fill(0)
    return np.maximum(x, y, out=y)


def _relu_slope(_x: Array, y: Array, out: Array) -> None:
    np.greater(y, 0, out=out)


def _leaky_relu(slope: float, x: Array, out: Array | None = None) -> Array:
    y: Array = np.maximum(x, slope * x, out=out)
    return y


def _leaky_slope(slope: float, x: Array, _y: Array, out: Array) -> None:
    np.greater(x, 0, out=out)
    out *= 1 - slope  # two passes, and still faster than one that compares an array and a number
    out += slope
