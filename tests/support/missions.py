"""How a network flies a mission: from its own start, and from starts that differ from it a little."""

import numpy as np

from ai.agent.agent import DeepQAgent
from ai.lander.environment import LanderEnv, Outcome
from ai.lander.missions import Mission

REACH = np.array([0.5, 0.5, 0.2, 0.2, 0.05, 0.05])


def near(mission: Mission, count: int) -> LanderEnv:
    """Landers that begin near the mission's own start; the first begins at it."""
    env = mission.begin(count, frame_skip=4)
    away = REACH * np.random.default_rng(0).uniform(-1, 1, (count, 6))
    away[0] = 0.0
    env.place(np.ones(count, dtype=bool), np.array(mission.start) + away)
    return env


def fly(agent: DeepQAgent, mission: Mission, count: int) -> tuple[np.ndarray, ...]:
    """Outcome, cause, fuel and seconds of `count` flights, (count,) each; the first is from the mission's own start."""
    env = near(mission, count)
    observation = env.observe()
    while (env.outcome == Outcome.FLYING).any():
        observation = env.step(agent.act(observation, held=env.actions)).observation
    return env.outcome, env.cause, env.fuel, env.time
