"""Confidence intervals of a share and of a mean."""

from __future__ import annotations

from collections.abc import Sequence
from math import sqrt
from statistics import mean, stdev
from typing import Final

# Student's t of a two-sided 95 % interval, by degrees of freedom from 1 on.
_T: Final = (12.71, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201, 2.179, 2.160, 2.145, 2.131)


def wilson(share: float, count: int) -> tuple[float, float]:
    """Return the 95 % interval of a share that was found in `count` trials.

    Wilson, "Probable Inference, the Law of Succession, and Statistical Inference" (1927).
    """
    z = 1.96  # standard deviations to each side
    middle = (share + z * z / (2 * count)) / (1 + z * z / count)
    half = z * sqrt(share * (1 - share) / count + z * z / (4 * count * count)) / (1 + z * z / count)
    return max(0.0, middle - half), min(1.0, middle + half)


def mean_of_shares(shares: Sequence[float]) -> tuple[float, float, float]:
    """Return the mean of two or more shares, and its 95 % interval within 0 to 1 (Student's t)."""
    half = _T[min(len(shares) - 1, len(_T)) - 1] * stdev(shares) / sqrt(len(shares))
    return mean(shares), max(0.0, mean(shares) - half), min(1.0, mean(shares) + half)
