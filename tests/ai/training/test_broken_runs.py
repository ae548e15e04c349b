"""The rules of the hints against recordings of real runs: see benchmarks/broken_runs.py, which made them."""

from __future__ import annotations

import json
from dataclasses import dataclass
from functools import cache
from operator import attrgetter
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from ai.training.config import PRESETS, Config, idle
from ai.training.hints import Adviser, Hint, RecentCurves
from ai.training.history import REVERTED, Checkpoint, History, Point, SettingChange

FILE = Path(__file__).with_name("broken_runs.npz")
MADE_WITH = PRESETS | {"modern": Config()}  # recorded before modern learned as it does now


@dataclass(frozen=True)
class Recording:
    config: Config
    table: np.ndarray  # (points, columns)
    turns: list[tuple[int, str, Any]]


@cache
def recordings() -> tuple[list[str], dict[str, Recording]]:
    """Return the names of the columns, and every run by name."""
    with np.load(FILE, allow_pickle=False) as arrays:
        told = json.loads(str(arrays["described"]))
        return told["columns"], {
            " ".join(map(Config.name_now, name.split())): Recording(
                config_of(case), arrays[name].T.astype(float), [tuple(turn) for turn in case["turns"]]
            )
            for name, case in told["cases"].items()
        }


def config_of(case: dict[str, Any]) -> Config:
    return Config.from_json(MADE_WITH[case["preset"]].to_json() | Config.renamed(case["changes"]))


@dataclass
class Watched:
    """What an adviser said of a run: each hint once, with the seconds at which it came."""

    hints: list[tuple[float, Hint]]
    config: Config

    @property
    def names(self) -> list[str]:
        return [hint.name for _, hint in self.hints]


def watch(name: str) -> Watched:
    """Let an adviser see a recording grow, as the game does."""
    columns, runs = recordings()
    run = runs[name]
    config, history, adviser = run.config, History(), Adviser(run.config)
    said, turns = Watched([], config), [*run.turns]
    history.append(Checkpoint(0.0, 0, 0.0, np.zeros(3, np.float32)))
    checkpoint_at = 2_500.0
    for row in run.table:
        told = dict(zip(columns, row.tolist(), strict=True))
        shares = [told.pop(name) for name in ("dead_share", "clipped_share")]
        while turns and told["decisions"] > turns[0][0]:
            at, knob, value = turns.pop(0)
            new = config.turned(knob, value)
            history.append(SettingChange(at, knob, attrgetter(knob)(config), attrgetter(knob)(new)))
            config = new
        if told["decisions"] >= checkpoint_at:
            history.append(
                Checkpoint(told["seconds"], int(told["decisions"]), told["success"], np.zeros(3, np.float32))
            )
            checkpoint_at = told["decisions"] + 10_240
        history.append(Point(**told, steps_per_second=0.0, landed=told["success"]))
        hint = adviser.advise(history, config, *(None if np.isnan(share) else share for share in shares))
        if hint and (not said.hints or said.hints[-1][1] != hint):
            said.hints.append((told["seconds"], hint))
    said.config = config
    return said


def check_remedies(name: str, said: Watched) -> None:
    """Each remedy changes a knob from a value that the run had, and one that acts."""
    run = recordings()[1][name]
    settings = [run.config, *(run.config.turned(turn[1], turn[2]) for turn in run.turns)]
    for knob, value in (item for _, hint in said.hints for item in hint.remedy.items()):
        assert any(attrgetter(knob)(config) != value for config in settings), knob
        assert knob not in idle(run.config, 1, 1), knob


def test_the_recordings_are_real_and_small():
    columns, runs = recordings()
    assert FILE.stat().st_size < 300_000
    assert sum(name.startswith("modern") for name in runs) > 30
    assert sum(name.startswith("classic") for name in runs) > 12
    for run in runs.values():
        assert (np.diff(run.table[:, columns.index("decisions")]) > 0).all()


HEALTHY = ("modern healthy", "modern healthy, another seed", "classic healthy")


@pytest.mark.parametrize("name", HEALTHY)
def test_nothing_is_said_of_a_healthy_run(name: str):
    assert watch(name).names == []


