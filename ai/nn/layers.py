"""Layers: each maps inputs to outputs on the forward pass, and output errors to input errors on the backward pass.

An *error* is the derivative of the cost with respect to what it stands for: one number per element.
"""

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from functools import cached_property, lru_cache, partial
from typing import Any

import numpy as np
import numpy.typing as npt

from ai.nn.activations import Activation, Function
from ai.nn.parameter import INITIALISATIONS, Array, Parameter

ImageShape = tuple[int, int, int]  # height, width, channels

# A small file must not be able to ask for more than a machine has. An agent of so many parameters, two networks with
# gradients and an optimizer, takes 430 MB to load.
MAX_SIZE = 1 << 20  # of any one size
MOST_LAYERS = 500
MOST_PARAMETERS = 12_000_000
WIDEST = 1 << 18  # values that a layer may make of one example
MOST_WORK = 1_000_000_000  # multiplications for one example


class Layer(ABC):
    """One step of a network, on arrays of shape (batch, values), or images (batch, height, width, channels).

    A custom layer has `forward_propagate`, `backward_propagate` and `predict`; if it learns, `shapes` and
    `initial_value`; if it is to be saved and copied, `settings` and `ai.nn.register_layer`.

    What `forward_propagate` and `backward_propagate` return lasts until their next call: they may write into
    arrays that are kept while the batch size stays the same. `predict` returns a new array, or its input where
    there is nothing to compute, and also takes one example without the batch axis.
    """

    settings: tuple[str, ...] = ()  # arguments of the constructor that are stored with the layer
    inputs: int | ImageShape | None = None  # of an example; None: of any shape, and as many come out
    outputs: int | ImageShape | None = None
    shapes: Mapping[str, tuple[int, ...]] = {}  # of the parameters
    initialisation: str | None = "constant"  # None: as suits the activation that follows
    rng: np.random.Generator | None = None
    dtype: npt.DTypeLike = np.float32
    joined = False  # whether it belongs to a network
    output: Array  # of the last forward pass, and the input error of the last way back, in layers that keep them
    error: Array

    @cached_property
    def parameters(self) -> tuple[Parameter, ...]:
        """Learned parameters, drawn when first asked for: by then the layer's network and neighbours are known."""
        values = {name: np.asarray(self.initial_value(name), self.dtype) for name in self.shapes}
        for name, value in values.items():
            if value.shape != tuple(self.shapes[name]):
                raise ValueError(f"{name} begins with shape {value.shape}, and is said to have {self.shapes[name]}")
        return tuple(Parameter(name, value, np.zeros_like(value)) for name, value in values.items())

    def initial_value(self, name: str) -> Array:
        """Return the first value of a parameter, of the shape that `shapes` tells; draw it from `rng`."""
        raise NotImplementedError(f"{type(self).__name__} does not say how {name} begins")

    def join(self, rng: np.random.Generator, dtype: npt.DTypeLike) -> None:
        """Become a part of one network, which computes in `dtype`; a layer without an `rng` gets one of the network's.

        Raises ValueError if it is part of one already: a network's parameters lie in its own flat vector.
        """
        if self.joined:
            raise ValueError(f"this {type(self).__name__} belongs to a network already; make another, or copy that one")
        self.joined, self.rng, self.dtype = True, self.rng or rng.spawn(1)[0], np.dtype(dtype)
        if "parameters" in vars(self):  # drawn before, perhaps in another precision
            self.parameters = tuple(
                Parameter(each.name, each.value.astype(dtype), each.gradient.astype(dtype)) for each in self.parameters
            )

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

    def row_step(self, memory: Array, values: Array, output: Array) -> Callable[[], object]:  # noqa: ARG002
        """Return a function that predicts the one example in `memory` into `output`, whenever it is called.

        `memory` is (inputs + 1,): the example, and a 1 for a bias; `output` is (outputs,). `values` are the layer's
        parameters, flat.
        """
        example = memory[:-1]  # NumPy handles a vector up to three times faster than a batch of one
        return lambda: np.copyto(output, self.predict(example))

    @abstractmethod
    def backward_propagate(self, output_error: Array) -> Array:
        """Fill the parameters' gradients and return the input error, both of the last forward pass."""

    def fill_gradients(self, output_error: Array) -> None:
        """Fill the gradients alone: all that is asked of the lowest layer."""
        self.backward_propagate(output_error)

    def input_error(self, output_error: Array) -> Array:
        """Return the input error, and leave the gradients as they are."""
        before = [parameter.gradient.copy() for parameter in self.parameters]
        error = self.backward_propagate(output_error)
        for parameter, gradient in zip(self.parameters, before, strict=True):
            parameter.gradient[...] = gradient
        return error


