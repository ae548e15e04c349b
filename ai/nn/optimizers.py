"""Optimizers: each turns a gradient into a step, in place, over a network's one flat vector of parameters."""

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from ai.files.reading import array_like, count_of
from ai.nn.parameter import Array


class DivergenceError(FloatingPointError):
    """Divergence of training: a cost, a gradient or a step is not finite. The parameters are as before the step.

    Attributes:
        step: number of the step of its optimizer, from 1.
        learning_rate: of that step, the most likely cause.

    """

    def __init__(self, what: str, optimizer: "Optimizer") -> None:
        self.step, self.learning_rate = optimizer.steps + 1, optimizer.learning_rate
        super().__init__(
            f"the {what} was not finite at learning step {self.step}; "
            f"most likely the learning rate of {self.learning_rate:g} is too high"
        )


class Optimizer(ABC):
    """A rule that moves parameters against their gradient.

    `learning_rate` and `clip` may be changed at any time. A gradient longer than `clip` is shortened to it,
    its direction kept (Pascanu et al. 2013); with None it never is.
    """

    remembers: tuple[str, ...] = ()  # names of what it remembers of each parameter from step to step
    never_negative: tuple[str, ...] = ()  # which of these no step can bring below 0

    def __init__(self, learning_rate: float = 0.01, *, clip: float | None = None) -> None:
        if isinstance(learning_rate, bool) or not isinstance(learning_rate, int | float | np.number):
            raise ValueError(f"a learning rate is a number, not {learning_rate!r}")
        self.learning_rate = learning_rate
        self.clip = clip
        self.steps = 0
        self.memory: dict[str, Array] = {}
        self.scratch: Array = np.empty(0)
        self._moved: Array | None = None  # the parameters of the network that it serves

    def __getstate__(self) -> dict[str, Any]:
        """Copy and pickle all but whose parameters they are: a copy moves those of a copied network."""
        return vars(self) | {"_moved": None}

    def step(self, values: Array, gradients: Array, cost: float = 0.0) -> float:
        """Move `values`, in place, and return the length of `gradients` as they came.

        Both are flat and of one size; `gradients` is shortened in place where it is clipped. `cost` is what
        the gradient was taken of: Huber's gradient is bounded even where the cost is infinite.

        Raises DivergenceError, and leaves `values` as they are, if the cost, the gradient or the step is not
        finite, or too long for its length to be; ValueError if the size is not that of the steps before.
        """
        if not math.isfinite(cost):
            raise DivergenceError("cost", self)
        if self.scratch.shape != values.shape or self.scratch.dtype != values.dtype:
            self._prepare(values)
        with np.errstate(over="ignore", invalid="ignore"):  # once, as it takes as long as a pass: found right below
            length = _length(gradients)
            if not math.isfinite(length):
                raise DivergenceError("gradient", self)
            if self.clip is not None and length > self.clip:
                gradients *= self.clip / length
            self._fill_step(gradients, self.steps + 1)
            if not math.isfinite(_length(self.scratch)):
                raise DivergenceError("step", self)
        values -= self.scratch
        self.steps += 1
        return length

    def serve(self, values: Array) -> None:
        """Take note of the network's parameters that are to be moved; raises ValueError if others were before."""
        if self.remembers and self._moved is not values:
            if self._moved is not None and self.steps:
                raise ValueError("an optimizer remembers one network's gradients; another network needs its own")
            self._moved = values

    def state(self) -> dict[str, npt.NDArray[Any]]:
        """Return copies of all that the next step depends on, besides the settings."""
        return {"steps": np.array(self.steps)} | {name: memory.copy() for name, memory in self.memory.items()}

    def load_state(self, state: Mapping[str, npt.NDArray[Any]], values: Array) -> None:
        """Go on from what `state` returned, with the parameters `values` (parameters,).

        Raises ValueError, and changes nothing, if the state is not of this kind of optimizer, or not one of these
        parameters.
        """
        names = self.remembers if state.get("steps", 0) else ()
        if set(state) != {"steps", *names}:
            raise ValueError(f"not a state of {type(self).__name__}: it holds {', '.join(sorted(state))}")
        steps = count_of(state["steps"].tolist())
        memory = {name: array_like(values, state[name], name) for name in names}
        for name in memory.keys() & set(self.never_negative):
            if (memory[name] < 0).any():
                raise ValueError(f"{name} holds numbers below 0, and is a sum of squares")
        self.steps, self.memory, self.scratch, self._moved = steps, memory, np.empty(0), None

    @abstractmethod
    def _fill_step(self, gradients: Array, number: int) -> None:
        """Fill `scratch` with what step `number`, from 1, takes off the parameters."""

    def _prepare(self, values: Array) -> None:
        if not self.memory:
            self.memory = {name: np.zeros_like(values) for name in self.remembers}
        for name, memory in self.memory.items():
            if memory.shape != values.shape:
                raise ValueError(f"{name} is kept of {memory.size} parameters, and here are {values.size}")
        self.scratch = np.empty_like(values)


