import json
from dataclasses import asdict

import numpy as np
import pytest

from ai.lander.spawns import RUNGS
from game.core import texts
from game.flight.becoming import KINDS, Estimate, LandingAlone, curves, kind_of
from game.flight.flight_file import Entry
from game.flight.logbook import LOGBOOK, Records
from game.scenes.logbook.scene import LogbookScene

STARTS = {"ladder": {"spawn": next(iter(RUNGS))}, "plain": {}, "hills": {"pads": 3}, "missions": {"course": "brake"}}


def flown(*, landed: bool = True, **more) -> Entry:
    return Entry(0.0, "LANDED" if landed else "CRASHED", 10.0, 3.0, 0.4, more.pop("human", 1.0), **more)


def alone(*, landed: bool = True, **more) -> Entry:
    return flown(landed=landed, alone=True, **more)


def after(landed: list[bool]) -> Estimate:
    belief = LandingAlone()
    for one in landed:
        belief.add(landed=one)
    return belief.estimate


def test_without_flights_every_share_is_as_likely_and_more_flights_narrow_it():
    nothing = LandingAlone().estimate
    assert nothing.mean == pytest.approx(0.5)
    assert nothing.high - nothing.low == pytest.approx(0.8, abs=0.02)
    few, some, many = (after([True, False] * pairs) for pairs in (1, 5, 20))
    assert [each.known for each in (nothing, few, after([False] * 4), some, many)] == [False, False, False, True, True]
    assert few.high - few.low > some.high - some.low > many.high - many.low
    assert [each.flights for each in (few, some, many)] == [2, 10, 40]


def test_one_flight_counts_as_in_the_rule_of_succession_and_old_ones_are_forgotten():
    assert after([True]).mean == pytest.approx(2 / 3, abs=0.01)  # Laplace
    assert after([False] * 40 + [True] * 20).mean > 0.6
    assert after([True] * 40 + [False] * 20).mean < 0.4


def test_the_truth_lies_in_the_interval_as_often_as_it_says():
    for flights in (5, 20):
        rng = np.random.default_rng(flights)
        within = []
        for share in rng.random(300):
            estimate = after([bool(landed) for landed in rng.random(flights) < share])
            within.append(estimate.low <= share <= estimate.high)
        assert 0.75 <= np.mean(within) <= 0.88, flights


def test_kinds_of_starts_have_estimates_of_their_own():
    assert set(KINDS) == set(texts.BECOMING_KINDS)
    assert {kind: kind_of(alone(**start)) for kind, start in STARTS.items()} == {kind: kind for kind in KINDS}
    found = curves([alone()] * 10 + [alone(landed=False, pads=3)] * 10)
    assert found["plain"][-1].mean > 0.8
    assert found["hills"][-1].mean < 0.2
    assert not found["missions"][-1].known
    assert {kind: len(curve) - 1 for kind, curve in found.items()} == {
        "ladder": 0, "plain": 10, "hills": 10, "missions": 0
    }  # fmt: skip


def test_helped_flights_and_practice_tell_nothing_and_the_rest_what_the_model_says():
    others = [flown(barred="helped", guarded=0.4), flown(barred="hands"), alone(gravity=0.8), alone(pace=0.5)]
    belief = LandingAlone()
    belief.add(landed=True)
    assert curves([alone(), *others])["plain"][-1] == belief.estimate


def test_the_logbook_opens_on_the_kind_flown_last_and_says_its_estimate(open_game, context, written: list[str]):
    context.user_dir.mkdir(exist_ok=True)
    for last in ("hills", "missions"):
        lines = [asdict(alone(**start)) for start in (*STARTS.values(), *[STARTS[last]] * 24)]
        for line in lines:
            del line["guarded"]  # as in an old logbook
        (context.user_dir / LOGBOOK).write_text("".join(json.dumps(line) + "\n" for line in lines))
        assert not Records(context.user_dir).problem
        driver = open_game(LogbookScene)
        driver.frames(3)
        driver.press_on(texts.CHOICES_MORE)
        driver.frames(3)
        choice = driver.choice(texts.BECOMING_KINDS[last])
        assert choice.options[choice.index] == texts.BECOMING_KINDS[last]
        assert texts.BECOMING_ESTIMATE.format(share=10, low=9, high=10) in written
