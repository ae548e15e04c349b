"""Evaluations in shards: the same flights as in one batch, however they are cut."""

import json

import numpy as np
import pytest

from ai.agent.agent import DeepQAgent
from ai.copilot import measurement
from ai.lander.environment import LanderEnv
from ai.sweep import shards as module
from ai.sweep.shards import parts_of, results, shards
from ai.training.tasks import Evaluation, evaluate
from game.core.assets import MODELS_DIR
from main import main

MODERN = MODELS_DIR / "lander" / "modern"
AGENT = DeepQAgent.load(MODERN)


def test_flights_are_those_of_one_batch_whatever_the_size_of_a_shard(monkeypatch):
    whole = evaluate(AGENT, 14, 3, "hard")
    for size, lengths in ((5, [5, 5, 4]), (14, [14])):
        monkeypatch.setattr(module, "SHARD", size)
        parts = shards(MODERN, 14, 3, "hard")
        assert [len(part.args[1]) for part in parts] == lengths
        cut = Evaluation.of(sum(results(parts)))
        assert (cut.episodes, cut.success, cut.crash) == (whole.episodes, whole.success, whole.crash), size
        assert cut.mean_return == pytest.approx(whole.mean_return)
        assert cut.mean_time == pytest.approx(whole.mean_time)
    assert cut == whole


@pytest.mark.slow
def test_processes_give_what_this_one_gives_in_the_same_order(monkeypatch):
    monkeypatch.setattr(module, "SHARD", 2)
    parts, reports = shards(MODERN, 6, 3, "random"), []
    assert np.array_equal(results(parts, 2, lambda: reports.append(1)), results(parts))
    assert len(reports) == 3


def test_sums_of_flights_give_their_means():
    sums = np.array([0, 2, 2, 0, 0, 4.0, 14.0, 6.0, 10, 20.0])
    assert Evaluation.of(sums) == Evaluation(4, 0.5, 0.5, 0.0, 0.0, 1.0, 7.0, 3.0, 0.5)
    assert Evaluation.of(np.array([0, 0, 2, 0, 0, 0.0, 0.0, 0.0, 1, 2.0])).mean_time is None


def test_evaluate_prints_an_interval_around_the_share(capsys):
    assert main(["evaluate", "--model", str(MODERN), "--episodes", "10", "--json"]) == 0
    values = json.loads(capsys.readouterr().out)
    low, high = values["success_interval"]
    assert low < values["success"] <= high
    assert main(["evaluate", "--model", str(MODERN), "--episodes", "10"]) == 0
    assert f"(95%: {low:.2%} to {high:.2%})" in capsys.readouterr().out


def test_the_copilots_table_is_the_same_in_parts(monkeypatch):
    names, helps = ("laggy", "noisy"), (("alone", 0.0),)
    table = (lambda slots, rng: LanderEnv(slots, rng, "rung_1"), names)
    monkeypatch.setattr(measurement, "TABLES", {"one_pad": table})
    monkeypatch.setattr(module, "PILOTS", 1)
    asked = parts_of({"one_pad": MODERN}, helps, 3, 2)
    assert [name for name, _ in asked] == ["one_pad"] * 2
    rows = [row for _, part in asked for row in part()]
    assert rows == list(measurement.rows(AGENT, AGENT, "one_pad", names, helps, 3, 2))
