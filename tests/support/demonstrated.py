"""Demonstrations of a scripted pilot."""

import numpy as np

from ai.lander.environment import LanderEnv, Outcome
from ai.lander.pilots import Pilot
from ai.training.demonstrations import Demonstration, stream


def demonstrate(pilot: Pilot, count: int, seed: int = 0, spawn: str = "random") -> list[Demonstration]:
    """Let a pilot fly until it has landed `count` times, each flight from a seed of its own, and return those.

    Raises ValueError for a pilot that crashes more than nine times out of ten.
    """
    found: list[Demonstration] = []
    seeds = range(seed, seed + 10 * count)
    env = LanderEnv(len(seeds), 0, spawn, frame_skip=4)
    for slot, own in enumerate(seeds):
        env.streams[slot] = stream(own)
    observation, flown = env.reset(), []
    while (env.outcome == Outcome.FLYING).any():
        flown.append(pilot.act(observation, held=env.actions))
        observation = env.step(flown[-1]).observation
    for slot in np.flatnonzero(env.outcome == Outcome.LANDED)[:count].tolist():
        actions = np.repeat([row[slot] for row in flown], env.frame_skip)[: env.steps[slot]]
        found.append(Demonstration(seeds[slot], tuple(actions.tolist()), spawn))
    if len(found) < count:
        raise ValueError(f"of {len(seeds)} flights, only {len(found)} landed, not {count}")
    return found
