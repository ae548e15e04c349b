"""Runs side by side: their names, their lines, and the axis they are measured by."""

from dataclasses import replace

import numpy as np
import pytest

from ai.training.history import History
from game.core import texts
from game.panels.training_charts import TrainingCharts
from game.training.training_run import EARLIER, EarlierRun, put_beside
from tests.ai.training.test_hints import HEALTHY


def run_of(seconds: float, decisions: float) -> History:
    run = History()
    for number in range(50):
        share = number / 49
        run.append(replace(HEALTHY, seconds=share * seconds, decisions=share * decisions))
    return run


def test_a_run_keeps_its_style_as_others_come_and_go():
    runs: list[EarlierRun[str]] = []
    for name in ("a", "b", "c"):
        assert put_beside(runs, name, name) == ""
    styles = {each.name: each.style for each in runs}
    assert len(set(styles.values())) == 3
    assert 0 not in styles.values(), "that is the run that goes on"
    assert put_beside(runs, "d", "d") == "a", "who makes room is told"
    assert len(runs) == EARLIER
    assert {each.name: each.style for each in runs} == {"b": styles["b"], "c": styles["c"], "d": styles["a"]}
    assert put_beside(runs, "c", "again") == ""
    assert next(each.style for each in runs if each.name == "c") == styles["c"]


def look(training_charts: TrainingCharts, history: History, beside: list[EarlierRun[History]]) -> None:
    for _ in range(12):
        training_charts.look(history, beside)


@pytest.mark.parametrize(("axis", "end", "reach"), [(0, 367.0, 12.0), (1, 4e6, 2e5), (2, 100.0, 100.0)])
def test_a_short_run_beside_a_long_one_can_be_measured_so_that_it_is_seen(axis: int, end: float, reach: float):
    training_charts, short = TrainingCharts(), run_of(12.0, 200_000.0)
    look(training_charts, short, [EarlierRun("long", run_of(367.0, 4e6), 1)])
    training_charts.measure_by(axis)
    look(training_charts, short, [EarlierRun("long", run_of(367.0, 4e6), 1)])
    for chart in training_charts.charts.charts:
        assert chart.x_range == (0.0, pytest.approx(end))
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
