from collections.abc import Callable

import numpy as np
import pygame
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from game.drawing.canvas import Canvas
from game.ui import plotting
from game.ui.chart import RUN_STYLES, Chart, Series, Tick
from game.ui.charts import Charts

BOX = (40, 450, 372, 128)
NAN, INF = float("nan"), float("inf")


@pytest.fixture
def canvas() -> Canvas:
    return Canvas(pygame.Surface((1280, 720)))


@pytest.fixture
def drawn(canvas: Canvas) -> Callable[[Chart], np.ndarray]:
    """Draw a chart on a black ground and return the pixels of its plot, (columns, rows, 3)."""

    def draw(chart: Chart) -> np.ndarray:
        canvas.surface.fill((0, 0, 0))
        chart.draw(canvas)
        return pygame.surfarray.array3d(canvas.surface.subsurface(canvas.rect(*chart.plot)))

    return draw


def update_chart(chart: Chart, steps: int = 200) -> None:
    for _ in range(steps):
        chart.update()


def chart_of(y: object, x: object = None, **options: object) -> Chart:
    chart = Chart(BOX, "LOSS", **options)
    values = np.asarray(y, float)
    place = np.arange(len(values), dtype=float) if x is None else np.asarray(x, float)
    chart.set([Series(place, values, "this run")], (0.0, max(1.0, len(values) - 1.0)))
    update_chart(chart)
    return chart


# Limits and grids


def test_grid_lines_are_few_even_and_around_the_numbers(subtests: pytest.Subtests):
    for low, high in [(0, 1), (0.021, 0.83), (-412, 118), (0, 1e30), (-1e-7, 3e-7), (5, 5), (0, 0)]:
        with subtests.test(low=low, high=high):
            lines = plotting.grid(low, high)
            assert 2 <= len(lines) <= 4
            slack = 1e-9 * (lines[-1] - lines[0])
            assert lines[0] <= low + slack
            assert lines[-1] >= high - slack
            np.testing.assert_allclose(np.diff(lines), lines[1] - lines[0])
            mantissa = (lines[1] - lines[0]) / 10.0 ** np.floor(np.log10(lines[1] - lines[0]))
            assert min(abs(mantissa - good) for good in (1, 2, 2.5, 5, 10)) < 1e-6


def test_limits_hold_the_numbers_but_for_a_few_that_exploded() -> None:
    exploded = np.abs(np.sin(np.arange(500.0)))
    exploded[480:] = 1e30
    assert chart_of(exploded).limits[1] < 100
    wide = np.concatenate([np.linspace(5, 0.1, 30), np.full(200, 0.1) + 0.02 * np.sin(np.arange(200))])
    assert chart_of(wide).limits[1] >= 5
    assert chart_of(np.repeat([0.0, 1.0], [300, 10])).limits[1] >= 1  # its middle half has no width at all
    assert chart_of([3, 250, -4], limits=(0.0, 100.0)).limits == (0.0, 100.0)


def test_limits_do_not_flicker_while_the_numbers_still_fit() -> None:
    lines = plotting.steady_grid((0.0, 0.99), None)
    for most in (1.01, 0.97, 1.02, 0.95):
        lines = plotting.steady_grid((0.0, most), lines)
    np.testing.assert_array_equal(plotting.steady_grid((0.0, 0.93), lines), lines)
    assert plotting.steady_grid((0.0, 0.1), lines)[-1] < 0.5


# Curves


def test_smoothing_neither_lags_nor_bends_a_straight_line() -> None:
    x = np.arange(900.0)
    line = plotting.trace(x, 3 - 0.01 * x, (0, 899), 300, 9)
    np.testing.assert_allclose(line, 3 - 0.01 * np.linspace(0, 899, 300), atol=0.02)


def test_smoothing_takes_noise_away_and_keeps_a_bump_in_its_place() -> None:
    x = np.arange(2000.0)
    bump = np.exp(-(((x - 700) / 150) ** 2))
    noise = np.random.default_rng(0).normal(size=2000)
    line = plotting.trace(x, bump + 0.2 * noise, (0, 1999), 400, 9)
    assert abs(np.argmax(line) * 1999 / 399 - 700) < 60
    assert np.std(line - np.interp(np.linspace(0, 1999, 400), x, bump)) < 0.06


