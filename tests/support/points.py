"""Moments of runs that never were."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields, replace
from typing import Any

import numpy as np

from ai.training.history import History
from ai.training.loop import PARTS, Progress


def point(**values: Any) -> Progress:
    """Return the progress with some numbers, all others 0."""
    nothing = dict.fromkeys((item.name for item in fields(Progress)), 0.0) | {"parts": (0.0,) * len(PARTS)}
    return Progress(**{**nothing, **values})


HEALTHY = point(success_rate=0.97, mean_return=100.0, loss=0.05, mean_q=0.7, epsilon=0.05, crashed=0.02, timed_out=0.01)
Curve = Callable[[float], Progress]  # of the share of the run that is over


def history(curve: Curve, points: int = 400, decisions: float = 400_000, seconds: float = 40.0) -> History:
    """Return the history of a run whose points follow a curve."""
    made = History()
    for number in range(1, points + 1):
        share = number / points
        moment = {"seconds": share * seconds, "decisions": share * decisions, "episodes": share * decisions / 150}
        made.append(replace(curve(share), **moment))
    return made


def later(when: float, **values: Any) -> Curve:
    """Healthy until a share of the run is over."""
    return lambda share: replace(HEALTHY, **values) if share > when else HEALTHY


def point_of(row: np.ndarray) -> Progress:
    """Return the progress whose numbers are a row of a history's points."""
    numbers = row[: -len(PARTS)].tolist()
    named = zip((item.name for item in fields(Progress)), numbers, strict=False)
    return point(**dict(named), parts=tuple(row[-len(PARTS) :].tolist()))
