import json
from dataclasses import asdict

import pytest

from ai.copilot.alone import Estimate, LandingAlone
from ai.lander.spawns import RUNGS
from game.core import texts
from game.flight.becoming import KINDS, curves, kind_of, said
from game.flight.flight_file import Entry
from game.flight.logbook import LOGBOOK, Records
from game.scenes.logbook.scene import LogbookScene

STARTS = {"ladder": {"spawn": next(iter(RUNGS))}, "plain": {}, "hills": {"pads": 3}, "missions": {"course": "brake"}}


def flown(*, landed: bool = True, **more) -> Entry:
    return Entry(0.0, "LANDED" if landed else "CRASHED", 10.0, 3.0, 0.4, more.pop("human", 1.0), **more)


def alone(*, landed: bool = True, **more) -> Entry:
    return flown(landed=landed, alone=True, **more)


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


def test_words_for_few_flights_and_for_many():
    assert said(Estimate(0.5, 0.1, 0.9, 2)) == texts.BECOMING_TOO_FEW.format(count=2)
    assert said(Estimate(0.7, 0.52, 0.88, 20)) == texts.BECOMING_ESTIMATE.format(share=7, low=5, high=9)
    assert said(Estimate(0.99, 0.98, 1.0, 20)) == texts.BECOMING_SURE.format(share=10)


def test_the_logbook_opens_on_the_kind_flown_last_and_says_its_estimate(
    open_game, context, written: list[str], subtests: pytest.Subtests
):
    context.user_dir.mkdir(exist_ok=True)
    for last in KINDS:
        with subtests.test(last=last):
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
