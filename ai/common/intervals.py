"""Confidence interval of a share."""

from __future__ import annotations

from math import sqrt


def wilson(share: float, count: int, z: float = 1.96) -> tuple[float, float]:
    """Return the interval of a share that was found in `count` trials; `z` standard deviations to each side.

    Wilson, "Probable Inference, the Law of Succession, and Statistical Inference" (1927).
    """
    middle = (share + z * z / (2 * count)) / (1 + z * z / count)
    half = z * sqrt(share * (1 - share) / count + z * z / (4 * count * count)) / (1 + z * z / count)
    return max(0.0, middle - half), min(1.0, middle + half)
