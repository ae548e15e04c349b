"""Optimizers: each turns a gradient into a step, in place, over a network's one flat vector of parameters."""

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from ai.nn.parameter import Array


class Optimizer(ABC):
    """A rule that moves parameters against their gradient.

    `learning_rate` and `clip` may be changed at any time. A gradient longer than `clip` is shortened to it,
    its direction kept (Pascanu et al. 2013); with None it never is.
    """

    remembers: tuple[str, ...] = ()  # names of what is kept of each parameter from step to step

    def __init__(self, learning_rate: float, *, clip: float | None = None) -> None:
        self.learning_rate = learning_rate
        self.clip = clip
        self.steps = 0
        self.memory: dict[str, Array] = {}
        self.scratch: Array = np.empty(0)

    def step(self, values: Array, gradients: Array) -> float:
        """Move `values`, in place, and return the length of `gradients` as they came.

        Both are flat and of one size; `gradients` is shortened in place where it is clipped. A gradient that
        is not finite would ruin the network, so it moves nothing: ask `math.isfinite` of the returned length.
        Raises ValueError if the size is not that of the steps before.
        """
        with np.errstate(all="ignore"):
            length = math.sqrt(np.dot(gradients, gradients))
        if not math.isfinite(length):
            return length
        if self.scratch.shape != values.shape or self.scratch.dtype != values.dtype:
            self._prepare(values)
        if self.clip is not None and length > self.clip:
            gradients *= self.clip / length
        self.steps += 1
        self._move(values, gradients)
        return length

    def state(self) -> dict[str, npt.NDArray[Any]]:
        """Return copies of all that the next step depends on, besides the settings."""
        return {"steps": np.array(self.steps)} | {name: kept.copy() for name, kept in self.memory.items()}

    def load_state(self, state: Mapping[str, npt.NDArray[Any]]) -> None:
        """Go on from what `state` returned; raises ValueError if it is not of this kind of optimizer."""
        steps = int(state["steps"]) if "steps" in state else -1
        names = self.remembers if steps else ()
        if steps < 0 or set(state) != {"steps", *names}:
            raise ValueError(f"not a state of {type(self).__name__}: it holds {sorted(state)}")
        self.steps = steps
        self.memory = {name: np.array(state[name]) for name in names}
        self.scratch = np.empty(0)

    @abstractmethod
    def _move(self, values: Array, gradients: Array) -> None: ...

    def _prepare(self, values: Array) -> None:
        if not self.memory:
            self.memory = {name: np.zeros_like(values) for name in self.remembers}
        for name, kept in self.memory.items():
            if kept.shape != values.shape:
                raise ValueError(f"{name} is kept of {kept.size} parameters, and here are {values.size}")
        self.scratch = np.empty_like(values)


class SGD(Optimizer):
    """Stochastic gradient descent: values -= learning_rate · gradient."""

    def __init__(self, learning_rate: float = 0.01, *, clip: float | None = None) -> None:
        super().__init__(learning_rate, clip=clip)

    def _move(self, values: Array, gradients: Array) -> None:
        np.multiply(gradients, self.learning_rate, out=self.scratch)
        values -= self.scratch


class Momentum(Optimizer):
    """Steps along v = momentum · v + gradient, the heavy ball of Polyak 1964: values -= learning_rate · v."""

    remembers = ("velocity",)

    def __init__(self, learning_rate: float = 0.01, *, momentum: float = 0.9, clip: float | None = None) -> None:
        super().__init__(learning_rate, clip=clip)
        self.momentum = momentum

    def _move(self, values: Array, gradients: Array) -> None:
        velocity = self.memory["velocity"]
        velocity *= self.momentum
        velocity += gradients
        np.multiply(velocity, self.learning_rate, out=self.scratch)
        values -= self.scratch


class Adam(Optimizer):
    """Adam (Kingma & Ba 2015, algorithm 1).

    The paper's moments are (1 - β) times the sums kept here: the factor, like the bias correction, goes into
    two numbers per step instead of passes over every parameter.
    """

    remembers = ("gradient_sum", "square_sum")

    def __init__(
        self,
        learning_rate: float = 0.001,
        *,
        beta1: float = 0.9,
        beta2: float = 0.999,
        epsilon: float = 1e-8,
        clip: float | None = None,
    ) -> None:
        super().__init__(learning_rate, clip=clip)
        self.beta1, self.beta2, self.epsilon = beta1, beta2, epsilon

    def _move(self, values: Array, gradients: Array) -> None:
        gradient_sum, square_sum, scratch = *self.memory.values(), self.scratch
        first = (1 - self.beta1) / (1 - self.beta1**self.steps)
        second = math.sqrt((1 - self.beta2) / (1 - self.beta2**self.steps))

        gradient_sum *= self.beta1
        gradient_sum += gradients
        square_sum *= self.beta2
        np.square(gradients, out=scratch)
        square_sum += scratch

        np.sqrt(square_sum, out=scratch)
        scratch += self.epsilon / second
        np.divide(gradient_sum, scratch, out=scratch)
        scratch *= self.learning_rate * first / second
        values -= scratch


OPTIMIZERS: dict[str, type[SGD] | type[Momentum] | type[Adam]] = {
    "sgd": SGD,
    "momentum": Momentum,
    "adam": Adam,
}
