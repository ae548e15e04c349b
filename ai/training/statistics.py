"""Statistics of the last hundred episodes of a training run."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping
from typing import Any, Final

import numpy as np

from ai.common.environment import SUCCESS, Doubles, StepResult
from ai.files import array_like

RECENT: Final = 100
OUTCOMES: Final = 4  # an environment has that many at the most; 0, going on, is not counted


class EpisodeStatistics:
    """Episode statistics: sums over every slot's current episode, and the last hundred that ended.

    Returns and parts of the reward are in points, exploration included.
    """

    def __init__(self, num_envs: int) -> None:
        self.earned: Doubles = np.zeros(num_envs)  # in each slot's episode so far
        self.shares: tuple[float, ...] = (0.0,) * OUTCOMES  # of the last hundred, by outcome from 1 on
        self.mean_return = 0.0  # of the same
        self.parts: tuple[float, ...] = ()  # of that, what each part of the reward brought
        self._paid: Doubles | None = None  # what `earned` is the sum of, (parts, num_envs)
        self._outcomes: deque[int] = deque(maxlen=RECENT)
        self._returns: deque[float] = deque(maxlen=RECENT)
        self._parts: deque[list[float]] = deque(maxlen=RECENT)

    @property
    def known(self) -> bool:
        """Whether any episode has ended."""
        return bool(self._outcomes)

    @property
    def success(self) -> float:
        """Share of the last hundred that ended well; 0 before any has ended."""
        return self.shares[SUCCESS - 1]

    def add(self, result: StepResult) -> None:
        """Count one step; slots that have ended begin anew with the next."""
        self.earned += result.reward
        if result.components:
            paid = np.array(list(result.components.values()), dtype=float)
            self._paid = paid if self._paid is None else np.add(self._paid, paid, out=paid)

    def finish(self, result: StepResult) -> None:
        """Close the episodes that ended in this step."""
        ended = result.ended
        self._outcomes.extend(result.outcome[ended].tolist())
        self._returns.extend(self.earned[ended].tolist())
        self.earned[ended] = 0.0
        if self._paid is not None:
            self._parts.extend(self._paid[:, ended].T.tolist())
            self._paid[:, ended] = 0.0
        self._sum_up()

    def to_json(self) -> dict[str, list[Any]]:
        """Return the last hundred episodes' results for a file, so that a resumed run goes on counting from them."""
        return {"outcomes": [*self._outcomes], "returns": [*self._returns], "parts": [*self._parts]}

    def load(self, told: Mapping[str, Any]) -> None:
        """Take over what `to_json` gave; raises KeyError, TypeError or ValueError where it makes no sense."""
        outcomes = [int(outcome) for outcome in told["outcomes"]]
        returns = [float(earned) for earned in told["returns"]]
        parts = [[float(part) for part in parts] for parts in told["parts"]]
        if len(returns) != len(outcomes) or len(parts) not in (0, len(outcomes)) or len({*map(len, parts)}) > 1:
            raise ValueError("the last flights have outcomes, returns and parts of different numbers")
        if not np.isfinite([*returns, *(part for each in parts for part in each)]).all():
            raise ValueError("the last flights have returns that are no numbers")
        self._outcomes, self._returns = deque(outcomes, maxlen=RECENT), deque(returns, maxlen=RECENT)
        self._parts = deque(parts, maxlen=RECENT)
        if outcomes:
            self._sum_up()

    def state(self) -> dict[str, Any]:
        """Return copies of all of it, so that a run goes on in the middle of its episodes."""
        return {"recent": self.to_json(), "earned": self.earned.copy(),
                "paid": None if self._paid is None else self._paid.copy()}  # fmt: skip

    def load_state(self, state: Mapping[str, Any]) -> None:
        """Go on from what `state` returned; raises KeyError, TypeError or ValueError for anything else."""
        self.load(state["recent"])
        self.earned = array_like(self.earned, state["earned"], "earned")
        if (paid := state["paid"]) is not None:
            self._paid = array_like(np.empty((len(paid), len(self.earned))), paid, "paid")

    def _sum_up(self) -> None:
        count = len(self._outcomes)
        self.shares = tuple(self._outcomes.count(outcome + 1) / count for outcome in range(OUTCOMES))
        self.mean_return = sum(self._returns) / count
        if self._parts:
            self.parts = tuple(np.mean(self._parts, axis=0).tolist())
