"""Recordings of real runs, healthy and broken, as benchmarks/broken_runs.py made them."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from operator import attrgetter
from pathlib import Path
from typing import Any

import numpy as np

from ai.training.config import PRESETS, Config
from ai.training.history import Checkpoint, History, SettingChange
from tests.support.points import point as moment

_RECORDED = PRESETS["modern"].changed(  # before modern learned as it does now
    learning_rate=2e-3, schedule_decisions=600_000, n_step=10, batch_size=256, gradient_steps=12, activation="relu",
    target_judges=True, double=True, final_tau=1.0, epsilon_decisions=40_000, spawn="thorough",
)  # fmt: skip
_MADE_WITH = PRESETS | {"modern": _RECORDED}
FILE = Path(__file__).parents[1] / "ai" / "training" / "broken_runs.npz"


@dataclass
class Recorded:
    """A run as its history was at one moment."""

    history: History
    config: Config


@cache
def _file() -> tuple[list[str], dict[str, tuple[dict[str, Any], np.ndarray]]]:
    """Names of the columns; every case with its table, by its name."""
    with np.load(FILE, allow_pickle=False) as arrays:
        described = json.loads(str(arrays["described"]))
        return described["columns"], {
            name: (case, arrays[name].T.astype(float)) for name, case in described["cases"].items()
        }


def names() -> list[str]:
    """The names of all recordings."""
    return list(_file()[1])


def turns(name: str) -> list[tuple[int, str, Any]]:
    """When which knob was turned to what."""
    return [tuple(turn) for turn in _file()[1][name][0]["turns"]]


def growing(name: str) -> Iterator[Recorded]:
    """A recording as it grew, point by point; the history is the same object each time."""
    columns, cases = _file()
    case, table = cases[name]
    config = Config.from_json(_MADE_WITH[case["preset"]].to_json() | case["changes"])
    left, history, checkpoint_at = turns(name), History(), 0.0
    history.reward_scale = config.reward_scale
    for row in table:
        point = dict(zip(columns, row.tolist(), strict=True))
        while left and point["decisions"] > left[0][0]:
            at, knob, value = left.pop(0)
            turned = config.turned(knob, value)
            history.append(SettingChange(at, knob, attrgetter(knob)(config), attrgetter(knob)(turned)))
            config = turned
        if point["decisions"] >= checkpoint_at:
            at, success = (int(point["decisions"]), point["success_rate"]) if checkpoint_at else (0, 0.0)
            history.append(Checkpoint(point["seconds"], at, success, np.zeros(3, np.float32)))
            checkpoint_at = max(point["decisions"] + 10_240, 2_500.0) if checkpoint_at else 2_500.0
        history.append(moment(**point))
        yield Recorded(history, config)


def recorded(name: str, until: float = np.inf) -> Recorded:
    """A recording, whole or as it was after so many decisions."""
    for each in growing(name):
        if each.history["decisions"][-1] >= until:
            break
    return each
