"""Learning step of any network, read from a recording of the code that took it: forward, cost, backward, optimizer."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from ai.common.environment import Floats
from ai.explain.recorder import RETURN, Event, Function, Recorder, Row
from ai.nn import NeuralNetwork
from ai.nn.optimizers import Optimizer

MOST_PARAMETERS: Final = 500_000  # of a network that is explained: a lesson holds some ten vectors of as many
_FEW: Final = 64  # numbers of an array that is kept whole, whatever its shape
_MOST_WHOLE: Final = 50_000  # parameters of a network whose vectors are kept whole in each line of code


@dataclass(frozen=True, eq=False)
class Value:
    """Value of a variable in a line of code.

    Attributes:
        name: the variable; "return" for the function's result.
        shape: of the array; () for a number.
        case: what of it belongs to the memory of the lesson: its row of a minibatch; the whole of a vector of all
            parameters, unless these are many, and of a small array; None where nothing does.

    """

    name: str
    shape: tuple[int, ...]
    case: Any


@dataclass(frozen=True, eq=False)
class Line:
    """Line of our own code that ran: the function's qualified name, its number in the file, and what it set."""

    function: str
    number: int
    values: tuple[Value, ...]


@dataclass(frozen=True, eq=False)
class Step:
    """One step of an optimizer on a minibatch, and what it did to a network.

    Attributes:
        row: row of the minibatch that the lesson is about.
        values_before, values_after: (parameters,) of the network.
        activations: what each layer gave for that row on the forward pass, from the first layer up.
        errors: derivative of the cost by what each layer gave, for that row, from the first layer up.
        gradient: (parameters,) of the whole minibatch, as the optimizer used it.
        gradient_length: its length before it was clipped.
        share: (parameters,) of the gradient before it was clipped, the part that comes from that row.
        learning_rate: of the step.
        optimizer_before, optimizer_after: what the optimizer keeps of each parameter, by name, (parameters,) each.
        taken: (parameters,) what the step took off the values.
        lines: the lines of our own code, in the order in which they ran.

    """

    row: int
    values_before: Floats
    values_after: Floats
    activations: tuple[Floats, ...]
    errors: tuple[Floats, ...]
    gradient: Floats
    gradient_length: float
    share: Floats
    learning_rate: float
    optimizer_before: dict[str, Floats]
    optimizer_after: dict[str, Floats]
    taken: Floats
    lines: tuple[Line, ...]


def network_functions(network: NeuralNetwork, optimizer: Optimizer) -> Iterable[Function]:
    """Return the functions that a learning step of a network runs through, from the forward pass to the optimizer."""
    yield from (NeuralNetwork.predict, NeuralNetwork.forward_propagate, NeuralNetwork.backward_propagate)
    for kind in {type(layer): None for layer in network.layers}:
        yield from (kind.forward_propagate, kind.backward_propagate, kind.fill_gradients, kind.input_error)
    yield from (network.cost.function, network.cost.derivative)
    yield from (Optimizer.step, type(optimizer)._fill_step)


def recorded_step(
    recorder: Recorder,
    network: NeuralNetwork,
    optimizer: Optimizer,
    values_before: Floats,
    optimizer_before: dict[str, Floats],
    row: int,
) -> Step:
    """Read one step of an optimizer from a recording; only that one may be in it.

    `network` and `optimizer` are as the step left them, and stay so.
    """
    given: dict[int, Any] = {}
    errors: dict[int, Any] = {}
    for event in recorder.events:
        if RETURN in event.values and event.function.endswith(".forward_propagate"):
            given[id(event.owner)] = event.values[RETURN]
        elif "output_error" in event.values and event.function.endswith((".backward_propagate", ".fill_gradients")):
            errors.setdefault(id(event.owner), event.values["output_error"])
    gradient, after = network.gradients.copy(), network.values.copy()
    return Step(
        row=row,
        values_before=values_before,
        values_after=after,
        activations=tuple(of_row(given[id(layer)], row) for layer in network.layers),
        errors=tuple(of_row(errors[id(layer)], row) for layer in network.layers),
        gradient=gradient,
        gradient_length=float(recorder.last("Optimizer.step", "length")),
        share=_share(network, values_before, errors[id(network)], row),
        learning_rate=optimizer.learning_rate,
        optimizer_before=optimizer_before,
        optimizer_after=kept_by(optimizer, after),
        taken=optimizer.scratch.copy(),
        lines=tuple(line_of(event, len(errors[id(network)]), len(after), row) for event in recorder.events),
    )


def _share(network: NeuralNetwork, values_before: Floats, derivative: Floats, row: int) -> Floats:
    """Return the gradient that one row of the last minibatch brought: the backward pass with the other errors at 0."""
    alone = np.zeros_like(derivative)
    alone[row] = derivative[row]
    gradient, after = network.gradients.copy(), network.values.copy()
    network.values = values_before  # the layers still hold what the forward pass left in them
    network.backward_propagate(alone)
    share = network.gradients.copy()
    network.values, network.gradients[...] = after, gradient
    return share


def kept_by(optimizer: Optimizer, values: Floats) -> dict[str, Floats]:
    """Return copies of what an optimizer keeps of each parameter, zeros before its first step."""
    return {name: optimizer.memory.get(name, np.zeros_like(values)).copy() for name in optimizer.remembers}


def line_of(event: Event, batch: int, parameters: int, row: int) -> Line:
    """Return a recorded line with what of its values belongs to one row of a minibatch of a size."""
    values = (_value(name, value, batch, parameters, row) for name, value in event.values.items())
    return Line(event.function, event.number, tuple(values))


def _value(name: str, value: Any, batch: int, parameters: int, row: int) -> Value:
    """Return a variable with what of it belongs to one row of the minibatch."""
    shape = value.shape if isinstance(value, Row) else np.shape(value)
    if shape and shape[0] == batch:
        return Value(name, shape, of_row(value, row))
    if isinstance(value, Row):
        return Value(name, shape, None)
    whole = np.size(value) <= (_MOST_WHOLE if shape == (parameters,) else _FEW)
    return Value(name, shape, value if whole else None)


def of_row(value: Any, row: int) -> Any:
    """Return a row of a recorded array."""
    return value.values if isinstance(value, Row) else value[row]
