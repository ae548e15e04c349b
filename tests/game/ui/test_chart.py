from collections.abc import Sequence
from typing import Any

import numpy as np
import pygame
import pytest

from game.drawing.canvas import Canvas
from game.drawing.tokens import NET
from game.ui import chart as module
from game.ui import plotting
from game.ui.chart import Chart
from game.ui.charts import Charts
from game.ui.curves import BESIDE, Series, Tick
from game.ui.tooltip import draw_tooltip

NAN, INF = float("nan"), float("inf")


@pytest.fixture
def canvas() -> Canvas:
    return Canvas(pygame.Surface((1280, 720)))


def chart_of(*runs: Sequence[float], **options: Any) -> Chart:
    """A chart of runs that tell a value every second."""
    chart = Chart("LOSS", empty="nothing yet", **options)
    chart.move(pygame.FRect(40, 450, 372, 128))
    series = [Series(range(len(y)), y, f"run {n}", *(BESIDE if n else (NET, ()))) for n, y in enumerate(runs)]
    chart.set(series, max([1.0, *(len(y) - 1.0 for y in runs)]), [Tick(1.0, "checkpoint"), Tick(1.0, "a knob", "knob")])
    return chart


def point_at(chart: Chart, place: tuple[float, float]) -> None:
    Charts([chart]).follow(pygame.Event(pygame.MOUSEMOTION, pos=place))


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


def test_smoothing_takes_noise_away_and_keeps_a_slope_and_a_bump_in_their_place() -> None:
    x = np.arange(900.0)
    line = plotting.trace(x, 3 - 0.01 * x, 899, 300, 9)
    np.testing.assert_allclose(line, 3 - 0.01 * np.linspace(0, 899, 300), atol=0.02)
    x = np.arange(2000.0)
    bump, noise = np.exp(-(((x - 700) / 150) ** 2)), np.random.default_rng(0).normal(size=2000)
    line = plotting.trace(x, bump + 0.2 * noise, 1999, 400, 9)
    assert abs(np.argmax(line) * 1999 / 399 - 700) < 60
    assert np.std(line - np.interp(np.linspace(0, 1999, 400), x, bump)) < 0.06


def test_an_unsmoothed_trace_passes_through_its_points_and_ends_with_them() -> None:
    line = plotting.trace(np.array([0.0, 50, 100]), np.array([1.0, 0.0, 0.5]), 200, 201, 0)
    assert (line[0], line[25], line[50], line[75], line[100]) == (1.0, 0.5, 0.0, 0.25, 0.5)
    assert np.isnan(line[101:]).all()


def test_a_stroke_is_as_thick_as_it_should_be_and_smooth() -> None:
    first, cover = plotting.stroke(np.full(40, 10.3), 30, 1.6)
    np.testing.assert_allclose(cover.sum(axis=0), 1.6, atol=1e-5)
    middle = (cover * (first + np.arange(len(cover)))[:, None]).sum(axis=0) / cover.sum(axis=0)
    np.testing.assert_allclose(middle, 10.3, atol=0.15)
    _, slanted = plotting.stroke(np.linspace(5, 45, 40), 60, 1.6)  # about 45 degrees: √2 thicker upright
    assert slanted.sum(axis=0)[5:-5].mean() == pytest.approx(1.6 * np.hypot(1, 40 / 39), rel=0.05)


def test_x_at_is_none_outside_and_never_beyond_the_axis() -> None:
    chart = chart_of(np.arange(21.0))
    plot = chart.plot
    assert chart.x_at((plot.x - 50, plot.centery)) is None
    assert chart.x_at((plot.centerx, chart.box.y - 10)) is None
    assert chart.x_at((plot.x - 3, plot.centery)) == 0.0
    assert chart.x_at((plot.right + 3, plot.centery)) == 20.0


def test_the_cursor_reads_the_nearest_point_of_each_run_inside_the_box(
    canvas: Canvas, monkeypatch: pytest.MonkeyPatch
) -> None:
    said, boxes = [], []

    def draw(*given: Any) -> None:
        said.append(([row.figure for row in given[4]], given[3]))
        boxes.append(draw_tooltip(*given))

    monkeypatch.setattr(module, "draw_tooltip", draw)
    chart = chart_of(np.arange(21.0), [*range(12), NAN, *range(33, 41)], [7.0, 8.0])
    for x in (0.0, 1.0, 12.4, 20.0):
        point_at(chart, chart.place(x, 3.0))
        chart.draw(canvas)
        assert chart.box.contains(boxes[-1])
    assert said[1][1][1:] == ["a knob"], "rather than the checkpoint of that moment"
    assert said[2][0] == ["12.0", "33.0"]  # the nearest that are numbers; a run that had ended says nothing
    point_at(chart, (0.0, 0.0))
    chart.draw(canvas)
    assert len(boxes) == 4


def test_the_curve_is_where_its_values_are(canvas: Canvas) -> None:
    chart = chart_of(np.full(100, 25.0), limits=(0.0, 100.0))
    chart.draw(canvas)
    pixels = pygame.surfarray.array3d(canvas.surface.subsurface(canvas.rect(*chart.plot))).astype(int)
    rows = (pixels[20:-20, :, 2] - pixels[20:-20, :, 0]).sum(axis=0)
    assert rows.argmax() == pytest.approx(0.75 * (pixels.shape[1] - 1), abs=1)


UGLY = {
    "nothing": [],
    "one point": [3.0],
    "no number at all": [NAN] * 9,
    "infinite": [INF, -INF, 1.0, INF],
    "constant": [7.0] * 40,
    "zero": [0.0] * 40,
    "negative": [-5.0, -400.0, -3e5],
    "exploding": list(10.0 ** np.arange(-8.0, 31.0)),
    "as large as can be": [-1e300, 1e300, 1e308, -1e308, 0.0],
    "as small as can be": [5e-324, 1e-310, 0.0],
}


def test_ugly_numbers_are_drawn(canvas: Canvas) -> None:
    for name, y in UGLY.items():
        chart = chart_of(y, y)
        chart.mark(1.0, "checkpoint 2 s: fly against it, and a caption that is much too long for such a small chart")
        for point in ((60.0, 500.0), (405.0, 577.0)):
            point_at(chart, point)
            chart.draw(canvas)
        low, high = chart.limits
        assert np.isfinite([low, high]).all(), name
        assert low < high, name


def test_numbers_are_written_short() -> None:
    for value, text in (
        (0.0, "0"), (0.0213, "0.0213"), (0.84, "0.840"), (-0.5, "−0.500"), (118.2, "118"), (12_345, "12.3k"),
        (148_000, "148k"), (1.23e30, "1.2e30"), (-4e-7, "−4.0e−7"), (NAN, "–"), (INF, "–"),
    ):  # fmt: skip
        assert plotting.compact(value) == text
