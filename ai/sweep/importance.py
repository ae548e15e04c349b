"""How much each knob matters: functional analysis of variance of a random forest (fANOVA).

Hutter, Hoos and Leyton-Brown, "An Efficient Approach for Assessing Hyperparameter Importance" (2014). A forest is
grown on the trials; each tree splits the search space into boxes with a value each, so the mean over all knobs but
one, the marginal of that knob, is an exact sum. The share of the variance of all values that a marginal has tells how
much the knob matters by itself; what is left of 1 is due to knobs together.

Optuna's own needs scikit-learn and SciPy; this one needs NumPy, so the game can show it too.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from ai.common.environment import Doubles
from ai.sweep.space import Space

TREES: Final = 64
LEAST: Final = 8  # trials below which nothing is said
_LEAVES: Final = 200  # about as many at the most: more follow the noise, and take long


@dataclass(frozen=True)
class Importance:
    """Share of the variance that a knob explains by itself, 0 to 1, and its standard deviation over the trees."""

    share: float
    spread: float


def importances(space: Space, params: list[dict[str, object]], values: list[float]) -> dict[str, Importance]:
    """Return how much each knob matters, the most important first; nothing for too few trials or equal values."""
    if len(values) < LEAST or len(set(values)) < 2:
        return {}
    places = np.array([[_place(space, name, each[name]) for name in space] for each in params])
    told = np.array(values)
    told /= np.abs(told).max()  # shares stay, and no square is too large
    rng = np.random.default_rng(0)
    shares = np.array([_shares(*_grown(places, told, rng)) for _ in range(TREES)])
    means, spreads = shares.mean(axis=0), shares.std(axis=0)
    known = {
        name: Importance(float(mean), float(spread)) for name, mean, spread in zip(space, means, spreads, strict=True)
    }
    return dict(sorted(known.items(), key=lambda item: -item[1].share))


def _place(space: Space, name: str, value: object) -> float:
    """Return the place of a value from 0 to 1; of n choices, each has an n-th."""
    dimension = space[name]
    if not dimension.choices:
        return dimension.place(value)
    return (dimension.choices.index(value) + 0.5) / len(dimension.choices)


def _grown(places: Doubles, values: Doubles, rng: np.random.Generator) -> tuple[Doubles, Doubles]:
    """Grow a regression tree on a bootstrap sample; return its leaves' boxes (leaves, knobs, 2) and values (leaves,).

    `places` is (trials, knobs), `values` (trials,). Each split is the best of two thirds of the knobs.
    """
    drawn = rng.integers(len(values), size=len(values))
    least = max(1, len(values) // _LEAVES)
    knobs = places.shape[1]
    boxes, means = [], []
    open_nodes = [(drawn, np.tile([0.0, 1.0], (knobs, 1)))]
    while open_nodes:
        rows, box = open_nodes.pop()
        tried = rng.permutation(knobs)[: max(1, -(-2 * knobs // 3))]
        found = _best_split(places[np.ix_(rows, tried)], values[rows], least)
        if found is None:
            boxes.append(box)
            means.append(values[rows].mean())
            continue
        knob, at = int(tried[found[0]]), found[1]
        left, right = box.copy(), box.copy()
        left[knob, 1] = right[knob, 0] = at
        below = places[rows, knob] < at
        open_nodes += [(rows[below], left), (rows[~below], right)]
    return np.array(boxes), np.array(means)


def _best_split(places: Doubles, values: Doubles, least: int) -> tuple[int, float] | None:
    """Return the column and the place of the split that leaves the least squared error; None if none helps."""
    count = len(values)
    if count < 2 * least or np.ptp(values) == 0:
        return None
    order = places.argsort(axis=0, kind="stable")
    sorted_places = np.take_along_axis(places, order, axis=0)
    sums = values[order].cumsum(axis=0)
    below = np.arange(1, count)[:, None]
    gain = sums[:-1] ** 2 / below + (sums[-1] - sums[:-1]) ** 2 / (count - below)
    possible = (sorted_places[1:] > sorted_places[:-1]) & (below >= least) & (count - below >= least)
    gain = np.where(possible, gain, -np.inf)
    row, column = np.unravel_index(gain.argmax(), gain.shape)
    if not possible[row, column]:
        return None
    return int(column), float(sorted_places[row : row + 2, column].mean())


def _shares(boxes: Doubles, values: Doubles) -> npt.NDArray[np.float64]:
    """Return the share of a tree's variance that each knob's marginal has, (knobs,); zeros for a tree of one leaf."""
    widths = boxes[:, :, 1] - boxes[:, :, 0]
    volumes = widths.prod(axis=1)
    mean = float(volumes @ values)
    variance = float(volumes @ (values - mean) ** 2)
    if variance <= 0.0:
        return np.zeros(boxes.shape[1])
    shares = []
    for knob in range(boxes.shape[1]):
        # The marginal is a step function: each leaf adds its value times the rest of its volume from low to high.
        ends = np.unique(boxes[:, knob])
        steps = np.zeros(len(ends))
        weight = values * volumes / widths[:, knob]
        np.add.at(steps, ends.searchsorted(boxes[:, knob, 0]), weight)
        np.subtract.at(steps, ends.searchsorted(boxes[:, knob, 1]), weight)
        marginal = steps.cumsum()[:-1]
        shares.append(float(np.diff(ends) @ (marginal - mean) ** 2) / variance)
    return np.array(shares)
