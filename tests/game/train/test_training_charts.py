"""The charts of runs: in points whatever a network counts in, and side by side on one axis."""

from dataclasses import replace

import numpy as np
import pytest

from ai.digits.training import DigitProgress
from ai.training.config import PRESETS, Config
from ai.training.history import COLUMNS, DIGIT_COLUMNS, History, SettingChange, Validation
from ai.training.loop import PARTS
from game.core import texts
from game.scenes.train.charts import DIGIT_CHARTS, LANDER_CHARTS, Beside, TrainingCharts, ticks_of
from tests.support.points import HEALTHY, point

NUMBERS = list(COLUMNS[: -len(PARTS)])


def run_of(config: Config, points: float) -> History:
    """A run whose network hopes for so many points of reward, as it tells of it."""
    history = History()
    history.reward_scale = config.reward_scale
    for second in range(20):
        values = dict.fromkeys(NUMBERS, 1.0) | {"seconds": float(second), "mean_q": points * config.reward_scale}
        history.append(point(**values, parts=(0.0, 40.0, *[0.0] * (len(PARTS) - 3), -39.0)))
    return history


def long_run(seconds: float, decisions: float) -> History:
    history = History()
    for number in range(50):
        share = number / 49
        history.append(replace(HEALTHY, seconds=share * seconds, decisions=share * decisions))
    return history


def looked(history: History, beside: Beside | None = None, moment: int | None = None) -> TrainingCharts:
    charts = TrainingCharts(LANDER_CHARTS)
    charts.take(history, beside, "", moment)
    return charts


def test_what_is_expected_is_drawn_and_said_in_points() -> None:
    modern, classic = (run_of(PRESETS[name], -80.0) for name in ("modern", "classic"))
    assert modern["mean_q"][0] != classic["mean_q"][0]
    for history in (modern, classic):
        chart = looked(history).charts[1]
        earned, expected = chart.runs
        np.testing.assert_allclose(expected.y, -80.0, rtol=1e-6)
        np.testing.assert_allclose(earned.y, 1.0)
        said = texts.TRAIN_SCORES.format(earned=1, expected=-80)
        assert chart.caption == said.replace("-", "−")


def test_an_experiment_that_is_paid_otherwise_is_not_compared_by_its_pay() -> None:
    healthy, other = (run_of(PRESETS["modern"], 80.0) for _ in range(2))
    landed, score = looked(healthy, Beside("other", other, in_step=True, paid_otherwise=True)).charts
    assert [run.name for run in landed.runs] == [texts.TRAIN_THIS, "other"]
    assert [run.name for run in score.runs] == [texts.TRAIN_THIS]


def test_a_run_of_digits_shows_new_digits_and_dashed_those_it_learns_from() -> None:
    history = History(DIGIT_COLUMNS)
    for second in range(1, 5):
        history.append(DigitProgress(float(second), second, 1.0, 0.1 * second, 0.5, 0.01, 1.0))
        history.append(Validation(second, 0.9, 0.9, best=True, seconds=float(second)))
    history.append(SettingChange(2, "learning_rate", 0.1, 0.2, seconds=2.0))
    charts = TrainingCharts(DIGIT_CHARTS)
    charts.take(history, None, "", None)
    loss, accuracy = charts.charts
    assert loss.runs[0].y.tolist() == pytest.approx([0.1, 0.2, 0.3, 0.4])
    assert [run.y.tolist() for run in accuracy.runs] == [[90.0] * 4, [50.0] * 4]
    assert accuracy.caption == texts.DIGIT_RUN_BOTH.format(90.0, 50.0)
    (tick,) = ticks_of(history)
    assert (tick.x, tick.text) == (2.0, f"{texts.KNOBS['learning_rate']} 0.2")


def test_a_run_before_is_measured_by_the_same_seconds_and_an_experiment_by_the_same_decisions() -> None:
    for chart in looked(long_run(12.0, 2e5), Beside("long", long_run(367.0, 4e6))).charts:
        assert chart.end == pytest.approx(367.0)
        assert chart.runs[0].x[-1] == pytest.approx(12.0)
    quick = long_run(30.0, 1e6)  # it learns in a third of the time, and waits for its twin
    for chart in looked(long_run(90.0, 1e6), Beside("quick", quick, in_step=True)).charts:
        assert [run.x[-1] for run in chart.runs] == pytest.approx([90.0, 90.0])


def test_a_place_on_the_axis_is_a_moment_of_the_run() -> None:
    run = long_run(100.0, 1e6)
    charts = looked(run)
    assert charts.decisions_at(50.0) == pytest.approx(500_000)
    assert charts.decisions_at(200.0) == np.inf, "beyond its end is now"
    assert charts.charts[0].marker is None
    assert [chart.marker for chart in looked(run, moment=500_000).charts] == pytest.approx([50.0] * 2)