class HalvedLayer(Layer):
    """Layer whose backward pass has two separate halves, gradients and input error, so that either can be skipped."""

    def backward_propagate(self, output_error: Array) -> Array:
        """Fill the parameters' gradients and return the input error, both of the last forward pass."""
        self.fill_gradients(output_error)
        return self.input_error(output_error)

    def fill_gradients(self, output_error: Array) -> None:
        """Fill the gradients alone: nothing, where there are no parameters."""

    @abstractmethod
    def input_error(self, output_error: Array) -> Array:
        """Return the input error alone."""


class FullyConnectedLayer(HalvedLayer):
    """Each output is a weighted sum of all inputs, plus a bias: y = x W + b.

    `initialisation` is "glorot" or "he"; by default it suits the activation that follows in the network.
    `scale` multiplies the first weights: a small one keeps first outputs near zero. The weights come from
    `rng`, or else from the network's.
    """

    settings: tuple[str, ...] = ("inputs", "outputs")

    def __init__(
        self,
        inputs: int,
        outputs: int,
        *,
        initialisation: str | None = None,
        scale: float = 1.0,
        rng: np.random.Generator | None = None,
        dtype: npt.DTypeLike = np.float32,
    ) -> None:
        if initialisation not in (None, *INITIALISATIONS):
            raise ValueError(f"initialisation is one of {', '.join(INITIALISATIONS)}, not {initialisation!r}")
        self.inputs = checked_size("inputs", inputs)
        self.outputs = checked_size("outputs", outputs)
        self.shapes = {"weights": (self.inputs, self.outputs), "bias": (self.outputs,)}
        self.initialisation = initialisation
        self.scale = scale
        self.rng = rng.spawn(1)[0] if rng else None  # its own: the weights are drawn later
        self.dtype = dtype

    @property
    def weights(self) -> Array:
        """Weights, (inputs, outputs)."""
        return self.parameters[0].value

    @property
    def bias(self) -> Array:
        """Biases, (outputs,)."""
        return self.parameters[1].value

    def forward_propagate(self, input_data: Array) -> Array:
        """Return x W + b, (batch, outputs)."""
        weights, bias = self.parameters
        self.input = np.asarray(input_data, self.dtype)
        output = self.kept("output", (len(input_data), bias.value.size), self.dtype)
        self.input.dot(weights.value, output)
        output += bias.value
        return output

    def predict(self, input_data: Array) -> Array:
        """Return x W + b as a new array, (batch, outputs) or (outputs,)."""
        weights, bias = self.parameters
        output: Array = input_data.dot(weights.value)
        output += bias.value
        return output

    def row_step(self, memory: Array, values: Array, output: Array) -> Callable[[], object]:
        """Return the step x W + b of one example, as the one product [x 1] [W; b]: a sum apart takes a fifth longer."""
        return partial(memory.dot, values.reshape(-1, output.size), output)

    def fill_gradients(self, output_error: Array) -> None:
        """Set the gradients of weights, xᵀ E, and bias, Σ E over the batch."""
        weights, bias = self.parameters
        self.input.T.dot(output_error, weights.gradient)
        ones(len(output_error), self.dtype).dot(output_error, bias.gradient)

    def input_error(self, output_error: Array) -> Array:
        """Return E Wᵀ, (batch, inputs)."""
        error: Array = output_error.dot(self.parameters[0].value.T, self.kept("error", self.input.shape, self.dtype))
        return error

    def initial_value(self, name: str) -> Array:
        """Return zeros for the bias, and weights drawn as `initialisation` says."""
        if name == "bias":
            return np.zeros(self.shapes[name])
        draw = INITIALISATIONS[self.initialisation or "glorot"]
        return self.scale * draw(self.rng or np.random.default_rng(0), *self.shapes[name])