class SGD(Optimizer):
    """Stochastic gradient descent: values -= learning_rate · gradient."""

    def _fill_step(self, gradients: Array, number: int) -> None:  # noqa: ARG002 - all steps are alike
        np.multiply(gradients, self.learning_rate, out=self.scratch)


class Momentum(Optimizer):
    """Gradient descent with momentum (Polyak 1964): v = momentum · v + gradient; values -= learning_rate · v."""

    remembers = ("velocity",)

    def __init__(self, learning_rate: float = 0.01, *, momentum: float = 0.9, clip: float | None = None) -> None:
        super().__init__(learning_rate, clip=clip)
        self.momentum = momentum

    def _fill_step(self, gradients: Array, number: int) -> None:  # noqa: ARG002 - all steps are alike
        velocity = self.memory["velocity"]
        velocity *= self.momentum
        velocity += gradients
        np.multiply(velocity, self.learning_rate, out=self.scratch)


class Adam(Optimizer):
    """Adam (Kingma & Ba 2015, algorithm 1).

    The paper's step is learning_rate · m̂ / (√v̂ + ε), with moments m̂ and v̂ of the gradient g, corrected for bias:

        m̂ = a · G, a = (1 - β₁) / (1 - β₁ᵗ)        G = β₁·G + g  (`gradient_sum`)
        v̂ = b² · S, b² = (1 - β₂) / (1 - β₂ᵗ)      S = β₂·S + g² (`square_sum`)

    That is learning_rate · (a / b) · G / (√S + ε / b): two numbers per step take the place of passes over every
    parameter. In the code a is `first`, and b `second`.
    """

    remembers = ("gradient_sum", "square_sum")
    never_negative = ("square_sum",)

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

    def _fill_step(self, gradients: Array, number: int) -> None:
        gradient_sum, square_sum, scratch = *self.memory.values(), self.scratch
        first = (1 - self.beta1) / (1 - self.beta1**number)
        second = math.sqrt((1 - self.beta2) / (1 - self.beta2**number))

        gradient_sum *= self.beta1
        gradient_sum += gradients
        square_sum *= self.beta2
        np.square(gradients, out=scratch)
        square_sum += scratch

        np.sqrt(square_sum, out=scratch)
        scratch += self.epsilon / second
        np.divide(gradient_sum, scratch, out=scratch)
        scratch *= self.learning_rate * first / second


def _length(vector: Array) -> float:
    """Euclidean length of a flat vector; not finite where a number of it is not, or their squares overflow."""
    return math.sqrt(np.dot(vector, vector))


OPTIMIZERS: dict[str, type[SGD] | type[Momentum] | type[Adam]] = {"sgd": SGD, "momentum": Momentum, "adam": Adam}
