"""Ablations: named ways to take one part away from a configuration, so that a run shows what it is for.

The effect depends on the base configuration: the words that go with these names were measured on one preset, with
seeds 0 and 1, over 150,000 decisions each. Shares of training flights are of the last hundred, with their chance
moves.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

from ai.lander.rewards import RewardWeights
from ai.training.config import Config

MEASURED: Final = "modern"  # the preset
_TERMINAL_ALONE: Final = {name: 0.0 for name in vars(RewardWeights()) if name != "terminal"}
_SMALLEST_MEMORY: Final = 100

# Settings that each changes, given the base configuration.
SABOTAGES: Final[dict[str, Callable[[Config], dict[str, Any]]]] = {
    "no_target": lambda _: {"target_update_interval": 1, "tau": 1.0},
    "no_replay": lambda c: {"replay_size": max(_SMALLEST_MEMORY, c.batch_size), "replay_prune": 1},
    "no_shaping": lambda c: {"reward_weights": RewardWeights(**{**vars(c.reward_weights), **_TERMINAL_ALONE})},
    "no_exploration": lambda _: {"epsilon_start": 0.0, "epsilon_end": 0.0, "epsilon_spread": 0.0},
    "rate_times_100": lambda c: {
        "learning_rate": min(1.0, 100 * c.learning_rate),
        "final_learning_rate": min(1.0, 100 * c.final_learning_rate),
    },
    "no_n_step": lambda _: {"n_step": 1},
    "one_lander": lambda _: {"num_envs": 1},
    "uniform_actions": lambda _: {"random_main": 0.5},
    "short_sight": lambda _: {"discount": 0.8},
    "no_practice": lambda _: {"spawn": "random"},
    "plain_steps": lambda _: {"optimizer": "sgd"},
    "no_normalisation": lambda _: {"layer_normalisation": False},
}


def sabotaged(config: Config, name: str) -> Config:
    """Return the configuration without the part that `name` takes away; raises KeyError for an unknown name."""
    return config.changed(**SABOTAGES[name](config))
