"""Pilots and pays of one's own: a Python file that flies, or pays, in a process of its own.

What such a file imports from here: the senses in metres, seconds and radians, the actions by name, and how a flight
can end. `ai.pilots.own` has what flies a file.
"""

from ai.lander.rules import CRASHED, FLYING, LANDED, OUT
from ai.pilots.senses import (
    COAST,
    LEFT,
    MAIN,
    MAIN_LEFT,
    MAIN_RIGHT,
    RIGHT,
    drift,
    fall,
    feet,
    height,
    offset,
    spin,
    tilt,
)

__all__ = [
    "COAST", "CRASHED", "FLYING", "LANDED", "LEFT", "MAIN", "MAIN_LEFT", "MAIN_RIGHT", "OUT", "RIGHT", "drift", "fall",
    "feet", "height", "offset", "spin", "tilt",
]  # fmt: skip
