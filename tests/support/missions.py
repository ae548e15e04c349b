"""How a network flies a mission: from its own start, and from starts that differ from it a little."""

from pathlib import Path

import numpy as np

from ai.agent.agent import DeepQAgent
from ai.lander.environment import LanderEnv, Outcome
from ai.lander.missions import Mission
from ai.lander.pilots import Pilot

REACH = np.array([0.5, 0.5, 0.2, 0.2, 0.05, 0.05])


def near(mission: Mission, count: int) -> LanderEnv:
    """Landers that begin near the mission's own start; the first begins at it."""
    env = mission.begin(count, frame_skip=4)
    away = REACH * np.random.default_rng(0).uniform(-1, 1, (count, 6))
    away[0] = 0.0
    env.place(np.ones(count, dtype=bool), np.array(mission.start) + away)
    return env


def pilots(folder: Path) -> dict[bool, DeepQAgent]:
    """Networks that come with the game, in `folder`, by whether they fly elsewhere than on the moon."""
    return {False: DeepQAgent.load(folder / "modern"), True: DeepQAgent.load(folder / "anywhere")}


def fly(pilot: Pilot, mission: Mission, count: int) -> tuple[np.ndarray, ...]:
    """Outcome, cause, fuel and seconds of `count` flights, (count,) each; the first is from the mission's own start."""
    env = near(mission, count)
    return flown(pilot, env), env.cause, env.fuel, env.time


def flown(pilot: Pilot, env: LanderEnv) -> np.ndarray:
    """Outcome of every flight of `env`, which have begun, (n,): the pilot sees of it what it can read."""
    while (env.outcome == Outcome.FLYING).any():
        env.fly(pilot.act(env.observe_for(pilot), held=env.actions))
    return env.outcome
