"""Schedules of settings during training, by step count and never by the clock: a seed must be reproducible."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from ai.agent.config import AgentConfig
    from ai.environment import Doubles


def linear(start: float, end: float, done: int, total: int) -> float:
    """Interpolate from `start` to `end` in a straight line over `total` steps, then stay level."""
    share = min(1.0, done / total) if total > 0 else 1.0
    return start * (1.0 - share) + end * share


def learning_rate(config: AgentConfig, decisions: int) -> float:
    """Return the learning rate after so many decisions: it falls in a straight line over the schedule."""
    return linear(config.learning_rate, config.final_learning_rate, decisions, config.schedule_decisions)


def target_rate(config: AgentConfig, decisions: int) -> float:
    """Return the target network's update rate after so many decisions: τ falls in a straight line to a share of it."""
    fallen = linear(0.0, 1.0 - config.final_tau, decisions, config.schedule_decisions)
    return config.tau * (1.0 - fallen)  # a share of 1 leaves τ as it is, to the bit


def importance(config: AgentConfig, decisions: int) -> float:
    """Return the importance-sampling exponent β, which rises to 1 over the schedule (Schaul et al. 2016, 3.4)."""
    return linear(config.importance_exponent, 1.0, decisions, config.schedule_decisions)


def exploration(config: AgentConfig, decisions: int, episodes: int) -> float:
    """Return the share of random actions, ε, of the lander that explores least.

    It falls by a factor with each episode, in a straight line with decisions, or both: the line then starts at what the
    factor has left. Never does it fall below `epsilon_end`.
    """
    end = config.epsilon_end
    start = max(end, config.epsilon_start * config.epsilon_decay**episodes)
    return linear(start, end, decisions, config.epsilon_decisions) if config.epsilon_decisions else start


def exploration_of_each(config: AgentConfig, epsilon: float, count: int) -> Doubles:
    """Return the ε of each lander, (count,): from `epsilon` for the first to a larger one for the last.

    Lander i of `count` has ε to the power of 1 - spread · i / (count - 1). As in Horgan et al. 2018, they are powers of
    one ε: bold landers go on finding what careful ones never try.
    """
    reach = np.linspace(1.0, 1.0 - config.epsilon_spread, count)
    return np.asarray(epsilon**reach)
