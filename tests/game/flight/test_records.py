import json
import os
from dataclasses import asdict, replace
from functools import cache
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from ai.files.schema import read_as
from ai.flights.recording import Easing
from ai.lander.descent import LegStart
from ai.lander.environment import Outcome
from ai.lander.pilots import ScriptedPilot
from ai.lander.push import STEPS, Push
from game.core import texts
from game.flight import logbook as records
from game.flight.flight import Flight, Recording, StickHolder
from game.flight.flight_file import VERSION, Entry, Record, from_text, to_text
from game.flight.logbook import Goals, Records, best, longest_descent
from tests.support.descent import stand_on
from tests.support.flights import NOON, begun, fly_out, scripted


@cache
def fly(seed: int = 3, *, by_hand: bool = False, pads: int = 1) -> Flight:
    """A flight to its end: the scripted pilot's, or, by hand, a fall."""
    return fly_out(begun(seed, ScriptedPilot(), pads=pads)) if by_hand else scripted(seed, pads=pads)


def entry(outcome: str = "LANDED", when: float = NOON, **figures) -> Entry:
    return Entry(**{"when": when, "outcome": outcome, "seconds": 10.0, "fuel": 3.0, "touchdown": 0.5, "human": 1.0,
                    "alone": True}
                 | figures)  # fmt: skip


@pytest.fixture
def kept(tmp_path: Path) -> Records:
    return Records(tmp_path / "user")


def test_a_flight_comes_back_from_its_file_and_flies_as_it_did(kept: Records):
    flight = fly(pads=3)
    line = kept.keep(flight, NOON, network="modern")
    assert not kept.problem
    assert (kept.folder / line.file).stat().st_size < 8_000
    record = kept.read(line.file)
    assert record.recording == flight.recording
    assert record.entry == line
    again = begun(record.recording.seed, spawn=record.recording.spawn, pads=record.recording.pads)
    for push in record.recording.pushes:
        again.step(push)
    assert again.outcome is Outcome.LANDED
    assert again.poses.now[0].tolist() == list(record.end)


def test_a_network_of_any_name_leaves_a_line_that_can_be_read(kept: Records):
    for name in ("new\nline", "\udcff", "\u202e", "x" * 255 + " (yours)"):
        kept.keep(fly(), NOON, network=name)
        assert not kept.problem
    assert [len(each.network) for each in kept.entries()] == [8, 1, 1, 255]
    assert not kept.problem
    assert kept.read(kept.entries()[-1].file)


SPOILT = (
    ('"version": 8', '"version": 9'), ('"version": 8', '"version": 7'),
    ('"seed": 3', '"seed": -3'), ('"random"', '"nowhere"'),
    ('"network*', '"nobody*'), ('"LANDED"', '"FLOWN"'),
    ('"pads": 1', '"pads": 2'), ('"entry"', '"other"'),
    ('"end": [', f'"end": [{10**400}, '), ('"when": ', '"when": 99999999999'),
    *(('"pushes": "', f'"pushes": "{spoilt} ') for spoilt in (
        "0,0*1", "17,0*5", "1,-17*5", "-1,0*5", "1*5", "1,2,3*5", "-*4", "a,b*5", "0,0*-5", "0,0*99999999999",
    )),
)  # fmt: skip


