"""Plans of studies: metrics of learning curves, and search spaces from the knobs' own ranges or from a file."""

import json
from dataclasses import asdict

import pytest

from ai.digits.config import DIGIT_PRESETS
from ai.files import read_as
from ai.sweep.design import Dimension, Measurement, Metric, knob_dimension, knob_space, read_space
from ai.training.config import PRESETS

MODERN = PRESETS["modern"]
CURVE = [
    Measurement(100, 0.0, -5.0),
    Measurement(200, 0.96, 1.0),
    Measurement(300, 0.99, 2.0),
    Measurement(400, 0.97, 3.0),
]


def test_a_metric_reads_a_curve_and_gives_a_diverged_seed_the_worst_value():
    for name, value, diverged in (
        ("success", 0.97, 0.0),
        ("accuracy", 0.97, 0.0),
        ("return", 3.0, -5.0),
        ("mean", 0.73, 0.0),
        ("time_to_95", 200, 780),
        ("time_to_99", 300, 796),
        ("time_to_100", 400 * (1 + 1.0 - 0.99), 800),
    ):
        metric = Metric.named(name)
        assert metric.of(CURVE, 400) == pytest.approx(value), name
        assert metric.of(CURVE, 400, True) == pytest.approx(diverged), name
        assert metric.of([], 400) is None, name
        assert metric.sign == (1 if name.startswith("time") else -1)
    for name in ("", "time_to_0", "time_to_101", "time_to_", "loss", "TIME_TO_99"):
        with pytest.raises(ValueError, match="--metric"):
            Metric.named(name)


def test_a_share_never_reached_counts_for_more_than_the_whole_run_and_the_nearer_the_better():
    metric = Metric.named("time_to_99")
    far, near = ([Measurement(400, share, 0.0)] for share in (0.1, 0.9))
    values = [metric.of(near, 400), metric.of(far, 400), metric.of(near, 400, True)]
    assert values == sorted(values, key=lambda value: value or 0.0)
    assert min(value or 0.0 for value in values) > 400


def test_a_knob_is_searched_in_its_own_range_and_scale():
    assert knob_dimension(MODERN, "learning_rate") == Dimension(1e-5, 1.0, log=True)
    assert knob_dimension(MODERN, "n_step") == Dimension(1, 20, whole=True)
    assert knob_dimension(MODERN, "double").choices == (False, True)
    assert [128, 128] in knob_dimension(MODERN, "hidden").choices
    for name in ("no_such_knob", "env", "reward_weights"):
        with pytest.raises(ValueError, match=name):
            knob_space(MODERN, [name])


def test_a_group_stands_for_its_knobs_that_change_anything():
    space = knob_space(MODERN, ["memory"])
    assert "replay_size" in space
    assert "priority_exponent" not in space, "replay is not prioritised, so it changes nothing"
    assert "tau" in knob_space(MODERN, ["memory", "tau"])
    assert knob_space(DIGIT_PRESETS["modern"], ["images"])


def test_a_file_narrows_ranges_and_lists_choices(tmp_path):
    file = tmp_path / "space.json"
    asked = {"learning_rate": {"low": 1e-4, "high": 1e-2}, "n_step": {}, "hidden": [[16], [32, 32]]}
    file.write_text(json.dumps(asked))
    space = read_space(MODERN, file)
    assert space["learning_rate"] == Dimension(1e-4, 1e-2, log=True)
    assert space["n_step"] == knob_dimension(MODERN, "n_step")
    assert space["hidden"].choices == ([16], [32, 32])
    for nonsense in (
        {"learning_rate": {"low": -1}},
        {"learning_rate": {"low": 1e-2, "high": 1e-3}},
        {"learning_rate": {"lowest": 1e-3}},
        {"learning_rate": {"low": "x"}},
        {"optimizer": ["no such"]},
        {"hidden": [16]},
        {"n_step": [1.5]},
        {"n_step": {"low": 1.5, "high": 3}},
        {"n_step": []},
        {"n_step": 3},
        {"unknown": {}},
        [],
        {},
    ):
        file.write_text(json.dumps(nonsense))
        with pytest.raises(ValueError, match=r"\w"):
            read_space(MODERN, file)


def test_a_dimension_survives_its_file_and_knows_its_values():
    for name in ("learning_rate", "n_step", "hidden", "epsilon_decisions", "double"):
        dimension = knob_dimension(MODERN, name)
        assert read_as(Dimension, json.loads(json.dumps(asdict(dimension)))) == dimension
        kind = int if dimension.whole else float
        ends = dimension.choices or (kind(dimension.low), kind(dimension.high))
        assert all(dimension.holds(each) for each in ends), name
        for outside in (dimension.low - 1, dimension.high + 1, float("nan"), "x", None, [], *[1.5] * dimension.whole):
            assert not dimension.holds(outside), (name, outside)
