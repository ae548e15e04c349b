"""Moments of runs that never were."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

import numpy as np

from ai.training.loop import PARTS, Progress


def point(**values: Any) -> Progress:
    """Return the progress with some numbers, all others 0."""
    nothing = dict.fromkeys((item.name for item in fields(Progress)), 0.0) | {"parts": (0.0,) * len(PARTS)}
    return Progress(**{**nothing, **values})


def point_of(row: np.ndarray) -> Progress:
    """Return the progress whose numbers are a row of a history's points."""
    numbers = row[: -len(PARTS)].tolist()
    named = zip((item.name for item in fields(Progress)), numbers, strict=False)
    return point(**dict(named), parts=tuple(row[-len(PARTS) :].tolist()))