def test_a_damaged_file_is_named_and_left_alone(kept: Records):
    path = kept.folder / kept.keep(fly(), NOON).file
    text = path.read_text()
    assert all(sound in text for sound, _ in SPOILT)
    for spoilt in ("", text[: len(text) // 2], "[]", "[" * 100_000, " " * 3_000_000,
                   *(text.replace(*spoil) for spoil in SPOILT)):  # fmt: skip
        path.write_text(spoilt)
        with pytest.raises(ValueError, match=path.name):
            kept.read(path.name)
        assert path.read_text() == spoilt
    path.unlink()
    with pytest.raises(ValueError, match=rf"{path.name} is not there"):
        kept.read(path.name)


def test_damaged_lines_of_the_logbook_are_counted_and_the_rest_is_read(kept: Records):
    kept.keep(fly(), NOON)
    with kept.logbook.open("a") as file:
        file.write('nonsense\n{"when": 1}\n{"when": NaN, "outcome": "LANDED"}\n\n')
        file.write(
            '{"when": 1' + 400 * "0" + ', "outcome": "LANDED", "seconds": 1, "fuel": 1, "touchdown": 0, "human": 1}\n'
        )
        file.write('{"when": 17')  # a killed game
    kept.keep(fly(), NOON + 1)
    assert [line.when for line in kept.entries()] == [NOON, NOON + 1]
    assert "5 lines" in kept.problem


def test_of_a_huge_logbook_the_end_is_read(kept: Records):
    kept.keep(fly(), NOON)
    line = kept.logbook.read_bytes()
    with kept.logbook.open("wb") as file:
        file.truncate(300_000_000)
        file.seek(0, os.SEEK_END)
        file.write(b"\n" + line)
    assert [each.when for each in kept.entries()] == [NOON]


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no pipes")
def test_a_pipe_in_place_of_a_flight_or_the_logbook_is_named(kept: Records):
    kept.folder.mkdir(parents=True)
    os.mkfifo(kept.folder / "a.json")
    os.mkfifo(kept.logbook)
    with pytest.raises(ValueError, match=r"a\.json.* is not an ordinary file"):
        kept.read("a.json")
    assert kept.entries() == []
    assert kept.problem == texts.FLIGHTS_UNREADABLE.format(path=kept.logbook, reason="is not an ordinary file")


def test_a_line_cannot_lead_out_of_the_folder():
    with pytest.raises(ValueError, match="plain name"):
        read_as(Entry, asdict(entry(file="../settings.json")))


def test_old_files_make_room_but_the_best_and_the_logbook_stay(kept: Records, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(records, "RECENT", 6)
    monkeypatch.setattr(records, "SLACK", 2)
    flight = fly()
    good = [kept.keep(flight, NOON + second, alone=True).file for second in range(6)]
    fall = fly(by_hand=True)
    bad = [kept.keep(fall, NOON + 10 + second).file for second in range(9)]
    (kept.folder / "mine.json").write_text("not in the logbook")
    kept.keep(fall, NOON + 30)
    assert set(good[:5]) <= kept.kept()
    assert bad[0] not in kept.kept()
    assert "mine.json" in kept.kept()
    assert len(kept.entries()) == 16


def test_all_legs_of_the_longest_descent_stay(kept: Records, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(records, "RECENT", 6)
    monkeypatch.setattr(records, "SLACK", 2)
    legs, fall = [], fly(by_hand=True)
    for number in (1, 2, 1, 2, 3, 4, 5, 6, 7):
        flight = begun(3, leg=LegStart(number))
        stand_on(flight.env, 0)
        while not flight.over:
            flight.step()
        legs.append(kept.keep(flight, NOON + len(legs), alone=True, course="descent", total=10 * number).file)
    for second in range(12):
        kept.keep(fall, NOON + 100 + second)
    assert [entry.file for entry in longest_descent(kept.entries())] == legs[2:]
    assert set(legs[2:]) <= kept.kept()


def test_a_clock_that_is_set_back_costs_no_new_flight(kept: Records, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(records, "RECENT", 3)
    monkeypatch.setattr(records, "SLACK", 1)
    fall = fly(by_hand=True)
    for second in range(4):
        kept.keep(fall, NOON + second)
    new = [kept.keep(fall, NOON - 365 * 86400 + second).file for second in range(6)]
    assert set(new[-3:]) <= kept.kept()
    assert [line.file for line in kept.entries()][-6:] == new


def test_flights_of_one_moment_are_distinguished_also_by_two_games(kept: Records, tmp_path: Path):
    other = Records(kept.folder.parent)
    flight = fly()
    names = [games.keep(flight, NOON).file for _ in range(3) for games in (kept, other)]
    assert len(set(names)) == len(kept.kept()) == 6
    assert not kept.problem


def test_best_are_landings_by_hand_by_points_and_in_missions_by_fuel():
    lines = [entry(score=score, file=f"{score}.json") for score in (40, 20, 90, 10, 30, 50)]
    lines += [entry(score=99, alone=False, file="helped"), entry("CRASHED", score=99, file="crash"), entry(score=99)]
    lines += [
        entry(fuel=fuel, score=round(10 * fuel), medal=medal, course="wind", file=f"w{fuel}")
        for fuel, medal in ((8.0, 1), (6.0, 3), (5.0, 1), (7.0, 3))
    ]
    lines += [entry(fuel=7.0, pads=3, file="p")]
    wanted = ["90.json", "50.json", "40.json", "30.json", "20.json", "p", "w6.0", "w7.0", "w5.0", "w8.0"]
    assert [line.file for line in best(lines)] == wanted
    elsewhere = [entry(score=100, **kind) for kind in ({"spawn": "rung_3"}, {"course": "night"}, {"alone": False})]
    assert Goals([*lines, *elsewhere]).best == 99
    assert Goals([]).best == 0


def test_a_flight_of_another_version_is_refused_by_name_and_left_where_it_is(kept: Records):
    line = kept.keep(scripted(0, mission="earth"), NOON, course="earth", alone=True)
    path = kept.folder / line.file
    older = path.read_text().replace(f'"version": {VERSION}', f'"version": {VERSION - 1}')
    path.write_text(older)
    with pytest.raises(ValueError, match=f"{line.file}: recorded by another version .* {VERSION - 1}, .* {VERSION}"):
        kept.read(line.file)
    assert path.read_text() == older


SHARES = st.tuples(st.integers(0, STEPS), st.integers(-STEPS, STEPS))


@given(
    st.lists(SHARES, min_size=1, max_size=100),
    st.integers(0, 2**40), st.booleans(), st.booleans(),
)  # fmt: skip
@settings(max_examples=40, deadline=None)
def test_any_recording_survives_its_file(steps: list, seed: int, wider: bool, untimed: bool):
    hands = [StickHolder.HUMAN if main % 2 else StickHolder.NETWORK for main, _ in steps]
    recording = Recording(
        seed, "hard", 3, leg=LegStart(7, 12.345, bare=True) if seed % 2 else None, hands=hands,
        pushes=[Push(*step) for step in steps], easing=Easing(wider, untimed),
    )  # fmt: skip
    record = Record(recording, replace(entry(), file="x"), (1.0, 2.0, -0.25))
    assert from_text(to_text(record)) == record
    assert json.loads(to_text(record))["version"] == VERSION
