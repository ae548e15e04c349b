"""Cost functions, summed over the outputs of an example and averaged over the batch.

The sum is the point: a network with ten outputs learns each of them as fast as a network with one would,
whatever the learning rate (docs/adr/0003-cost-is-summed-over-outputs.md).
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import Any, Self

import numpy as np

from ai.nn.parameter import Array

# The cost itself is one number; its derivative has the shape of the prediction.
CostFunction = Callable[[Array, Array], Any]


@dataclass(frozen=True)
class Cost:
    """A function of (prediction, target) and its derivative with respect to the prediction.

    Both arrays are (batch, outputs), or (outputs,) for a single example. Unpacks as the pair (function,
    derivative) of which the first is the cost itself: it can be called, and takes its name and options along
    to `config.json`.
    """

    function: CostFunction
    derivative: CostFunction
    name: str | None = None
    options: Mapping[str, float] = field(default_factory=dict, hash=False)
    logits: bool = False  # predictions are logarithms of odds, and `softmax` makes probabilities of them

    @classmethod
    def of(cls, function: CostFunction, derivative: CostFunction | None = None) -> Self:
        """Return `function` if it is a cost, or make one of a plain pair, which then has no name."""
        if isinstance(function, cls):
            return function
        if derivative is None:
            raise TypeError("a cost is a function and its derivative; the derivative is missing")
        return cls(function, derivative)

    def __call__(self, prediction: Array, target: Array) -> float:
        """Return the cost of a batch; raises ValueError for targets of another shape."""
        return float(self.function(prediction, target))

    def __iter__(self) -> Iterator[CostFunction]:
        yield self
        yield self.derivative


class CostFunctions:
    """The costs that can be saved by name; each `use_` method returns one."""

    @staticmethod
    def use_mse() -> Cost:
        """Squared error: Σ (prediction - target)², averaged over the batch."""
        return Cost(_squared, _squared_slope, "mse")

    @staticmethod
    def use_huber(delta: float = 1.0) -> Cost:
        """Huber 1964: ½e² while |e| ≤ delta, then the straight line delta·(|e| - ½delta).

        Beyond delta an outlier pulls no harder, which keeps a surprising reward from upsetting a Q-network.
        """
        if not 0 < delta < np.inf:
            raise ValueError(f"delta of the Huber cost is a positive number, not {delta}")
        return Cost(partial(_huber, delta), partial(_huber_slope, delta), "huber", {"delta": delta})

    @staticmethod
    def use_softmax_cross_entropy() -> Cost:
        """Cross-entropy -Σ target · log softmax(prediction), averaged over the batch (Bridle 1990).

        Targets are probabilities, (batch, classes): one-hot rows, or smoothed ones. Predictions are logits:
        the network ends without an activation, and `softmax` of its outputs are its probabilities. The derivative
        is softmax(prediction) · Σ target - target.
        """
        return Cost(_cross_entropy, _cross_entropy_slope, "softmax_cross_entropy", logits=True)


def softmax(logits: Array) -> Array:
    """Return probabilities over the last axis, exp(logit) / Σ exp(logit), for logits of any size."""
    probabilities: Array = np.exp(_shifted(logits))
    probabilities /= probabilities.sum(axis=-1, keepdims=True)
    return probabilities


COSTS: dict[str, Callable[..., Cost]] = {
    "mse": CostFunctions.use_mse,
    "huber": CostFunctions.use_huber,
    "softmax_cross_entropy": CostFunctions.use_softmax_cross_entropy,
}


def _squared(prediction: Array, target: Array) -> float:
    difference = _difference(prediction, target)
    return float(np.vdot(difference, difference)) / _batch(difference)


def _squared_slope(prediction: Array, target: Array) -> Array:
    difference = _difference(prediction, target)
    return difference * (2 / _batch(difference))


def _huber(delta: float, prediction: Array, target: Array) -> float:
    error = np.abs(_difference(prediction, target))
    curved = np.minimum(error, delta)
    return float(np.sum(curved * (error - 0.5 * curved))) / _batch(error)


def _huber_slope(delta: float, prediction: Array, target: Array) -> Array:
    error = _difference(prediction, target).clip(-delta, delta)
    return error / _batch(error)


def _cross_entropy(prediction: Array, target: Array) -> float:
    logits, target = _shifted(prediction), np.asarray(target)
    logarithms = logits - np.log(np.exp(logits).sum(axis=-1, keepdims=True))
    # A class that is masked by -inf costs nothing unless it is the target.
    return -float(np.vdot(target, np.where(target == 0, 0.0, logarithms))) / _batch(logits)


def _cross_entropy_slope(prediction: Array, target: Array) -> Array:
    target = np.asarray(target)
    error: Array = softmax(prediction) * target.sum(axis=-1, keepdims=True)
    error -= target
    return error / _batch(error)


def _shifted(logits: Array) -> Array:
    """Return logits of which the largest is 0: softmax is the same, and nothing can overflow."""
    logits = np.asarray(logits)
    shifted: Array = logits - logits.max(axis=-1, keepdims=True)
    return shifted


def _difference(prediction: Array, target: Array) -> Array:
    """Return prediction - target; (n,) beside (n, 1) would make n · n differences of no meaning."""
    if np.shape(prediction) != np.shape(target):
        raise ValueError(f"the targets have shape {np.shape(target)}, the predictions {np.shape(prediction)}")
    difference: Array = np.subtract(prediction, target)
    return difference


def _batch(outputs: Array) -> int:
    """Return the number of examples, for a mean; that of none is 0."""
    return max(1, len(outputs)) if outputs.ndim > 1 else 1
