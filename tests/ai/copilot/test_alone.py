import numpy as np
import pytest

from ai.copilot.alone import ASSISTS, BASE, CALM_SECONDS, SLOPE, SPREAD, Estimate, LandingAlone


def after(landed: list[bool]) -> Estimate:
    belief = LandingAlone()
    for one in landed:
        belief.add_alone(landed=one)
    return belief.estimate


def test_without_flights_every_share_is_as_likely():
    estimate = LandingAlone().estimate
    assert estimate.mean == pytest.approx(0.5)
    assert estimate.high - estimate.low == pytest.approx(0.8, abs=0.02)
    assert not estimate.known


def test_more_flights_narrow_it_and_few_say_nothing():
    widths = [after([True, False] * pairs) for pairs in (1, 5, 20)]
    assert [each.known for each in widths] == [False, True, True]
    assert not after([False] * 4).known
    assert widths[0].high - widths[0].low > widths[1].high - widths[1].low > widths[2].high - widths[2].low
    assert [each.alone for each in widths] == [2, 10, 40]


def test_one_flight_counts_as_in_the_rule_of_succession():
    assert after([True]).mean == pytest.approx(2 / 3, abs=0.01)  # Laplace


def test_the_interval_reaches_the_end_for_those_who_always_land_or_never():
    assert after([True] * 30).high == pytest.approx(1.0)
    assert after([False] * 30).low == pytest.approx(0.0)
    assert after([True] * 30).low > 0.9


def test_old_flights_are_forgotten():
    assert after([False] * 40 + [True] * 20).mean > 0.6
    assert after([True] * 40 + [False] * 20).mean < 0.4


@pytest.mark.parametrize("flights", [5, 20])
def test_the_truth_lies_in_the_interval_as_often_as_it_says(flights: int):
    rng = np.random.default_rng(flights)
    within = []
    for share in rng.random(300):
        estimate = after([bool(landed) for landed in rng.random(flights) < share])
        within.append(estimate.low <= share <= estimate.high)
    assert 0.75 <= np.mean(within) <= 0.88


def test_a_helped_flight_tells_less_than_one_alone_and_a_calm_landing_is_a_good_sign():
    def helped(*, landed: bool = True, changed: float = 0.0, assist: float = 0.4) -> float:
        belief = LandingAlone()
        belief.add_helped(landed=landed, changed=changed, assist=assist)
        return belief.estimate.mean

    assert helped(changed=CALM_SECONDS + 1) < 0.5 < helped() < after([True]).mean
    assert helped(landed=False) == helped(changed=CALM_SECONDS + 1)
    for unmeasured in (0.0, 0.9):
        assert helped(assist=unmeasured) == pytest.approx(0.5)


def test_helped_flights_with_a_few_alone_come_near_the_truth():
    rng = np.random.default_rng(3)
    base, slope, spread = (float(np.interp(0.4, ASSISTS, each)) for each in (BASE, SLOPE, SPREAD))
    within, off = [], []
    for share in rng.uniform(0.02, 0.98, 200):
        odds = base + slope * np.log(share / (1 - share)) + spread * rng.normal()
        calm = 1 / (1 + np.exp(-odds))
        belief = LandingAlone()
        for number in range(25):
            if number % 5 == 4:
                belief.add_alone(landed=bool(rng.random() < share))
            else:
                belief.add_helped(landed=True, changed=0.0 if rng.random() < calm else 9.0, assist=0.4)
        estimate = belief.estimate
        within.append(estimate.low <= share <= estimate.high)
        off.append(abs(estimate.mean - share))
    assert 0.75 <= np.mean(within) <= 0.88
    assert np.mean(off) < 0.16
    assert (estimate.alone, estimate.helped) == (5, 20)
