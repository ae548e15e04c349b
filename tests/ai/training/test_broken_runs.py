"""The rules of the hints against recordings of real runs: see benchmarks/broken_runs.py, which made them."""

from __future__ import annotations

from functools import cache
from itertools import islice
from operator import attrgetter

import numpy as np
import pytest

from ai.training.config import Config
from ai.training.curves import RecentCurves
from ai.training.hints import Adviser, Hint
from ai.training.history import REVERTED, SettingChange
from tests.support.recordings import FILE, growing, names, recorded, turns


@cache
def watch(name: str) -> tuple[list[tuple[float, Hint]], list[Config]]:
    """Let an adviser see a recording grow, as the game does; each hint once, with its seconds, and all settings.

    Each remedy changes a knob from a value that the run had.
    """
    said, configs, adviser = list[tuple[float, Hint]](), list[Config](), None
    for run in islice(growing(name), None, None, 3):
        adviser = adviser or Adviser()
        if run.config not in configs:
            configs.append(run.config)
        hint = adviser.advise(run.history, run.config)
        if hint and (not said or said[-1][1] != hint):
            said.append((float(run.history["seconds"][-1]), hint))
    for knob, value in (item for _, hint in said for item in hint.remedy.items()):
        assert any(attrgetter(knob)(config) != value for config in configs), knob
    return said, configs


def hints(name: str) -> set[str]:
    return {hint.name for _, hint in watch(name)[0]}


def test_the_recordings_are_real_and_small():
    assert FILE.stat().st_size < 300_000
    assert sum(name.startswith("modern") for name in names()) > 30
    assert sum(name.startswith("classic") for name in names()) > 12
    for name in names():
        assert (np.diff(recorded(name).history["decisions"]) > 0).all()


HEALTHY = ("modern healthy", "modern healthy, another seed", "classic healthy")
TOO_HIGH = (
    "modern rates 1", "modern rates 0.3", "modern rates 0.1", "modern learning_rate 1",
    "modern sabotage rate_times_100", "classic rates 1", "classic rates 0.3", "classic rates 0.1",
    "classic learning_rate 1",
)  # fmt: skip


def test_a_rate_that_is_too_high_is_named_and_nothing_else_is_blamed(subtests: pytest.Subtests):
    for name in TOO_HIGH:
        with subtests.test(name):
            assert hints(name) == {"rate_too_high"}
            said, configs = watch(name)
            seconds, hint = said[0]
            assert seconds < 5.5
            sane = configs[-1]
            for knob, value in hint.remedy.items():
                assert knob in ("learning_rate", "final_learning_rate")
                sane = sane.turned(knob, value)
            assert max(sane.learning_rate, sane.final_learning_rate) < 0.01
            assert hint.back_to == 0


def test_while_it_is_broken_the_rate_is_named_and_after_the_mend_the_damage_with_the_way_back(
    subtests: pytest.Subtests,
):
    for name in ("modern rates to 1 and back", "modern rates to 1 and back, late", "classic rates to 1 and back"):
        with subtests.test(name):
            said, _ = watch(name)
            assert said[0][1].name == "rate_too_high"
            assert hints(name) <= {"rate_too_high", "damaged"}, "and never the reward, the units or the values"
            for _, hint in said:
                assert hint.back_to is not None
                assert hint.back_to <= turns(name)[0][0] < turns(name)[-1][0]


def test_after_going_back_the_damage_is_no_longer_spoken_of():
    name = "modern rates to 1 and back, late"
    run = recorded(name)
    assert RecentCurves(run.history, run.config).damaged_at() == turns(name)[0][0]
    run.history.append(SettingChange(turns(name)[-1][0] + 10, REVERTED, None, 100_000))
    assert RecentCurves(run.history, run.config).damaged_at() is None


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
    "modern sabotage plain_steps": ("crashes", {"optimizer"}),
}


def test_the_right_hint_names_the_right_knob(subtests: pytest.Subtests):
    for name, (hint, knobs) in NAMED.items():
        with subtests.test(name):
            assert hints(name) == {hint}
            assert set(watch(name)[0][-1][1].remedy) == knobs


def test_of_healthy_runs_and_all_others_nothing_is_said_for_it_would_be_wrong():
    others = [name for name in names() if name not in (*NAMED, *TOO_HIGH) and "and back" not in name]
    assert {name: hints(name) for name in others if hints(name)} == {}
    assert set(HEALTHY) <= set(others)
    assert len(others) > 30
