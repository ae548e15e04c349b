"""The knobs, through real pygame events: on Train's screen, where their page is open."""

from collections.abc import Callable
from typing import Any

import pygame
import pytest

from ai.training.config import PRESETS
from game.core import texts
from game.core.worker import WorkerState
from game.scenes.train.scene import TrainScene
from game.training.run_settings import label
from game.ui.rows import SliderRow
from tests.support import inline_worker
from tests.support.driver import Driver
from tests.support.small import LANDERS, learn, pause
from tests.support.written import words_written

MODERN = PRESETS["modern"]


@pytest.fixture
def page(open_game: Callable[..., Driver], monkeypatch: pytest.MonkeyPatch) -> Driver:
    inline_worker.install(monkeypatch.setattr)
    driver = open_game(TrainScene)
    driver.top.show_all()
    driver.frames(2)
    return driver


def knob(driver: Driver, name: str) -> Any:
    """Return the widget of a knob, where it is seen."""
    driver.frames(1)
    found, panel = driver.widget(label(name)), driver.top.panel
    panel.scroll(found.box.centery - panel.box.centery)
    driver.frames(1)
    return found


def drag(driver: Driver, name: str, fraction: float) -> None:
    found = knob(driver, name)
    left, right = found._track
    driver.click((left + fraction * (right - left), found.box.centery))
    driver.frames(1)


def test_the_mouse_drags_a_knob_from_stop_to_stop(page: Driver):
    drag(page, "batch_size", 0.0)
    assert page.top.knobs.asked.batch_size == 8
    found = knob(page, "batch_size")
    page.post(pygame.MOUSEBUTTONDOWN, pos=page.to_window((found._track[0] + 50, found.box.centery)), button=1)
    page.move((1270, 700))
    assert page.top.knobs.asked.batch_size == 1024
    page.frames(2)
    assert page.widget(label("batch_size")) is found, "what is dragged stays while it is"
    page.post(pygame.MOUSEBUTTONUP, pos=page.to_window((1270, 700)), button=1)
    page.frames(1)
    drag(page, "reward_weights.time", 1.0)
    assert page.top.knobs.asked.reward_weights.time == -2.0


def test_arrows_go_from_stop_to_stop_and_on_while_they_are_held(page: Driver):
    page.top.knobs.turn("learning_rate", 0.0008)
    found = knob(page, "learning_rate")
    page.form.focus(found)
    page.key(pygame.K_RIGHT)
    page.frames(1)
    assert page.top.knobs.asked.learning_rate == 0.001
    page.post(pygame.KEYDOWN, key=pygame.K_LEFT, mod=0)
    page.frames(60)
    page.post(pygame.KEYUP, key=pygame.K_LEFT, mod=0)
    assert page.top.knobs.asked.learning_rate < 2e-4
    assert page.form.focused.label == label("learning_rate")


def test_a_shape_that_has_no_word_gets_one(page: Driver):
    page.top.knobs.ask(MODERN.changed(hidden=(48,)))
    choice = knob(page, "hidden")
    assert choice.options[choice.index] == "48"
    choice.choose(0)
    assert page.top.knobs.asked.hidden == (16, 16)


def test_what_takes_a_new_run_waits_says_so_and_can_be_undone(page: Driver, monkeypatch: pytest.MonkeyPatch):
    page.top.knobs.ask(LANDERS)
    learn(page)
    drag(page, "n_step", 0.0)
    assert page.top.run.config.n_step == LANDERS.n_step
    with monkeypatch.context() as patch:
        written = words_written(patch)
        page.frames(1)
    assert texts.KNOBS_STARTS_ANEW in " ".join(written)
    page.press_on(texts.KNOBS_UNDO)
    page.frames(1)
    assert page.top.knobs.asked == LANDERS
    assert texts.KNOBS_UNDO not in [each.label for each in page.form.widgets]
    drag(page, "n_step", 0.0)
    page.press_on(texts.TRAIN_ANEW)
    page.wait(lambda: page.top.run.config.n_step == 1 and page.top.run.state is WorkerState.RUNNING)


def test_a_preset_is_a_word_and_waits_whole_in_a_run(page: Driver):
    page.press_on("Classic")
    assert page.top.knobs.asked == PRESETS["classic"]
    page.frames(1)
    page.press_on("Modern")
    page.top.knobs.ask(LANDERS)
    learn(page)
    pause(page)
    page.press_on("Classic")
    page.frames(2)
    assert page.top.run.config == LANDERS
    page.press_on(texts.TRAIN_ANEW)
    assert page.top.run.config == PRESETS["classic"]


def test_a_refused_value_is_explained_on_the_panel(page: Driver, monkeypatch: pytest.MonkeyPatch):
    page.top.knobs.turn("discount", 2.0)
    with monkeypatch.context() as patch:
        written = words_written(patch)
        page.frames(2)
    assert page.top.knobs.problem.split(" lies")[0] in " ".join(written)


def test_once_its_schedule_is_over_the_rate_that_acts_is_the_one_to_turn(page: Driver):
    page.top.show_few()
    page.top.knobs.ask(LANDERS.changed(schedule_decisions=1000))

    def knobs() -> list[str]:
        return [each.label for each in page.form.widgets if isinstance(each, SliderRow)]

    page.frames(1)
    assert knobs() == [label(name) for name in ("learning_rate", "epsilon_end", "discount")]
    learn(page)
    page.wait(lambda: page.top.run.history["decisions"][-1] > 1000)
    page.frames(2)
    assert knobs() == [label(name) for name in ("final_learning_rate", "epsilon_end", "discount")]
