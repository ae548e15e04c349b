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
from ai.training.history import History, Point, SettingChange

_MADE_WITH = PRESETS | {"modern": Config()}  # recorded before modern learned as it does now
FILE = Path(__file__).parents[1] / "ai" / "training" / "broken_runs.npz"


@dataclass
class Recorded:
    """A run as its history was at one moment, with what was known of its network."""

    history: History
    config: Config
    dead_share: float | None = None
    clipped_share: float | None = None


@cache
def _file() -> tuple[dict[str, Any], dict[str, np.ndarray]]:
    with np.load(FILE, allow_pickle=False) as arrays:
        told = json.loads(str(arrays["described"]))
        return told, {name: arrays[name].T.astype(float) for name in told["cases"]}


def names() -> list[str]:
    """The names of all recordings."""
    return list(_file()[0]["cases"])


def growing(name: str) -> Iterator[Recorded]:
    """A recording as it grew, point by point; the history is the same object each time."""
    told, tables = _file()
    case = told["cases"][name]
    config = Config.from_json(_MADE_WITH[case["preset"]].to_json() | Config.renamed(case["changes"]))
    turns, history = [tuple(turn) for turn in case["turns"]], History()
    history.reward_scale = config.reward_scale
    for row in tables[name]:
        point = dict(zip(told["columns"], row.tolist(), strict=True))
        shares = [None if np.isnan(share) else share for share in (point.pop("dead_share"), point.pop("clipped_share"))]
        while turns and point["decisions"] > turns[0][0]:
            at, knob, value = turns.pop(0)
            turned = config.turned(knob, value)
            history.append(SettingChange(at, knob, attrgetter(knob)(config), attrgetter(knob)(turned)))
            config = turned
        history.append(Point(**point, steps_per_second=0.0, landed=point["success"]))
        yield Recorded(history, config, *shares)


def recorded(name: str, until: float = np.inf) -> Recorded:
    """A recording, whole or as it was after so many decisions."""
    for each in growing(name):
        if each.history["decisions"][-1] >= until:
            break
    return each
