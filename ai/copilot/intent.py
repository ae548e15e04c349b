"""Intent inference: which pad a pilot has in mind, judged by their actions."""

from __future__ import annotations

from typing import Final

import numpy as np

from ai.environment import Bools, Doubles, Floats, Ints
from ai.lander.pilots import COAST

_TEMPER: Final = 2.0  # temperature of the Boltzmann model of the pilot, in points of reward
_SLIP: Final = 0.3  # share of actions that are slips of the hand, and no evidence
_MEMORY: Final = 0.98  # exponent on old evidence at each decision: people change their minds
DOUBT: Final = 0.1  # pads less likely than this share of the likeliest are ruled out


class Intent:
    """Probability that each of several pads is meant, by Bayes' rule (Javdani, Srinivasa and Bagnell 2015).

    A pilot who heads for a pad is modelled to choose actions by their value on the way there (Boltzmann). Hands
    off the stick are no evidence.

    Attributes:
        chances: what they are so far, (n, pads); replaced, never changed.

    """

    def __init__(self, reward_scale: float) -> None:
        self.reward_scale = reward_scale
        self.chances: Doubles = np.ones((0, 0))

    def likely(self, slots: int, pads: int) -> Doubles:
        """Return the chances so far, (n, pads)."""
        if self.chances.shape != (slots, pads):
            self.chances = np.full((slots, pads), 1.0 / pads)
        return self.chances

    def watch(self, values: Floats, pilot: Ints) -> Doubles:
        """Update by one action (n,), given `values` (n, pads, 6) on the way to each pad; return chances (n, pads)."""
        slots, pads, actions = values.shape
        worse = (values - values.max(axis=2, keepdims=True)) / (_TEMPER * self.reward_scale)
        chance = np.exp(worse)
        chance /= chance.sum(axis=2, keepdims=True)
        likelihood = (1.0 - _SLIP) * chance[np.arange(slots), :, pilot] + _SLIP / actions
        likely = self.likely(slots, pads) ** _MEMORY * likelihood
        likely /= likely.sum(axis=1, keepdims=True)
        says = (pilot != COAST) & np.isfinite(likely).all(axis=1)
        self.chances = np.where(says[:, None], likely, self.chances)
        return self.chances

    def forget(self, mask: Bools | None = None) -> None:
        """Begin anew in the slots of `mask` (n,), or in all: all pads are equally likely."""
        if self.chances.size:
            self.chances = self.chances.copy()
            self.chances[slice(None) if mask is None else mask] = 1.0 / self.chances.shape[1]
