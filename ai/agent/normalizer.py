"""Running normalisation of observations, whatever their units."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from ai.environment import Doubles, Floats
from ai.files.reading import count_of

REACH: Final = 10.0  # standard deviations from the mean at which values are clipped
_LEAST: Final = 1e-30  # of a deviation that is one: its inverse is a number in single precision
_ROUNDING: Final = 1e-7  # of a number in single precision
_MOST: Final = float(np.finfo(np.float32).max)


class Normalizer:
    """Running mean and standard deviation, which scale observations to mean 0 and standard deviation 1.

    Units may be any: everything is measured from an `origin`, the first observation, in double precision. What is
    `measured` so can be kept in single precision without loss, however far off the environment's own zero is.

    Attributes:
        origin: (features,) in the environment's units.
        count: observations so far.
        mean: (features,) of them, from the origin.
        squares: (features,) summed squares of their distances from the mean.

    """

    def __init__(self, num_features: int) -> None:
        self.origin: Doubles = np.zeros(num_features)
        self._set(0, np.zeros(num_features), np.zeros(num_features))

    def _set(self, count: int, mean: Doubles, squares: Doubles) -> None:
        self.count, self.mean, self.squares = count, mean, squares
        spread = np.sqrt(squares / max(1, count))
        known = (spread > _LEAST) & (spread > _ROUNDING * np.abs(mean))  # else it is the same all the time
        self._shift = mean.astype(np.float32)
        self._factor = (1.0 / np.where(known, spread, 1.0)).astype(np.float32)

    def begin(self, observations: NDArray[Any]) -> None:
        """Measure from the first of these observations (n, features), if there were none before."""
        if self.count == 0:
            self.origin = np.array(observations[0], dtype=float)

    def measured(self, observations: NDArray[Any]) -> Floats:
        """Return observations (n, features) from the origin, float32."""
        measured: Floats = np.clip(observations - self.origin, -_MOST, _MOST).astype(np.float32)
        return measured

    def update(self, measured: Floats) -> None:
        """Update mean and deviation by n more observations (n, features) (Chan, Golub and LeVeque 1983).

        The squares of two sets add up to S + S' + d²·N·n / (N + n), with N and n their counts, d the distance of means.
        """
        new, mean = len(measured), measured.mean(axis=0, dtype=float)
        shift, total = mean - self.mean, self.count + new
        squares = ((measured - mean) ** 2).sum(axis=0) + shift**2 * (self.count * new / total)
        self._set(total, self.mean + shift * (new / total), self.squares + squares)

    def scaled(self, measured: Floats) -> Floats:
        """Return what was measured in standard deviations from the mean, clipped at REACH, float32."""
        scaled: Floats = np.clip((measured - self._shift) * self._factor, -REACH, REACH)
        return scaled

    def __call__(self, observations: NDArray[Any]) -> Floats:
        """Return observations (n, features) in standard deviations from the mean, clipped at REACH, float32."""
        return self.scaled(self.measured(observations))

    def to_json(self) -> dict[str, Any]:
        """Return the values as JSON can hold them."""
        parts = {"origin": self.origin, "mean": self.mean, "squares": self.squares}
        return {"count": self.count} | {name: numbers.tolist() for name, numbers in parts.items()}

    def load(self, values: dict[str, Any]) -> None:
        """Take over what `to_json` gave; raises KeyError, TypeError or ValueError for anything else."""
        parts = [np.array(values[name], dtype=float) for name in ("origin", "mean", "squares")]
        fits = all(part.shape == self.mean.shape and np.isfinite(part).all() for part in parts)
        if not fits or (parts[2] < 0).any():
            raise ValueError(f"the scale of observations needs {len(self.mean)} finite origins, means and squares")
        self.origin = parts[0]
        self._set(count_of(values["count"]), *parts[1:])