def test_an_unsmoothed_trace_passes_through_its_points() -> None:
    line = plotting.trace(np.array([0.0, 50, 100]), np.array([1.0, 0.0, 0.5]), (0, 100), 101, 0)
    assert (line[0], line[25], line[50], line[75], line[100]) == (1.0, 0.5, 0.0, 0.25, 0.5)


def test_values_that_are_no_numbers_make_a_gap() -> None:
    for bad in (NAN, INF, -INF):
        y = np.ones(101)
        y[40:60] = bad
        line = plotting.trace(np.arange(101.0), y, (0, 100), 101, 3)
        np.testing.assert_array_equal(np.isnan(line), np.isin(np.arange(101), np.arange(40, 60)))
    line = plotting.trace(np.array([0.0, 30, 50, 100]), np.array([1.0, 1.0, NAN, 1.0]), (0, 100), 101, 0)
    np.testing.assert_array_equal(np.isnan(line), np.isin(np.arange(101), np.arange(31, 100)))


@given(st.integers(1, 5000), st.integers(2, 400), st.integers(0, 2**32 - 1))
@settings(max_examples=40, deadline=None)
def test_thinning_keeps_extremes_and_at_most_a_point_a_column(count: int, columns: int, seed: int) -> None:
    y = np.random.default_rng(seed).normal(size=count)
    kept = plotting.thinned(np.arange(float(count)), y, (0.0, float(count)), columns)
    assert len(kept) <= columns + 1
    assert (np.diff(kept) > 0).all()
    assert y[kept].min() == y.min()
    assert y[kept].max() == y.max()


def test_a_stroke_is_as_thick_as_it_should_be_and_smooth() -> None:
    first, cover = plotting.stroke(np.full(40, 10.3), 30, 1.6)
    np.testing.assert_allclose(cover.sum(axis=0), 1.6, atol=1e-5)
    middle = (cover * (first + np.arange(len(cover)))[:, None]).sum(axis=0) / cover.sum(axis=0)
    np.testing.assert_allclose(middle, 10.3, atol=0.15)
    _, slanted = plotting.stroke(np.linspace(5, 45, 40), 60, 1.6)  # about 45 degrees: √2 thicker upright
    assert slanted.sum(axis=0)[5:-5].mean() == pytest.approx(1.6 * np.hypot(1, 40 / 39), rel=0.05)


# Pointing


def test_x_at_is_none_outside_and_never_beyond_the_axis() -> None:
    chart = chart_of(np.arange(21.0))
    plot = chart.plot
    assert chart.x_at((plot.x - 50, plot.centery)) is None
    assert chart.x_at((plot.centerx, chart.box.y - 10)) is None
    assert chart.x_at((plot.x - 3, plot.centery)) == 0.0
    assert chart.x_at((plot.right + 3, plot.centery)) == 20.0


def test_the_cursor_reads_the_nearest_point_of_each_run(canvas: Canvas, monkeypatch: pytest.MonkeyPatch) -> None:
    read: list[float] = []

    def reading(value: float) -> str:
        read.append(value)
        return str(value)

    chart = Chart(BOX, "RETURN", read=reading)
    chart.set(
        [
            Series([0.0, 10.0, 20.0], [1.0, 2.0, 3.0], "this run"),
            Series([0.0, 9.0, 20.0], [4.0, NAN, 6.0], "before", *RUN_STYLES[1]),
            Series([0.0, 1.0], [7.0, 8.0], "ended long ago", *RUN_STYLES[1]),
        ],
        (0.0, 20.0),
    )
    update_chart(chart)
    chart.draw(canvas)
    read.clear()
    chart.hover(chart.place(12.0, 2.0))
    chart.draw(canvas)
    assert read == [2.0, 6.0]  # nearest to 12 that are numbers; a run that had ended says nothing


def test_the_readout_stays_inside_the_box(canvas: Canvas, monkeypatch: pytest.MonkeyPatch) -> None:
    from game.ui import chart as module
    from game.ui.tooltip import draw_tooltip

    boxes = []
    original = draw_tooltip

    def draw(*arguments: object) -> pygame.FRect:
        boxes.append(original(*arguments))
        return boxes[-1]

    monkeypatch.setattr(module, "draw_tooltip", draw)
    chart = chart_of(np.arange(21.0))
    for x in (0.0, 7.0, 13.0, 20.0):
        chart.hover(chart.place(x, 3.0))
        chart.draw(canvas)
        assert chart.box.contains(boxes[-1])
    chart.hover((0.0, 0.0))
    chart.draw(canvas)
    assert len(boxes) == 4


