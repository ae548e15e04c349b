"""Train's few knobs and its laboratory, through real pygame events; with real workers where their processes matter."""

import os
import signal
from dataclasses import replace
from functools import partial
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pygame
import pytest

from ai.files import read_json
from ai.training.config import PRESETS, Config, in_force
from ai.training.experiments import SABOTAGES, VERDICTS, sabotaged
from ai.training.history import History
from ai.training.loop import Training
from game.core import texts
from game.core.worker import WorkerState
from game.scenes.learn.scene import ChapterScene
from game.scenes.menus.dialogs import QuestionDialog
from game.scenes.train.knob import Knob
from game.scenes.train.laboratory import FILE, Chosen, came_words, has_recovered, measured, why
from game.training.library import Library
from game.training.run import AHEAD, TrainingRun
from game.ui.rows import RunRow
from tests.support import inline_worker
from tests.support.driver import Driver
from tests.support.points import HEALTHY
from tests.support.small import LANDERS as SMALL
from tests.support.written import words_written


def knobs(driver: Driver) -> list[str]:
    driver.frames(1)
    return [each.description.name for each in driver.form.widgets if isinstance(each, Knob)]


def press_try(driver: Driver) -> None:
    driver.press_on(texts.TRAIN_EXPERIMENTS)
    driver.press_on(texts.SABOTAGES["rate_times_100"][0])
    driver.press_on(texts.LAB_SKIP)
    if isinstance(driver.top, QuestionDialog):
        driver.press_on(texts.TRAIN_KEEP_FIRST)
    driver.frames(2)


def split(driver: Driver) -> None:
    press_try(driver)
    driver.wait(lambda: driver.top.run.twin and len(driver.top.run.twin.history) >= 2)


# Knobs


def test_a_knob_without_effect_gives_way_to_the_one_that_acts(train: Driver) -> None:
    scene = train.top
    config = scene.knobs.config.changed(schedule_decisions=10_000)
    scene.knobs.set_config(config, 0)
    scene.knobs.show_in_force(in_force(config, 20_000, 300))
    shown = knobs(train)
    assert shown == ["final_learning_rate", "epsilon_end", "discount"]
    scene.knobs.show_in_force(in_force(config, 5_000, 100))
    assert knobs(train)[0] == "learning_rate"


def test_three_knobs_come_first_and_a_page_on_demand(train: Driver) -> None:
    assert knobs(train) == ["learning_rate", "epsilon_end", "discount"]
    train.press_on(texts.TRAIN_MORE_KNOBS)
    assert len(knobs(train)) == 16
    chapters = {label for each in train.form.widgets if (label := each.label).startswith("Learn: ")}
    assert len(chapters) >= 5, "doors to the chapters that explain them"
    train.press_on(sorted(chapters)[0])
    train.frames(2)
    assert isinstance(train.top, ChapterScene)
    train.key(pygame.K_ESCAPE)
    train.key(pygame.K_ESCAPE)
    assert len(knobs(train)) == 3


# Experiments


@pytest.mark.slow
def test_both_runs_begin_alike_and_stay_in_step(beside: Driver) -> None:
    beside.unseen = True
    split(beside)
    run = beside.top.run
    assert run.config == SMALL
    assert run.twin.config == SMALL.changed(learning_rate=0.3, final_learning_rate=0.03)
    assert run.seed == run.twin.seed == 3
    gaps = []
    for _ in range(60):
        beside.frames(1)
        gaps.append(abs(run.turns - run.twin.turns))
    assert max(gaps) <= AHEAD
    beside.wait(lambda: len(run.history.checkpoints) >= 2 and len(run.twin.history.checkpoints) >= 2)
    for each in (run, run.twin):
        assert np.array_equal(each.history.checkpoints[0].values, run.history.checkpoints[0].values)
        assert np.array_equal(each.history.checkpoints[1].values, alone(each.config, each.history)), "as without a twin"


def alone(config: Config, history: History) -> np.ndarray:
    training = Training(config, 3)
    while training.agent.decisions < history.checkpoints[1].decisions:
        training.advance()
    return training.agent.network.values


def test_a_worker_that_dies_leaves_the_other_flying(beside: Driver) -> None:
    split(beside)
    run = beside.top.run
    os.kill(run.twin._worker.process_id, signal.SIGKILL)
    beside.wait(lambda: run.twin.state is WorkerState.FAILED)
    before = run.turns
    beside.wait(lambda: run.turns > before + 3 * AHEAD)
    assert run.state is WorkerState.RUNNING
    assert "SIGKILL" in run.twin.problem
    beside.frames(21)
    assert beside.top.view.laboratory.came is None, "that is no verdict on the experiment"
    beside.press_on(texts.LAB_KEEP_RUN)
    assert run.twin is None
    assert run.state is WorkerState.RUNNING


