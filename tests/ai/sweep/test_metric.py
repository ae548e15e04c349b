"""Metrics of learning curves, and how seeds are judged."""

import pytest

from ai.sweep.plan import Metric, Point
from ai.sweep.study import median

CURVE = [Point(100, 0.0, -5.0), Point(200, 0.96, 1.0), Point(300, 0.99, 2.0), Point(400, 0.97, 3.0)]


def test_a_metric_reads_a_curve(subtests):
    for name, value in [
        ("success", 0.97),
        ("accuracy", 0.97),
        ("return", 3.0),
        ("mean", 0.73),
        ("time_to_95", 200),
        ("time_to_99", 300),
        ("time_to_100", 400 * (1 + 1.0 - 0.99)),
    ]:
        with subtests.test(name=name, value=value):
            assert Metric.named(name).of(CURVE, 400) == pytest.approx(value)


def test_a_share_never_reached_counts_for_more_than_the_whole_run_and_the_nearer_the_better():
    metric = Metric.named("time_to_99")
    far, near = ([Point(400, share, 0.0)] for share in (0.1, 0.9))
    nearer, farther, lost = metric.of(near, 400), metric.of(far, 400), metric.of(far, 400, True)
    assert nearer
    assert farther
    assert lost
    assert 400 < nearer < farther < lost
    assert metric.sign == 1
    assert Metric.named("return").sign == -1


@pytest.mark.parametrize("name", ["", "time_to_0", "time_to_101", "time_to_", "loss", "TIME_TO_99"])
def test_other_names_are_refused(name):
    with pytest.raises(ValueError, match="--metric"):
        Metric.named(name)


def test_a_trial_is_judged_by_the_median_of_its_seeds_if_all_have_a_value():
    assert median([1.0, 9.0, 2.0]) == 2.0
    assert median([0.5, 0.9]) == pytest.approx(0.7)
    assert median([0.5, None]) is None
    assert median([]) is None


def test_a_diverged_seed_has_the_worst_value_there_is():
    assert Metric.named("success").of(CURVE, 400, True) == 0.0
    assert Metric.named("return").of(CURVE, 400, True) == -5.0
    assert Metric.named("return").of([], 400, True) is None