class DuelingLayer(FullyConnectedLayer):
    """A fully connected layer in which Q-values share one estimate of the state: Q = V + A - mean A.

    Wang et al. 2016, eq. 9, with both streams linear. The weights' first column makes the value V, the others
    the advantages A. With n outputs, Q = [V A]·M, and M is `mixture`: a row of ones above the unit matrix less 1/n. So
    the error E of Q is E·Mᵀ for the streams.
    """

    def __init__(self, inputs: int, outputs: int, **options: Any) -> None:
        super().__init__(inputs, outputs, **options)
        self.shapes = {"weights": (inputs, outputs + 1), "bias": (outputs + 1,)}

    @property
    def mixture(self) -> Array:
        """Matrix that makes Q-values of the streams, (1 + outputs, outputs)."""
        return _mixture(self.shapes["bias"][0] - 1, np.dtype(self.dtype))

    def forward_propagate(self, input_data: Array) -> Array:
        """Return Q, (batch, outputs)."""
        q: Array = super().forward_propagate(input_data).dot(self.mixture)
        return q

    def predict(self, input_data: Array) -> Array:
        """Return Q as a new array, (batch, outputs) or (outputs,)."""
        q: Array = super().predict(input_data).dot(self.mixture)
        return q

    def row_step(self, memory: Array, values: Array, output: Array) -> Callable[[], object]:
        """Return the step that fills in Q of one example."""
        streams, mixture = np.empty(self.shapes["bias"], output.dtype), self.mixture
        fill_streams = super().row_step(memory, values, streams)

        def step() -> None:
            fill_streams()
            streams.dot(mixture, output)

        return step

    def fill_gradients(self, output_error: Array) -> None:
        """Set the gradients of both streams' weights and biases."""
        super().fill_gradients(output_error.dot(self.mixture.T))

    def input_error(self, output_error: Array) -> Array:
        """Return the sum of what both streams send back, (batch, inputs)."""
        return super().input_error(output_error.dot(self.mixture.T))


class ActivationLayer(HalvedLayer):
    """An elementwise function: `ActivationLayer(*ActivationFunctions.use_tanh())`, or a pair of your own.

    A plain pair (function, derivative), both of the input, works too, but cannot be saved.
    """

    settings = ("activation",)

    def __init__(self, activation: Activation | Function, derivative: Function | None = None) -> None:
        self.activation = Activation.of(activation, derivative)

    def forward_propagate(self, input_data: Array) -> Array:
        """Return f(x), of the shape of x."""
        self.input = input_data
        self.output = self.kept("output", input_data.shape, input_data.dtype)
        return self.activation.function(input_data, out=self.output)

    def predict(self, input_data: Array) -> Array:
        """Return f(x) as a new array."""
        return self.activation.function(input_data)

    def row_step(self, memory: Array, values: Array, output: Array) -> Callable[[], object]:  # noqa: ARG002
        """Return the step that fills in f(x) of one example."""
        return partial(self.activation.function, memory[:-1], output)

    def input_error(self, output_error: Array) -> Array:
        """Return f'(x) · E."""
        error = self.kept("error", self.output.shape, self.output.dtype)
        self.activation.slope(self.input, self.output, error)
        error *= output_error
        return error


class LayerNormalisation(HalvedLayer):
    """Each example to mean 0 and variance 1 over its values, then a learned gain and bias (Ba et al. 2016).

    y = gain · n + bias, with n = (x - mean x) / deviation and deviation = √(variance + epsilon). `centred` is
    x - mean x and `stretch` is gain / deviation, so y = centred · stretch + bias.

    Means are products with a constant vector, because BLAS sums rows several times faster than `mean` does.
    Likewise gain / deviation is made by an outer product, and then one plain product of two arrays does for two
    that would have to repeat a row or a column.
    """

    settings = ("size", "epsilon")

    def __init__(self, size: int, *, epsilon: float = 1e-5, dtype: npt.DTypeLike = np.float32) -> None:
        if not 0 < epsilon < 1:
            raise ValueError(f"epsilon is a small positive number, not {epsilon}")
        self.size = self.inputs = self.outputs = checked_size("size", size)
        self.shapes = {"gain": (size,), "bias": (size,)}
        self.epsilon = epsilon
        self.dtype = dtype

    def forward_propagate(self, input_data: Array) -> Array:
        """Return the normalised batch, (batch, size)."""
        gain, bias = self.parameters
        self.output, self.centred, self.stretch, self.error, self.scratch = self.kept(
            "buffers", (5, *input_data.shape), self.dtype
        )
        self.inverse_deviation = self._centre(np.asarray(input_data, self.dtype), self.centred)
        self.inverse_deviation.dot(gain.value[None], self.stretch)
        np.multiply(self.centred, self.stretch, out=self.output)
        self.output += bias.value
        return self.output

    def predict(self, input_data: Array) -> Array:
        """Return the normalised batch as a new array."""
        gain, bias = self.parameters
        output = np.empty_like(input_data)
        output *= self._centre(input_data, output).dot(gain.value[None])
        output += bias.value
        return output

    def row_step(self, memory: Array, values: Array, output: Array) -> Callable[[], object]:
        """Return the step that normalises one example: `predict`, with plain numbers in place of columns of one."""
        example, average = memory[:-1], self._average
        gain, bias = values.reshape(2, self.size)

        def step() -> None:
            centred = example - example.dot(average)
            inverse_deviation = 1 / np.sqrt(centred.dot(centred) / self.size + self.epsilon)
            np.multiply(centred, inverse_deviation * gain, out=output)
            np.add(output, bias, out=output)

        return step

    def fill_gradients(self, output_error: Array) -> None:
        """Set the gradients of gain, Σ n E, and bias, Σ E over the batch, with n the normalised input."""
        gain, bias = self.parameters
        self.inverse_deviation.T.dot(np.multiply(self.centred, output_error, out=self.scratch), gain.gradient[None])
        ones(len(output_error), self.dtype).dot(output_error, bias.gradient)

    def input_error(self, output_error: Array) -> Array:
        """Return D - mean D - n · mean(n D), with D = gain · E / deviation and means over the values.

        n is centred / deviation and occurs twice, hence the square in `along`.
        """
        error: Array = np.multiply(output_error, self.stretch, out=self.error)
        along = np.vecdot(self.centred, error)[:, None]
        along *= self.inverse_deviation**2 / self.size
        error -= error.dot(self._average)[:, None]
        error -= np.multiply(self.centred, along, out=self.scratch)
        return error

    def _centre(self, input_data: Array, out: Array) -> Array:
        """Fill `out` with the input at mean 0, and return the inverse of its standard deviation, (..., 1)."""
        np.subtract(input_data, input_data.dot(self._average)[..., None], out=out)
        variance = np.vecdot(out, out)[..., None]
        variance /= self.size
        variance += self.epsilon
        inverse_deviation: Array = np.divide(1, np.sqrt(variance, out=variance), out=variance)
        return inverse_deviation

    @property
    def _average(self) -> Array:
        return _constant(self.size, 1 / self.size, np.dtype(self.dtype))

    def initial_value(self, name: str) -> Array:
        """Return gains of 1 and biases of 0."""
        return (np.ones if name == "gain" else np.zeros)(self.shapes[name])