# Drawing


def test_the_same_numbers_are_not_drawn_again(canvas: Canvas) -> None:
    def series(last: float) -> list[Series]:
        return [Series(np.arange(30.0), np.append(np.arange(29.0), last), "this run")]

    chart = Chart(BOX, "RETURN")
    chart.set(series(1.0), (0, 29))
    for _ in range(30):
        chart.update()
        chart.draw(canvas)
    redraws = chart.redraws
    for _ in range(30):
        chart.set(series(1.0), (0, 29))
        chart.hover(chart.place(float(_), 3.0))
        chart.update()
        chart.draw(canvas)
    assert chart.redraws == redraws
    chart.set(series(2.0), (0, 29))
    for _ in range(30):
        chart.update()
        chart.draw(canvas)
    assert chart.redraws == redraws + 1
    memory = np.arange(30.0)
    for last in (29.0, 28.5):  # an array that changes in place
        memory[-1], redraws = last, chart.redraws
        chart.set([Series(memory, memory, "this run")], (0, 29))
        update_chart(chart)
        chart.draw(canvas)
        assert chart.redraws > redraws


def test_a_new_window_size_is_drawn_at_once(canvas: Canvas) -> None:
    chart = chart_of(np.arange(20.0))
    chart.draw(canvas)
    canvas.attach(pygame.Surface((1920, 1080)))
    redraws = chart.redraws
    chart.draw(canvas)
    assert chart.redraws == redraws + 1


def test_runs_behind_follow_the_axes(drawn: Callable[[Chart], np.ndarray]) -> None:
    x = np.linspace(0.0, 20.0, 50)
    runs = [Series(x, x / 40, "this run"), Series(x, 1 - x / 40, "before", *RUN_STYLES[1])]
    chart, fresh = (Chart(BOX, "LOSS", limits=(0.0, 1.0)) for _ in range(2))
    pictures = []
    for end in (20.0, 40.0):
        chart.set(runs, (0.0, end))
        update_chart(chart)
        pictures.append(drawn(chart))
    fresh.set(runs, (0.0, 40.0))
    assert np.array_equal(drawn(fresh), pictures[1])


def test_charts_take_turns_and_rest(canvas: Canvas) -> None:
    boxes = [(40, 40 + 100 * number, 300, 90) for number in range(6)]
    charts = Charts([Chart(box, "A") for box in boxes])
    most = total = 0
    charts.draw(canvas)
    for frame in range(60):
        for chart in charts.charts:
            chart.set([Series(np.arange(9.0), np.arange(9.0) + 1e-6 * frame, "this run")], (0, 8))
        before = [chart.redraws for chart in charts.charts]
        charts.update()
        charts.draw(canvas)
        drawn = sum(chart.redraws for chart in charts.charts) - sum(before)
        most, total = max(most, drawn), total + drawn
    assert most == 1
    assert 6 * 8 <= total <= 6 * 10
    assert min(chart.redraws for chart in charts.charts) >= 8


def test_decades_enclose_what_is_shown() -> None:
    for low, high, lines in (
        (0.3, 700.0, [0.2, 1, 10, 100, 1000]), (1.0, 10.0, [1, 10]), (2.1, 4.0, [2, 5]), (0.9, 1.1, [0.5, 1, 2]),
        (3.0, 3.0, [2, 5]),
    ):  # fmt: skip
        np.testing.assert_allclose(10 ** plotting.decades(np.log10(low), np.log10(high)), lines)
    assert np.isfinite(plotting.decades(-300.0, 300.0)).all()


def test_on_a_log_axis_a_tenth_is_as_far_as_ten_times_and_values_are_read_as_they_are(canvas: Canvas) -> None:
    chart = Chart((40, 40, 300, 100), "LOSS", log=True)
    x = np.arange(4.0)
    chart.set([Series(x, [1.0, 10.0, 100.0, 0.0], "this run", smooth=False)], (0, 3))
    chart.update(at_once=True)
    chart.draw(canvas)
    heights = [chart.place(0.0, np.log10(value))[1] for value in (1.0, 10.0, 100.0)]
    assert heights[0] - heights[1] == pytest.approx(heights[1] - heights[2])
    assert chart.read(2.0) == "100"
    assert chart.runs[0].last() == 2.0, "the logarithm of the last value that has one"


