"""The record of a run: what it keeps stays in bounds, and is spread over the run."""

from dataclasses import dataclass

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from game.training.record import Record, size_of


@dataclass(frozen=True, eq=False)
class Note:
    decisions: int
    data: np.ndarray


def note(decisions: int, length: int = 0) -> Note:
    return Note(decisions, np.zeros(length, np.uint8))


@given(st.lists(st.integers(0, 3000), max_size=120), st.integers(1, 60_000), st.integers(0, 4000))
def test_it_stays_in_bounds_is_spread_evenly_and_begins_with_the_first(steps: list[int], most: int, length: int):
    record, moments = Record[Note](most), np.cumsum(steps, dtype=int).tolist()
    for moment in moments:
        record.append(note(moment, length))
        assert len(record.moments) * size_of(note(0, length)) <= most or len(record.moments) == 1
    spread = [moments[:: 2**power] for power in range(8)]
    assert record.moments in spread
    assert record.begins == (moments[0] if moments else None)


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
