"""Layers on vectors: fully connected, dueling, activation, normalisation, dropout."""

from functools import cached_property, lru_cache
from typing import Any

import numpy as np

from ai.nn.activations import Activation, Function
from ai.nn.layer import NO_ARRAY, Layer, checked_size, fitting
from ai.nn.parameter import Array, glorot_uniform


class FullyConnectedLayer(Layer):
    """Each output is a weighted sum of all inputs, plus a bias: y = x W + b.

    `scale` multiplies the first weights: a small one keeps first outputs near zero.
    """

    settings: tuple[str, ...] = ("inputs", "outputs")
    output = error = NO_ARRAY  # written into again at each pass

    def __init__(self, inputs: int, outputs: int, *, scale: float = 1.0) -> None:
        self.inputs = checked_size("inputs", inputs)
        self.outputs = checked_size("outputs", outputs)
        self.shapes = {"weights": (self.inputs, self.outputs), "bias": (self.outputs,)}
        self.scale = scale

    @property
    def weights(self) -> Array:
        return self.parameters[0].value

    @property
    def bias(self) -> Array:
        return self.parameters[1].value

    def forward_propagate(self, input_data: Array) -> Array:
        """Return x W + b, (batch, outputs)."""
        weights, bias = self.parameters
        self.input = np.asarray(input_data, self.dtype)
        self.output = fitting(self.output, (len(input_data), bias.value.size), self.dtype)
        self.input.dot(weights.value, self.output)
        self.output += bias.value
        return self.output

    def predict(self, input_data: Array) -> Array:
        weights, bias = self.parameters
        output: Array = input_data.dot(weights.value)
        output += bias.value
        return output

    def fill_gradients(self, output_error: Array) -> None:
        """Set the gradients of weights, xᵀ E, and bias, Σ E over the batch."""
        weights, bias = self.parameters
        self.input.T.dot(output_error, weights.gradient)
        constant(len(output_error), 1.0, self.dtype).dot(output_error, bias.gradient)

    def input_error(self, output_error: Array) -> Array:
        """Return E Wᵀ, (batch, inputs)."""
        self.error = fitting(self.error, self.input.shape, self.dtype)
        output_error.dot(self.weights.T, self.error)
        return self.error

    def initial_value(self, name: str) -> Array:
        if name == "bias":
            return np.zeros(self.shapes[name])
        draw = self.initialise or glorot_uniform
        return self.scale * draw(self.rng or np.random.default_rng(0), *self.shapes[name])


class DuelingLayer(FullyConnectedLayer):
    """A fully connected layer in which Q-values share one estimate of the state: Q = V + A - mean A.

    Wang et al. 2016, eq. 9, with both streams linear. The weights' first column makes the value V, the others
    the advantages A. With n outputs, Q = [V A]·M, and M is `mixture`: a row of ones above the unit matrix less 1/n. So
    the error E of Q is E·Mᵀ for the streams.
    """

    def __init__(self, inputs: int, outputs: int, *, scale: float = 1.0) -> None:
        super().__init__(inputs, outputs, scale=scale)
        self.shapes = {"weights": (inputs, outputs + 1), "bias": (outputs + 1,)}

    @cached_property
    def mixture(self) -> Array:
        """Matrix that makes Q-values of the streams, (1 + outputs, outputs)."""
        count = self.shapes["bias"][0] - 1
        return np.vstack([np.ones(count), np.eye(count) - 1 / count]).astype(self.dtype)

    def forward_propagate(self, input_data: Array) -> Array:
        """Return Q, (batch, outputs)."""
        q: Array = super().forward_propagate(input_data).dot(self.mixture)
        return q

    def predict(self, input_data: Array) -> Array:
        q: Array = super().predict(input_data).dot(self.mixture)
        return q

    def fill_gradients(self, output_error: Array) -> None:
        super().fill_gradients(output_error.dot(self.mixture.T))

    def input_error(self, output_error: Array) -> Array:
        return super().input_error(output_error.dot(self.mixture.T))


class ActivationLayer(Layer):
    """An elementwise function: `ActivationLayer(*ActivationFunctions.use_tanh())`, or a pair of your own.

    A plain pair (function, derivative), both of the input, works too, but cannot be saved.
    """

    settings = ("activation",)
    output = error = NO_ARRAY

    def __init__(self, activation: Activation | Function, derivative: Function | None = None) -> None:
        self.activation = Activation.of(activation, derivative)

    def forward_propagate(self, input_data: Array) -> Array:
        self.input = input_data
        self.output = fitting(self.output, input_data.shape, input_data.dtype)
        return self.activation.function(input_data, out=self.output)

    def predict(self, input_data: Array) -> Array:
        return self.activation.function(input_data)

    def input_error(self, output_error: Array) -> Array:
        """Return f'(x) · E."""
        self.error = fitting(self.error, self.output.shape, self.output.dtype)
        self.activation.slope(self.input, self.output, self.error)
        self.error *= output_error
        return self.error


