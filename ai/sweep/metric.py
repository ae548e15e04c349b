"""Metric of a trial: one number from the learning curves of its seeds.

A curve is measured without random actions on validation episodes, at fixed numbers of decisions (digits: epochs on
the images held out), so a metric is the same on a slow machine and on a fast one.
"""

from __future__ import annotations

import re
import statistics
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, Self

from ai.files import Count, Share

JUDGES: Final = ("median", "worst")
NAMES: Final = "success, accuracy, return, mean, or time_to_99 with any percentage"
_TIME: Final = re.compile(r"time_to_(\d{1,3})")


@dataclass(frozen=True)
class Point:
    """Point of a learning curve.

    Attributes:
        at: decisions taken so far, or epochs.
        success: share of episodes that ended well, or of digits read right, 0 to 1; None where that is not defined.
        mean_return: mean sum of rewards; for digits the share again.

    """

    at: Count
    success: Share | None
    mean_return: float


@dataclass(frozen=True)
class Metric:
    """Metric by name, such as `time_to_99`: what is read off a curve, and whether more of it is better."""

    name: str
    kind: str
    share: float = 0.0  # of a time, the success to reach

    @classmethod
    def named(cls, name: str) -> Self:
        """Return the metric of that name; raises ValueError for none."""
        if match := _TIME.fullmatch(name):
            if 0 < int(match[1]) <= 100:
                return cls(name, "time", int(match[1]) / 100)
        elif name in ("success", "accuracy", "return", "mean"):
            return cls(name, "success" if name == "accuracy" else name)
        raise ValueError(f"--metric is {NAMES}; not {name}")

    @property
    def mode(self) -> str:
        """Return "min" or "max", whichever is better."""
        return "min" if self.kind == "time" else "max"

    def of(self, curve: Sequence[Point], budget: int) -> float | None:
        """Return the value of one seed's curve so far, of a run of `budget`; None before the first point.

        A share that has not been reached counts as more than the whole budget: the more, the farther it was missed.
        """
        if not curve:
            return None
        if self.kind == "return":
            return curve[-1].mean_return
        shares = [point.success or 0.0 for point in curve]
        if self.kind == "success":
            return shares[-1]
        if self.kind == "mean":
            return statistics.fmean(shares)
        reached = [point.at for point, share in zip(curve, shares, strict=True) if share >= self.share]
        return float(reached[0]) if reached else budget * (1 + self.share - max(shares))

    def lost(self, curve: Sequence[Point], budget: int) -> float | None:
        """Return the value of a seed that diverged: the worst there is, or of a return the worst that was measured."""
        if self.kind == "return":
            return min((point.mean_return for point in curve), default=None)
        return budget * (1 + self.share) if self.kind == "time" else 0.0

    def judged(self, values: Sequence[float | None], judge: str) -> float | None:
        """Return the value of a trial from those of its seeds: their median or the worst; None if one has none."""
        known = [value for value in values if value is not None]
        if not known or len(known) < len(values):
            return None
        if judge == "median":
            return statistics.median(known)
        return max(known) if self.mode == "min" else min(known)

    def shown(self, value: float | None, budget: int) -> str:
        """Return a value as a table shows it."""
        if value is None:
            return "–"
        if self.kind == "time" and value > budget:
            return "not reached"
        if abs(value) >= 1e12:
            return f"{value:.3g}"
        if self.kind == "time":
            return f"{value:,.0f}"
        return f"{value:.1f}" if self.kind == "return" else f"{value:.2%}"
