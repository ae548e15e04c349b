"""Metric of a trial: one number from the learning curves of its seeds.

A curve is measured without random actions on validation episodes, at fixed numbers of decisions (digits: epochs on
the images held out), so a metric is the same on a slow machine and on a fast one.
"""

from __future__ import annotations

import re
import statistics
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Self

from ai.files import Count, Share


@dataclass(frozen=True)
class Point:
    """Point of a learning curve."""

    at: Count  # decisions so far, or epochs
    success: Share | None  # of episodes that ended well, or of digits read right; None where that is not defined
    mean_return: float  # sum of rewards; for digits the share again


@dataclass(frozen=True)
class Metric:
    """What is read off a curve: "success", "return", "mean" or the "time" to a `share` of success."""

    kind: str
    share: float = 0.0

    @classmethod
    def named(cls, name: str) -> Self:
        """Return the metric of that name; raises ValueError for none."""
        if (time := re.fullmatch(r"time_to_(\d{1,3})", name)) and 0 < int(time[1]) <= 100:
            return cls("time", int(time[1]) / 100)
        if name in ("success", "accuracy", "return", "mean"):
            return cls("success" if name == "accuracy" else name)
        raise ValueError(f"--metric is success, accuracy, return, mean, or time_to_99 with any percentage; not {name}")

    @property
    def sign(self) -> int:
        """1 where less is better, -1 where more is."""
        return 1 if self.kind == "time" else -1

    def of(self, curve: Sequence[Point], budget: int, diverged: bool = False) -> float | None:
        """Return the value of one seed's curve so far, of a run of `budget`; None before the first point.

        A share that has not been reached counts as more than the whole budget: the more, the farther it was missed.
        A run that diverged has the worst value there is, or of a return the worst that was measured.
        """
        shares = [point.success or 0.0 for point in curve]
        if self.kind == "return":
            returns = [point.mean_return for point in curve]
            return (min(returns) if diverged else returns[-1]) if returns else None
        if diverged:
            return budget * (1 + self.share) if self.kind == "time" else 0.0
        if not curve:
            return None
        if self.kind == "success":
            return shares[-1]
        if self.kind == "mean":
            return statistics.fmean(shares)
        reached = (point.at for point, share in zip(curve, shares, strict=True) if share >= self.share)
        return float(next(reached, budget * (1 + self.share - max(shares))))

    def shown(self, value: float | None, budget: int) -> str:
        """Return a value as a table shows it."""
        if value is None:
            return "–"
        if self.kind == "time" and value > budget:
            return "not reached"
        kinds = {"time": ",.0f", "return": ".1f"}
        return format(value, ".3g" if abs(value) >= 1e12 else kinds.get(self.kind, ".2%"))


def median(values: Iterable[float | None]) -> float | None:
    """Return the value of a trial from those of its seeds; None if one has none."""
    every = list(values)
    known = [value for value in every if value is not None]
    return statistics.median(known) if known and len(known) == len(every) else None
