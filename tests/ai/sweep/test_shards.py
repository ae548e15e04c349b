"""Evaluations in shards: the same flights as in one batch, however they are cut."""

import json

import pytest

from ai.agent.agent import DeepQAgent
from ai.copilot import measurement
from ai.copilot.measurement import one_pad, three_pads
from ai.sweep import copilot_table
from ai.sweep import shards as module
from ai.sweep.cluster import each
from ai.sweep.copilot_table import parts, tables_of
from ai.sweep.shards import flown_shards, fly, shards
from ai.training.lander_task import FlightSums, evaluate
from game.core.assets import MODELS_DIR
from main import main

MODERN = MODELS_DIR / "lander" / "modern"


def total(parts):
    return next(sums for sums in flown_shards(parts, None, 1) if sums is not None)


@pytest.mark.parametrize("size", [7, 40])
def test_flights_are_those_of_one_batch_whatever_the_size_of_a_shard(monkeypatch, size):
    monkeypatch.setattr(module, "SHARD", size)
    parts = shards(MODERN, 40, 3, "hard", 4)
    assert [part.last - part.first for part in parts] == ([7] * 5 + [5] if size == 7 else [40])
    cut, whole = total(parts).evaluation(), evaluate(DeepQAgent.load(MODERN), 40, 3, "hard")
    if size == 40:
        assert cut == whole
    assert (cut.episodes, cut.success, cut.crash) == (whole.episodes, whole.success, whole.crash)
    assert cut.mean_return == pytest.approx(whole.mean_return)
    assert cut.mean_time == pytest.approx(whole.mean_time)


def test_the_order_in_which_shards_are_done_changes_nothing(monkeypatch):
    monkeypatch.setattr(module, "SHARD", 7)
    parts = shards(MODERN, 20, 3, "random", 4)
    in_order = total(parts)

    def backwards(function, items, address, workers):
        yield from reversed(list(each(function, items, address, workers)))

    monkeypatch.setattr(module, "each", backwards)
    assert total(parts) == in_order


def test_sums_add_up():
    one = FlightSums((0, 1, 1, 0, 0), 2.0, 7.0, 3.0, 5, 10.0)
    two = one.plus(one)
    assert two.outcomes == (0, 2, 2, 0, 0)
    assert two.evaluation() == one.evaluation().__class__(4, 0.5, 0.5, 0.0, 0.0, 1.0, 7.0, 3.0, 0.5)
    assert FlightSums((0, 0, 2, 0, 0), 0.0, 0.0, 0.0, 1, 2.0).evaluation().mean_time is None


def test_evaluate_tells_an_interval_around_the_share(capsys):
    assert main(["evaluate", "--model", str(MODERN), "--episodes", "30", "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    low, high = told["success_interval"]
    assert low < told["success"] <= high
    assert main(["evaluate", "--model", str(MODERN), "--episodes", "30"]) == 0
    assert f"(95%: {low:.2%} to {high:.2%})" in capsys.readouterr().out


def test_a_worker_flies_one_shard_after_another_with_the_same_network(monkeypatch):
    parts = shards(MODERN, 3, 0, "random", 4)
    assert fly(parts[0]) == fly(parts[0])


@pytest.mark.slow
def test_the_copilots_table_is_the_same_in_parts(monkeypatch):
    monkeypatch.setattr(measurement, "ONE_PAD", measurement.ONE_PAD[:2])  # the rest takes long
    monkeypatch.setattr(measurement, "THREE_PADS", measurement.THREE_PADS[:2])
    monkeypatch.setattr(measurement, "INTENT_PILOTS", ("laggy",))
    monkeypatch.setattr(measurement, "GROUNDS", 2)
    monkeypatch.setattr(measurement, "PILOTS", {name: measurement.PILOTS[name] for name in ("laggy", "noisy")})
    asked = parts(MODERN, False, 3, 2)
    done = {index: copilot_table.fly(part) for index, part in reversed([*enumerate(asked)])}
    tables = tables_of(asked, done)
    agent = DeepQAgent.load(MODERN)
    assert tables["one_pad"] == list(one_pad(agent, agent, 3, 2))
    assert tables["three_pads"] == list(three_pads(agent, agent, 3, 2))
