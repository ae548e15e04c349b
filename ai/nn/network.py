"""Neural network: a list of layers, the cost to minimise, and one flat vector of all parameters."""

from collections.abc import Iterator, Sequence
from copy import deepcopy
from pathlib import Path
from typing import Any, Literal, Self, TypeVar

import numpy as np
import numpy.typing as npt

from ai.nn.costs import Cost, CostFunction
from ai.nn.layer import Layer, check_next
from ai.nn.layers import ActivationLayer, DropoutLayer
from ai.nn.optimizers import SGD, Optimizer
from ai.nn.parameter import Array, Parameter
from ai.nn.storage import read_network, save_network

N = TypeVar("N", bound="NeuralNetwork")
IMAGES = 250  # predicted at a time: each takes some 100 KB on its way


class NeuralNetwork:
    """Feedforward network: layers in a row, trained by gradient descent.

    `function` and `derivative` are a cost: `NeuralNetwork(*CostFunctions.use_mse())`, or a plain pair of your
    own, both of (prediction, target). First weights come from `rng`, by default one seeded with 0: the same
    program makes the same network. Float32 is fast; float64 is for checking gradients.
    """

    def __init__(
        self,
        function: Cost | CostFunction,
        derivative: CostFunction | None = None,
        *,
        rng: np.random.Generator | None = None,
        dtype: npt.DTypeLike = np.float32,
    ) -> None:
        self.cost = Cost.of(function, derivative)
        self.layers: list[Layer] = []
        self.rng = rng or np.random.default_rng(0)
        self.dtype = np.dtype(dtype)
        if self.dtype not in (np.float32, np.float64):
            raise ValueError(f"a network computes with float32 or float64, floating-point numbers, not {self.dtype}")
        self._takes: tuple[int, ...] = ()  # shape of an example; none as long as any will do
        self._take(())

    def add_layer(self, *layers: Layer) -> Self:
        """Append a layer, or several in a row.

        Raises ValueError, and appends none, if one does not fit the one before, belongs to a network already, or makes
        this one too large.
        """
        for place, layer in enumerate(layers):
            check_next([*self.layers, *layers[:place]], layer)
            if layer.in_network or layer in layers[:place]:
                kind = type(layer).__name__
                raise ValueError(f"this {kind} belongs to a network already; make another, or copy that one")
        for layer in layers:
            self._take([layer])
            if isinstance(layer, ActivationLayer):
                for before in self.layers:
                    before.suit(layer.activation.initialise)
        return self

    def _take(self, layers: Sequence[Layer]) -> None:
        """Append layers that fit, and move all parameters into one flat vector."""
        for layer in layers:
            layer.in_network, layer.dtype, layer.rng = True, self.dtype, layer.rng or self.rng.spawn(1)[0]
            if not self._takes and layer.inputs is not None:
                self._takes = layer.inputs if isinstance(layer.inputs, tuple) else (layer.inputs,)
        self.layers += layers
        parameters = [parameter for layer in self.layers for parameter in layer.parameters]
        self._values = np.concatenate([np.zeros(0), *(value.ravel() for _, value, _ in parameters)], dtype=self.dtype)
        self._gradients = np.zeros_like(self._values)
        start = 0
        for layer in self.layers:
            views = []
            for name, value, _ in layer.parameters:
                parts = (flat[start : start + value.size] for flat in (self._values, self._gradients))
                views.append(Parameter(name, *(part.reshape(value.shape) for part in parts)))
                start += value.size
            layer.parameters = tuple(views)

    @property
    def values(self) -> Array:
        """All parameters in one flat vector; the layers' arrays are views of it, so writing changes them."""
        return self._values

    @values.setter
    def values(self, values: npt.ArrayLike) -> None:
        values = np.asarray(values)
        if values.shape != self._values.shape or values.dtype.kind not in "fiub":
            given = f"{values.dtype} of shape {values.shape}"
            raise ValueError(f"the network has {self._values.size:,} real parameters, in one row, not {given}")
        self._values[...] = values

    @property
    def gradients(self) -> Array:
        """The gradients that the last backward pass left, in the order of `values`."""
        return self._gradients

    def predict(self, input_data: npt.ArrayLike) -> Array:
        """Return the output for a batch (batch, inputs), or one example (inputs,), as a new array.

        Inputs of a network for images are (batch, height, width, channels), or without the batch as well.
        Leaves no trace: a backward pass may still follow the last `forward_propagate`.
        """
        data = self._input(input_data)
        if data.ndim == 2 and len(data) == 1:  # as a vector: in two thirds of the time
            return self._through(data[0])[None]
        if data.ndim == 3:
            one: Array = self._through(data[None])[0]
            return one
        if data.ndim == 4 and len(data) > IMAGES:
            return np.concatenate([self._through(part) for part in np.split(data, range(IMAGES, len(data), IMAGES))])
        return self._through(data)

    def _through(self, data: Array) -> Array:
        for layer in self.layers:
            data = layer.predict(data)
        return data

    def _input(self, given: npt.ArrayLike) -> Array:
        """Return what a network is given, in its own kind of numbers; raises ValueError for what it cannot take."""
        array = np.asarray(given)
        if array.dtype != self.dtype:
            if array.dtype.kind not in "fiub":
                raise ValueError(f"a network takes numbers, not {array.dtype} of shape {array.shape}")
            array = array.astype(self.dtype)
        if array.shape[1:] != self._takes and array.shape != self._takes and self._takes:
            raise ValueError(f"the network takes {self._takes}, or a batch of such, not {array.shape}")
        return array

    def activations(self, input_data: npt.ArrayLike) -> list[Array]:
        """Return what each layer gives for a batch; the last is what `predict` returns."""
        data: Array = np.asarray(input_data, self.dtype)
        return [data := layer.predict(data) for layer in self.layers]

    def input_gradient(self, input_data: npt.ArrayLike, output_error: npt.ArrayLike) -> Array:
        """Return the derivative of Σ output_error · output by every number of a batch, as a new array of its shape.

        With a one-hot error it says which pixels speak for that answer (Simonyan et al. 2014). Nothing is
        dropped and `gradients` stay as they are, but what the last forward pass left for the way back is overwritten.
        """
        layers = [layer for layer in self.layers if not isinstance(layer, DropoutLayer)]
        gradients = self.gradients.copy()
        data: Array = np.asarray(input_data, self.dtype)
        for layer in layers:
            data = layer.forward_propagate(data)
        error: Array = np.asarray(output_error, self.dtype)
        for layer in reversed(layers):
            error = layer.input_error(error)
        self.gradients[...] = gradients
        return np.array(error)

    def forward_propagate(self, input_data: npt.ArrayLike) -> Array:
        """Return the output for a batch, and let every layer keep what the way back needs.

        The next call overwrites the array.
        """
        data = self._input(input_data)
        for layer in self.layers:
            data = layer.forward_propagate(data)
        return data

    def backward_propagate(self, output_error: Array) -> None:
        """Fill `gradients`, given the cost's derivative by the output of the last forward pass."""
        error: Array = np.asarray(output_error, self.dtype)
        for layer in self.layers[:0:-1]:
            error = layer.backward_propagate(error)
        self.layers[0].fill_gradients(error)

    def train(
        self,
        x: npt.ArrayLike,
        y: npt.ArrayLike,
        epochs: int = 1,
        batch_size: int = 500,
        learning_rate: float = 0.2,
        *,
        sampling: Literal["sequential", "random"] = "sequential",
        optimizer: Optimizer | None = None,
        rng: np.random.Generator | None = None,
    ) -> list[float]:
        """Fit outputs to targets `y` (examples, outputs) on inputs `x` (examples, inputs).

        "sequential" takes the examples in order, "random" in an order that `rng` (by default one seeded with
        0) draws anew each epoch. Without an `optimizer`, plain gradient descent at `learning_rate`; with one,
        its own rate holds. Returns the mean cost of each epoch, batches counted as they were met. Raises
        DivergenceError as soon as a number is no longer finite, most often because the rate is too high.
        """
        examples, targets = np.asarray(x, self.dtype), np.asarray(y, self.dtype)
        if len(examples) != len(targets) or not len(examples):
            raise ValueError(f"{len(examples)} inputs need as many targets, at least one; not {len(targets)}")
        for name, numbers in (("input", examples), ("target", targets)):
            if not np.isfinite(numbers).all():
                row, *place = np.argwhere(~np.isfinite(numbers))[0].tolist()
                raise ValueError(f"{name} {row} is {numbers[row, *place]} at place {place}, and no finite number")
        optimizer = optimizer or SGD(learning_rate)
        rng = rng or np.random.default_rng(0)
        history = []
        for _ in range(epochs):
            total = 0.0
            for batch in _batches(len(examples), batch_size, sampling, rng):
                total += self.train_batch(examples[batch], targets[batch], optimizer) * len(targets[batch])
            history.append(total / len(examples))
        return history

    def train_batch(self, x: npt.ArrayLike, y: npt.ArrayLike, optimizer: Optimizer) -> float:
        """Take one step on one batch, and return what it cost before the step; raises as `train` does."""
        with np.errstate(over="ignore", invalid="ignore"):  # what overflows is found by the optimizer
            return self.correct(self.forward_propagate(x), y, optimizer)

    def correct(self, prediction: Array, y: npt.ArrayLike, optimizer: Optimizer) -> float:
        """Do the second half of `train_batch`, for `prediction` as the last forward pass returned it."""
        target: Array = np.asarray(y, self.dtype)
        if prediction.shape != target.shape:
            raise ValueError(f"the targets have shape {target.shape}, the predictions {prediction.shape}")
        with np.errstate(over="ignore", invalid="ignore"):
            cost = self.cost(prediction, target)
            self.backward_propagate(self.cost.derivative(prediction, target))
        optimizer.serve(self.values)
        if len(target):
            optimizer.step(self.values, self.gradients, cost)
        return cost

    def copy(self) -> Self:
        """Return an independent network with equal parameters."""
        return deepcopy(self)

    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]:
        """Copy and pickle what `copy` copies: parameters stay views of one flat vector, and buffers are left out."""
        layers = [(type(layer), layer.arguments()) for layer in self.layers]
        return _restored, (type(self), self.cost, layers, self.dtype, self.values.copy())

    def save(self, folder: str | Path) -> None:
        """Write the network to a folder, whole or not at all (docs/adr/0004-models-are-folders.md).

        Raises ValueError if it has functions without a name or parameters that are not finite,
        FileExistsError if the folder holds something else, OSError if it cannot be written.
        """
        save_network(folder, self.cost, self.layers, self.dtype)

    @classmethod
    def load(cls, folder: str | Path) -> Self:
        """Read a network from its folder; raises ModelFormatError, which names what is wrong with it."""
        return _made(cls, *read_network(folder))


def _restored(
    kind: type[N], cost: Cost, layers: list[tuple[type[Layer], dict[str, Any]]], dtype: npt.DTypeLike, values: Array
) -> N:
    """Make a copied or pickled network."""
    network = _made(kind, cost, [layer(**arguments) for layer, arguments in layers], dtype)
    network.values = values
    return network


def _made(kind: type[N], cost: Cost, layers: list[Layer], dtype: npt.DTypeLike) -> N:
    """Make a network of these layers, with parameters as they have them."""
    network = kind(cost, dtype=dtype)
    network._take(layers)
    return network


def _batches(
    examples: int, batch_size: int, sampling: str, rng: np.random.Generator
) -> Iterator[slice | npt.NDArray[np.intp]]:
    """Yield what picks each batch of one epoch; the last may be smaller."""
    if sampling not in ("sequential", "random"):
        raise ValueError(f"sampling is 'sequential' or 'random', not {sampling!r}")
    if batch_size < 1:
        raise ValueError(f"batch_size is at least 1, not {batch_size}")
    order = rng.permutation(examples) if sampling == "random" else None
    for start in range(0, examples, batch_size):
        batch = slice(start, start + batch_size)
        yield batch if order is None else order[batch]
