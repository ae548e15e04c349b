"""The record of a run: what it keeps is what an explicit model says, whatever comes in, and it stays in bounds."""

from dataclasses import dataclass

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from game.training.record import Record, size_of


@dataclass(frozen=True, eq=False)
class Note:
    decisions: int
    data: np.ndarray


def note(decisions: int, length: int = 0) -> Note:
    return Note(decisions, np.zeros(length, np.uint8))


def first_of_each_cell(notes: list[Note], spacing: int) -> list[Note]:
    cells: dict[int, Note] = {}
    for each in notes:
        cells.setdefault(each.decisions // spacing, each)
    return list(cells.values())


def model(notes: list[Note], most: int) -> list[Note]:
    """The first of each cell, of the narrowest cells with which all of them fit."""
    spacing = 1
    while sum(map(size_of, kept := first_of_each_cell(notes, spacing))) > most and len(kept) > 1:
        spacing *= 2
    return kept


STEPS = st.lists(st.tuples(st.integers(0, 3000), st.integers(0, 4000)), max_size=120)


@given(STEPS, st.integers(1_000, 60_000), st.integers(0, 10**9))
def test_it_keeps_what_the_model_keeps(steps: list[tuple[int, int]], most: int, began: int) -> None:
    record, notes, now = Record[Note](most), list[Note](), began
    for passed, length in steps:
        now += passed
        notes.append(note(now, length))
        record.append(notes[-1])
        assert record.size <= most or len(record) == 1
    assert record.moments == [each.decisions for each in model(notes, most)]
    assert record.size == sum(map(size_of, model(notes, most)))


@given(st.lists(st.integers(0, 500), max_size=50), st.floats(-100, 600))
def test_the_nearest_that_was_kept_is_shown_and_none_is_invented(moments: list[int], asked: float) -> None:
    record, notes = Record[Note](8_000), [note(moment) for moment in sorted(moments)]
    for each in notes:
        record.append(each)
    found = record.nearest(asked)
    if found is None:
        assert not notes
    else:
        assert found in notes
        assert abs(found.decisions - asked) == min(abs(moment - asked) for moment in record.moments)


def test_a_long_run_is_kept_evenly() -> None:
    record = Record[Note](200_000)
    for decisions in range(0, 5_000_000, 256):
        record.append(note(decisions, 50))
    gaps = np.diff(record.moments)
    assert len(record) > 90
    assert set(gaps) == {record.spacing}


@pytest.mark.parametrize("most", [0, 10])
def test_what_is_larger_than_its_room_is_kept_alone(most: int) -> None:
    record = Record[Note](most)
    for decisions in (3, 900, 10**15):
        record.append(note(decisions, 5000))
    assert record.moments == [3]


def test_a_message_from_before_is_left_out_and_clear_forgets() -> None:
    record = Record[Note](10_000)
    record.append(note(10))
    record.append(note(4))
    record.append(note(10))
    assert record.moments == [10]
    record.clear()
    assert (len(record), record.size, record.nearest(3)) == (0, 0, None)
