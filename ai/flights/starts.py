"""Starts of recorded flights: the ground and the environment that each begins in."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

import numpy as np

from ai.lander.environment import LanderEnv
from ai.lander.ground import Ground, hilly
from ai.lander.missions import STARTS


@lru_cache(maxsize=8)
def ground_of(seed: int, pads: int) -> Ground:
    """Return the ground of a flight: a plain with one pad, or hills with a pad of every size."""
    return Ground.flat() if pads == 1 else hilly(np.random.default_rng(seed))


def begun(seeds: Sequence[int], spawn: str, pads: int = 1, mission: str = "") -> LanderEnv:
    """Return landers at the starts of flights, one for each seed, one physics step to a decision.

    A mission sets everything by itself. With several pads the ground is that of the first seed, so all must be equal.
    """
    if mission:
        return STARTS[mission].begin(len(seeds))
    env = LanderEnv(len(seeds), 0, spawn, frame_skip=1, ground=ground_of(seeds[0], pads))
    for slot, seed in enumerate(seeds):  # as each would draw alone
        env.draw_from(slot, np.random.default_rng(seed).spawn(1)[0])
    env.reset()
    return env
