"""Train's laboratory, through real pygame events; with real workers where their processes matter."""

import os
import signal
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pygame
import pytest

from ai.files.reading import read_json
from ai.training.config import PRESETS, Config
from ai.training.experiments import SABOTAGES, sabotaged
from ai.training.history import History
from ai.training.loop import Training
from game.core import texts
from game.core.worker import WorkerState
from game.scenes.learn.scene import ChapterScene
from game.scenes.train.layout import FLIGHTS
from game.training.library import Library
from game.training.run import AHEAD
from tests.support.driver import Driver
from tests.support.points import HEALTHY
from tests.support.small import LANDERS as SMALL
from tests.support.small import learn
from tests.support.written import words_written


def split(driver: Driver, sabotage: str = "rate_times_100") -> None:
    driver.press_on(texts.TRAIN_EXPERIMENTS)
    driver.press_on(texts.SABOTAGES[sabotage][0])
    driver.press_on(texts.LAB_GUESSES["few"])
    driver.wait(lambda: driver.top.run.twin and len(driver.top.run.twin.history) >= 2)
    driver.frames(2)


def test_a_page_of_knobs_leads_to_the_chapters_that_explain_them(train: Driver) -> None:
    train.press_on(texts.TRAIN_MORE_KNOBS)
    train.frames(1)
    chapters = sorted({label for each in train.form.widgets if (label := each.label).startswith("Learn: ")})
    assert len(chapters) >= 5
    train.press_on(chapters[0])
    train.frames(2)
    assert isinstance(train.top, ChapterScene)
    train.key(pygame.K_ESCAPE)
    train.key(pygame.K_ESCAPE)
    train.frames(1)
    assert train.widget(texts.TRAIN_MORE_KNOBS)


def test_every_sabotage_has_its_words():
    assert texts.SABOTAGES.keys() == texts.SABOTAGE_WHY.keys() == SABOTAGES.keys()


# Two runs


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


@pytest.mark.slow
def test_a_worker_that_dies_leaves_the_other_flying(beside: Driver) -> None:
    split(beside)
    run = beside.top.run
    os.kill(run.twin._worker.process_id, signal.SIGKILL)
    beside.wait(lambda: run.twin.state is WorkerState.FAILED)
    before = run.turns
    beside.wait(lambda: run.turns > before + 3 * AHEAD and len(run.history) > len(run.twin.history))
    beside.top.view.rewind.go_to(float(run.history["decisions"][-1]) - 1)  # farther than the twin came
    beside.frames(2)
    assert run.state is WorkerState.RUNNING
    assert "SIGKILL" in run.twin.problem
    beside.frames(21)
    assert beside.top.view.laboratory.came is None, "that is no verdict on the experiment"
    beside.press_on(texts.LAB_END)
    assert run.twin is None
    assert run.state is WorkerState.RUNNING


def test_what_learnt_is_kept_first_and_only_the_healthy_run_lies_on_the_disk(train: Driver, tmp_path: Path) -> None:
    learn(train)
    train.top.knobs.turn("discount", 0.9)
    train.wait(lambda: np.isfinite(train.top.run.history["success_rate"]).any())
    split(train)
    assert train.top.run.earlier is not None
    train.app.close()
    library = Library(tmp_path / "user")
    assert [run.name for run in library.runs()] == [texts.TRAIN_NAME.format(preset="Modern")]
    left = library.rescued()
    assert left is not None
    assert "learning_rate" not in read_json(left.folder / "training.json")["changes"]


def test_a_pause_and_a_turned_knob_are_for_both_but_the_knob_that_differs(train: Driver) -> None:
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


def test_a_run_that_is_flown_again_from_its_seed_is_not_its_own_earlier_run(train: Driver) -> None:
    scene = train.top
    learn(train)
    train.wait(lambda: np.isfinite(scene.run.history["success_rate"]).any())
    split(train)
    train.press_on(texts.LAB_END)
    assert scene.run.earlier is None, "its curve would lie on the other, bit for bit"


# The guess


def test_the_lab_asks_for_a_guess_flies_both_and_goes_on_with_the_run(train: Driver) -> None:
    scene, laboratory = train.top, train.top.view.laboratory
    train.press_on(texts.TRAIN_EXPERIMENTS)
    train.press_on(texts.SABOTAGES["no_replay"][0])
    assert laboratory.page == "guess"
    assert not scene.run.twin
    train.press_on(texts.LAB_GUESSES["few"])
    assert (laboratory.page, laboratory.guess) == ("result", "few")
    assert scene.run.twin.config == sabotaged(SMALL, "no_replay")
    train.wait(lambda: len(scene.run.twin.history) >= 2 and len(scene.run.history) >= 2)
    train.frames(25)  # they are judged now and then
    assert laboratory.came is None
    assert scene.status.line, "it is told how far they are"
    assert not scene.status.figure, "each half tells its own, by its name"
    train.press_on(texts.BACK)
    train.frames(1)
    train.press_on(texts.TRAIN_EXPERIMENTS)
    train.frames(1)
    train.press_on(texts.LAB_END)
    assert not scene.run.twin
    assert laboratory.page == "picks"
    train.press_on(texts.BACK)
    train.frames(1)
    split(train, "no_exploration")
    laboratory._ask("no_replay")
    train.frames(1)
    assert laboratory.name == texts.SABOTAGES["no_exploration"][0], "which is what still flies"
    laboratory.open()
    train.press_on(texts.TRAIN_ANEW)
    train.frames(2)
    assert laboratory.page == "", "another run has begun"


@pytest.mark.parametrize("size", [(1024, 768), (800, 600), (1280, 720)])
def test_an_experiment_leaves_room_for_the_flights_at_the_largest_text(train: Driver, size: tuple[int, int]) -> None:
    train.write_in("largest")
    train.resize(size)
    split(train, "no_replay")
    assert all(swarm.box.height >= FLIGHTS for swarm in train.top.view.swarms.both)


def test_a_verdict_is_given_once_with_the_numbers_it_goes_by(train: Driver, monkeypatch: pytest.MonkeyPatch) -> None:
    split(train, "no_shaping")
    laboratory, config, run = train.top.view.laboratory, PRESETS["modern"], History()
    twin = SimpleNamespace(config=config, history=History(), problem="")
    laboratory._run = SimpleNamespace(config=config, history=run, twin=twin)
    while not laboratory.came:
        landed = 0.97 if len(run) > 20 else 0.1
        run.append(replace(HEALTHY, decisions=1000.0 * len(run), success_rate=landed))
        twin.history.append(replace(HEALTHY, decisions=1000.0 * len(run), success_rate=0.1))
        laboratory._frame = -1
        laboratory.update()
    assert laboratory.came == "few"
    figures = laboratory._figures
    laboratory._run.history, laboratory._frame = twin.history, -1
    laboratory.update()
    assert laboratory._figures == figures, "a verdict stays"
    train.frames(1)
    with monkeypatch.context() as patch:
        said = words_written(patch)
        train.frames(1)
    assert " ".join(said).count(texts.LAB_AS_GUESSED.split()[0]) == 1


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
    shown = [swarm.swarm_state.decisions for swarm in scene.view.swarms.both]
    assert shown == [run.swarms.moments[0], run.twin.swarms.nearest(scene.view.rewind.moment).decisions]
    assert shown[1] < run.twin.swarm_state.decisions
    train.press_on(texts.REWIND_NOW)
    train.frames(2)
    assert scene.view.swarms.both[1].swarm_state is run.twin.swarm_state
