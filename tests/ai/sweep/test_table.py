"""Progress of a study: a table in a terminal, few lines in a log, and the time left."""

import io

import pytest

from ai.sweep.results import FinishedTrial
from ai.sweep.study import Study
from ai.sweep.table import Table, duration
from tests.support.studies import tiny_plan

PARAMS = {"learning_rate": 0.001, "tau": 0.01}


class Terminal(io.StringIO):
    def isatty(self):
        return True


class Clock:
    now = 0.0

    def __call__(self):
        return self.now


def trial(number, at=400, value=1.0):
    return FinishedTrial(number, PARAMS, value, at, False, 1.0, ())


@pytest.fixture
def study(tmp_path):
    return Study.create(tmp_path / "study", tiny_plan())


def test_a_log_has_a_line_for_each_new_best_alone(study):
    log = io.StringIO()
    table = Table(study, 2, log, Clock())
    for number, value in enumerate((5.0, 3.0, 7.0)):
        table.begin(number, PARAMS)
        table.progress(trial(number, 200, value))
        table.draw()
        study.record(trial(number, value=value))
        table.finish(trial(number, value=value))
    assert [line.partition(":")[0] for line in log.getvalue().splitlines()] == ["1 of 4 trials", "3 of 4 trials"]


def test_a_terminal_has_a_table_that_is_redrawn_in_place(study):
    screen, clock = Terminal(), Clock()
    table = Table(study, 2, screen, clock)
    table.begin(0, PARAMS)
    table.draw()
    assert screen.getvalue() == "", "not more often than one can read"
    clock.now = 1.0
    table.draw()
    assert "0 of 4 trials, 1 running" in screen.getvalue()
    assert "learning_rate=0.001" in screen.getvalue()
    clock.now = 2.0
    table.draw()
    assert "\x1b[2A\x1b[J" in screen.getvalue(), "it takes the place of the one before"


def test_the_time_left_is_that_of_the_work_left(study):
    clock = Clock()
    table = Table(study, 1, io.StringIO(), clock)
    assert table.seconds_left() is None
    table.begin(0, PARAMS)
    clock.now = 10.0
    table.progress(trial(0, 200))  # an eighth of the work in 10 s
    assert table.seconds_left() == pytest.approx(70.0)
    study.record(trial(0))
    table.finish(trial(0))
    clock.now = 20.0
    assert table.seconds_left() == pytest.approx(60.0)
    assert [duration(seconds) for seconds in (12, 300, 8000)] == ["12 s", "5 min", "2 h 13 min"]
