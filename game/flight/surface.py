"""Ground of a flight, and the height of its surface for drawing."""

from __future__ import annotations

from functools import lru_cache
from typing import Final

import numpy as np

from ai.lander.environment import LanderEnv
from ai.lander.ground import PADS, Ground, Pad, hilly
from ai.lander.rules import PARAMS

_PROFILE_REACH: Final = 30.0  # metres to both sides for which the ground's height is cached
_PROFILE_STEP: Final = 0.02


@lru_cache(maxsize=8)
def ground_of(seed: int, pads: int, width: float = 1.0) -> Ground:
    """Return the ground of a flight: a plain with one pad, or hills with a pad of every size.

    Pads are `width` times as wide as they usually are.
    """
    if pads == 1:
        return Ground((Pad(0.0, PARAMS.pad_top, width * PARAMS.pad_width),), base=PARAMS.ground)
    return hilly(np.random.default_rng(seed), [(width * wide, factor) for wide, factor in PADS])


def surface_height(env: LanderEnv, x: float) -> float:
    """Return the height in metres of the surface at x: a pad, a hill or the plain; for drawing."""
    heights = _profile(env.ground)
    if env.conditions.moves:  # one pad on a plain
        x -= float(env.pad_shift[0])
    return heights[min(max(round((x + _PROFILE_REACH) / _PROFILE_STEP), 0), len(heights) - 1)]


@lru_cache(maxsize=8)
def _profile(ground: Ground) -> list[float]:
    """Return the ground's height at even steps, cached for many look-ups per frame."""
    heights: list[float] = ground.height(np.arange(-_PROFILE_REACH, _PROFILE_REACH, _PROFILE_STEP)).tolist()
    return heights
