"""The charts of runs: in points whatever a network counts in, and side by side on one axis."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from ai.digits.training import DigitProgress
from ai.training.config import PRESETS, Config
from ai.training.history import COLUMNS, DIGIT_COLUMNS, History, SettingChange, Validation
from ai.training.lander_session import LanderSession
from ai.training.loop import PARTS
from ai.training.messages import RunStarted
from game.core import texts
from game.core.worker import WorkerState
from game.scenes.train.charts import DIGIT_CHARTS, LANDER_CHARTS, Beside, TrainingCharts, ticks_of
from game.training.library import Library
from game.training.record import EarlierRun, put_beside, take_away
from game.training.run import TrainingRun
from game.training.run_kind import LANDERS
from game.ui.curves import run_style
from tests.support.points import HEALTHY, point

NUMBERS = list(COLUMNS[: -len(PARTS)])


def run_of(config: Config, points: float) -> History:
    """A run whose network hopes for so many points of reward, as it tells of it."""
    history = History()
    history.reward_scale = config.reward_scale
    for second in range(20):
        values = dict.fromkeys(NUMBERS, 1.0) | {"seconds": float(second), "mean_q": points * config.reward_scale}
        history.append(point(**values))
    return history


def long_run(seconds: float, decisions: float) -> History:
    history = History()
    for number in range(50):
        share = number / 49
        history.append(replace(HEALTHY, seconds=share * seconds, decisions=share * decisions))
    return history


def looked(
    charts: TrainingCharts, history: History, beside: Beside | None = None, moment: int | None = None
) -> TrainingCharts:
    charts.take(history, beside or Beside(), "", moment)
    for _ in charts.charts:
        charts.go_on()
    return charts


def test_what_is_expected_is_drawn_and_said_in_points_whatever_networks_count_in() -> None:
    modern, classic = (run_of(PRESETS[name], -80.0) for name in ("modern", "classic"))
    assert modern["mean_q"][0] != classic["mean_q"][0]
    for history in (modern, classic):
        chart = looked(TrainingCharts(LANDER_CHARTS), history).charts[1]
        earned, expected = chart.runs
        np.testing.assert_allclose(expected.y, -80.0, rtol=1e-6)
        np.testing.assert_allclose(earned.y, 1.0)
        assert chart.caption == texts.TRAIN_SCORES.format(1, -80).replace("-", "−")
    chart = looked(TrainingCharts(LANDER_CHARTS), run_of(PRESETS["modern"], -0.2)).charts[1]
    assert chart.caption == texts.TRAIN_SCORES.format(1, 0), "no −0"


def test_a_twin_that_is_paid_otherwise_is_not_compared_by_its_pay() -> None:
    healthy, other = (run_of(PRESETS["modern"], 80.0) for _ in range(2))
    charts = TrainingCharts(LANDER_CHARTS)
    charts.show(more=True)
    looked(charts, healthy, Beside([EarlierRun("other", other, 1)], "healthy", paid_otherwise=True))
    compared = {chart.label: [run.name for run in chart.runs] for chart in charts.charts}
    for name in ("success", "loss", "epsilon"):
        assert compared[texts.TRAIN_CHARTS[name]] == ["healthy", "other"], name
    assert "other" not in compared[texts.TRAIN_CHARTS["mean_return"]]


def test_a_run_of_digits_shows_new_digits_and_dashed_those_it_learns_from() -> None:
    history = History(DIGIT_COLUMNS)
    for second in range(1, 5):
        history.append(DigitProgress(float(second), second, 1.0, 0.1 * second, 0.5, 0.01, 1.0))
        history.append(Validation(second, 0.9, 0.9, best=True, seconds=float(second)))
    history.append(SettingChange(2, "learning_rate", 0.1, 0.2, seconds=2.0))
    loss, accuracy = looked(TrainingCharts(DIGIT_CHARTS), history).charts
    assert loss.runs[0].y.tolist() == pytest.approx([0.1, 0.2, 0.3, 0.4])
    assert [run.y.tolist() for run in accuracy.runs] == [[90.0] * 4, [50.0] * 4]
    assert accuracy.caption == texts.DIGIT_RUN_BOTH.format(90.0, 50.0)
    (tick,) = ticks_of(history)
    assert (tick.x, tick.text) == (2.0, f"{texts.KNOBS['learning_rate']} 0.2")


def flown() -> History:
    history = History()
    history.append(HEALTHY)
    return history


def test_a_run_keeps_its_style_as_others_come_and_go() -> None:
    runs: list[EarlierRun] = []
    for number in range(12):
        put_beside(runs, f"run {number}", flown())
    put_beside(runs, "without a curve", History())
    styles = {each.name: each.style for each in runs}
    assert len(set(styles.values())) == 12
    assert 0 not in styles.values(), "that is the run that goes on"
    take_away(runs, styles["run 3"])
    assert {each.name: each.style for each in runs} == {name: each for name, each in styles.items() if name != "run 3"}
    new, again = flown(), flown()
    put_beside(runs, "new", new)
    assert runs[0] == EarlierRun("new", new, styles["run 3"])
    put_beside(runs, "run 7", again)
    assert runs[0] == EarlierRun("run 7", again, styles["run 7"])
    assert len(runs) == 12


def test_lines_of_many_runs_differ_in_colour_or_dashes_and_neighbours_in_both() -> None:
    styles = [run_style(number) for number in range(1, 25)]
    assert len(set(styles)) == 24
    for (colour, dash), (other, dashes) in pairwise(styles):
        assert colour != other
        assert dash != dashes
    assert run_style(0)[1] == ()
    assert run_style(25) == run_style(1)


def test_a_short_run_beside_a_long_one_is_measured_by_the_same_seconds() -> None:
    charts = TrainingCharts(LANDER_CHARTS)
    looked(charts, long_run(12.0, 200_000.0), Beside([EarlierRun("long", long_run(367.0, 4e6), 1)]))
    for chart in charts.charts:
        assert chart.end == pytest.approx(367.0)
        assert chart.runs[0].x[-1] == pytest.approx(12.0)


def test_a_place_on_the_axis_is_a_moment_of_the_run() -> None:
    charts, run = TrainingCharts(LANDER_CHARTS), long_run(100.0, 1e6)
    looked(charts, run)
    assert charts.decisions_at(50.0) == pytest.approx(500_000)
    assert charts.decisions_at(200.0) == np.inf, "beyond its end is now"
    looked(charts, run, moment=500_000)
    assert [chart.marker for chart in charts.charts] == pytest.approx([50.0] * 2)
    looked(charts, run)
    assert charts.charts[0].marker is None


def test_a_run_says_in_which_unit_it_counts(tmp_path, monkeypatch: pytest.MonkeyPatch) -> None:
    config = PRESETS["classic"].changed(num_envs=1, hidden=(4,))
    session = LanderSession.live(config, 0, keep=tmp_path / "run")
    messages = next(session)
    for _ in range(3):
        next(session)
    session.close()
    assert History.read(tmp_path / "run").reward_scale == config.reward_scale

    class StubWorker:
        state = WorkerState.RUNNING

        def __init__(self, *_: object, **__: object) -> None: ...
        def set_pace(self, _: object) -> None: ...
        def poll(self) -> tuple[object, ...]:
            return tuple(message for message in messages if isinstance(message, RunStarted))

    monkeypatch.setattr("game.training.run.Worker", StubWorker)
    run = TrainingRun(LANDERS, Library(tmp_path))
    run.begin(config, 0)
    run.poll()
    assert run.history.reward_scale == config.reward_scale
