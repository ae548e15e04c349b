"""Neural network: a list of layers, the cost to minimise, and one flat vector of all parameters."""

from collections.abc import Iterator
from functools import cached_property
from pathlib import Path
from typing import Any, Literal, Self

import numpy as np
import numpy.typing as npt

from ai.nn.costs import Cost, CostFunction
from ai.nn.layer import Layer, check_next
from ai.nn.layers import ActivationLayer, DropoutLayer
from ai.nn.optimizers import SGD, Optimizer
from ai.nn.parameter import Array, pack
from ai.nn.storage import read_network, save_network

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
        self._takes: tuple[int, ...] = ()  # shape of an example; none as long as any will do
        self.rng = rng or np.random.default_rng(0)
        self.dtype = np.dtype(dtype)
        if self.dtype.kind != "f":
            raise ValueError(f"a network computes with floating-point numbers, not {self.dtype}")

    def add_layer(self, layer: Layer) -> Self:
        """Append a layer.

        Raises ValueError if it does not fit the one before, belongs to a network already, or makes this one too large.
        """
        check_next(self.layers, layer)
        layer.join(self)
        if isinstance(layer, ActivationLayer):
            for before in self.layers:
                before.initialise = before.initialise or layer.activation.initialise
        if not self._takes and layer.inputs is not None:
            self._takes = layer.inputs if isinstance(layer.inputs, tuple) else (layer.inputs,)
        self.layers.append(layer)
        self.__dict__.pop("_flat", None)  # made anew when needed
        for each in self.layers:
            each.__dict__.pop("parameters", None)
        return self

    @property
    def values(self) -> Array:
        """All parameters in one flat vector; the layers' arrays are views of it, so writing changes them."""
        return self._flat[0]

    @values.setter
    def values(self, values: Array) -> None:
        values = np.asarray(values)
        if values.shape != self._flat[0].shape:
            raise ValueError(f"the network has {self._flat[0].size:,} parameters, in one row, not {values.shape}")
        self._flat[0][...] = values

    @property
    def gradients(self) -> Array:
        """The gradients that the last backward pass left, in the order of `values`."""
        return self._flat[1]

    @cached_property
    def _flat(self) -> tuple[Array, Array]:
        return pack((parameter for layer in self.layers for parameter in layer.drawn), self.dtype)

    def predict(self, input_data: npt.ArrayLike) -> Array:
        """Return the output for a batch (batch, inputs), or one example (inputs,), as a new array.

        Inputs of a network for images are (batch, height, width, channels), or without the batch as well.
        Leaves no trace: a backward pass may still follow the last `forward_propagate`.
        """
        return self._answer(self._input(input_data))

    def _answer(self, data: Array) -> Array:
        """Return the output for what `_input` has taken."""
        if data.ndim == 3:
            one: Array = self._answer(data[None])[0]
            return one
        if data.ndim == 2 and len(data) == 1:  # as a vector: in two thirds of the time
            answer: Array = self._answer(data[0])[None]
            return answer
        if data.ndim == 4 and len(data) > IMAGES:
            return np.concatenate([self._answer(part) for part in np.split(data, range(IMAGES, len(data), IMAGES))])
        for layer in self.layers:
            data = layer.predict(data)
        return data

    def _input(self, given: npt.ArrayLike) -> Array:
        """Return what a network is given, in its own kind of numbers; raises ValueError for what it cannot take."""
        array = given if isinstance(given, np.ndarray) else np.asarray(given)
        if array.dtype.kind not in "fiub":
            raise ValueError(f"a network takes numbers, not {array.dtype} of shape {array.shape}")
        if self._takes and array.shape != self._takes and array.shape[1:] != self._takes:
            raise ValueError(f"the network takes {self._takes}, or a batch of such, not {array.shape}")
        return array.astype(self.dtype, copy=False)

    def activations(self, input_data: npt.ArrayLike) -> list[Array]:
        """Return what each layer gives for a batch; the last is what `predict` returns."""
        data: Array = np.asarray(input_data, self.dtype)
        return [data := layer.predict(data) for layer in self.layers]

    def input_gradient(self, input_data: npt.ArrayLike, output_error: npt.ArrayLike) -> Array:
        """Return the derivative of Σ output_error · output by every number of a batch, as a new array of its shape.

        With a one-hot error it says which pixels speak for that answer (Simonyan et al. 2014). Nothing is
        dropped and `gradients` stay as they are, but what the last forward pass kept is overwritten.
        """
        layers = [layer for layer in self.layers if not isinstance(layer, DropoutLayer)]
        data: Array = np.asarray(input_data, self.dtype)
        for layer in layers:
            data = layer.forward_propagate(data)
        error: Array = np.asarray(output_error, self.dtype)
        for layer in reversed(layers):
            error = layer.input_error(error)
        return np.array(error)

    def forward_propagate(self, input_data: npt.ArrayLike) -> Array:
        """Return the output for a batch, and let every layer keep what the way back needs.

        The array is kept for reuse: the next call overwrites it.
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
        twin = type(self)(self.cost, dtype=self.dtype)
        for layer in self.layers:
            twin.add_layer(type(layer)(**layer.arguments()))
        twin.values = self.values
        return twin

    def __reduce__(self) -> tuple[Any, ...]:
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
        """Read a network from its folder; raises ModelFormatError, which names all that is wrong with it."""
        cost, layers, dtype = read_network(folder)
        network = cls(cost, dtype=dtype)
        for layer in layers:
            network.add_layer(layer)
        return network


def _restored(
    kind: type[NeuralNetwork], cost: Cost, layers: list[tuple[type[Layer], dict[str, Any]]], dtype: Any, values: Array
) -> NeuralNetwork:
    """Make a copied or pickled network."""
    network = kind(cost, dtype=dtype)
    for layer, arguments in layers:
        network.add_layer(layer(**arguments))
    network.values = values
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
