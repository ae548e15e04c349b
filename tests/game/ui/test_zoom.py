"""The zoom of charts: what it shows stays within the axis, and what it holds stays where it is."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from game.ui.charts import MOST, Zoom

STEPS = st.lists(st.tuples(st.floats(0.2, 5.0), st.floats(0.0, 1.0), st.floats(0.0, 2.0)), max_size=20)


@given(STEPS, st.floats(1.0, 1e7))
def test_a_part_of_the_axis_is_shown_whatever_is_done(steps: list[tuple[float, float, float]], end: float) -> None:
    zoom = Zoom()
    zoom.end = end
    for factor, about, reached in steps:
        start, stop = zoom.shown
        zoom.by(factor, start + about * (stop - start))
        zoom.reach(reached * zoom.end)
        zoom.end *= 1.1
        start, stop = zoom.shown
        assert -1e-6 * zoom.end <= start < stop <= zoom.end * (1 + 1e-6)
        assert 1.0 <= zoom.factor <= MOST
        assert stop - start == pytest.approx(zoom.end / zoom.factor)
    zoom.reset()
    assert zoom.shown == (0.0, zoom.end)


def test_what_is_under_the_mouse_stays_there() -> None:
    zoom = Zoom()
    zoom.end = 100.0
    zoom.by(2.0, 30.0)
    assert zoom.shown == pytest.approx((15.0, 65.0))
    zoom.by(2.0, 30.0)
    assert zoom.shown == pytest.approx((22.5, 47.5))
    zoom.by(0.25, 30.0)
    assert zoom.shown == (0.0, 100.0)


def test_the_end_of_a_run_that_goes_on_stays_in_sight() -> None:
    zoom = Zoom()
    zoom.end = 100.0
    zoom.by(2.0)
    assert zoom.shown == (50.0, 100.0)
    zoom.end = 200.0
    assert zoom.shown == (100.0, 200.0)


def test_a_place_that_is_reached_is_shown() -> None:
    zoom = Zoom()
    zoom.end = 100.0
    zoom.by(4.0, 90.0)
    zoom.reach(10.0)
    start, end = zoom.shown
    assert start <= 10.0 <= end
    assert end - start == 25.0
