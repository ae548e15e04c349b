"""The training screen, through real pygame events; with a real worker beside it where its process matters."""

import gc
import threading
import time
from collections.abc import Callable
from dataclasses import replace
from multiprocessing import active_children
from pathlib import Path

import pygame
import pytest

from ai.lander.rewards import RewardWeights
from ai.training.config import PRESETS
from ai.training.messages import FirstLanding
from game.core import texts
from game.core.scene import Push
from game.core.worker import WorkerState
from game.explain.network_view import NetworkView
from game.scenes.lesson.scene import LessonScene
from game.scenes.train import landers
from game.scenes.train.scene import TrainScene
from game.training.library import Library
from game.training.run import PACES, TrainingRun
from game.ui.charts import Scrubber
from game.ui.entry import EntryRow
from tests.support import inline_worker
from tests.support.driver import Driver
from tests.support.player import Player
from tests.support.small import LANDERS as SMALL
from tests.support.small import learn


def save_as(driver: Driver, name: str) -> None:
    driver.press_on(texts.TRAIN_SAVE)
    driver.the(EntryRow).text = name
    driver.key(pygame.K_RETURN)


def test_start_pause_and_go_on(beside: Driver) -> None:
    learn(beside)
    scene = beside.top
    assert scene.run.state is WorkerState.RUNNING
    assert len(scene.view.swarms.shown.swarm_state.outcome) == 4
    beside.key(pygame.K_RETURN)
    beside.wait(lambda: scene.run.state is WorkerState.PAUSED)
    beside.frames(20)
    time.sleep(0.1)
    beside.frames(5)
    stood = scene.run.swarm_state.decisions
    time.sleep(0.15)
    beside.frames(5)
    assert scene.run.swarm_state.decisions == stood
    beside.key(pygame.K_RETURN)
    beside.wait(lambda: scene.run.swarm_state.decisions > stood + 8)


def test_a_run_goes_slow_or_fast_in_sight(train: Driver, monkeypatch: pytest.MonkeyPatch) -> None:
    assert train.choice(texts.TRAIN_PACES[0]).index == 1
    learn(train)
    train.frames(2)
    pace = train.choice(texts.TRAIN_PACES[0])
    assert pace.index == 1
    asked: list[float | None] = []
    monkeypatch.setattr(train.top.run._worker, "set_pace", asked.append)
    pace.choose(0)
    pace.choose(1)
    assert asked == [PACES[0], None], "to be watched, and as fast as possible"
    assert not train.app.context.settings.slow_runs, "the next one goes as this one"


def test_a_first_run_goes_slowly(open_game: Callable[..., Driver]) -> None:
    assert open_game(TrainScene, first_run=True).choice(texts.TRAIN_PACES[0]).index == 0


def test_at_the_first_landing_it_offers_once_to_stop_and_look(
    open_game: Callable[..., Driver], monkeypatch: pytest.MonkeyPatch
) -> None:
    inline_worker.install(monkeypatch.setattr)
    driver = open_game(TrainScene, first_run=True)
    driver.frames(2)
    scene, run = driver.top, driver.top.run
    scene.knobs.ask(SMALL)
    learn(driver, 5)
    scene.set_pace(1)
    at = run.swarm_state.decisions
    scene.view.lessons.ask(2)
    driver.wait(lambda: isinstance(driver.top, LessonScene))
    lesson = driver.top.lesson
    driver.key(pygame.K_ESCAPE)
    driver.wait(lambda: driver.top is scene)
    run.first_landing = FirstLanding(lesson)
    driver.frames(2)
    assert driver.form.focused.label == texts.LESSON_LOOK, "one key"
    assert driver.choice(texts.TRAIN_PACES[0]).index == 0, "so that not all land before it is read"
    assert not driver.app.context.settings.slow_runs, "of this run, for now"
    driver.key(pygame.K_RETURN)
    driver.wait(lambda: isinstance(driver.top, LessonScene))
    assert driver.top.lesson is lesson
    assert run.state is WorkerState.PAUSED, "the landers stand still behind it"
    driver.key(pygame.K_ESCAPE)
    driver.wait(lambda: run.swarm_state.decisions > at)
    assert texts.LESSON_LOOK not in [each.label for each in driver.form.widgets]
    assert driver.app.context.settings.lesson_offered, "never again"
    driver.app.context.settings.lesson_offered = False
    monkeypatch.setattr(landers, "_SLOW", 5)
    driver.frames(20)
    assert driver.choice(texts.TRAIN_PACES[0]).index == 1, "slowly for a while"
    driver.press_on(texts.LESSON_FLY_ON)
    driver.frames(2)
    assert driver.choice(texts.TRAIN_PACES[0]).index == 1, "as fast as before"


def test_what_was_left_without_a_name_goes_on_under_its_own_settings(
    train: Driver, open_game: Callable[..., Driver]
) -> None:
    train.top.knobs.ask(PRESETS["classic"].changed(hidden=(8,)))
    learn(train)
    decisions = train.top.run.history["decisions"][-1]
    train.app.close()
    driver = open_game(TrainScene)
    driver.frames(2)
    run = driver.top.run
    driver.press_on(texts.TRAIN_GO_ON)
    driver.wait(lambda: run.begun or run.swarm_state)
    driver.frames(2)
    assert run.swarm_state.decisions >= decisions
    assert run.config.hidden == driver.top.knobs.asked.hidden == (8,)
    assert texts.TRAIN_GO_ON not in [each.label for each in driver.form.widgets]


