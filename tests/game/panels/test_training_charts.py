"""The charts of runs whose networks count in different units."""

import numpy as np
import pytest

from ai.training.config import PRESETS, Config
from ai.training.history import COLUMNS, History, Point
from ai.training.lander_session import live
from ai.training.messages import RunStarted
from game.core import texts
from game.core.worker import WorkerState
from game.scenes.train.charts import TrainingCharts
from game.training.beside import EarlierRun
from game.training.library import Library
from game.training.run import TrainingRun
from game.training.workers import LANDERS
from game.ui.chart import Chart, Series

NUMBERS = list(COLUMNS[:10])


def run(config: Config, points: float) -> History:
    """A run whose network hopes for so many points of reward, as it tells of it."""
    history = History()
    history.reward_scale = config.reward_scale
    for second in range(20):
        values = dict.fromkeys(NUMBERS, 1.0) | {
            "seconds": float(second),
            "mean_q": points * config.reward_scale,
        }
        history.append(Point(**values))
    return history


def test_what_is_expected_is_drawn_in_points_whatever_networks_count_in(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    drawn: dict[str, list[Series]] = {}
    monkeypatch.setattr(Chart, "set", lambda chart, series, *_: drawn.update({chart.label: series}))
    modern, classic = (run(PRESETS[name], 80.0) for name in ("modern", "classic"))
    assert modern["mean_q"][0] != classic["mean_q"][0]
    for history in (modern, classic):
        training_charts = TrainingCharts()
        for _ in range(24):
            training_charts.look(history, [])
        earned, expected = drawn[texts.TRAIN_CHARTS["mean_return"]]
        np.testing.assert_allclose(expected.y, 80.0, rtol=1e-6)
        np.testing.assert_allclose(earned.y, 1.0)


def test_what_is_said_of_both_scores_are_the_numbers_of_their_curves(monkeypatch: pytest.MonkeyPatch) -> None:
    training_charts = TrainingCharts()
    for _ in range(24):
        training_charts.look(run(PRESETS["modern"], -80.0), [])
    said = training_charts.charts.charts[1].caption
    assert said == texts.TRAIN_SCORES.format(earned=1, expected=-80).replace("-", "−")


def test_a_twin_that_is_paid_otherwise_is_not_compared_by_its_pay(monkeypatch: pytest.MonkeyPatch) -> None:
    drawn: dict[str, int] = {}
    monkeypatch.setattr(Chart, "set", lambda chart, series, *_: drawn.update({chart.label: len(series)}))
    training_charts = TrainingCharts(more=True)
    healthy, other = (run(PRESETS["modern"], 80.0) for _ in range(2))
    for _ in range(24):
        training_charts.look(healthy, [EarlierRun("other", other, 1)], paid_otherwise=True)
    compared = {name for name in texts.TRAIN_CHARTS if drawn[texts.TRAIN_CHARTS[name]] == 2}
    assert compared == {"success", "loss", "epsilon"}


@pytest.mark.parametrize("preset", ["modern", "classic"])
def test_a_run_says_in_which_unit_it_counts(preset: str, tmp_path, monkeypatch: pytest.MonkeyPatch) -> None:
    config = PRESETS[preset].changed(num_envs=1, hidden=(4,))
    session = live(config, 0, keep=tmp_path / "run")
    told = next(session)
    for _ in range(3):
        next(session)
    session.close()
    assert History.read(tmp_path / "run").reward_scale == config.reward_scale

    class Tells:
        state = WorkerState.RUNNING

        def __init__(self, *_: object, **__: object) -> None: ...
        def set_pace(self, _: object) -> None: ...
        def poll(self) -> tuple[object, ...]:
            return tuple(message for message in told if isinstance(message, RunStarted))

    monkeypatch.setattr("game.training.run.Worker", Tells)
    lander_run = TrainingRun(LANDERS, Library(tmp_path))
    lander_run.begin(config, 0)
    lander_run.poll()
    assert lander_run.history.reward_scale == config.reward_scale
