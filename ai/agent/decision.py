"""Decision of a network: its observation, the value of each action, and the action taken."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from ai.environment import Bools, Floats, Ints

Real = TypeVar("Real", np.float32, np.float64)


@dataclass(frozen=True, eq=False)
class Decision:
    """Decision for n landers at once, with the observations and values behind it.

    It is computed once, then both flown and drawn.

    Attributes:
        observation: (n, features) that it was made on.
        action: (n,) to fly.
        best: (n,) the action of the greatest value.
        values: (n, actions) as the network gives them; None from a pilot that computes none.
        steadiness: how far the value of a kept action may lie below the best, in the unit of `values`.
        reward_scale: size of one point of reward in the unit of `values`.

    """

    observation: Floats
    action: Ints
    best: Ints
    values: Floats | None = None
    steadiness: float = 0.0
    reward_scale: float = 1.0

    @cached_property
    def points(self) -> Floats | None:
        """Values (n, actions) in points of reward: the expected score from here on, by the first action."""
        return None if self.values is None else in_points(self.values, self.reward_scale)

    @property
    def margin(self) -> float:
        """Points of reward by which the value of a kept action may lie below the best."""
        return self.steadiness / self.reward_scale

    @property
    def kept(self) -> Bools:
        """Whether an action was kept although another one is worth a little more, (n,)."""
        kept: Bools = self.action != self.best
        return kept

    def updated(self, slots: Ints, newer: Decision) -> Decision:
        """Return the decisions of all n landers, with those of `slots` (m,) replaced by `newer` ones."""
        both = {name: array.copy() for name, array in self._rows.items() if name in newer._rows}
        for name, array in both.items():
            array[slots] = newer._rows[name]
        return replace(newer, values=both.pop("values", None), **both)

    def of(self, slot: int) -> Decision:
        """Return a copy of the decision for one of the landers, with n = 1."""
        return replace(self, **{name: array[[slot]] for name, array in self._rows.items()})

    @property
    def _rows(self) -> dict[str, Any]:
        """What has a row for each lander."""
        rows = {"observation": self.observation, "action": self.action, "best": self.best, "values": self.values}
        return {name: array for name, array in rows.items() if array is not None}


def decide(
    observation: Floats,
    values: Floats,
    held: Ints | None = None,
    *,
    steadiness: float = 0.0,
    reward_scale: float = 1.0,
) -> Decision:
    """Choose the best actions by `values` (n, actions); keep those `held` (n,) until now that are nearly as good."""
    best: Ints = values.argmax(axis=1)
    action = best
    if held is not None and steadiness > 0.0:
        rows = np.arange(len(best))
        action = np.where(values[rows, held] >= values[rows, best] - steadiness, held, best)
    return Decision(observation, action, best, values, steadiness, reward_scale)


def in_points(values: NDArray[Real], reward_scale: float) -> NDArray[Real]:
    """Return a network's values as points of reward: it learns from rewards times `reward_scale`."""
    points: NDArray[Real] = values / values.dtype.type(reward_scale)
    return points
