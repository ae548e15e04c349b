"""The panel of knobs, through real pygame events: on Train's screen, where their page is open."""

from collections.abc import Callable
from typing import Any

import pygame
import pytest

from ai.training.config import PRESETS, in_force
from game.core import texts
from game.drawing.canvas import Canvas
from game.scenes.train.knob import Knob, SliderKnob, WordsKnob
from game.scenes.train.knobs import KnobsPanel
from game.scenes.train.scene import TrainScene
from game.training.run_settings import figure
from tests.support.driver import Driver
from tests.support.written import words_written

MODERN = PRESETS["modern"]


class Panel:
    """What the tests see of the screen, and what the panel has asked for."""

    def __init__(self, driver: Driver) -> None:
        self._driver = driver
        self.heard: list[Any] = []
        settings: Any = self.knobs.settings
        settings._on_change = lambda name, value: self.heard.append((name, value))
        settings._on_restart = lambda *anew: self.heard.append(anew)

    @property
    def knobs(self) -> KnobsPanel:
        found: KnobsPanel = self._driver.top.knobs
        return found

    def knob(self, name: str) -> Any:
        self._driver.frames(1)
        knob = next(
            each for each in self._driver.form.widgets if isinstance(each, Knob) and each.description.name == name
        )
        panel = self._driver.top.panel
        panel.scroll(knob.box.centery - panel.box.centery)
        self._driver.frames(1)
        return knob

    def press(self, label: str) -> None:
        self._driver.frames(1)
        self._driver.click(self._driver.widget(label).box.center)
        self._driver.frames(1)

    def has(self, label: str) -> bool:
        self._driver.frames(1)
        return any(each.label == label for each in self._driver.form.widgets)


@pytest.fixture
def panel(open_game: Callable[..., Driver]) -> tuple[Driver, Panel]:
    driver = open_game(TrainScene)
    driver.top.knobs.open()
    driver.frames(2)
    return driver, Panel(driver)


def at(knob: SliderKnob, fraction: float) -> tuple[float, float]:
    left, right = knob.track
    return left + fraction * (right - left), knob.box.centery


def test_the_mouse_drags_a_slider_from_stop_to_stop(panel: tuple[Driver, Panel]):
    game, scene = panel
    knob = scene.knob("batch_size")
    game.click(at(knob, 0.0))
    assert scene.knobs.config.batch_size == 8
    game.post(pygame.MOUSEBUTTONDOWN, pos=game.to_window(at(knob, 0.3)), button=1)
    game.move((1270, 700))
    assert scene.knobs.config.batch_size == 1024
    game.post(pygame.MOUSEBUTTONUP, pos=game.to_window((1270, 700)), button=1)


def test_a_press_on_the_name_brings_the_preset_back_and_never_drags(panel: tuple[Driver, Panel]):
    game, scene = panel
    knob = scene.knob("learning_rate")
    game.click((knob.box.left + 40, knob.box.centery))
    assert scene.heard == []
    game.click(at(knob, 0.9))
    assert knob.changed
    assert scene.knobs.settings.changed
    game.click((knob.box.left + 40, knob.box.centery))
    assert scene.knobs.config == PRESETS["modern"]
    assert not scene.knobs.settings.changed


def test_arrows_go_from_stop_to_stop_even_from_between_them_and_r_brings_the_preset_back(panel: tuple[Driver, Panel]):
    game, scene = panel
    scene.knobs.turn("learning_rate", 0.0008)
    knob = scene.knob("learning_rate")
    game.form.focus(knob)
    game.key(pygame.K_RIGHT)
    assert scene.knobs.config.learning_rate == 0.001
    game.keys(pygame.K_LEFT, pygame.K_LEFT)
    assert scene.knobs.config.learning_rate == 0.0005
    game.key(pygame.K_r)
    assert scene.knobs.config == MODERN


def test_words_without_room_go_on_below_and_sizes_that_have_none_get_one(panel: tuple[Driver, Panel]):
    game, scene = panel
    scene.knobs.set_config(MODERN.changed(hidden=(48,)), 0)
    assert (48,) in scene.knob("hidden").values
    for size in ((1280, 720), (800, 600)):
        game.resize(size)
        game.frames(2)
        for knob in (each for each in game.form.widgets if isinstance(each, WordsKnob)):
            assert len(knob._places) == len(knob.values)
            assert all(knob.box.left <= place.left and place.right <= knob.box.right + 8 for place in knob._places), (
                size, knob.label, knob._places,
            )  # fmt: skip


def test_what_takes_a_new_run_waits_and_says_so(panel: tuple[Driver, Panel]):
    game, scene = panel
    scene.knobs.set_running(True)
    game.click(at(scene.knob("n_step"), 0.0))
    assert scene.heard == []
    assert scene.knobs.config.n_step == MODERN.n_step
    assert scene.knob("n_step").waits
    assert scene.knobs.settings.waiting == ["n_step"]
    scene.press(texts.TRAIN_ANEW)
    assert scene.heard == [(MODERN.changed(n_step=1), 0)]
    assert scene.knobs.settings.waiting == []
    assert not scene.has(texts.KNOBS_UNDO)
    game.frames(3)


