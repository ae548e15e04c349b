"""Starts of recorded flights: the ground and the environment that each begins in."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

import numpy as np

from ai.flights.recording import Recording
from ai.lander.descent import leg_of
from ai.lander.environment import LIMITS, LanderEnv
from ai.lander.ground import PADS, Ground, Pad, hilly
from ai.lander.rules import PARAMS


@lru_cache(maxsize=8)
def ground_of(seed: int, pads: int, width: float = 1.0) -> Ground:
    """Return the ground of a flight: a plain with one pad, or hills with a pad of every size.

    Pads are `width` times as wide as they usually are.
    """
    if pads == 1:
        return Ground((Pad(0.0, PARAMS.pad_top, width * PARAMS.pad_width),), base=PARAMS.ground)
    return hilly(np.random.default_rng(seed), [(width * wide, factor) for wide, factor in PADS])


def begun(start: Recording, seeds: Sequence[int] = ()) -> LanderEnv:
    """Return landers at the start of a recorded flight, one physics step to a decision.

    There is one for each of `seeds`, by default for the recording's own. A mission sets everything by itself. With
    several pads the ground is that of the first seed, so all must be equal.
    """
    seeds, easing = seeds or (start.seed,), start.easing
    if start.leg:
        return leg_of(seeds[0], start.leg).begin(start.leg.tank)
    if start.mission:
        env = easing.mission(start.mission).begin(len(seeds))
        env.limits = env.limits.in_area(start.area)
        return env
    limits = easing.limits(LIMITS).in_area(start.area)
    ground = ground_of(seeds[0], start.pads, easing.pads)
    env = LanderEnv(len(seeds), 0, start.spawn, frame_skip=1, ground=ground, limits=limits)
    for slot, seed in enumerate(seeds):  # as each would draw alone
        env.draw_from(slot, np.random.default_rng(seed).spawn(1)[0])
    env.reset()
    return env
