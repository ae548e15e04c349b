"""Recorder: it records the lines that ran and what they set, and changes nothing."""

import sys

import numpy as np

from ai.explain.recorder import LARGE, RETURN, Recorder, Row


def scaled(numbers, factor):
    """Return numbers times a factor, in two ways."""
    total = 0.0
    for number in numbers:
        total += number * factor
    numbers *= factor
    return numbers, total


def doubled(numbers):
    return 2 * numbers


def test_each_line_has_the_values_that_it_set():
    numbers = np.array([1.0, 2.0])
    with Recorder([scaled]) as recorder:
        scaled(numbers, 3.0)
    values = [event.values for event in recorder.events]
    assert values[0]["factor"] == 3.0
    np.testing.assert_array_equal(values[0]["numbers"], [1.0, 2.0])
    assert [each["total"] for each in values if "total" in each] == [0.0, 3.0, 9.0]
    np.testing.assert_array_equal(recorder.last("scaled", "numbers"), [3.0, 6.0])  # changed in place
    np.testing.assert_array_equal(recorder.last("scaled", f"{RETURN}.0"), [3.0, 6.0])
    first = scaled.__code__.co_firstlineno
    assert [event.number - first for event in recorder.events] == [0, 2, 3, 4, 3, 4, 3, 5, 6]


def test_what_is_recorded_stays_when_the_array_changes():
    numbers = np.ones(3)
    with Recorder([scaled]) as recorder:
        scaled(numbers, 2.0)
    numbers[:] = 7.0
    np.testing.assert_array_equal(recorder.last("scaled", "numbers"), [2.0, 2.0, 2.0])


def test_only_the_functions_asked_for_are_recorded_and_only_within():
    before = sys.gettrace()
    with Recorder([scaled]) as recorder:
        sorted([3, 1])
        doubled(np.ones(2))
    assert recorder.events == []
    scaled(np.ones(2), 2.0)
    assert recorder.events == []
    assert sys.gettrace() is before


def test_of_a_large_array_one_row_is_recorded():
    numbers = np.arange(2.0 * LARGE).reshape(4, -1)
    with Recorder([scaled], row=2) as recorder:
        scaled(numbers, 1.0)
    row = recorder.last("scaled", "numbers")
    assert isinstance(row, Row)
    assert row.shape == numbers.shape
    np.testing.assert_array_equal(row.values, numbers[2])
