"""Settings in force at one moment of a run, and those that have no effect any more.

`idle` asks the very functions that training asks.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import ClassVar, Final

from ai.agent.schedule import exploration, exploration_of_each, importance, learning_rate, linear, target_rate
from ai.training.config import Config

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


def touchdown_limits(config: Config, decisions: int) -> float:
    """Return the limits of a touchdown after so many decisions, as a share of the real ones."""
    return linear(1.0, config.final_touchdown_limits, decisions, config.schedule_decisions)


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
    if not any(exploration_of_each(config, exploration(config, *moment), config.num_envs).any() for moment in moments):
        found["random_main"] = "epsilon_end"
    return found


def _scheduled(config: Config, decisions: int, episodes: int) -> tuple[float, ...]:
    """Return all scheduled values at one moment, rounded so that they can be compared."""
    each = exploration_of_each(config, exploration(config, decisions, episodes), config.num_envs)
    corrected = importance(config, decisions) if config.prioritised else 0.0
    limits = touchdown_limits(config, decisions)
    rates = (learning_rate(config, decisions), target_rate(config, decisions))
    decided = (*rates, limits, corrected, float(each[0]), float(each[-1]))
    return tuple(round(value, 12) for value in decided)
