"""Numbers that change as training goes on, by step count and never by the clock: a seed must be reproducible."""

from __future__ import annotations


def linear(start: float, end: float, done: int, total: int) -> float:
    """From `start` to `end` in a straight line over `total` steps, then level."""
    share = min(1.0, done / total) if total > 0 else 1.0
    return start * (1.0 - share) + end * share


def geometric(start: float, end: float, factor: float, done: int) -> float:
    """`start` times `factor` for each of `done` steps, never below `end`."""
    return max(end, start * factor**done)
