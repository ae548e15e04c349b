"""Learning step of any network, read from a recording of the code that took it: forward, cost, backward, optimizer."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from typing import Any, Final

import numpy as np

from ai.environment import Floats
from ai.explain.recorder import RETURN, Function, Line, Recorder, Row
from ai.nn import NeuralNetwork
from ai.nn.layer import Layer
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
    """One step of an optimizer on a minibatch, and what it did to a network; around one row of the minibatch."""

    row: int
    values_before: Floats  # (parameters,) of the network
    values_after: Floats
    activations: tuple[Floats, ...]  # what each layer gave for that row on the forward pass, from the first layer up
    gradient: Floats  # (parameters,) of the whole minibatch, as the optimizer used it
    gradient_length: float  # before it was clipped
    share: Floats  # (parameters,) of the gradient before it was clipped, the part that comes from that row
    learning_rate: float
    optimizer_before: dict[str, Floats]  # what the optimizer keeps of each parameter, by name, (parameters,) each
    optimizer_after: dict[str, Floats]
    taken: Floats  # (parameters,) what the step took off the values
    lines: tuple[Line, ...]  # of our own code, in the order in which they ran; each of their values is a Value


def forward_functions(network: NeuralNetwork) -> list[Function]:
    """Return the functions that a forward pass of a network runs through."""
    return [NeuralNetwork.forward_propagate, *(kind.forward_propagate for kind in _kinds(network))]


def backward_functions(network: NeuralNetwork, optimizer: Optimizer) -> list[Function]:
    """Return the functions from the derivative of the cost to the step of the optimizer."""
    ways = [(kind.backward_propagate, kind.fill_gradients, kind.input_error) for kind in _kinds(network)]
    through = [each for way in ways for each in way]
    return [NeuralNetwork.backward_propagate, *through, Optimizer.step, type(optimizer)._fill_step]


def recorded_step(
    take: Callable[[], object], network: NeuralNetwork, optimizer: Optimizer, others: Iterable[Function], row: int
) -> tuple[Recorder, Step]:
    """Take one step of an optimizer on a minibatch; return its recording and what it did, around one row.

    `others` are functions to record besides those of network, cost and optimizer. Raises ValueError for a network of
    more than MOST_PARAMETERS, and what `take` does.
    """
    values_before = network.values.copy()
    if len(values_before) > MOST_PARAMETERS:
        raise ValueError(f"a network of more than {MOST_PARAMETERS:,} parameters is too large to be explained")
    forward, backward = forward_functions(network), backward_functions(network, optimizer)
    kept, cost = _kept_by(optimizer, values_before), network.cost
    with Recorder(
        [*others, NeuralNetwork.predict, *forward, cost.function, cost.derivative, *backward], row
    ) as recorder:
        take()
    derivative = recorder.call(NeuralNetwork.backward_propagate).arguments["output_error"]
    given = {id(call.owner): call.values[RETURN] for call in recorder.calls(*forward)}
    gradient, after = network.gradients.copy(), network.values.copy()
    return recorder, Step(
        row=row,
        values_before=values_before,
        values_after=after,
        activations=tuple(of_row(given[id(layer)], row) for layer in network.layers),
        gradient=gradient,
        gradient_length=float(recorder.call(Optimizer.step).values["length"]),
        share=_share(network, values_before, derivative, row),
        learning_rate=optimizer.learning_rate,
        optimizer_before=kept,
        optimizer_after=_kept_by(optimizer, after),
        taken=optimizer.scratch.copy(),
        lines=shown_lines(recorder, row, len(derivative), len(after)),
    )


def _kinds(network: NeuralNetwork) -> Iterable[type[Layer]]:
    return {type(layer): None for layer in network.layers}


def _share(network: NeuralNetwork, values_before: Floats, derivative: Floats, row: int) -> Floats:
    """Return the gradient that one row of the last minibatch brought: the backward pass with the other errors at 0."""
    alone = np.zeros_like(derivative)
    alone[row] = derivative[row]
    after, network.values = network.values.copy(), values_before
    network.backward_propagate(alone)  # the layers still hold what the forward pass left in them
    network.values = after
    return network.gradients.copy()


def _kept_by(optimizer: Optimizer, values: Floats) -> dict[str, Floats]:
    """Return copies of what an optimizer keeps of each parameter, zeros before its first step."""
    return {name: optimizer.memory.get(name, np.zeros_like(values)).copy() for name in optimizer.remembers}


def shown_lines(recorder: Recorder, row: int = 0, batch: int = 1, parameters: int = 0) -> tuple[Line, ...]:
    """Return all recorded lines, each with a Value in place of a value: what belongs to one row of a minibatch."""

    def shown(name: str, value: Any) -> Value:
        shape = value.shape if isinstance(value, Row) else np.shape(value)
        if shape and shape[0] == batch:
            return Value(name, shape, of_row(value, row))
        most = _MOST_WHOLE if shape == (parameters,) else _FEW
        return Value(name, shape, None if isinstance(value, Row) or np.size(value) > most else value)

    return tuple(
        replace(line, values={name: shown(name, value) for name, value in line.values.items()})
        for line in recorder.lines
    )


def of_row(value: Any, row: int) -> Any:
    """Return a row of a recorded array."""
    return value.values if isinstance(value, Row) else value[row]
