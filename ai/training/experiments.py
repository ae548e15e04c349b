"""Experiments: runs in which one knob differs greatly, beside a healthy twin from the same seed, and what came of them.

What there is to try follows from a setting's range and scale. Where an experiment is a sabotage under another name,
it is that sabotage: one part is taken away from a configuration, so that a run shows what it is for. The effect
depends on the configuration: the words that go with these names were measured on one preset, with seeds 0 and 1, over
150,000 decisions each. Shares of training flights are of the last hundred, with their chance moves.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, field, fields, is_dataclass
from typing import Any, Final, Literal, NamedTuple

import numpy as np

from ai.lander.rewards import RewardWeights
from ai.training.config import Config, idle
from ai.training.hints import RULES, RecentCurves
from ai.training.history import History

Kind = Literal["times", "divided", "value", "sabotage"]
FACTOR: Final = 100.0  # on a logarithmic scale
WEIGHT_FACTOR: Final = 10.0  # of a part of the reward
_LEAST_FACTOR: Final = 3.0  # below which a difference shows nothing
_HEAVY: Final = ("num_envs",)  # more of these take the machine, not the learner, to its limits
# The experiments that a sabotage is, by the setting and its new value as the modern preset has it.
_SABOTAGES: Final = {
    ("learning_rate", "times"): "rate_times_100",
    ("epsilon_end", 0.0): "no_exploration",
    ("discount", 0.8): "short_sight",
    ("n_step", 1): "no_n_step",
    ("num_envs", 1): "one_lander",
    ("layer_normalisation", False): "no_normalisation",
    ("optimizer", "sgd"): "plain_steps",
}
Verdict = Literal["as_well", "later", "never", "runs_away"]
VERDICTS: Final[tuple[Verdict, ...]] = ("as_well", "later", "never", "runs_away")
LANDS: Final = 0.8  # share of a hundred flights from which a run counts as one that lands
_NEVER: Final = 0.3  # share below which it does not: near the pad, some land by chance
_GRACE: Final = 1.5  # times as long as the twin took, after which it is judged
_LATER: Final = 1.25  # times as long as the twin took, from which it came later
_WORSE: Final = 0.15  # of a share that is worse than the twin's by more than chance
_RUN_AWAY: Final = ("q_runs_away", "loss_explodes")  # rules of hints
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


@dataclass(frozen=True)
class Experiment:
    """One difference between two runs.

    Attributes:
        kind: how the setting changes: by a factor, to a value, or as a sabotage says.
        amount: the factor, or the value; None for a sabotage that is no knob's.
        changes: the new settings, by the fields of Config.
        sabotage: name of the sabotage that it is; empty if none.

    """

    kind: Kind
    amount: Any
    changes: Mapping[str, Any] = field(hash=False)
    sabotage: str = ""

    def applied(self, config: Config) -> Config:
        """Return the configuration with this difference; raises ValueError if it is not valid there."""
        return config.changed(**self.changes)


def experiments(config: Config, name: str) -> list[Experiment]:
    """Return what can be tried on a knob of a configuration, which is named as `Config.turned` does.

    A number on a logarithmic scale can be a hundred times more or less; any other can be at either end of its range,
    a part of the reward 0 or ten times more, and a switch or a choice anything else.
    """
    head, _, part = name.partition(".")
    if head in idle(config):  # it would change nothing
        return []
    found = _of_weight(config, part) if part else _of_field(config, head)
    return [each for each in found if _is_valid(config, each)]


def experiment_of(config: Config, sabotage: str) -> Experiment:
    """Return the experiment that is a sabotage; raises KeyError for an unknown name."""
    return Experiment("sabotage", None, SABOTAGES[sabotage](config), sabotage)


def differences(before: Config, after: Config) -> dict[str, tuple[Any, Any]]:
    """Return both values of every setting that differs; a part of the reward by the name "reward_weights.part"."""
    found: dict[str, tuple[Any, Any]] = {}
    for item in fields(before):
        old, new = getattr(before, item.name), getattr(after, item.name)
        if is_dataclass(old) and not isinstance(old, type):
            parts = zip(asdict(old).items(), asdict(new).values(), strict=True)
            found |= {f"{item.name}.{part}": (value, other) for (part, value), other in parts if value != other}
        elif old != new:
            found[item.name] = (old, new)
    return found


def _of_weight(config: Config, part: str) -> list[Experiment]:
    weights = asdict(config.reward_weights)
    if not weights[part]:
        return []

    def turned(value: float) -> dict[str, Any]:
        return {"reward_weights": RewardWeights(**{**weights, part: value})}

    return [
        Experiment("value", 0.0, turned(0.0)),
        Experiment("times", WEIGHT_FACTOR, turned(WEIGHT_FACTOR * weights[part])),
    ]


def _of_field(config: Config, name: str) -> list[Experiment]:
    item = next(item for item in fields(config) if item.name == name)
    described, value = item.metadata, getattr(config, name)
    if item.type == "bool":
        return [_to(config, name, not value)]
    if described["choices"]:
        others = [each for each in described["choices"] if each != value]
        return [_to(config, name, each) for each in others] if len(others) <= 2 else []
    if isinstance(value, tuple) or described["low"] is None:
        return []
    low, high = described["low"], described["high"]
    if described["log"] and value:
        return _by_factors(config, name, low, high)
    whole = item.type == "int"
    ends = [end for end in (low, high) if end != value and (end < value or name not in _HEAVY)]
    return [_to(config, name, int(end) if whole else float(end)) for end in ends]


def _by_factors(config: Config, name: str, low: float, high: float) -> list[Experiment]:
    """Return the hundredth and the hundredfold, or as much of either as the range allows."""
    value = getattr(config, name)
    less, more = (
        round(end) if isinstance(value, int) else float(f"{end:.6g}")
        for end in (max(low, value / FACTOR), min(high, value * FACTOR))
    )
    factors: tuple[tuple[Kind, float, float], ...] = (("divided", less, value / less), ("times", more, more / value))
    return [_to(config, name, end, kind, factor) for kind, end, factor in factors if factor >= _LEAST_FACTOR]


def _to(config: Config, name: str, value: Any, kind: Kind = "value", amount: Any = None) -> Experiment:
    """Return the experiment of one setting, or the sabotage that it is."""
    amount = value if amount is None else amount
    sabotage = _SABOTAGES.get((name, "times" if kind == "times" else value), "")
    changes = SABOTAGES[sabotage](config) if sabotage else {}
    if changes.get(name) == value:
        return Experiment(kind, amount, changes, sabotage)
    return Experiment(kind, amount, {name: value})


def _is_valid(config: Config, experiment: Experiment) -> bool:
    try:
        return experiment.applied(config) != config
    except ValueError:
        return False


class Flown(NamedTuple):
    """Curves of a run, and the configuration it was flown with."""

    history: History
    config: Config

    @property
    def turns(self) -> float:
        """Decisions of each lander so far."""
        return float(self.history["decisions"][-1]) / self.config.num_envs if len(self.history) else 0.0

    @property
    def landed(self) -> float:
        """Share of the last hundred flights that landed; 0 before any has ended."""
        return self.landed_at(-1)

    def landed_at(self, row: int) -> float:
        """Return that share at a row of the history."""
        return float(np.nan_to_num(self.history["success"][row])) if len(self.history) else 0.0

    def landed_after(self) -> float:
        """Decisions of each lander until a hundred flights landed as `LANDS` asks; infinite if they never did."""
        reached = np.flatnonzero(self.history["success"] >= LANDS)
        return float(self.history["decisions"][reached[0]]) / self.config.num_envs if len(reached) else float("inf")


def verdict(healthy: Flown, other: Flown, *, failed: bool = False) -> Verdict | None:
    """Return what came of an experiment so far; None while it is too early to say, or its twin does not land either.

    `failed` says that its training has diverged. It has run away if its mean Q-value or its loss has: see the hints.
    """
    if failed or (len(other.history) and _has_run_away(other)):
        return "runs_away"
    needed = healthy.landed_after()
    if healthy.turns < _GRACE * needed:
        return None
    if np.nan_to_num(other.history["success"]).max(initial=0.0) < _NEVER:
        return "never"
    in_time = other.landed_after() <= _LATER * needed
    return "as_well" if in_time and other.landed >= healthy.landed - _WORSE else "later"


def judged_at(healthy: Flown, other: Flown) -> float:
    """Return the decisions from which an experiment is judged; infinite while its twin does not land."""
    return _GRACE * healthy.landed_after() * other.config.num_envs


def _has_run_away(flown: Flown) -> bool:
    run = RecentCurves(flown.history, flown.config)
    return any(rule.holds(run) for rule in RULES if rule.name in _RUN_AWAY)