class LayerNormalisation(Layer):
    """Each example to mean 0 and variance 1 over its values, then a learned gain and bias (Ba et al. 2016).

    With means over the values of an example, E the output error, and ε the `epsilon`:

        centred = x - mean x                        D      = E · stretch
        inverse = 1 / √(mean centred² + ε)          gain'  = Σ E · centred · inverse   over the batch
        stretch = inverse · gain                    bias'  = Σ E
        y       = centred · stretch + bias          x'     = D - mean D - centred · inverse² · mean(centred · D)

    Means are products with a constant vector, because BLAS sums rows several times faster than `mean` does.
    Likewise `stretch` is made by an outer product, and then one plain product of two arrays does for two that would
    have to repeat a row or a column.
    """

    settings = ("size", "epsilon")
    buffers = output = NO_ARRAY

    def __init__(self, size: int, *, epsilon: float = 1e-5) -> None:
        if not 0 < epsilon < 1:
            raise ValueError(f"epsilon is a small positive number, not {epsilon}")
        self.size = self.inputs = self.outputs = checked_size("size", size)
        self.shapes = {"gain": (size,), "bias": (size,)}
        self.epsilon = epsilon

    def forward_propagate(self, input_data: Array) -> Array:
        gain, bias = self.parameters
        # Five arrays in one: there is one look whether they fit the batch.
        self.buffers = fitting(self.buffers, (5, *input_data.shape), self.dtype)
        self.output, self.centred, self.stretch, self.error, self.scratch = self.buffers
        self.inverse = self._centre(np.asarray(input_data, self.dtype), self.centred)
        self.inverse.dot(gain.value[None], self.stretch)
        np.multiply(self.centred, self.stretch, out=self.output)
        self.output += bias.value
        return self.output

    def predict(self, input_data: Array) -> Array:
        gain, bias = self.parameters
        if input_data.ndim == 1:  # with plain numbers in place of columns of one: in a third of the time
            centred: Array = input_data - input_data.dot(self._average)
            centred *= gain.value * (1 / np.sqrt(centred.dot(centred) / self.size + self.epsilon))
            centred += bias.value
            return centred
        output = np.empty_like(input_data)
        output *= self._centre(input_data, output).dot(gain.value[None])
        output += bias.value
        return output

    def fill_gradients(self, output_error: Array) -> None:
        """Set the gradients of gain, Σ E · centred · inverse, and bias, Σ E over the batch."""
        gain, bias = self.parameters
        self.inverse.T.dot(np.multiply(self.centred, output_error, out=self.scratch), gain.gradient[None])
        constant(len(output_error), 1.0, self.dtype).dot(output_error, bias.gradient)

    def input_error(self, output_error: Array) -> Array:
        """Return D - mean D - centred · inverse² · mean(centred · D), with D = E · stretch."""
        error: Array = np.multiply(output_error, self.stretch, out=self.error)
        along = np.vecdot(self.centred, error)[:, None]
        along *= self.inverse**2 / self.size
        error -= error.dot(self._average)[:, None]
        error -= np.multiply(self.centred, along, out=self.scratch)
        return error

    def _centre(self, input_data: Array, out: Array) -> Array:
        """Fill `out` with the input at mean 0, and return the inverse of its standard deviation, (..., 1)."""
        np.subtract(input_data, input_data.dot(self._average)[..., None], out=out)
        variance = np.vecdot(out, out)[..., None]
        variance /= self.size
        variance += self.epsilon
        inverse: Array = np.divide(1, np.sqrt(variance, out=variance), out=variance)
        return inverse

    @property
    def _average(self) -> Array:
        return constant(self.size, 1 / self.size, self.dtype)

    def initial_value(self, name: str) -> Array:
        return (np.ones if name == "gain" else np.zeros)(self.shapes[name])


class DropoutLayer(Layer):
    """Sets each value to 0 with probability `rate` while training, and divides the others by 1 - rate.

    After Srivastava et al. 2014, inverted: sums keep their mean, so that `predict` has nothing to do. What is
    dropped comes from a generator of the network's, so the same program drops the same. Raises ValueError for
    a rate outside 0 ≤ rate < 1.
    """

    settings = ("rate",)
    output = error = factors = NO_ARRAY

    def __init__(self, rate: float = 0.5) -> None:
        if isinstance(rate, bool) or not isinstance(rate, int | float) or not 0 <= rate < 1:
            raise ValueError(f"the rate of dropout is at least 0 and less than 1, not {rate!r}")
        self.rate = rate

    def forward_propagate(self, input_data: Array) -> Array:
        """Return what is not dropped, enlarged, and 0 elsewhere."""
        self.rng = self.rng or np.random.default_rng(0)
        # Drawn in the order that images have in memory; for small arrays the order does not matter.
        drawn = self.rng.random(input_data.shape[::-1], np.float32).T
        self.factors = fitting(self.factors, input_data.shape, input_data.dtype)
        self.output = fitting(self.output, input_data.shape, input_data.dtype)
        np.multiply(drawn >= self.rate, 1 / (1 - self.rate), out=self.factors, casting="same_kind")
        np.multiply(input_data, self.factors, out=self.output)
        return self.output

    def predict(self, input_data: Array) -> Array:
        return input_data

    def input_error(self, output_error: Array) -> Array:
        self.error = fitting(self.error, self.factors.shape, self.factors.dtype)
        np.multiply(output_error, self.factors, out=self.error)
        return self.error


@lru_cache(maxsize=64)
def constant(size: int, value: float, dtype: Any) -> Array:
    """Return a vector of one number, to sum rows with: it is kept, and cannot be written to."""
    vector: Array = np.full(size, value, dtype)
    vector.setflags(write=False)
    return vector