@pytest.mark.parametrize("share", [0.98, None])
def test_start_keeps_what_was_left_if_it_lands(
    train: Driver, open_game: Callable[..., Driver], monkeypatch: pytest.MonkeyPatch, share: float | None
) -> None:
    learn(train)
    train.app.close()
    left = Library.rescued
    monkeypatch.setattr(Library, "rescued", lambda library: (run := left(library)) and replace(run, success=share))
    driver = open_game(TrainScene)
    driver.frames(2)
    library = driver.top.run.collection
    driver.top.knobs.ask(SMALL)
    learn(driver)
    assert len(library.runs()) == (share is not None)


def test_a_run_whose_place_a_changed_setting_takes_is_in_the_list(train: Driver) -> None:
    learn(train)
    scene = train.top
    scene.knobs.turn("n_step", 3)
    train.frames(2)
    train.press_on(texts.TRAIN_ANEW)
    train.wait(lambda: scene.run.collection.runs() and scene.run.config.n_step == 3)
    (kept,) = scene.run.collection.runs()
    assert not kept.problem
    assert kept.decisions > 0


def test_a_saved_run_goes_on_in_the_scene_that_is_there(train: Driver) -> None:
    learn(train)
    scene = train.top
    save_as(train, "mine")
    train.wait(scene.run.collection.runs)
    train.press_on(texts.TRAIN_RUNS)
    train.frames(2)
    train.press_on(texts.RUN_TRAIN)
    assert train.top is scene
    train.wait(lambda: scene.run.swarm_state is not None)
    assert scene.run.state is WorkerState.RUNNING


def test_a_name_that_is_taken_is_reported_and_can_be_changed(train: Driver) -> None:
    learn(train)
    scene = train.top
    (scene.run.collection.folder / "mine").mkdir()
    train.press_on(texts.TRAIN_SAVE)
    train.the(EntryRow).text = "mine"
    train.key(pygame.K_RETURN)
    assert train.top_name == "NameDialog"
    train.post(pygame.TEXTINPUT, text="M2")
    train.key(pygame.K_RETURN)
    assert train.top is scene
    train.wait(scene.run.collection.runs)


def test_flying_against_a_checkpoint_and_back(train: Driver) -> None:
    learn(train)
    scene = train.top
    scene.form.focus(next(each for each in scene.form.widgets if isinstance(each, Scrubber)))
    train.key(pygame.K_LEFT)
    train.key(pygame.K_RETURN)
    assert train.top_name == "PlayScene"
    train.wait(lambda: scene.run.state is WorkerState.PAUSED)
    train.frames(3)
    train.key(pygame.K_ESCAPE)
    train.press_on(texts.PAUSE_LEAVE)
    assert train.top is scene
    train.wait(lambda: scene.run.state is WorkerState.RUNNING)


def test_a_run_is_started_named_found_and_left_without_a_mouse(train: Driver) -> None:
    scene, press = train.top, Player(train, "pad").press
    press("confirm")
    train.wait(lambda: len(scene.run.history) >= 2)
    press("confirm")
    train.wait(lambda: scene.run.state is WorkerState.PAUSED)
    press("up")
    assert scene.form.focused is not train.widget(texts.TRAIN_RESUME)
    scene.form.focus(train.widget(texts.TRAIN_SAVE))
    press("confirm")
    assert train.top_name == "NameDialog"
    press("confirm")
    assert train.top is scene
    train.wait(scene.run.collection.runs)
    (run,) = scene.run.collection.runs()
    assert not run.problem
    press("back")
    assert not train.app.scenes.running, "the scene was left, and nothing was below it"


@pytest.mark.slow
def test_a_dead_worker_is_reported_and_its_run_can_still_be_saved(beside: Driver, tmp_path: Path) -> None:
    beside.unseen = True
    learn(beside)
    scene = beside.top
    beside.wait(lambda: scene.run.collection.unsaved.is_dir() or scene.run.state is WorkerState.FAILED, 60)
    for child in active_children():
        child.kill()
    beside.wait(lambda: scene.run.state is WorkerState.FAILED)
    assert scene.run.problem
    beside.frames(20)
    save_as(beside, "saved all the same")
    (run,) = Library(tmp_path / "user").runs()
    assert (run.name, run.problem) == ("saved all the same", "")


def test_numbers_that_run_away_are_reported(train: Driver) -> None:
    wild = SMALL.changed(cost="mse", reward_scale=1.0, reward_weights=RewardWeights(terminal=1e30))
    train.top.knobs.ask(wild)
    train.key(pygame.K_RETURN)
    train.wait(lambda: train.top.run.state is WorkerState.FAILED, 60)
    assert "learning step" in train.top.run.problem
    train.frames(20)
    assert train.top_name == "TrainScene"


def _kept() -> list[object]:
    return [each for each in gc.get_objects() if isinstance(each, TrainScene | TrainingRun | NetworkView)]


@pytest.mark.slow
def test_visits_leave_no_process_no_thread_and_no_scene(game: Driver) -> None:
    threads, others = threading.active_count(), set(map(id, _kept()))
    for visit in range(4):
        assert game.top_name == "MenuScene"
        scene = TrainScene(game.app.context)
        game.app.scenes.apply(Push(scene))
        game.frames(2)
        scene.knobs.ask(SMALL)
        game.key(pygame.K_RETURN)
        if visit == 0:  # the others leave while it starts
            game.wait(lambda scene=scene: scene.run.swarm_state)  # type: ignore[misc]
        game.key(pygame.K_ESCAPE)
        assert not active_children()
    del scene
    game.wait(lambda: threading.active_count() <= threads)
    gc.collect()
    assert not [each for each in _kept() if id(each) not in others]