def test_enter_leads_to_apply_and_undo_follows(panel: tuple[Driver, Panel]):
    game, scene = panel
    scene.knobs.set_running(True)
    knob = scene.knob("n_step")
    game.form.focus(knob)
    game.key(pygame.K_LEFT)
    game.frames(1)
    game.key(pygame.K_RETURN)
    assert game.form.focused.label == texts.TRAIN_ANEW
    game.keys(pygame.K_RIGHT, pygame.K_RETURN)
    assert scene.knobs.settings.waiting == []
    assert scene.heard == []


def test_a_preset_is_a_word_and_a_sabotage_waits_under_its_own_name(panel: tuple[Driver, Panel]):
    _, scene = panel
    scene.press("Classic")
    assert (scene.knobs.config, scene.knobs.name) == (PRESETS["classic"], "Classic")
    scene.press("Modern")
    scene.knobs.set_running(True)
    scene.knobs.load(sabotage="no_replay")
    assert scene.knobs.name == "Modern", "that is what still flies"
    assert not scene.knobs.settings.changed
    scene.press(texts.TRAIN_ANEW)
    assert scene.knobs.name == texts.SABOTAGES["no_replay"][0]
    scene.press("Modern")
    assert scene.knobs.config != MODERN, "it waits"
    scene.press(texts.TRAIN_ANEW)
    assert scene.knobs.config == MODERN


def test_a_new_pay_says_that_the_memory_begins_anew(panel: tuple[Driver, Panel], monkeypatch: pytest.MonkeyPatch):
    game, scene = panel
    knob = scene.knob("reward_weights.time")
    game.form.focus(knob)
    for running in (False, True):
        scene.knobs.set_running(running)
        said = " ".join(words_drawn(game, monkeypatch))
        assert (texts.KNOBS_NEW_PAY in said) == running


def test_a_refused_value_is_explained_on_the_panel(panel: tuple[Driver, Panel], monkeypatch: pytest.MonkeyPatch):
    game, scene = panel
    scene.knobs.turn("discount", 2.0)
    assert scene.knobs.config == MODERN
    problem = scene.knobs.settings.problem
    assert problem.split()[0] in " ".join(words_drawn(game, monkeypatch))


def test_what_acts_now_is_shown_beside_what_is_set(panel: tuple[Driver, Panel], monkeypatch: pytest.MonkeyPatch):
    game, scene = panel
    knobs = scene.knobs
    knobs.set_running(True)
    knobs.show_in_force(in_force(MODERN, 50_000, 400))
    rate, last = scene.knob("learning_rate"), scene.knob("final_learning_rate")
    assert rate.now == pytest.approx(1.65e-3)
    assert last.now is None
    written = words_drawn(game, monkeypatch)
    assert {texts.KNOB_NOW.format(value="0.00165"), "0.00165"} & set(written)
    assert "0.003" in written, "and what is set stays"


def test_a_knob_whose_time_is_over_gives_way_to_the_one_that_acts_now(panel: tuple[Driver, Panel]):
    game, scene = panel
    game.top.knobs.close()
    game.frames(2)
    named = [each.label for each in game.form.widgets if isinstance(each, Knob)]
    scene.knobs.set_running(True)
    scene.knobs.show_in_force(in_force(MODERN, 100_000, 900))
    game.frames(2)
    rates = texts.KNOBS["learning_rate"], texts.KNOBS["final_learning_rate"]
    assert rates[0] in named
    now = [each.label for each in game.form.widgets if isinstance(each, Knob)]
    assert now == [rates[1] if each == rates[0] else each for each in named], "its name says that it is another one"
    game.top.knobs.open()
    game.frames(2)
    now = [each.label for each in game.form.widgets if isinstance(each, Knob)]
    assert rates[1] in now
    assert rates[0] not in now, "none is shown that has no effect"
    scene.knobs.set_running(False)
    game.frames(2)
    assert rates[0] in [each.label for each in game.form.widgets if isinstance(each, Knob)], "a new run begins with it"


def words_drawn(game: Driver, monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Return what is written in a frame."""
    with monkeypatch.context() as patch:
        written = words_written(patch)
        game.frames(1)
    return written


def test_a_figure_of_seven_digits_stands_clear_of_the_handle_at_the_end_of_its_track(
    panel: tuple[Driver, Panel], monkeypatch: pytest.MonkeyPatch
):
    _, seen = panel
    boxes: dict[str, pygame.FRect] = {}
    text = Canvas.text

    def noted(canvas: Canvas, string: str, *more: Any, **options: Any) -> pygame.FRect:
        boxes[string] = box = text(canvas, string, *more, **options)
        return box

    monkeypatch.setattr(Canvas, "text", noted)
    knob = seen.knob("replay_size")
    assert knob.value == 1_000_000
    assert boxes[figure(1_000_000)].left > knob.track[1] + 6
