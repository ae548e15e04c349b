"""Runs side by side: their names, their lines, and the axis they are measured by."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from ai.training.history import History
from game.core import texts
from game.scenes.train.charts import TrainingCharts
from game.training.beside import EarlierRun, put_beside, rename_beside, take_away
from game.ui.series import run_style
from tests.ai.training.test_hints import HEALTHY


def run_of(seconds: float, decisions: float) -> History:
    run = History()
    for number in range(50):
        share = number / 49
        run.append(replace(HEALTHY, seconds=share * seconds, decisions=share * decisions))
    return run


def test_a_run_keeps_its_style_as_others_come_and_go():
    runs: list[EarlierRun] = []
    for number in range(12):
        put_beside(runs, f"run {number}", History())
    styles = {each.name: each.style for each in runs}
    assert len(set(styles.values())) == 12
    assert 0 not in styles.values(), "that is the run that goes on"
    take_away(runs, styles["run 3"])
    assert {each.name: each.style for each in runs} == {
        name: style for name, style in styles.items() if name != "run 3"
    }
    new, again = History(), History()
    put_beside(runs, "new", new)
    assert runs[0] == EarlierRun("new", new, styles["run 3"])
    put_beside(runs, "run 7", again)
    assert runs[0] == EarlierRun("run 7", again, styles["run 7"])
    assert len(runs) == 12


def test_a_run_beside_is_renamed_but_not_to_the_name_of_another():
    runs: list[EarlierRun] = []
    first, second = History(), History()
    put_beside(runs, "a", first)
    put_beside(runs, "b", second)
    style = runs[0].style
    assert rename_beside(runs, style, "a") == texts.COMPARE_NAME_TAKEN
    assert rename_beside(runs, style, "") == texts.COMPARE_NAME_EMPTY
    assert rename_beside(runs, style, "b") == ""
    assert rename_beside(runs, style, "bold") == ""
    assert [(each.name, each.run) for each in runs] == [("bold", second), ("a", first)]


def test_lines_of_many_runs_differ_in_colour_or_dashes_and_neighbours_in_both():
    styles = [run_style(number) for number in range(1, 25)]
    assert len(set(styles)) == 24
    for (colour, dash), (other, dashes) in pairwise(styles):
        assert colour != other
        assert dash != dashes
    assert run_style(0)[1] == ()
    assert run_style(25) == run_style(1)


def look(training_charts: TrainingCharts, history: History, beside: list[EarlierRun]) -> None:
    for _ in range(12):
        training_charts.look(history, beside)


@pytest.mark.parametrize(("axis", "end", "reach"), [(0, 367.0, 12.0), (1, 4e6, 2e5), (2, 100.0, 100.0)])
def test_a_short_run_beside_a_long_one_can_be_measured_so_that_it_is_seen(axis: int, end: float, reach: float):
    training_charts, short = TrainingCharts(), run_of(12.0, 200_000.0)
    look(training_charts, short, [EarlierRun("long", run_of(367.0, 4e6), 1)])
    training_charts.measure_by(axis)
    look(training_charts, short, [EarlierRun("long", run_of(367.0, 4e6), 1)])
    for chart in training_charts.charts.charts:
        assert chart.x_range == pytest.approx((0.0, end))
        assert chart.runs[0].x[-1] == pytest.approx(reach)
        assert chart.read_x(end) == texts.TRAIN_AXIS[axis].format(end)


@pytest.mark.parametrize(("axis", "place"), [(0, 50.0), (1, 500_000.0), (2, 50.0)])
def test_a_place_on_the_axis_is_a_moment_of_the_run(axis: int, place: float):
    training_charts, run = TrainingCharts(), run_of(100.0, 1e6)
    training_charts.measure_by(axis)
    look(training_charts, run, [])
    assert training_charts.decisions_at(place) == pytest.approx(500_000)
    assert training_charts.decisions_at(2e6) == np.inf, "beyond its end is now"
    training_charts.moment = 500_000
    look(training_charts, run, [])
    for chart in training_charts.charts.charts:
        assert chart.marker == pytest.approx(place)
