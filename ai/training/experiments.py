"""Experiments: runs in which one thing differs greatly, beside a healthy twin of the same seed, and what came of them.

A sabotage takes one part away from a configuration, so that a run shows what it is for. Shares of training flights are
of the last hundred, with their chance moves.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, fields, is_dataclass
from typing import Any, Final, Literal

import numpy as np

from ai.files.knobs import Knobs
from ai.lander.rewards import RewardWeights
from ai.training.config import Config
from ai.training.curves import RATES, Curves, runs_away

_FACTOR: Final = 100.0  # of a rate that is far too high
Verdict = Literal["as_well", "later", "never", "runs_away"]
VERDICTS: Final[tuple[Verdict, ...]] = ("as_well", "later", "never", "runs_away")
_NEVER: Final = 0.3  # share below which it does not: near the pad, some land by chance
_GRACE: Final = 2.0  # times as long as the twin took, after which it is judged
_LATER: Final = 1.25  # times as long as the twin took, from which it came later
_WORSE: Final = 0.15  # of a share that is worse than the twin's by more than chance
_TERMINAL_ALONE: Final = {name: 0.0 for name in vars(RewardWeights()) if name != "terminal"}
_SMALLEST_MEMORY: Final = 100
_WITHOUT: Final = " without "  # in the name of a preset, before that of what is taken away

# Settings that each changes, given the base configuration.
SABOTAGES: Final[dict[str, Callable[[Config], dict[str, Any]]]] = {
    "no_replay": lambda c: {"replay_size": max(_SMALLEST_MEMORY, c.batch_size), "replay_prune": 1},
    "no_exploration": lambda _: {"epsilon_start": 0.0, "epsilon_end": 0.0, "epsilon_spread": 0.0},
    "no_shaping": lambda c: {"reward_weights": RewardWeights(**{**vars(c.reward_weights), **_TERMINAL_ALONE})},
    "short_sight": lambda _: {"discount": 0.8},
    "rate_times_100": lambda c: {name: min(1.0, _FACTOR * getattr(c, name)) for name in RATES},
    "no_normalisation": lambda _: {"layer_normalisation": False},
}


def sabotaged(config: Config, name: str) -> Config:
    """Return the configuration without the part that `name` takes away; raises KeyError for an unknown name."""
    return config.changed(**SABOTAGES[name](config), preset=f"{named(config)[0]}{_WITHOUT}{name}")


def named(config: Knobs) -> tuple[str, str]:
    """Return the name of a configuration's preset, and of the part that was taken away from it, or ""."""
    preset, _, sabotage = config.preset.partition(_WITHOUT)
    return preset, sabotage


def differences(before: Config, after: Config) -> dict[str, tuple[Any, Any]]:
    """Return both values of every setting that differs; a part of the reward by the name "reward_weights.part"."""
    found: dict[str, tuple[Any, Any]] = {}
    for item in (each for each in fields(before) if each.compare):
        old, new = getattr(before, item.name), getattr(after, item.name)
        if is_dataclass(old) and not isinstance(old, type):
            parts = zip(asdict(old).items(), asdict(new).values(), strict=True)
            found |= {f"{item.name}.{part}": (value, other) for (part, value), other in parts if value != other}
        elif old != new:
            found[item.name] = (old, new)
    return found


def verdict(healthy: Curves, other: Curves, *, failed: bool = False) -> Verdict | None:
    """Return what came of an experiment; None while it is too early to say, or its twin does not land either.

    `failed` says that its training has diverged. It has run away if its mean Q-value or its loss has.
    """
    if failed:
        return "runs_away"
    needed = healthy.landed_after()
    if min(healthy.turns, other.turns) < _GRACE * needed:
        return None
    if runs_away(other):
        return "runs_away"
    if np.nan_to_num(other.history["success_rate"]).max(initial=0.0) < _NEVER:
        return "never"
    in_time = other.landed_after() <= _LATER * needed
    return "as_well" if in_time and other.landed() >= healthy.landed() - _WORSE else "later"
