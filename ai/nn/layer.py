"""What a layer is: inputs to outputs on the forward pass, and output errors to input errors on the backward pass.

An *error* is the derivative of the cost with respect to what it stands for: one number per element.
"""

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ai.nn.parameter import Array, Initialise, Parameter

if TYPE_CHECKING:
    from ai.nn.network import NeuralNetwork

ImageShape = tuple[int, int, int]  # height, width, channels

# Limits of networks: a small file must not be able to ask for more than a machine has.
MAX_SIZE = 1 << 20  # of any one size
MOST_LAYERS = 500
MOST_PARAMETERS = 12_000_000  # an agent of so many, two networks with gradients and an optimizer, takes 430 MB to load
WIDEST = 1 << 18  # values that a layer may make of one example
MOST_WORK = 1_000_000_000  # multiplications for one example


class Layer(ABC):
    """One step of a network, on arrays of shape (batch, values), or images (batch, height, width, channels).

    A custom layer has `forward_propagate`, `predict`, and `backward_propagate` or both its halves, `fill_gradients` and
    `input_error`; if it learns, `shapes` and `initial_value`; if it is to be saved and copied, `settings` and
    `ai.nn.register_layer`.

    What `forward_propagate` and `backward_propagate` return lasts until their next call: they may write into
    arrays that are kept while the batch size stays the same. `predict` returns a new array, or its input where
    there is nothing to compute, and also takes one vector without the batch axis.
    """

    settings: tuple[str, ...] = ()  # arguments of the constructor that are stored with the layer
    inputs: int | ImageShape | None = None  # of an example; None: of any shape, and as many come out
    outputs: int | ImageShape | None = None
    shapes: Mapping[str, tuple[int, ...]] = {}  # of the parameters
    initialise: Initialise | None = None  # how weights are drawn: as suits the activation that follows, if any does
    rng: np.random.Generator | None = None
    dtype: npt.DTypeLike = np.float32
    network: "NeuralNetwork | None" = None  # that it is part of
    output: Array  # of the last forward pass, and the input error of the last way back, in layers that keep them
    error: Array

    @cached_property
    def parameters(self) -> tuple[Parameter, ...]:
        """Learned parameters; in a network, views of its flat vector from the first time that they are asked for."""
        drawn = self.drawn
        self.gather()
        return drawn

    @cached_property
    def drawn(self) -> tuple[Parameter, ...]:
        """The same, drawn when first asked for, when network and neighbours are known, and not gathered into a vector.

        Another layer that joins the network makes another vector; `parameters` are the way to those in use.
        """
        values = {name: np.asarray(self.initial_value(name), self.dtype) for name in self.shapes}
        for name, value in values.items():
            if value.shape != tuple(self.shapes[name]):
                raise ValueError(f"{name} begins with shape {value.shape}, and is said to have {self.shapes[name]}")
        return tuple(Parameter(name, value, np.zeros_like(value)) for name, value in values.items())

    def initial_value(self, name: str) -> Array:
        """Return the first value of a parameter, of the shape that `shapes` names; draw it from `rng`."""
        raise NotImplementedError(f"{type(self).__name__} does not say how {name} begins")

    def gather(self) -> None:
        """Let the network that this is part of, if any, make one flat vector of all its parameters."""
        if self.network is not None:
            _ = self.network.values

    def join(self, network: "NeuralNetwork") -> None:
        """Become a part of one network; the layer gets a generator of its own.

        Raises ValueError if it is part of one already: a network's parameters lie in its own flat vector.
        """
        if self.network is not None:
            raise ValueError(f"this {type(self).__name__} belongs to a network already; make another, or copy that one")
        self.network, self.rng, self.dtype = network, self.rng or network.rng.spawn(1)[0], network.dtype
        for parameter in vars(self).get("drawn", ()):  # before, perhaps in another precision
            parameter.value = parameter.value.astype(self.dtype)
            parameter.gradient = parameter.gradient.astype(self.dtype)

    def arguments(self) -> dict[str, Any]:
        """Return what the constructor needs to make such a layer again."""
        return {name: getattr(self, name) for name in self.settings}

    def kept(self, name: str, shape: tuple[int, ...], dtype: npt.DTypeLike) -> npt.NDArray[Any]:
        """Return the attribute `name`, an array that begins as zeros, made anew where shape or dtype are others.

        Images are in Fortran order, as in `ai.nn.images`.
        """
        array: npt.NDArray[Any] | None = self.__dict__.get(name)
        if array is None or array.shape != shape or array.dtype != dtype:
            array = self.__dict__[name] = np.zeros(shape, dtype, "F" if len(shape) == 4 else "C")
        return array

    @abstractmethod
    def forward_propagate(self, input_data: Array) -> Array:
        """Return the output and keep what the way back needs; `input_data` is to stay as it is until then."""

    @abstractmethod
    def predict(self, input_data: Array) -> Array:
        """Return the output and keep nothing."""

    def backward_propagate(self, output_error: Array) -> Array:
        """Fill the parameters' gradients and return the input error, both of the last forward pass."""
        self.fill_gradients(output_error)
        return self.input_error(output_error)

    def fill_gradients(self, output_error: Array) -> None:
        """Fill the gradients alone: all that is asked of the lowest layer."""
        if self.shapes:
            self.backward_propagate(output_error)

    def input_error(self, output_error: Array) -> Array:
        """Return the input error alone, and leave the gradients as they are."""
        before = [parameter.gradient.copy() for parameter in self.parameters]
        error = self.backward_propagate(output_error)
        for parameter, gradient in zip(self.parameters, before, strict=True):
            parameter.gradient[...] = gradient
        return error


def check_next(before: Sequence[Layer], layer: Layer) -> None:
    """Raise ValueError if a layer does not take what those before it give, or makes the network too large."""
    given = next((one.outputs for one in reversed(before) if one.outputs is not None), None)
    if None not in (given, layer.inputs) and given != layer.inputs:
        raise ValueError(f"{type(layer).__name__} takes {_said(layer.inputs)}, the layer before gives {_said(given)}")
    layers = [*before, layer]
    width = math.prod(layer.outputs) if isinstance(layer.outputs, tuple) else layer.outputs or 0
    parameters = [sum(map(math.prod, one.shapes.values())) for one in layers]
    # A convolution uses each of its parameters in every window.
    windows = [math.prod(one.outputs[:2]) if isinstance(one.outputs, tuple) else 1 for one in layers]
    work = sum(count * places for count, places in zip(parameters, windows, strict=True))
    for count, most, words in (
        (len(layers), MOST_LAYERS, "a network has at most {:,} layers, not {}"),
        (width, WIDEST, "a layer makes at most {:,} values of an example, not {}"),
        (sum(parameters), MOST_PARAMETERS, "a network has at most {:,} parameters, not {}"),
        (work, MOST_WORK, "a network takes at most {:,} multiplications for an example, not {}"),
    ):
        if count > most:
            raise ValueError(words.format(most, count))


def _said(shape: int | ImageShape | None) -> str:
    return "images of {} x {} x {}".format(*shape) if isinstance(shape, tuple) else f"{shape} values"


def checked_size(name: str, size: int) -> int:
    """Return a size as a plain int; raises ValueError if it is none."""
    if isinstance(size, bool) or not isinstance(size, int | np.integer) or not 1 <= size <= MAX_SIZE:
        raise ValueError(f"{name} is a whole number from 1 to {MAX_SIZE}, not {size!r}")
    return int(size)
