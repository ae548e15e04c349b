import json
from pathlib import Path

import pytest

from game.cockpit.skill import DAMAGED_NAME, FILE_NAME, Entry, Skill

ALONE, HELPED = Entry(landed=True, alone=True), Entry(landed=True, alone=False)


def test_what_is_written_down_is_there_the_next_time(tmp_path: Path):
    skill = Skill(tmp_path / "new")
    for score in (30, 200, 90):
        skill.add(Entry(True, False, 3, score))
    again = Skill(tmp_path / "new")
    assert again.entries == skill.entries
    assert again.best == 200
    assert not again.problem


@pytest.mark.parametrize("content", [b"", b"{", b"[1]", b'[{"landed": 1}]', b"null", b"\xff\x00", b"[" * 99_999])
def test_a_damaged_file_is_kept_aside_and_a_new_one_begun(tmp_path: Path, content: bytes):
    (tmp_path / FILE_NAME).write_bytes(content)
    skill = Skill(tmp_path)
    assert DAMAGED_NAME in skill.problem
    assert (tmp_path / DAMAGED_NAME).read_bytes() == content
    skill.add(ALONE)
    assert len(json.loads((tmp_path / FILE_NAME).read_text())) == 1


def test_a_file_that_cannot_be_read_is_not_written_over(tmp_path: Path):
    (tmp_path / FILE_NAME).mkdir()
    skill = Skill(tmp_path)
    assert skill.problem
    skill.add(ALONE)
    assert skill.own == [True]
    assert (tmp_path / FILE_NAME).is_dir()


def test_a_folder_that_cannot_be_written_is_named_and_flights_are_counted_all_the_same(tmp_path: Path):
    (tmp_path / "file").write_text("")
    skill = Skill(tmp_path / "file" / "below")
    skill.add(ALONE)
    assert skill.problem
    assert skill.entries == [ALONE]


def test_every_fifth_flight_is_a_check_and_one_flown_alone_counts_as_such(tmp_path: Path):
    skill = Skill(tmp_path)
    due = []
    for number in range(12):
        due.append(skill.check_due)
        skill.add(ALONE if skill.check_due or number == 6 else HELPED)
    assert [number for number, check in enumerate(due) if check] == [4, 11]


def test_skill_is_the_share_of_landings_among_the_last_ten_without_help(tmp_path: Path):
    skill = Skill(tmp_path)
    for landed in [False] * 5 + [True] * 10:
        skill.add(Entry(landed, alone=True))
        skill.add(HELPED)
    assert skill.curve[4] == 0.0
    assert skill.curve[9] == pytest.approx(0.5)
    assert skill.curve[-1] == pytest.approx(1.0)
    assert len(skill.curve) == 15