def test_the_curve_is_where_its_values_are(drawn: Callable[[Chart], np.ndarray]) -> None:
    chart = chart_of(np.full(100, 25.0), limits=(0.0, 100.0))
    pixels = drawn(chart)
    blue = pixels[:, :, 2].astype(int) - pixels[:, :, 0]
    rows = blue[20:-20].sum(axis=0)
    assert rows.argmax() == pytest.approx(0.75 * (pixels.shape[1] - 1), abs=1)


UGLY = {
    "nothing": [],
    "one point": [3.0],
    "no number at all": [NAN] * 9,
    "infinite": [INF, -INF, 1.0, INF],
    "one number among none": [NAN, 2.0, NAN, NAN],
    "constant": [7.0] * 40,
    "zero": [0.0] * 40,
    "negative": [-5.0, -400.0, -3e5],
    "exploding": list(10.0 ** np.arange(-8.0, 31.0)),
    "as large as can be": [-1e300, 1e300, 1e308, -1e308, 0.0],
    "as small as can be": [5e-324, 1e-310, 0.0],
    "alternating": [(-1.0) ** k * 1e12 for k in range(60)],
}


def test_ugly_numbers_are_drawn(canvas: Canvas) -> None:
    for name, y in UGLY.items():
        for smooth in (True, False):
            chart = Chart(BOX, "LOSS")
            x = np.arange(len(y))
            series = [Series(x, y, "this run", smooth=smooth), Series(x, y, "b", *RUN_STYLES[1])]
            chart.set(series, (0.0, len(y)), [Tick(1.0, "checkpoint"), Tick(1e9, "a knob", "knob")])
            chart.mark(
                2.0, "checkpoint 2 s: fly against it, and a caption that is much too long for such a small chart"
            )
            for point in ((60.0, 500.0), (405.0, 577.0), None):
                chart.hover(point)
                update_chart(chart, 30)
                chart.draw(canvas)
            low, high = chart.limits
            assert np.isfinite([low, high]).all(), name
            assert low < high, name
    for x_range in ((0.0, 0.0), (5.0, 1.0), (NAN, 3.0), (0.0, INF)):
        chart = Chart(BOX, "LOSS")
        chart.set([Series([0.0, NAN, 2.0], [1.0, 2.0, 3.0, 4.0], "this run")], x_range)
        chart.draw(canvas)
        assert chart.x_at(chart.plot.center) is not None, x_range


def test_numbers_are_written_short() -> None:
    for value, text in (
        (0.0, "0"), (0.0213, "0.0213"), (0.84, "0.840"), (-0.5, "−0.500"), (118.2, "118"), (12_345, "12.3k"),
        (148_000, "148k"), (1.23e30, "1.2e30"), (-4e-7, "−4.0e−7"), (NAN, "–"), (INF, "–"),
    ):  # fmt: skip
        assert plotting.compact(value) == text


def test_an_axis_that_begins_later_has_its_ends_at_the_ends_of_the_plot(canvas: Canvas) -> None:
    chart = Chart((40, 40, 300, 100), "LOSS", limits=(0.0, 1.0))
    x = np.linspace(10.0, 20.0, 50)
    chart.set([Series(x, np.full(50, 0.5), "this run")], (10.0, 20.0))
    places = [chart.place(value, 0.5)[0] for value in (10.0, 15.0, 20.0)]
    assert places == pytest.approx([chart.plot.left, chart.plot.centerx, chart.plot.right])
    assert [chart.x_at((place, chart.plot.centery)) for place in places] == pytest.approx([10.0, 15.0, 20.0])


def test_an_outburst_does_not_flatten_a_chart_for_ever():
    def limits(after: int) -> tuple[float, float]:
        """Limits so many points after an outburst, of a curve that has climbed from -200 to 150."""
        climb, burst = np.linspace(-200.0, 150.0, 40), np.linspace(-3000.0, -2500.0, 40)
        values = np.concatenate([climb, burst, np.linspace(100.0, 150.0, after)])
        chart = Chart((0, 0, 300, 100), "SCORE")
        chart.set([Series(np.arange(len(values)), values, "run")], (0.0, len(values)))
        return chart.limits

    assert limits(0)[0] < -2000.0, "while it lasts, it is shown"
    assert -500.0 < limits(120)[0] <= -200.0, "and then the climb before it is seen again"
