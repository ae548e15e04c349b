"""Train at an earlier moment of its run: chosen by mouse, keys and gamepad, all of the screen, and back to now."""

from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pygame
import pytest

from ai.training.history import Checkpoint, History
from ai.training.messages import SwarmState
from game.core import texts
from game.core.worker import WorkerState
from game.scenes.train.landers import INSIDE
from game.scenes.train.rewind import Rewind
from game.scenes.train.scene import TrainScene
from game.training.record import Record
from game.ui.charts import Scrubber
from tests.support.driver import Driver
from tests.support.player import Player
from tests.support.points import point
from tests.support.small import learn, pause

POINTS = 10


@pytest.fixture
def train(train: Driver) -> Driver:
    """A run that has learnt for a while, and is paused."""
    learn(train, POINTS)
    pause(train)
    train.frames(14)
    return train


def halfway(driver: Driver, chart: int = 0) -> tuple[float, float]:
    """The place on a chart of the moment halfway through the run, by the clock."""
    seconds = float(driver.top.run.history["seconds"][-1])
    shown = driver.top.charts.charts[chart]
    return shown.place(seconds / 2, 0.0)[0], shown.plot.centery


def assert_all_of_it_is_at(driver: Driver, moment: int) -> None:
    scene = driver.top
    run, history = scene.run, scene.run.history
    assert scene.view.rewind.moment == moment
    # Everything is one of the messages of the run, the nearest that was kept.
    assert scene.view.swarms.shown.swarm_state is scene.view.rewind.swarm_state is run.swarms.nearest(moment)
    assert scene.view.rewind.swarm_state.decisions == moment
    assert scene.view.rewind.network_state is run.networks.nearest(moment)
    row = int(np.abs(history["decisions"] - moment).argmin())
    assert scene.view.rewind.row == row
    line = scene.status.line
    assert f"{moment:,}" in line
    seconds = float(np.interp(moment, history["decisions"], history["seconds"]))
    assert scene.charts.charts[0].marker == pytest.approx(seconds)


def test_a_click_on_any_chart_goes_to_that_moment_while_it_learns_on(train: Driver) -> None:
    scene = train.top
    train.click(halfway(train, 1))
    train.frames(2)
    moment = scene.view.rewind.moment
    assert moment is not None
    assert 0.2 < moment / scene.run.history["decisions"][-1] < 0.8
    assert_all_of_it_is_at(train, moment)
    points = len(scene.run.history)
    train.press_on(texts.TRAIN_RESUME)
    train.wait(lambda: len(scene.run.history) > points + 3)
    assert scene.run.state is WorkerState.RUNNING
    assert scene.view.rewind.moment == moment
    assert_all_of_it_is_at(train, moment)


def test_a_drag_stays_with_its_chart_and_a_word_or_its_end_leads_to_now(train: Driver) -> None:
    scene = train.top
    x, y = halfway(train, 1)
    train.move((x, y))
    train.post(pygame.MOUSEBUTTONDOWN, pos=train.to_window((x, y)), button=1)
    first = scene.view.rewind.moment
    train.move((x - 60, y - 120))
    assert scene.view.rewind.moment is not None
    assert first is not None
    assert scene.view.rewind.moment < first
    train.move((x + 600, y))
    assert scene.view.rewind.moment is None
    train.post(pygame.MOUSEBUTTONUP, pos=train.to_window((x, y)), button=1)
    train.click(halfway(train))
    train.frames(2)
    train.click(train.widget(texts.REWIND_NOW).box.center)
    assert scene.view.rewind.moment is None
    assert texts.REWIND_NOW not in [widget.label for widget in scene.form.widgets]


def test_left_and_right_step_through_the_run_and_back_leads_to_now_from_the_network_too(train: Driver) -> None:
    scene, player = train.top, Player(train, "pad")
    train.form.focus(train.the(Scrubber))
    moments = []
    for _ in range(4):
        player.press("left")
        moments.append(scene.view.rewind.moment)
    assert None not in moments
    assert sorted(set(moments), reverse=True) == moments
    train.frames(1)
    assert_all_of_it_is_at(train, moments[-1])
    player.press("right")
    assert scene.view.rewind.moment == moments[-2]
    train.app.context.unfold(INSIDE)
    train.frames(2)
    inside = scene.view.inside
    assert np.array_equal(inside.network.values, scene.view.rewind.network_state.values)
    player.press("back")
    train.frames(1)
    assert not scene.view.fills
    assert scene.view.rewind.moment == moments[-2]
    player.press("back")
    train.frames(2)
    assert train.top is scene
    assert scene.view.rewind.moment is None
    assert scene.charts.charts[0].marker is None


