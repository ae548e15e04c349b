"""Experiments: runs in which one thing differs greatly, beside a healthy twin of the same seed, and what came of them.

A sabotage takes one part away from a configuration, so that a run shows what it is for. Shares of training flights are
of the last hundred, with their chance moves.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, fields, is_dataclass
from typing import Any, Final, Literal

from ai.files.knobs import Knobs
from ai.lander.rewards import RewardWeights
from ai.training.config import Config
from ai.training.curves import LANDS, RATES, Curves

_FACTOR: Final = 100.0  # of a rate that is far too high
Verdict = Literal["most", "some", "few"]  # of a hundred flights land: `LANDS` or more, less, less than `_FEW`
VERDICTS: Final[tuple[Verdict, ...]] = ("most", "some", "few")
_FEW: Final = 0.2
_GRACE: Final = 2.0  # times as long as the twin took, after which it is judged
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

    `failed` says that its training has diverged: it flies no more.
    """
    if failed:
        return "few"
    if min(healthy.turns, other.turns) < _GRACE * healthy.landed_after():
        return None
    landed = round(other.landed(), 2)  # as it is written
    return "most" if landed >= LANDS else "some" if landed >= _FEW else "few"