def test_only_the_healthy_run_is_kept_on_the_disk(train: Driver, tmp_path: Path) -> None:
    split(train)
    train.app.close()
    library = Library(tmp_path / "user")
    assert library.items() == []
    left = library.rescued()
    assert left is not None
    assert "learning_rate" not in read_json(left.folder / "training.json")["changes"]


def test_pause_step_and_a_turned_knob_are_for_both_but_the_knob_that_differs(train: Driver) -> None:
    split(train)
    run = train.top.run
    train.top.knobs.turn("discount", 0.9)
    train.top.knobs.turn("learning_rate", 0.001)
    train.wait(lambda: run.config.learning_rate == 0.001 and run.twin.config.discount == 0.9)
    assert run.config.discount == 0.9
    assert run.twin.config.learning_rate == 0.3
    train.press_on(texts.TRAIN_PAUSE)
    train.frames(3)
    assert run.twin.state is run.state is WorkerState.PAUSED


# The guess


def test_the_lab_asks_for_a_guess_and_says_what_came(train: Driver) -> None:
    press = train.press_on
    scene, laboratory = train.top, train.top.view.laboratory
    press(texts.TRAIN_EXPERIMENTS)
    train.frames(2)
    press(texts.SABOTAGES["no_replay"][0])
    assert scene.view.laboratory.page == "guess"
    assert not scene.run.twin
    train.frames(2)
    press(texts.LAB_GUESSES["never"])
    assert scene.view.laboratory.page == "result"
    assert laboratory.chosen.guess == "never"
    assert scene.run.twin.config == sabotaged(SMALL, "no_replay")
    train.wait(lambda: len(scene.run.twin.history) >= 2 and len(scene.run.history) >= 2)
    train.frames(25)  # they are judged now and then
    assert laboratory.came is None
    assert laboratory.said["came"] == texts.LAB_TOO_EARLY
    laboratory.came = "never"
    train.frames(2)
    press(next(each.label for each in train.form.widgets if each.label.startswith("Next experiment")))
    assert (laboratory.page, laboratory.chosen) == ("guess", Chosen("no_exploration"))
    laboratory.came, laboratory.page = None, "result"
    train.frames(2)
    press(texts.LAB_KNOBS)
    assert knobs(train)
    press(texts.TRAIN_EXPERIMENTS)
    train.frames(2)
    press(texts.LAB_KEEP_RUN)
    assert not scene.run.twin
    assert knobs(train)


def test_a_verdict_is_given_once_and_before_it_stand_the_numbers_alone(
    train: Driver, monkeypatch: pytest.MonkeyPatch
) -> None:
    train.top.view.laboratory.chosen = Chosen("no_replay", "never")
    laboratory, config = train.top.view.laboratory, PRESETS["modern"]
    run = SimpleNamespace(config=config, history=History(), twin=None)
    run.twin = SimpleNamespace(config=config, history=History(), problem="")
    laboratory._run, laboratory._landed = run, (80, 12)
    said: list[tuple[str, str]] = []
    for _ in range(100):
        landed = 0.97 if len(run.history) > 20 else 0.1
        run.history.append(replace(HEALTHY, decisions=1000.0 * len(run.history), success_rate=landed))
        run.twin.history.append(replace(HEALTHY, decisions=1000.0 * len(run.history), success_rate=0.1))
        laboratory.follow()
        if said[-1:] != [now := (laboratory._figures(), laboratory.said["came"])]:
            said.append(now)
    begins = texts.LAB_FIGURES.format(other="12", healthy="80")
    assert said[0] == (begins, texts.LAB_TOO_EARLY)
    assert [figures for figures, _ in said[:-1]] == [begins] * (len(said) - 1)
    verdicts = [texts.LAB_AS_GUESSED, texts.LAB_NOT_AS_GUESSED]
    assert [any(each in came for each in verdicts) for _, came in said] == [False] * (len(said) - 1) + [True]
    run.history = run.twin.history
    laboratory.follow()
    assert (laboratory._figures(), laboratory.said["came"]) == said[-1], "a verdict stays"


def flown(run: TrainingRun) -> bool:
    """Whether a flight of it has ended."""
    return bool(np.isfinite(run.history["success_rate"]).any())


def test_each_name_of_the_legend_has_a_curve(train: Driver, monkeypatch: pytest.MonkeyPatch) -> None:
    scene = train.top
    monkeypatch.setattr(inline_worker, "TURNS", 1)  # so that no flight ends before the experiment begins
    train.press_on(texts.TRAIN_START)
    train.wait(lambda: len(scene.run.history) >= 1)
    assert not np.isfinite(scene.run.history["success_rate"]).any()
    monkeypatch.setattr(inline_worker, "TURNS", 40)
    split(train)
    for each in (scene.run, scene.run.twin):
        train.wait(partial(flown, each))
    train.press_on(texts.LAB_KNOBS)
    train.frames(14)
    curves = {run.name for run in scene.charts.charts[0].runs if np.isfinite(run.y).any()}
    legend = {row.label for row in train.form.widgets if isinstance(row, RunRow)}
    assert legend <= curves
    assert len(legend) > 1