TOO_HIGH = (
    "modern rates 1",
    "modern rates 0.3",
    "modern rates 0.1",
    "modern learning_rate 1",
    "modern sabotage rate_times_100",
    "classic rates 1",
    "classic rates 0.3",
    "classic rates 0.1",
    "classic learning_rate 1",
)


@pytest.mark.parametrize("name", TOO_HIGH)
def test_a_rate_that_is_too_high_is_named_and_nothing_else_is_blamed(name: str):
    said = watch(name)
    assert set(said.names) == {"rate_too_high"}
    seconds, hint = said.hints[0]
    assert seconds < 5.0
    sane = said.config
    for knob, value in hint.remedy.items():
        assert knob in ("learning_rate", "final_learning_rate")
        sane = sane.turned(knob, value)
    assert max(sane.learning_rate, sane.final_learning_rate) < 0.01
    assert hint.back_to == 0
    check_remedies(name, said)


@pytest.mark.parametrize(
    "name", ["modern rates to 1 and back", "modern rates to 1 and back, late", "classic rates to 1 and back"]
)
def test_while_it_is_broken_the_rate_is_named_and_after_the_mend_the_damage_with_the_way_back(name: str):
    run, said = recordings()[1][name], watch(name)
    broken, mended = run.turns[0][0], run.turns[-1][0]
    assert said.names[0] == "rate_too_high"
    assert set(said.names) <= {"rate_too_high", "damaged"}, "and never the reward, the units or the values"
    for _, hint in said.hints:
        assert hint.back_to is not None
        assert hint.back_to <= broken < mended
    check_remedies(name, said)


def test_after_going_back_the_damage_is_no_longer_spoken_of():
    name = "modern rates to 1 and back, late"
    columns, runs = recordings()
    run = runs[name]
    history = History()
    for row in run.table:
        told = dict(zip(columns, row.tolist(), strict=True))
        history.append(Point(**{key: told[key] for key in columns[:-2]}, steps_per_second=0.0, landed=told["success"]))
    for at, knob, value in run.turns:
        before = getattr(MADE_WITH["modern"], knob) if value == 1.0 else 1.0
        history.append(SettingChange(at, knob, before, value))
    assert RecentCurves(history, MADE_WITH["modern"]).damaged_at() == run.turns[0][0]
    history.append(SettingChange(run.turns[-1][0] + 10, REVERTED, None, 100_000))
    assert RecentCurves(history, MADE_WITH["modern"]).damaged_at() is None


NAMED = {
    "modern replay_size 100": ("small_memory", {"replay_size"}),
    "classic replay_size 100": ("small_memory", {"replay_size"}),
    "modern sabotage no_replay": ("small_memory", {"replay_size"}),
    "modern num_envs 1": ("overfed", {"num_envs"}),
    "modern sabotage one_lander": ("overfed", {"num_envs"}),
    "classic gradient_steps 32": ("overfed", {"gradient_steps"}),
    "modern target_update_interval 10000": ("target_stands", {"target_update_interval"}),
    "modern tau 0.0001": ("target_stands", {"tau"}),
    "classic target_update_interval 10000": ("target_stands", {"target_update_interval"}),
    "classic tau 0.0001": ("target_stands", {"target_update_interval", "tau"}),
    "classic batch_size 1024": ("small_memory", {"replay_size"}),
    "classic gradient_clip 0.1": ("clipped", set()),
    "modern sabotage short_sight": ("short_sight", set()),
    "modern sabotage plain_steps": ("crashes", {"optimizer"}),
    "modern sabotage no_shaping": ("no_guide", set()),
}


@pytest.mark.parametrize("name", NAMED)
def test_the_right_hint_names_the_right_knob(name: str):
    hint, knobs = NAMED[name]
    said = watch(name)
    assert set(said.names) == {hint}
    assert set(said.hints[-1][1].remedy) == knobs
    check_remedies(name, said)


def test_of_all_other_runs_nothing_is_said_for_it_would_be_wrong():
    others = [name for name in recordings()[1] if name not in (*NAMED, *TOO_HIGH) and "and back" not in name]
    said = {name: watch(name).names for name in others if name not in HEALTHY}
    assert {name: names for name, names in said.items() if names} == {}
    assert len(others) > 30
