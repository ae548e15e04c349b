"""Ground of a flight, and the height of its surface for drawing."""

from __future__ import annotations

from functools import lru_cache
from typing import Final

import numpy as np

from ai.lander.environment import LanderEnv
from ai.lander.ground import Ground

_PROFILE_REACH: Final = 30.0  # metres to both sides for which the ground's height is cached
_PROFILE_STEP: Final = 0.02


def surface_height(env: LanderEnv, x: float) -> float:
    """Return the height in metres of the surface at x: a pad, a hill or the plain; for drawing."""
    ground, heights = _Latest.seen
    if ground is not env.ground:
        ground, heights = _Latest.seen = env.ground, _profile(env.ground)
    if env.conditions.moves:  # one pad on a plain
        x -= float(env.pad_shift[0])
    return heights[min(max(round((x + _PROFILE_REACH) / _PROFILE_STEP), 0), len(heights) - 1)]


class _Latest:
    """The ground that was asked about last, and its heights: to look it up by value takes longer than the rest."""

    seen: tuple[Ground | None, list[float]] = None, []


@lru_cache(maxsize=8)
def _profile(ground: Ground) -> list[float]:
    """Return the ground's height at even steps, cached for many look-ups per frame."""
    heights: list[float] = ground.height(np.arange(-_PROFILE_REACH, _PROFILE_REACH, _PROFILE_STEP)).tolist()
    return heights
