"""Statistics of the last hundred episodes of a training run, and the confidence interval of a share."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from math import sqrt
from typing import Final

import numpy as np

from ai.environment import Doubles, StepResult

RECENT: Final = 100
OUTCOMES: Final = 4  # an environment has that many at the most; 0, going on, is not counted


class EpisodeStatistics:
    """Sums over every slot's current episode, and the last hundred that ended; in points, exploration included."""

    def __init__(self, num_envs: int) -> None:
        self.earned: Doubles = np.zeros(num_envs)  # in each slot's episode so far
        self.shares: tuple[float, ...] = (0.0,) * OUTCOMES  # of the last hundred, by outcome from 1 on
        self.mean_return = 0.0  # of the same
        self.parts: tuple[float, ...] = ()  # what each part of the reward brought of that
        self._paid: Doubles | None = None  # what `earned` is the sum of, (parts, num_envs)
        self._recent: deque[tuple[int, float, Sequence[float]]] = deque(maxlen=RECENT)  # outcomes, returns, parts

    @property
    def known(self) -> bool:
        """Whether any episode has ended."""
        return bool(self._recent)

    def add(self, result: StepResult) -> None:
        """Count one step; slots that have ended begin anew with the next."""
        self.earned += result.reward
        if result.components:
            paid = np.array(list(result.components.values()), dtype=float)
            self._paid = paid if self._paid is None else np.add(self._paid, paid, out=paid)

    def finish(self, result: StepResult) -> None:
        """Close the episodes that ended in this step."""
        for slot in np.flatnonzero(result.ended).tolist():
            parts = () if self._paid is None else tuple(self._paid[:, slot].tolist())
            self._recent.append((int(result.outcome[slot]), float(self.earned[slot]), parts))
        self.earned[result.ended] = 0.0
        if self._paid is not None:
            self._paid[:, result.ended] = 0.0
        outcomes, returns, parts = zip(*self._recent, strict=True)
        self.shares = tuple(outcomes.count(outcome + 1) / len(outcomes) for outcome in range(OUTCOMES))
        self.mean_return = sum(returns) / len(returns)
        self.parts = tuple(np.mean(parts, axis=0).tolist())


def wilson(share: float, count: int) -> tuple[float, float]:
    """Return the 95 % interval of a share that was found in `count` trials.

    Wilson, "Probable Inference, the Law of Succession, and Statistical Inference" (1927).
    """
    z = 1.96  # standard deviations to each side
    middle = (share + z * z / (2 * count)) / (1 + z * z / count)
    half = z * sqrt(share * (1 - share) / count + z * z / (4 * count * count)) / (1 + z * z / count)
    return max(0.0, middle - half), min(1.0, middle + half)
