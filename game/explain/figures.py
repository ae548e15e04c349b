"""Figures as they are written: points of reward with their sign, numbers of a network briefly, shares in percent."""

from __future__ import annotations

import math
from typing import Final

from ai.lander.environment import OBSERVATION_SCALE
from game.core import texts
from game.ui import plotting

_SMALL: Final = 1e-4
_MOST_DIGITS: Final = 12


def decimal(value: float, digits: int, sign: str = "") -> str:
    """Write a number with so many digits after the point, its minus as long as a plus; 0 has none."""
    return f"{round(value, digits) + 0.0:{sign}.{digits}f}".replace("-", "−")


def points(value: float, digits: int = 2) -> str:
    """Write points of reward with their sign: +12.30."""
    if not math.isfinite(value):
        return "–"
    if abs(value) >= 1e5:
        return ("+" if value > 0 else "") + plotting.compact(value)
    return decimal(value, digits, "+")


def percent(share: float, digits: int = 0) -> str:
    """Write a share in percent, with so many digits after the point: 35 %."""
    return f"{decimal(100 * share, digits)} %"


def what_is_sensed(feature: int) -> str:
    """Say what an input of the lander's networks is, and its unit."""
    return texts.EXPLAIN_INPUTS[feature].format(unit=1 / OBSERVATION_SCALE[feature])


def number(value: float) -> str:
    """Write a number of a network with the digits that tell it from its neighbours; never as a power of ten."""
    size = abs(value)
    if 0 < size < 10.0**-_MOST_DIGITS:
        return "~0"
    if math.isfinite(value) and 0 < size < _SMALL:
        return decimal(value, min(1 - math.floor(math.log10(size)), _MOST_DIGITS))
    return plotting.compact(value, 4)
