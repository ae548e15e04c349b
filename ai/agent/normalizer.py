"""Running normalisation of observations, whatever their units."""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from ai.environment import Doubles, Floats
from ai.files import count_of

REACH: Final = 10.0  # standard deviations from the mean at which values are clipped


class Normalizer:
    """Running mean and standard deviation, which scale observations to mean 0 and standard deviation 1.

    Attributes:
        count: observations so far.
        mean: (features,) of them, in the environment's units.
        squares: (features,) summed squares of their distances from the mean.

    """

    def __init__(self, num_features: int) -> None:
        self._set(0, np.zeros(num_features), np.zeros(num_features))

    def _set(self, count: int, mean: Doubles, squares: Doubles) -> None:
        self.count, self.mean, self.squares = count, mean, squares
        spread = np.sqrt(squares / max(1, count))
        self._shift = mean.astype(np.float32)
        self._factor = (1.0 / np.where(spread > 1e-6, spread, 1.0)).astype(np.float32)

    def update(self, observations: Floats) -> None:
        """Update mean and deviation by n more observations (n, features) (Chan, Golub and LeVeque 1983).

        The squares of two sets add up to S + S' + d²·N·n / (N + n), with N and n their counts, d the distance of means.
        """
        new, mean = len(observations), observations.mean(axis=0, dtype=float)
        shift, total = mean - self.mean, self.count + new
        squares = ((observations - mean) ** 2).sum(axis=0) + shift**2 * (self.count * new / total)
        self._set(total, self.mean + shift * (new / total), self.squares + squares)

    def __call__(self, observations: Floats) -> Floats:
        """Return observations (n, features) in standard deviations from the mean, clipped at REACH, float32."""
        scaled: Floats = np.clip((observations - self._shift) * self._factor, -REACH, REACH)
        return scaled

    def to_json(self) -> dict[str, Any]:
        """Return the values as JSON can hold them."""
        return {"count": self.count, "mean": self.mean.tolist(), "squares": self.squares.tolist()}

    def load(self, values: dict[str, Any]) -> None:
        """Take over what `to_json` gave; raises KeyError, TypeError or ValueError for anything else."""
        mean, squares = (np.array(values[name], dtype=float) for name in ("mean", "squares"))
        finite = np.isfinite(mean).all() and np.isfinite(squares).all() and (squares >= 0).all()
        if mean.shape != self.mean.shape or squares.shape != mean.shape or not finite:
            raise ValueError(f"the scale of observations needs {len(self.mean)} finite means and squares")
        self._set(count_of(values["count"]), mean, squares)
