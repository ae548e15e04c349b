"""Recorder: it records the lines that ran and what they set, and changes nothing."""

import sys

import numpy as np
import pytest

from ai.explain.recorder import LARGE, RETURN, Recorder, Row


def scaled(numbers, factor):
    """Return numbers times a factor, in two ways."""
    total = 0.0
    for number in numbers:
        total += number * factor
    numbers *= factor
    return numbers, total


def countdown(number):
    return 1 if number == 0 else 1 + countdown(number - 1)


def doubled(numbers):
    return 2 * numbers


def test_each_line_has_the_values_that_it_set():
    numbers = np.array([1.0, 2.0])
    with Recorder([scaled]) as recorder:
        scaled(numbers, 3.0)
    numbers[:] = 7.0  # what is recorded stays
    call, first = recorder.call(scaled), scaled.__code__.co_firstlineno
    assert call.arguments["factor"] == 3.0
    np.testing.assert_array_equal(call.arguments["numbers"], [1.0, 2.0])
    assert [line.values["total"] for line in call.lines if "total" in line.values] == [0.0, 3.0, 9.0]
    np.testing.assert_array_equal(call.values["numbers"], [3.0, 6.0])  # changed in place
    np.testing.assert_array_equal(call.values[f"{RETURN}.0"], [3.0, 6.0])
    assert [line.number - first for line in recorder.lines] == [0, 2, 3, 4, 3, 4, 3, 5, 6]
    assert {line.function for line in call.lines} == {"scaled"}


def reshaped(numbers):
    numbers = numbers.reshape(2, 1)
    numbers = numbers.view(np.int64)
    return numbers.sum()


def test_a_new_shape_or_kind_of_the_same_bytes_is_news():
    with Recorder([reshaped]) as recorder:
        reshaped(np.zeros(2))
    news = [line.values["numbers"] for line in recorder.call(reshaped).lines if "numbers" in line.values]
    assert [(each.shape, each.dtype) for each in news] == [((2,), float), ((2, 1), float), ((2, 1), np.int64)]


def test_each_call_is_kept_apart_also_one_within_another():
    with Recorder([countdown, doubled]) as recorder:
        countdown(2)
    assert [call.arguments["number"] for call in recorder.calls(countdown)] == [2, 1, 0]
    assert [call.values[RETURN] for call in recorder.calls(countdown)] == [3, 2, 1]
    assert recorder.calls(doubled) == []
    with pytest.raises(LookupError, match="doubled did not run"):
        recorder.call(doubled)


def test_only_the_functions_asked_for_are_recorded_and_only_within_and_of_a_large_array_one_row():
    before = sys.gettrace()
    with Recorder([scaled]) as recorder:
        doubled(np.ones(2))
    scaled(np.ones(2), 2.0)
    assert recorder.lines == recorder.calls(scaled) == []
    assert sys.gettrace() is before
    numbers = np.arange(2.0 * LARGE).reshape(4, -1)
    with Recorder([scaled], row=2) as recorder:
        scaled(numbers, 1.0)
    row = recorder.call(scaled).values["numbers"]
    assert isinstance(row, Row)
    assert row.shape == numbers.shape
    np.testing.assert_array_equal(row.values, numbers[2])
