"""What a layer is: inputs to outputs on the forward pass, and output errors to input errors on the backward pass.

An *error* is the derivative of the cost with respect to what it stands for: one number per element.
"""

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from copy import copy, deepcopy
from functools import cached_property
from typing import Any, Final, TypeVar

import numpy as np
import numpy.typing as npt

from ai.nn.parameter import Array, Initialise, Parameter

T = TypeVar("T", bound=np.generic)
ImageShape = tuple[int, int, int]  # height, width, channels
NO_ARRAY: Final[Array] = np.empty(0, np.float32)


class Layer(ABC):
    """One step of a network, on arrays of shape (batch, values), or images (batch, height, width, channels).

    A layer of your own has `forward_propagate`, `backward_propagate` and `predict`; if it learns, `shapes` and
    `initial_value`; if it is to be saved and copied, `settings` and `ai.nn.register_layer`.
    """

    @abstractmethod
    def forward_propagate(self, input_data: Array) -> Array:
        """Return the output, and remember what the way back needs; `input_data` is to stay as it is until then.

        The output lasts until the next call, which may write into the same array.
        """

    def backward_propagate(self, output_error: Array) -> Array:
        """Fill the parameters' gradients and return the input error, both of the last forward pass.

        The input error lasts until the next call. A layer that can do one without the other has these two halves.
        """
        self.fill_gradients(output_error)
        return self.input_error(output_error)

    def fill_gradients(self, output_error: Array) -> None:
        """Fill the gradients: all that is asked of the lowest layer."""
        if self.shapes:
            self.backward_propagate(output_error)

    def input_error(self, output_error: Array) -> Array:
        """Return the input error: all that is asked on the way to the input."""
        return self.backward_propagate(output_error)

    @abstractmethod
    def predict(self, input_data: Array) -> Array:
        """Return the output as a new array, or the input where there is nothing to compute; remember nothing.

        It also takes one vector without the batch axis.
        """

    # What it learns

    shapes: Mapping[str, tuple[int, ...]] = {}  # of the parameters, by name
    initialise: Initialise | None = None  # how weights are drawn: as suits the first activation that follows, if any

    @cached_property
    def parameters(self) -> tuple[Parameter, ...]:
        """Learned parameters; in a network, views of its flat vectors."""
        values = zip(self.shapes, self.first_values(), strict=True)
        return tuple(Parameter(name, value, np.zeros_like(value)) for name, value in values)

    def initial_value(self, name: str) -> Array:
        """Return the first value of a parameter, of the shape that `shapes` names; draw it from `rng`."""
        raise NotImplementedError(f"{type(self).__name__} does not say how {name} begins")

    def first_values(self) -> list[Array]:
        """Return the first values of all parameters, the same at each call."""
        drawing = copy(self)
        drawing.rng = deepcopy(self.rng)
        return [np.array(drawing.initial_value(name), self.dtype) for name in self.shapes]

    def suit(self, initialise: Initialise) -> None:
        """Begin as suits the first activation that follows: what is drawn, and nobody has written to, is drawn anew."""
        if self.initialise is None:
            drawn, self.initialise = self.first_values(), initialise
            for parameter, before, value in zip(self.parameters, drawn, self.first_values(), strict=True):
                if np.array_equal(parameter.value, before):
                    parameter.value[...] = value

    # Its place in a network

    in_network = False  # a network's parameters lie in its own flat vectors, so a layer is part of one alone
    rng: np.random.Generator | None = None  # of the layer alone; the network gives it one
    dtype: Any = np.float32  # the network's
    settings: tuple[str, ...] = ()  # arguments of the constructor that are stored with the layer
    inputs: int | ImageShape | None = None  # of an example; None: of any shape, and as many come out
    outputs: int | ImageShape | None = None

    def arguments(self) -> dict[str, Any]:
        """Return what the constructor needs to make such a layer again."""
        return {name: getattr(self, name) for name in self.settings}


def fitting(array: npt.NDArray[T], shape: tuple[int, ...], dtype: npt.DTypeLike) -> npt.NDArray[T]:
    """Return an array to write into: the one of the last call if shape and dtype fit, else a new one of zeros.

    Images are in Fortran order, as in `ai.nn.images`.
    """
    if array.shape == shape and array.dtype == dtype:
        return array
    return np.zeros(shape, dtype, "F" if len(shape) == 4 else "C")


# A small file must not be able to ask for more than a machine has.
MOST_VALUES: Final = 1 << 18  # of an example, before and after any layer
MOST_LAYERS: Final = 500
MOST_WORK: Final = 1_000_000_000  # multiplications for one example
MOST_PARAMETERS: Final = 12_000_000  # of an agent: with gradients and an optimizer, that takes 430 MB to load


def check_next(before: Sequence[Layer], layer: Layer) -> None:
    """Raise ValueError if a layer does not take what those before it give, or makes the network too large."""
    given = next((one.outputs for one in reversed(before) if one.outputs is not None), None)
    if None not in (given, layer.inputs) and given != layer.inputs:
        raise ValueError(f"{type(layer).__name__} takes {_said(layer.inputs)}, the layer before gives {_said(given)}")
    layers = *before, layer
    parameters = [sum(map(math.prod, one.shapes.values())) for one in layers]
    if len(layers) > MOST_LAYERS or sum(parameters) > MOST_PARAMETERS:
        raise ValueError(f"a network has at most {MOST_LAYERS} layers and {MOST_PARAMETERS:,} parameters")
    # A convolution uses each of its parameters in every window.
    windows = [math.prod(one.outputs[:2]) if isinstance(one.outputs, tuple) else 1 for one in layers]
    if sum(count * places for count, places in zip(parameters, windows, strict=True)) > MOST_WORK:
        raise ValueError(f"a network takes at most {MOST_WORK:,} multiplications for an example")


def _said(shape: int | ImageShape | None) -> str:
    return "images of {} x {} x {}".format(*shape) if isinstance(shape, tuple) else f"{shape} values"


def checked_size(name: str, size: int) -> int:
    """Return a size as a plain int; raises ValueError if it is none."""
    if isinstance(size, bool) or not isinstance(size, int | np.integer) or not 1 <= size <= MOST_VALUES:
        raise ValueError(f"{name} is a whole number from 1 to {MOST_VALUES}, not {size!r}")
    return int(size)


def checked_shape(name: str, shape: ImageShape) -> ImageShape:
    """Return (height, width, channels) of plain numbers; raises ValueError if it is none, or of too many values."""
    if not isinstance(shape, tuple | list) or len(shape) != 3:
        raise ValueError(f"{name} is (height, width, channels), not {shape!r}")
    height, width, channels = map(checked_size, ("height", "width", "channels"), shape)
    checked_size("height · width · channels", height * width * channels)
    return height, width, channels