def test_a_run_that_has_ended_is_rewound_too_and_the_next_begins_at_now(train: Driver) -> None:
    scene, ended = train.top, train.top.run.swarms.moments[-1]
    scene.run.close()
    train.frames(5)
    train.click(halfway(train))
    train.frames(2)
    assert scene.view.rewind.moment is not None
    assert_all_of_it_is_at(train, scene.view.rewind.moment)
    assert texts.REWIND_AT.split("{")[0] in scene.view.rewind._words()
    train.press_on(texts.TRAIN_START)
    train.frames(2)
    assert scene.view.rewind.moment is None
    assert scene.run.swarms.moments[-1] < ended


def test_a_resumed_run_has_its_curves_and_the_networks_of_its_checkpoints(
    train: Driver, tmp_path: Path, open_game: Callable[..., Driver]
) -> None:
    decisions = train.top.run.history["decisions"][-1]
    train.app.close()
    driver = open_game(TrainScene)
    driver.frames(2)
    driver.press_on(texts.TRAIN_GO_ON)
    scene = driver.top
    driver.wait(lambda: scene.run.history and scene.run.history["decisions"][-1] > decisions + 100)
    driver.frames(14)
    scene.view.rewind.go_to(decisions / 2)
    driver.frames(2)
    assert scene.view.rewind.swarm_state is scene.view.swarms.shown.swarm_state is None
    checkpoint = scene.run.history.checkpoint_at(scene.view.rewind.moment)
    assert np.array_equal(scene.view.rewind.network_state.values, checkpoint.values)
    began = scene.run.swarms.begins
    assert began is not None
    scene.view.rewind.go_to(began + 100)
    assert scene.view.rewind.swarm_state


def test_the_first_landers_kept_and_the_point_at_their_moment_are_one_stop() -> None:
    swarms, networks, known = Record(1 << 20), Record(1 << 20), History()
    for decisions in (300.0, 600.0, 800.0):
        known.append(point(seconds=decisions / 100, decisions=decisions))
    for number in (600, 700, 800):
        nothing = np.zeros((1, 2))
        swarms.append(SwarmState(nothing, nothing[:, 0], nothing[:, 0], nothing[:, 0], number))
    rewind, stops = Rewind(SimpleNamespace(history=known, swarms=swarms, networks=networks)), []
    for direction in (-1, -1, -1, 1, 1, 1):
        rewind.shift(direction)
        stops.append(rewind.moment)
    assert stops == [700, 600, 300, 600, 700, None]


def test_without_a_run_there_is_nothing_to_rewind(open_game: Callable[..., Driver]) -> None:
    driver = open_game(TrainScene)
    driver.frames(2)
    scene = driver.top
    driver.click((200, 540))
    driver.form.focus(driver.the(Scrubber))
    driver.keys(pygame.K_LEFT, pygame.K_RIGHT)
    assert scene.view.rewind.moment is None
    scene.view.rewind.go_to(100)
    assert scene.view.rewind.moment is None


@pytest.mark.parametrize("values", [np.zeros(0, np.float32), np.zeros(7, np.float32), None])
def test_a_short_history_of_which_little_is_known_or_fits_is_rewound(
    open_game: Callable[..., Driver], values: np.ndarray | None
) -> None:
    driver = open_game(TrainScene)
    driver.frames(2)
    history = driver.top.run.history
    for decisions in (300.0, 600.0):
        history.append(
            point(
                seconds=decisions / 100,
                decisions=decisions,
                **dict.fromkeys(("success_rate", "mean_return", "loss", "mean_q"), np.nan),
            )
        )
    if values is not None:  # a checkpoint of another network
        history.append(Checkpoint(1.0, 100, 0.0, values))
    driver.frames(14)
    driver.top.view.rewind.go_to(10.0)
    driver.frames(14)
    assert driver.top.view.rewind.moment == 300
    assert driver.top.view.rewind.swarm_state is None
    assert driver.top.view.inside.network is None or driver.top.view.inside.shown is None
    driver.app.context.unfold(INSIDE)
    driver.frames(3)
    assert isinstance(driver.top, TrainScene)
