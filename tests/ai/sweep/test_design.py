"""Plans of studies: metrics of learning curves, and what is searched of the knobs."""

import pytest

from ai.digits.config import DIGIT_PRESETS
from ai.sweep.design import Measurement, Metric, choices_of, searched
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


def test_a_knob_is_searched_among_its_choices_or_in_its_own_range():
    assert choices_of(MODERN, "learning_rate") == ()
    assert choices_of(MODERN, "double") == (False, True)
    assert [128, 128] in choices_of(MODERN, "hidden")
    for name in ("no_such_knob", "env", "reward_weights"):
        with pytest.raises(ValueError, match=name):
            searched(MODERN, [name])


def test_a_group_stands_for_its_knobs_that_change_anything():
    knobs = searched(MODERN, ["memory"])
    assert "replay_size" in knobs
    assert "priority_exponent" not in knobs, "replay is not prioritised, so it changes nothing"
    assert "tau" in searched(MODERN, ["memory", "tau"])
    assert searched(DIGIT_PRESETS["modern"], ["images"])
