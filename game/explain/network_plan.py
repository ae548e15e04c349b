"""Plan of a network's drawing: which units and links are drawn, and how strongly. Arrays only, no surfaces."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final, Literal

import numpy as np
import numpy.typing as npt

from ai.explain.inspection import Link, links, traces
from ai.nn import NeuralNetwork

Show = Literal["weights", "activations", "gradients"]
Indices = npt.NDArray[np.intp]
Numbers = npt.NDArray[np.floating[Any]]

_LOYALTY: Final = 2.0  # factor by which a unit must be stronger than a shown one to replace it
_FAINTEST: Final = 0.02  # share of the largest link, below which a link is not drawn


@dataclass(frozen=True)
class Column:
    """The shown units of one layer.

    Attributes:
        units: (k,) indices of the shown units, rising.
        total: number of units in the layer.
        values: (k,) activations; NaN where unknown.
        bias: (k,) biases; None for the inputs.

    """

    units: Indices
    total: int
    values: Numbers
    bias: Numbers | None


@dataclass(frozen=True)
class Edge:
    """A drawn link from a unit of `column` to one of the next, both by their place among the shown units."""

    column: int
    start: int
    end: int
    size: float  # 0 to 1, relative to the largest between these columns
    positive: bool


def steady_choice(strength: Numbers, most: int, before: Indices | None = None) -> Indices:
    """Return indices of the `most` strongest units, rising; those of `before` stay until another is much stronger."""
    if len(strength) <= most:
        return np.arange(len(strength))
    strength = np.array(strength, float)
    if before is not None and len(before) == most and before[-1] < len(strength):
        strength[before] *= _LOYALTY
    return np.sort(np.argsort(-strength, kind="stable")[:most])


def strongest_edges(matrix: Numbers, column: int, most: int) -> list[Edge]:
    """Return the `most` entries of a matrix (starts, ends) of largest magnitude as edges, the faintest first."""
    size = np.nan_to_num(np.abs(matrix).astype(float), nan=0.0, posinf=0.0).ravel()
    chosen = np.argsort(size, kind="stable")[-most:]
    largest = float(size[chosen[-1]]) if len(chosen) else 0.0
    if not largest > 0:
        return []
    ends = matrix.shape[1]
    signs = matrix.ravel() > 0
    return [
        Edge(column, int(index) // ends, int(index) % ends, float(size[index] / largest), bool(signs[index]))
        for index in chosen
        if size[index] > _FAINTEST * largest
    ]


class NetworkPlan:
    """Snapshot of a network for drawing: columns of shown units, and the weights of the links between them.

    At most `most` units of a layer are shown: the most important by their weights, with a preference for those of the
    plan `before`. Everything is copied, so the network may change afterwards.
    """

    def __init__(
        self,
        network: NeuralNetwork,
        observation: npt.ArrayLike | None,
        most: int,
        before: NetworkPlan | None = None,
    ) -> None:
        found = links(network)
        sizes = [len(found[0].weights), *(len(link.bias) for link in found)] if found else []
        values = _values(network, observation, sizes)
        old = before if before and [column.total for column in before.columns] == sizes else None
        self.columns: list[Column] = []
        for stage, size in enumerate(sizes):
            strength = _strength(found, stage)
            units = steady_choice(strength, most, old.columns[stage].units if old else None)
            shown = values[stage][units].astype(float)
            bias = found[stage - 1].bias[units].astype(float) if stage else None
            self.columns.append(Column(units, size, shown, bias))
        self._links = []
        for link, left, right in zip(found, self.columns[:-1], self.columns[1:], strict=True):
            part = np.ix_(left.units, right.units)
            self._links.append((link.weights[part], link.gradient[part]))

    def edges(self, show: Show, most: int) -> list[Edge]:
        """Return the `most` strongest links between each two columns, the faintest first."""
        found: list[Edge] = []
        for number, (weights, gradient) in enumerate(self._links):
            with np.errstate(all="ignore"):
                if show == "gradients":
                    matrix = -gradient  # gradient descent moves the weight against the gradient
                elif show == "activations":
                    matrix = weights * self.columns[number].values[:, None]
                else:
                    matrix = weights
            found += strongest_edges(matrix, number, most)
        return sorted(found, key=lambda edge: edge.size)

    def best(self) -> int | None:
        """Return the place of the largest output; None if the outputs are unknown."""
        values = self.columns[-1].values if self.columns else np.zeros(0)
        return int(np.nanargmax(values)) if len(values) > 1 and np.isfinite(values).any() else None

    def brightness(self, column: int) -> Numbers:
        """Return the brightness of a column's units, (k,) in -1 to 1; outputs are scaled from least to greatest."""
        values = self.columns[column].values
        finite = values[np.isfinite(values)]
        if not len(finite):
            return np.zeros(len(values))
        values = np.nan_to_num(values, nan=0.0, posinf=0.0, neginf=0.0)
        if column == len(self.columns) - 1:
            span = float(np.ptp(finite))
            return np.clip((values - finite.min()) / span, 0.0, 1.0) if span > 0 else np.full(len(values), 0.5)
        least = 1.0 if column == 0 else 1e-9  # observations are of order one; a faint one stays faint
        lit: Numbers = values / max(float(np.abs(finite).max()), least)
        return lit


def _values(network: NeuralNetwork, observation: npt.ArrayLike | None, sizes: Sequence[int]) -> list[Numbers]:
    """Return each layer's values; without an observation, NaN."""
    if observation is None:
        return [np.full(size, np.nan) for size in sizes]
    return [*traces(network, observation)]


def _strength(found: Sequence[Link], stage: int) -> Numbers:
    """Return the importance of each unit of a layer: the product of the norms of its incoming and outgoing weights."""
    with np.errstate(all="ignore"):
        away = np.linalg.norm(found[stage].weights, axis=1) if stage < len(found) else 1.0
        to = np.linalg.norm(found[stage - 1].weights, axis=0) + 0 * found[stage - 1].bias if stage else 1.0
        strength: Numbers = np.asarray(away * to, float)
    return strength
