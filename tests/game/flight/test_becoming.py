import json
from dataclasses import asdict

import pytest

from ai.copilot.alone import Estimate, LandingAlone
from ai.lander.spawns import RUNGS
from game.core import texts
from game.flight.becoming import KINDS, Becoming, kind_of, said
from game.flight.flight_file import Entry
from game.flight.logbook import LOGBOOK, Records
from game.scenes.logbook.scene import LogbookScene


def flown(*, landed: bool = True, **more) -> Entry:
    return Entry(0.0, "LANDED" if landed else "CRASHED", 10.0, 3.0, 0.4, more.pop("human", 1.0), **more)


def alone(*, landed: bool = True, **more) -> Entry:
    return flown(landed=landed, alone=True, **more)


def guarded(**more) -> Entry:
    return flown(barred="helped", guarded=0.4, **more)


def test_kinds_of_starts_have_estimates_of_their_own():
    assert set(KINDS) == set(texts.BECOMING_KINDS)
    starts = {
        "ladder": {"spawn": next(iter(RUNGS))},
        "plain": {},
        "hills": {"pads": 3},
        "missions": {"course": "night"},
    }
    assert {kind: kind_of(alone(**start)) for kind, start in starts.items()} == {kind: kind for kind in KINDS}
    becoming = Becoming([alone()] * 10 + [alone(landed=False, pads=3)] * 10)
    assert becoming.estimate("plain").mean > 0.8
    assert becoming.estimate("hills").mean < 0.2
    assert not becoming.estimate("missions").known
    assert {kind: len(curve) for kind, curve in becoming.curves.items()} == {
        "ladder": 0, "plain": 10, "hills": 10, "missions": 0
    }  # fmt: skip


@pytest.mark.parametrize("entry", [
    flown(barred="helped"),  # by tolerance, or by a guardian that goes by values
    flown(barred="handed_over", guarded=0.4),
    flown(barred="hands"),
    guarded(course="night"),
    alone(gravity=0.8),
    guarded(pace=0.5),
])  # fmt: skip
def test_other_flights_tell_nothing(entry: Entry):
    assert not any(Becoming([entry]).curves.values())


def test_a_flight_that_the_guardian_left_alone_is_a_good_sign_and_one_it_changed_a_bad_one():
    before, good, bad = (
        Becoming(flights).estimate("plain")
        for flights in ([], [guarded(human=0.98)], [guarded(human=0.98), guarded(human=0.6)])
    )
    assert bad.mean < good.mean > before.mean
    assert (bad.alone, bad.helped) == (0, 2)


def test_the_estimate_is_that_of_the_model():
    belief = LandingAlone()
    belief.add_alone(landed=True)
    belief.add_helped(landed=True, changed=0.2 * 10.0, assist=0.4)
    assert Becoming([alone(), guarded(human=0.8)]).estimate("plain") == belief.estimate


def test_an_old_logbook_gives_estimates_from_what_it_holds(tmp_path):
    lines = [asdict(alone()) for _ in range(8)]
    for line in lines:
        del line["guarded"]
    records = Records(tmp_path)
    records.folder.mkdir()
    (records.folder / "x").unlink(missing_ok=True)
    records.logbook.write_text("".join(json.dumps(line) + "\n" for line in lines))
    assert records.logbook.name == LOGBOOK.rsplit("/")[-1]
    entries = records.entries()
    assert not records.problem
    assert Becoming(entries).estimate("plain").alone == 8


def test_words_for_few_flights_and_for_many():
    assert said(Estimate(0.5, 0.1, 0.9, alone=2)) == texts.BECOMING_TOO_FEW.format(count=2)
    assert said(Estimate(0.7, 0.52, 0.88, alone=20)) == texts.BECOMING_ESTIMATE.format(share=7, low=5, high=9)
    assert said(Estimate(0.99, 0.98, 1.0, alone=20)) == texts.BECOMING_SURE.format(share=10)


def test_the_logbook_opens_on_the_kind_flown_last_and_says_its_estimate(
    open_game, context, written: list[str], subtests: pytest.Subtests
):
    starts = {"plain": {}, "ladder": {"spawn": "rung_3"}, "hills": {"pads": 3}, "missions": {"course": "brake"}}
    for last in KINDS:
        with subtests.test(last=last):
            lines = [asdict(alone(**start)) for start in (*starts.values(), *[starts[last]] * 24)]
            context.user_dir.mkdir(exist_ok=True)
            (context.user_dir / LOGBOOK).write_text("".join(json.dumps(line) + "\n" for line in lines))
            driver = open_game(LogbookScene)
            driver.frames(3)
            choice = driver.choice(texts.BECOMING_KINDS[last])
            assert choice.options[choice.index] == texts.BECOMING_KINDS[last]
            assert texts.BECOMING_ESTIMATE.format(share=10, low=9, high=10) in written
