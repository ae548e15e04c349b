"""Learning step of any network, and the recording of the code that took it."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from typing import Any, Final

import numpy as np

from ai.environment import Floats
from ai.explain.recorder import Function, Line, Recorder, Row
from ai.nn import NeuralNetwork
from ai.nn.optimizers import Optimizer

MOST_PARAMETERS: Final = 500_000  # of a network that is explained: a lesson holds some ten vectors of as many
_FEW: Final = 64  # numbers of an array that is kept whole, whatever its shape
_MOST_WHOLE: Final = 50_000  # parameters of a network whose vectors are kept whole in each line of code


@dataclass(frozen=True, eq=False)
class Value:
    """Value of a variable in a line of code that is shown.

    Attributes:
        name: the variable; RETURN for the function's result.
        shape: of the array; () for a number.
        case: what of it belongs to the transition of the lesson: its row of a minibatch; the whole of a vector of all
            parameters, unless these are many, and of a small array; None where nothing does.

    """

    name: str
    shape: tuple[int, ...]
    case: Any


@dataclass(frozen=True, eq=False)
class Step:
    """One step of an optimizer on a minibatch, and what it did to a network."""

    values_before: Floats  # (parameters,) of the network
    values_after: Floats
    gradient: Floats  # (parameters,) of the whole minibatch, as the optimizer used it
    learning_rate: float
    lines: tuple[Line, ...]  # of our own code, in the order in which they ran; each of their values is a Value


def recorded_step(
    take: Callable[[], object], network: NeuralNetwork, optimizer: Optimizer, others: Iterable[Function], row: int
) -> tuple[Recorder, Step]:
    """Take one step of an optimizer on a minibatch; return its recording and what it did, around one row.

    `others` are functions to record besides those of network and optimizer. Raises ValueError for a network of more
    than MOST_PARAMETERS, and what `take` does.
    """
    values_before = network.values.copy()
    if len(values_before) > MOST_PARAMETERS:
        raise ValueError(f"a network of more than {MOST_PARAMETERS:,} parameters is too large to be explained")
    ways = NeuralNetwork.predict, NeuralNetwork.forward_propagate, NeuralNetwork.backward_propagate
    with Recorder([*others, *ways, Optimizer.step], row) as recorder:
        take()
    batch = len(recorder.call(NeuralNetwork.backward_propagate).arguments["output_error"])
    gradient, after = network.gradients.copy(), network.values.copy()
    lines = shown_lines(recorder, row, batch, len(after))
    return recorder, Step(values_before, after, gradient, optimizer.learning_rate, lines)


def shown_lines(recorder: Recorder, row: int = 0, batch: int = 1, parameters: int = 0) -> tuple[Line, ...]:
    """Return all recorded lines, each with a Value in place of a value: what belongs to one row of a minibatch."""

    def shown(name: str, value: Any) -> Value:
        shape = value.shape if isinstance(value, Row) else np.shape(value)
        if shape and shape[0] == batch:
            return Value(name, shape, value.values if isinstance(value, Row) else value[row])
        most = _MOST_WHOLE if shape == (parameters,) else _FEW
        return Value(name, shape, None if isinstance(value, Row) or np.size(value) > most else value)

    return tuple(
        replace(line, values={name: shown(name, value) for name, value in line.values.items()})
        for line in recorder.lines
    )
