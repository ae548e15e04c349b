import numpy as np
import pytest

from ai.copilot.alone import Estimate, LandingAlone


def after(landed: list[bool]) -> Estimate:
    belief = LandingAlone()
    for one in landed:
        belief.add(landed=one)
    return belief.estimate


def test_without_flights_every_share_is_as_likely():
    estimate = LandingAlone().estimate
    assert estimate.mean == pytest.approx(0.5)
    assert estimate.high - estimate.low == pytest.approx(0.8, abs=0.02)
    assert not estimate.known


def test_more_flights_narrow_it_and_few_say_nothing():
    few, some, many = (after([True, False] * pairs) for pairs in (1, 5, 20))
    assert [each.known for each in (few, some, many)] == [False, True, True]
    assert not after([False] * 4).known
    assert few.high - few.low > some.high - some.low > many.high - many.low
    assert [each.flights for each in (few, some, many)] == [2, 10, 40]


def test_one_flight_counts_as_in_the_rule_of_succession_and_old_ones_are_forgotten():
    assert after([True]).mean == pytest.approx(2 / 3, abs=0.01)  # Laplace
    assert after([False] * 40 + [True] * 20).mean > 0.6
    assert after([True] * 40 + [False] * 20).mean < 0.4


def test_the_interval_reaches_the_end_for_those_who_always_land_or_never():
    assert after([True] * 30).high == pytest.approx(1.0)
    assert after([False] * 30).low == pytest.approx(0.0)
    assert after([True] * 30).low > 0.9


def test_the_truth_lies_in_the_interval_as_often_as_it_says():
    for flights in (5, 20):
        rng = np.random.default_rng(flights)
        within = []
        for share in rng.random(300):
            estimate = after([bool(landed) for landed in rng.random(flights) < share])
            within.append(estimate.low <= share <= estimate.high)
        assert 0.75 <= np.mean(within) <= 0.88, flights
