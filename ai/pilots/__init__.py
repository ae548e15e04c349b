"""Pilots and pays of one's own: a Python file that flies, or pays, in a process of its own.

What such a file imports from here: the senses in metres, seconds and radians, the actions by name, and how a flight
can end. Each sense takes one observation (9,) or many (n, 9), and returns a number or an array (n,). `ai.pilots.own`
has what flies a file.
"""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from ai.lander.rules import CRASHED, FLYING, LANDED, OBSERVATION_SCALE, OUT

__all__ = [
    "COAST", "CRASHED", "FLYING", "LANDED", "LEFT", "MAIN", "MAIN_LEFT", "MAIN_RIGHT", "OUT", "RIGHT", "drift", "fall",
    "feet", "height", "offset", "spin", "tilt",
]  # fmt: skip

COAST, LEFT, RIGHT, MAIN, MAIN_LEFT, MAIN_RIGHT = range(6)
_SCALE: Final = OBSERVATION_SCALE.tolist()
_X, _Y, _VX, _VY, _SIN, _COS, _SPIN, _LEFT_FOOT, _RIGHT_FOOT = range(9)


def height(observation: Any) -> Any:
    """Metres from the feet down to the level of the pad."""
    return _unscaled(observation, _Y)


def offset(observation: Any) -> Any:
    """Metres to the right of the pad's middle; negative on its left."""
    return _unscaled(observation, _X)


def fall(observation: Any) -> Any:
    """Metres a second downwards; negative while it climbs."""
    return -_unscaled(observation, _VY)


def drift(observation: Any) -> Any:
    """Metres a second to the right; negative to the left."""
    return _unscaled(observation, _VX)


def tilt(observation: Any) -> Any:
    """Radians that it leans to the left; negative to the right."""
    return np.arctan2(_unscaled(observation, _SIN), _unscaled(observation, _COS))


def spin(observation: Any) -> Any:
    """Radians a second that it turns to the left; negative to the right."""
    return _unscaled(observation, _SPIN)


def feet(observation: Any) -> Any:
    """How many feet are down, 0 to 2."""
    return _unscaled(observation, _LEFT_FOOT) + _unscaled(observation, _RIGHT_FOOT)


def _unscaled(observation: Any, number: int) -> Any:
    return observation[..., number] / _SCALE[number]