def check_next(before: Sequence[Layer], layer: Layer) -> None:
    """Raise ValueError if a layer does not take what those before it give, or makes the network too large."""
    given = next((one.outputs for one in reversed(before) if one.outputs is not None), None)
    if None not in (given, layer.inputs) and given != layer.inputs:
        kind = type(layer).__name__
        raise ValueError(f"{kind} takes {_said(layer.inputs)}, the layer before gives {_said(given)}")
    layers = [*before, layer]
    width = math.prod(layer.outputs) if isinstance(layer.outputs, tuple) else layer.outputs or 0
    parameters = [sum(map(math.prod, one.shapes.values())) for one in layers]
    # A convolution uses each of its parameters in every window.
    windows = [math.prod(one.outputs[:2]) if isinstance(one.outputs, tuple) else 1 for one in layers]
    work = sum(count * places for count, places in zip(parameters, windows, strict=True))
    if len(layers) > MOST_LAYERS:
        raise ValueError(f"a network has at most {MOST_LAYERS} layers")
    if width > WIDEST:
        raise ValueError(f"a layer makes at most {WIDEST:,} values of an example, not {width}")
    if sum(parameters) > MOST_PARAMETERS:
        raise ValueError(f"a network has at most {MOST_PARAMETERS:,} parameters, not {sum(parameters)}")
    if work > MOST_WORK:
        raise ValueError(f"a network takes at most {MOST_WORK:,} multiplications for an example, not {work}")


def _said(shape: int | ImageShape | None) -> str:
    return "images of {} x {} x {}".format(*shape) if isinstance(shape, tuple) else f"{shape} values"


def checked_size(name: str, size: int) -> int:
    """Return a size as a plain int; raises ValueError if it is none."""
    if isinstance(size, bool) or not isinstance(size, int | np.integer) or not 1 <= size <= MAX_SIZE:
        raise ValueError(f"{name} is a whole number from 1 to {MAX_SIZE}, not {size!r}")
    return int(size)


def ones(size: int, dtype: npt.DTypeLike) -> Array:
    """Return a vector of ones, to sum rows with: it is kept, and cannot be written to."""
    return _constant(size, 1.0, np.dtype(dtype))


@lru_cache(maxsize=64)
def _constant(size: int, value: float, dtype: np.dtype[Any]) -> Array:
    vector: Array = np.full(size, value, dtype)
    vector.setflags(write=False)
    return vector


@lru_cache(maxsize=64)
def _mixture(outputs: int, dtype: np.dtype[Any]) -> Array:
    identity = np.eye(outputs)
    mixture: Array = np.vstack([np.ones(outputs), identity - 1 / outputs]).astype(dtype)
    mixture.setflags(write=False)
    return mixture