def test_a_run_that_is_flown_again_from_its_seed_is_not_its_own_earlier_run(train: Driver) -> None:
    scene = train.top
    train.press_on(texts.TRAIN_START)
    train.wait(lambda: np.isfinite(scene.run.history["success_rate"]).any())
    split(train)
    train.press_on(texts.LAB_KEEP_RUN)
    train.frames(3)
    assert scene.run.earlier == [], "its curve would lie on the other, bit for bit"
    scene.knobs.turn("discount", 0.9)
    train.wait(
        lambda: len(scene.run.history.setting_changes) > 0 and np.isfinite(scene.run.history["success_rate"]).any()
    )
    split(train)
    assert len(scene.run.earlier) == 1


def test_the_guess_can_be_skipped_or_the_sabotage_flown_alone(train: Driver) -> None:
    scene = train.top
    for sabotage, answer in (("no_normalisation", texts.LAB_ALONE), ("short_sight", texts.LAB_SKIP)):
        train.press_on(texts.TRAIN_EXPERIMENTS)
        train.press_on(texts.SABOTAGES[sabotage][0])
        train.press_on(answer)
        train.frames(1)
    assert scene.knobs.config.layer_normalisation is False, "flown alone, it is the run's own setting"
    assert scene.run.twin.config.discount == 0.8
    assert scene.view.laboratory.chosen.guess is None


def test_why_a_part_matters_is_said_with_every_verdict() -> None:
    for came in VERDICTS:
        assert texts.SABOTAGE_WHY["no_replay"] in why(came, "no_replay"), came
    assert why("as_well", "no_replay") != why("later", "no_replay"), "there it was not missed"
    assert not why(None, "no_replay")
    assert why("later", "no_replay", recovered=True) == texts.LAB_RECOVERED
    assert has_recovered([91, 92])
    assert not has_recovered([91, 90])
    assert has_recovered([91, 90], was=True), "no word comes and goes by chance"
    assert not has_recovered([91, 60], was=True)
    assert not has_recovered([91, None])
    assert texts.LAB_NOT_AS_GUESSED in came_words("never", "later")
    assert texts.LAB_AS_GUESSED in came_words("never", "never")


def test_two_lines_in_every_chart_and_both_shares_are_those_of_the_charts(
    train: Driver, monkeypatch: pytest.MonkeyPatch
) -> None:
    split(train)
    train.frames(14)
    written = words_written(monkeypatch)
    for _ in range(8):
        written.clear()
        train.frames(1)
        shares = [each for each in written if each.endswith(texts.SPLIT_LANDED.format(percent=""))]
        landed = [share for share in train.top.landed if share is not None]
        assert shares == [texts.SPLIT_LANDED.format(percent=share) for share in landed]
    assert {len(chart.runs) for chart in train.top.charts.charts} == {2}


def test_an_earlier_moment_shows_both_swarms_of_it(train: Driver) -> None:
    split(train)
    scene, run = train.top, train.top.run
    train.wait(lambda: min(len(run.swarms.moments), len(run.twin.swarms.moments)) >= 3)
    train.frames(2)
    scene.view.rewind.go_to(float(run.swarms.moments[0]))
    train.frames(2)
    assert scene.view.rewind.moment == run.swarms.moments[0]
    shown = [swarm.swarm_state.decisions for swarm in scene.view.swarms.pair]
    assert shown == [run.swarms.moments[0], run.twin.swarms.nearest(scene.view.rewind.moment).decisions]
    assert shown[1] < run.twin.swarm_state.decisions
    train.press_on(texts.REWIND_NOW)
    train.frames(2)
    assert scene.view.swarms.pair[1].swarm_state is run.twin.swarm_state


def test_each_card_says_what_was_measured_of_it(train: Driver) -> None:
    train.top.view.laboratory.open()
    train.frames(2)
    shown = [each.label for each in train.form.widgets]
    shares = read_json(FILE)["shares"]
    for name in SABOTAGES:
        assert texts.SABOTAGES[name][0] in shown
        assert texts.SABOTAGE_WHY[name]
        (other, low, high), (healthy, least, most) = (
            [100 * part for part in shares[each]] for each in (name, "modern")
        )
        figures = {"other": other, "low": low, "high": high, "healthy": healthy, "least": least, "most": most}
        assert measured(name) == texts.LAB_MEASURED.format(seeds=4, decisions=100_000, **figures), name
