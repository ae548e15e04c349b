"""Activation functions, and their derivatives by hand."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Self

import numpy as np

from ai.nn.parameter import Array

Function = Callable[[Array], Array]


@dataclass(frozen=True)
class Activation:
    """An elementwise function with its derivative, written as two kernels that fill an array they are given.

    `write(input, out)` fills `out` with f(input), and may be asked to do so in place;
    `write_slope(input, output, out)` fills it with f'(input). Most slopes come cheaper from the output: that
    of tanh is 1 - y².

    Unpacks as the pair (function, derivative) of which the first is the activation itself: it can be called,
    and takes its name and options along to `config.json`.
    """

    write: Callable[[Array, Array], object]
    write_slope: Callable[[Array, Array, Array], object]
    name: str | None = None
    options: Mapping[str, float] = field(default_factory=lambda: MappingProxyType({}), hash=False)
    initialisation: str = "glorot"  # how weights that feed this activation had better start

    @classmethod
    def of(cls, function: Function, derivative: Function | None = None) -> Self:
        """Return `function` if it is an activation, or make one of a plain pair, which then has no name."""
        if isinstance(function, cls):
            return function
        if derivative is None:
            raise TypeError("an activation is a function and its derivative; the derivative is missing")
        return cls(
            write=lambda x, out: np.copyto(out, function(x)),
            write_slope=lambda x, _output, out: np.copyto(out, derivative(x)),
        )

    def function(self, input_data: Array) -> Array:
        """Return f of each element, as a new array."""
        output = np.empty_like(input_data)
        self.write(input_data, output)
        return output

    __call__ = function

    def derivative(self, input_data: Array) -> Array:
        """Return f' of each element, as a new array."""
        slope = np.empty_like(input_data)
        self.write_slope(input_data, self.function(input_data), slope)
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
        return Activation(
            write=lambda x, out: np.maximum(x, 0, out=out),
            write_slope=lambda _input, y, out: np.greater(y, 0, out=out),
            name="relu",
            initialisation="he",
        )

    @staticmethod
    def use_leaky_relu(slope: float = 0.01) -> Activation:
        """Leaky rectifier max(slope·x, x) (Maas et al. 2013), for 0 < slope < 1."""
        if not 0 < slope < 1:
            raise ValueError(f"the slope of a leaky ReLU lies between 0 and 1, not {slope}")
        return Activation(
            write=lambda x, out: np.maximum(x, slope * x, out=out),
            write_slope=lambda x, _output, out: np.maximum(np.greater(x, 0, out=out), slope, out=out),
            name="leaky_relu",
            options=MappingProxyType({"slope": slope}),
            initialisation="he",
        )


ACTIVATIONS: dict[str, Callable[..., Activation]] = {
    "tanh": ActivationFunctions.use_tanh,
    "sigmoid": ActivationFunctions.use_sigmoid,
    "relu": ActivationFunctions.use_relu,
    "leaky_relu": ActivationFunctions.use_leaky_relu,
}


def _tanh_slope(_input: Array, output: Array, out: Array) -> None:
    np.multiply(output, output, out=out)
    np.subtract(1, out, out=out)


def _sigmoid(input_data: Array, out: Array) -> None:
    # (1 + tanh(x/2)) / 2 is the same function, and cannot overflow.
    np.multiply(input_data, 0.5, out=out)
    np.tanh(out, out=out)
    out += 1
    out *= 0.5


def _sigmoid_slope(_input: Array, output: Array, out: Array) -> None:
    np.subtract(1, output, out=out)
    out *= output
