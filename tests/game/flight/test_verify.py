"""The command `verify`: files, codes and folders, true claims, wrong ones, and what is no flight at all."""

import json
import subprocess
import sys
from dataclasses import replace
from datetime import date
from io import BytesIO, TextIOWrapper
from pathlib import Path

import pytest

from game.core import texts
from game.core.assets import ASSETS_DIR
from game.flight import codes, flight_file
from game.flight.flight_file import Record
from game.flight.logbook import describe
from tests.support.flights import scripted
from tranquility.__main__ import main

ROOT = Path(__file__).parents[3]
FALL = ASSETS_DIR / "flights" / "fall.json"


@pytest.fixture(scope="module")
def record():
    return flight_file.read(FALL)


def code(record, **changed):
    return codes.code(replace(record, entry=replace(record.entry, **changed)))


def test_the_flights_that_come_with_the_game_earn_what_they_claim(capsys):
    assert main(["verify", str(ASSETS_DIR / "flights")]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) == len(list((ASSETS_DIR / "flights").glob("*.json"))) + 1
    assert lines[-1] == "11 true, 0 wrong, 0 refused"


def test_each_code_of_a_text_is_judged_by_itself(tmp_path, capsys, record):
    best = record.entry.score
    file = tmp_path / "codes.txt"
    file.write_text("\n".join([
        "Here they are:", code(record), code(record, score=best + 9), code(record, outcome="CRASHED", score=0),
        f"> “{code(record)}”", code(record)[:-6],
    ]))  # fmt: skip
    assert main(["verify", str(file), "--json"]) == 1
    report = json.loads(capsys.readouterr().out)
    assert [row["verdict"] for row in report["flights"]] == ["true", "wrong", "wrong", "true", "refused"]
    assert (report["true"], report["wrong"], report["refused"]) == (2, 2, 1)
    assert [row["points"] for row in report["flights"][:4]] == [best] * 4
    assert report["flights"][0]["medal"] == record.entry.medal
    assert main(["verify", str(file)]) == 1
    lines = capsys.readouterr().out.splitlines()
    fall = texts.MISSIONS["fall"][0]
    gold = f"{file}:2: {fall}: landed, {best} points, gold"
    assert lines[1] == f"{gold}  (WRONG, it claims: landed, {best + 9} points)"


def test_a_flight_from_elsewhere_than_it_says_is_wrong_and_the_day_is_named(tmp_path, capsys, monkeypatch):
    day = date(2026, 11, 22)
    true = scripted(day.toordinal(), pads=3)
    said = []
    for flight, course in ((true, "daily"), (scripted(day.toordinal()), "daily"), (true, "")):
        entry = describe(flight, 0.0, course=course)
        x, y, angle = flight.poses.now[0].tolist()
        said.append(codes.code(Record(flight.recording, entry, (x, y, angle))))
    piped = TextIOWrapper(BytesIO("\n".join(said).encode()))
    monkeypatch.setattr(sys, "stdin", piped)
    assert main(["verify", "-"]) == 1
    lines = capsys.readouterr().out.splitlines()
    verdicts = [line.partition("points  ")[2] for line in lines[:3]]
    assert verdicts == ["(true)", "(WRONG, it was not flown there)", "(true)"]
    assert [line.split(": ")[:2] for line in lines[:3]] == [
        ["-:1", f"{texts.DAILY}, 2026-11-22"], ["-:2", f"{texts.DAILY}, 2026-11-22"], ["-:3", texts.COURSE_FREE[3]],
    ]  # fmt: skip


def test_closed_standard_input_is_refused_in_a_sentence(capsys, monkeypatch):
    monkeypatch.setattr(sys, "stdin", None)
    assert main(["verify", "-"]) == 1
    assert capsys.readouterr().out == f"-: refused, {texts.CODE_REFUSED['none']}\n"


def test_what_is_no_flight_is_refused_in_a_sentence(tmp_path, capsys):
    file = tmp_path / "strange.txt"
    for content in (b"", b"hello", b"\xff\xfe\x00", b"{", b'{"format": "tranquility flight"}', b"tranq-0"):
        file.write_bytes(content)
        assert main(["verify", str(file), str(tmp_path / "gone.txt")]) == 1
        out, err = capsys.readouterr()
        assert [": refused, " in line for line in out.splitlines()] == [True, True], content
        assert err.strip() == "0 true, 0 wrong, 2 refused"


@pytest.mark.slow
def test_no_window_is_needed():
    program = """
import sys
from tranquility.__main__ import main
code = main(["verify", sys.argv[1]])
sys.exit(code + 10 * any(name in sys.modules for name in ("pygame", "pygame_gui", "PIL")))
"""
    done = subprocess.run([sys.executable, "-c", program, str(FALL)], cwd=ROOT, capture_output=True, check=False)
    assert done.returncode == 0, done.stderr
