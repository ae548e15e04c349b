"""Schedules of settings during training, by step count and never by the clock: a seed must be reproducible.

`idle` names the settings that have no effect any more; it asks the very functions that training asks.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, ClassVar, Final

import numpy as np

if TYPE_CHECKING:
    from ai.agent.config import Config
    from ai.common.environment import Doubles

# Settings that define schedules, each with the one that acts in its place once it has no effect.
_SCHEDULED: Final = {
    "learning_rate": "final_learning_rate",
    "final_learning_rate": "learning_rate",
    "schedule_decisions": "final_learning_rate",
    "final_touchdown_limits": "schedule_decisions",
    "epsilon_start": "epsilon_end",
    "epsilon_end": "epsilon_start",
    "epsilon_decay": "epsilon_end",
    "epsilon_decisions": "epsilon_end",
    "epsilon_spread": "num_envs",
}


@dataclass(frozen=True)
class InForce:
    """Values of the scheduled settings in force at one moment of a run.

    Attributes:
        values: the values in force, by the name of the setting that each began as.
        idle: settings that change nothing any more, each with the one that acts, or decides, in its place.

    """

    newest_only: ClassVar = True

    values: Mapping[str, float]
    idle: Mapping[str, str]


def linear(start: float, end: float, done: int, total: int) -> float:
    """Interpolate from `start` to `end` in a straight line over `total` steps, then stay level."""
    share = min(1.0, done / total) if total > 0 else 1.0
    return start * (1.0 - share) + end * share


def geometric(start: float, end: float, factor: float, done: int) -> float:
    """Return `start` times `factor` for each of `done` steps, never below `end`."""
    return max(end, start * factor**done)


def learning_rate(config: Config, decisions: int) -> float:
    """Return the learning rate after so many decisions: it falls in a straight line over the schedule."""
    return linear(config.learning_rate, config.final_learning_rate, decisions, config.schedule_decisions)


def target_rate(config: Config, decisions: int) -> float:
    """Return the target network's update rate after so many decisions: τ falls in a straight line to a share of it."""
    fallen = linear(0.0, 1.0 - config.final_tau, decisions, config.schedule_decisions)
    return config.tau * (1.0 - fallen)  # a share of 1 leaves τ as it is, to the bit


def importance(config: Config, decisions: int) -> float:
    """Return the importance-sampling exponent β, which rises to 1 over the schedule (Schaul et al. 2016, 3.4)."""
    return linear(config.importance_exponent, 1.0, decisions, config.schedule_decisions)


def touchdown_limits(config: Config, decisions: int) -> float:
    """Return the limits of a touchdown after so many decisions, as a share of the real ones."""
    return linear(1.0, config.final_touchdown_limits, decisions, config.schedule_decisions)


def exploration(config: Config, decisions: int, episodes: int) -> float:
    """Return the share of random actions, ε, of the lander that explores least."""
    start, end = config.epsilon_start, config.epsilon_end
    start = geometric(start, end, config.epsilon_decay, episodes)
    return linear(start, end, decisions, config.epsilon_decisions) if config.epsilon_decisions else start


def exploration_of_each(config: Config, epsilon: float) -> Doubles:
    """Return the ε of each lander, (num_envs,): from `epsilon` for the first to a larger one for the last.

    As in Horgan et al. 2018, they are powers of one ε: bold landers go on finding what careful ones never try.
    """
    reach = np.linspace(1.0, 1.0 - config.epsilon_spread, config.num_envs)
    return np.asarray(epsilon**reach)


def in_force(config: Config, decisions: int, episodes: int) -> InForce:
    """Return the scheduled values in force after so many decisions and episodes."""
    values = {
        "learning_rate": learning_rate(config, decisions),
        "tau": target_rate(config, decisions),
        "epsilon_start": exploration(config, decisions, episodes),
    }
    return InForce(values, idle(config, decisions, episodes))


@lru_cache(maxsize=8)
def idle(config: Config, decisions: int = 0, episodes: int = 0) -> Mapping[str, str]:
    """Return the settings that change nothing now or later, each with the one that acts, or decides, in its place."""
    found = config.unused()
    moments = ((decisions, episodes), (decisions + 1, episodes + 1))
    for name, instead in _SCHEDULED.items():
        described = type(config).__dataclass_fields__[name].metadata
        extremes = [config.changed(**{name: described[end]}) for end in ("low", "high")]
        if all(_scheduled(extremes[0], *moment) == _scheduled(extremes[1], *moment) for moment in moments):
            found[name] = instead
    if not any(exploration_of_each(config, exploration(config, *moment)).any() for moment in moments):
        found["random_main"] = "epsilon_end"
    return found


def _scheduled(config: Config, decisions: int, episodes: int) -> tuple[float, ...]:
    """Return all scheduled values at one moment, rounded so that they can be compared."""
    each = exploration_of_each(config, exploration(config, decisions, episodes))
    corrected = importance(config, decisions) if config.prioritised else 0.0
    limits = touchdown_limits(config, decisions)
    rates = (learning_rate(config, decisions), target_rate(config, decisions))
    decided = (*rates, limits, corrected, float(each[0]), float(each[-1]))
    return tuple(round(value, 12) for value in decided)
