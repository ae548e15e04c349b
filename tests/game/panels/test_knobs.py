from collections.abc import Callable
from itertools import pairwise
from typing import Any

import pygame
import pytest

from ai.training.config import PRESETS, in_force
from game.core import texts
from game.core.scene import Transition
from game.drawing.canvas import Canvas
from game.scenes.train.knob import Knob, SliderKnob
from game.scenes.train.knobs import KnobsPanel
from game.scenes.train.knob import SeedKnob
from game.training.knob_descriptions import knob_descriptions, pages
from game.ui.context import Context
from game.ui.widgets import Choice, TextButton
from tests.support.driver import Driver
from tests.support.form_page import FormPage
from tests.support.written import words_written

BOX = pygame.Rect(868, 20, 384, 404)
PAGES = pages(knob_descriptions())
MODERN = PRESETS["modern"]


class Panel(FormPage):
    """The panel, and one more widget."""

    def __init__(self, context: Context, box: pygame.Rect = BOX) -> None:
        super().__init__(context)
        self.box = box
        self.heard: list[Any] = []
        self.retries = 0
        heard = self.heard
        self.knobs = KnobsPanel(
            self.form,
            self.box,
            PRESETS["modern"],
            0,
            lambda name, value: heard.append((name, value)),
            lambda *anew: heard.append(anew),
        )
        self.other = self.form.add(TextButton(self.form.manager, (64, 600, 80, 24), "Other", lambda: None))

    def handle_event(self, event: pygame.event.Event) -> Transition | None:
        outcome = super().handle_event(event)
        if not self.form.used and event.type == pygame.KEYDOWN and event.key == pygame.K_r:
            self.retries += 1
        return outcome

    def draw(self, canvas: Canvas, alpha: float) -> None:
        super().draw(canvas, alpha)
        self.knobs.draw(canvas)

    def knob(self, name: str) -> Any:
        return next(each for each in self.form.widgets if isinstance(each, Knob) and each.description.name == name)

    def word(self, label: str) -> TextButton:
        return next(each for each in self.form.widgets if isinstance(each, TextButton) and each.label == label)

    @property
    def tabs(self) -> Choice:
        return next(each for each in self.form.widgets if isinstance(each, Choice))

    @property
    def seed_knob(self) -> SeedKnob:
        return next(each for each in self.form.widgets if isinstance(each, SeedKnob))

    def has(self, label: str) -> bool:
        return any(isinstance(each, TextButton) and each.label == label for each in self.form.widgets)


@pytest.fixture
def panel(open_game: Callable[..., Driver]) -> tuple[Driver, Panel]:
    driver = open_game(Panel)
    return driver, driver.top


def turn_to(game: Driver, scene: Panel, page: str) -> None:
    number = PAGES.index(page)
    game.click((scene.tabs.row.lefts[number] + 4, scene.tabs.box.centery))


def at(knob: SliderKnob, fraction: float) -> tuple[float, float]:
    left, right = knob.track
    return left + fraction * (right - left), knob.box.centery


def test_every_page_is_inside_its_box(panel: tuple[Driver, Panel]):
    game, scene = panel
    for page in PAGES:
        turn_to(game, scene, page)
        knobs = [each for each in scene.form.widgets if isinstance(each, Knob | SeedKnob)]
        assert knobs
        assert all(BOX.inflate(32, 0).contains(each.box) for each in knobs)
        assert max(each.box.bottom for each in knobs) <= BOX.bottom - 60
        assert all(a.box.bottom <= b.box.top for a, b in pairwise(knobs))


def test_tab_goes_through_the_panel_before_what_was_added_after_it(panel: tuple[Driver, Panel]):
    game, scene = panel
    turn_to(game, scene, "target")
    assert scene.form.widgets[-1] is scene.other
    scene.form.focus(scene.tabs)
    seen = []
    for _ in range(6):
        game.key(pygame.K_TAB)
        seen.append(scene.form.focused.label if scene.form.focused else "")
    rates = ["Target rate τ", "Target rate τ, last"]
    assert seen == ["Target judges", "Double", "Target sync every", *rates, "Fly the target"]


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
    assert scene.knobs.changed
    game.click((knob.box.left + 40, knob.box.centery))
    assert scene.knobs.config == PRESETS["modern"]
    assert not scene.knobs.changed


def test_r_brings_a_changed_knob_back_and_is_the_scenes_otherwise(panel: tuple[Driver, Panel]):
    game, scene = panel
    scene.form.focus(scene.knob("n_step"))
    game.keys(pygame.K_LEFT, pygame.K_LEFT)
    assert scene.knobs.config.n_step == MODERN.n_step - 2
    game.key(pygame.K_r)
    assert (scene.knobs.config.n_step, scene.retries) == (MODERN.n_step, 0)
    game.key(pygame.K_r)
    assert scene.retries == 1


def test_arrows_go_from_stop_to_stop_even_from_between_them(panel: tuple[Driver, Panel]):
    game, scene = panel
    scene.knobs.turn("learning_rate", 0.0008)
    scene.form.focus(scene.knob("learning_rate"))
    game.key(pygame.K_RIGHT)
    assert scene.knobs.config.learning_rate == 0.001
    game.keys(pygame.K_LEFT, pygame.K_LEFT)
    assert scene.knobs.config.learning_rate == 0.0005


def test_the_presets_own_value_is_a_stop_as_well(panel: tuple[Driver, Panel]):
    game, scene = panel
    game.click(scene.word("Classic").box.center)
    turn_to(game, scene, "memory")
    knob = scene.knob("learning_starts")
    assert PRESETS["classic"].learning_starts not in knob.description.stops
    scene.form.focus(knob)
    scene.heard.clear()
    game.keys(pygame.K_RIGHT, pygame.K_LEFT)
    assert [value for _, value in scene.heard] == [70, 64]


def test_a_weight_below_zero_grows_to_the_right(panel: tuple[Driver, Panel]):
    game, scene = panel
    turn_to(game, scene, "reward")
    scene.form.focus(scene.knob("reward_weights.time"))
    game.key(pygame.K_RIGHT)
    assert scene.heard == [("reward_weights.time", -0.6)]


def test_switches_and_words_for_keyboard_pad_and_mouse(panel: tuple[Driver, Panel]):
    game, scene = panel
    turn_to(game, scene, "network")
    scene.form.focus(scene.knob("dueling"))
    game.key(pygame.K_RETURN)
    game.button(pygame.CONTROLLER_BUTTON_DPAD_LEFT)
    words = scene.knob("activation")
    game.click((words.row.lefts[0] + 4, words.box.centery))
    scene.form.focus(words)
    game.button(pygame.CONTROLLER_BUTTON_DPAD_RIGHT)
    assert scene.heard == [("dueling", True), ("dueling", False), ("activation", "tanh"), ("activation", "sigmoid")]


def test_sizes_that_no_word_stands_for_have_one_made(panel: tuple[Driver, Panel]):
    game, scene = panel
    turn_to(game, scene, "network")
    scene.knobs.set_config(MODERN.changed(hidden=(48,)), 0)
    knob = scene.knob("hidden")
    assert knob.row.words[knob.values.index((48,))] == "48"
    game.frames(2)


def test_what_takes_a_new_run_waits_and_says_so(panel: tuple[Driver, Panel]):
    game, scene = panel
    scene.knobs.set_running(True)
    game.click(at(scene.knob("n_step"), 0.0))
    assert scene.heard == []
    assert scene.knobs.config.n_step == MODERN.n_step
    assert scene.knob("n_step").waits
    assert scene.knobs.waiting == ["n_step"]
    game.click(scene.word(texts.KNOBS_APPLY).box.center)
    assert scene.heard == [(MODERN.changed(n_step=1), 0)]
    assert not scene.has(texts.KNOBS_APPLY)
    game.frames(3)


def test_enter_leads_to_apply_and_undo_follows(panel: tuple[Driver, Panel]):
    game, scene = panel
    scene.knobs.set_running(True)
    scene.form.focus(scene.knob("n_step"))
    game.keys(pygame.K_LEFT, pygame.K_RETURN)
    assert scene.form.focused is scene.word(texts.KNOBS_APPLY)
    game.keys(pygame.K_RIGHT, pygame.K_RETURN)
    assert scene.knobs.waiting == []
    assert scene.heard == []
    assert scene.form.focused is scene.tabs


def test_presets_and_sabotages_are_words(panel: tuple[Driver, Panel]):
    game, scene = panel
    game.click(scene.word("Classic").box.center)
    assert (scene.knobs.config, scene.knobs.name) == (PRESETS["classic"], "Classic")
    game.click(scene.word("Modern").box.center)
    game.click(scene.word(texts.SABOTAGE).box.center)
    assert not any(isinstance(each, Knob) for each in scene.form.widgets)
    game.click(scene.word("1-step returns").box.center)
    assert scene.knobs.config == MODERN.changed(n_step=1)
    assert scene.knobs.name == "1-step returns"
    assert scene.knob("n_step").changed  # from modern: R is the cure
    game.click(scene.word("Modern").box.center)
    assert scene.knobs.config == MODERN


def test_the_sabotage_page_can_be_left_as_it_was(panel: tuple[Driver, Panel]):
    game, scene = panel
    scene.form.focus(scene.word(texts.SABOTAGE))
    game.keys(pygame.K_RETURN)
    assert isinstance(scene.form.focused, TextButton)
    assert scene.form.focused.label == "No target"
    game.click(scene.word(texts.SABOTAGE_LEAVE).box.center)
    assert scene.heard == []
    assert scene.knob("n_step")


def test_what_was_measured_is_told_of_the_preset_that_it_was_measured_on(panel: tuple[Driver, Panel]):
    game, scene = panel
    for preset, lines in (("Modern", 2), ("Classic", 1)):
        game.click(scene.word(preset).box.center)
        game.click(scene.word(texts.SABOTAGE).box.center)
        assert len(scene.word("No shaping").help.split("\n")) == lines
        game.click(scene.word(texts.SABOTAGE_LEAVE).box.center)


def test_turned_knobs_survive_a_preset_by_undo(panel: tuple[Driver, Panel]):
    game, scene = panel
    game.click(at(scene.knob("batch_size"), 0.0))
    game.click(scene.word("Classic").box.center)
    game.click(scene.word(texts.KNOBS_UNDO).box.center)
    assert scene.knobs.config == MODERN.changed(batch_size=8)
    assert scene.knobs.name == "Modern"


def test_the_seed_is_typed_or_stepped(panel: tuple[Driver, Panel]):
    game, scene = panel
    turn_to(game, scene, "lander")
    scene.form.focus(scene.seed_knob)
    game.key(pygame.K_RIGHT)
    game.key(pygame.K_RETURN)
    for letter in "4a2":
        game.post(pygame.TEXTINPUT, text=letter)
    game.key(pygame.K_RETURN)
    assert (scene.knobs.seed, scene.heard) == (42, [("seed", 1), ("seed", 42)])


@pytest.mark.parametrize("way_out", ["tab", "page", "nothing typed"])
def test_a_seed_that_is_left_while_it_is_typed_counts(panel: tuple[Driver, Panel], way_out: str):
    game, scene = panel
    turn_to(game, scene, "lander")
    scene.form.focus(scene.seed_knob)
    game.key(pygame.K_RETURN)
    if way_out == "nothing typed":
        game.key(pygame.K_BACKSPACE)
    else:
        game.post(pygame.TEXTINPUT, text="5")
    if way_out == "page":
        turn_to(game, scene, "target")
    else:
        game.key(pygame.K_TAB)
    game.frames(2)
    assert scene.knobs.seed == (0 if way_out == "nothing typed" else 5)


def test_a_refused_value_is_explained_on_the_panel(panel: tuple[Driver, Panel]):
    game, scene = panel
    game.frames(2)
    before = pygame.surfarray.array3d(game.app.canvas.surface)
    scene.knobs.turn("discount", 2.0)
    game.frames(2)
    after = pygame.surfarray.array3d(game.app.canvas.surface)
    assert scene.knobs.config == MODERN
    changed = (before != after).any(axis=2)
    assert changed[BOX.left : BOX.right, BOX.bottom - 60 : BOX.bottom].any()


@pytest.mark.parametrize("size", [(1280, 720), (1920, 1080), (800, 600)])
def test_all_states_are_drawn_at_any_size(panel: tuple[Driver, Panel], size: tuple[int, int]):
    game, scene = panel
    game.resize(size)
    for page in PAGES:
        turn_to(game, scene, page)
    scene.knobs.set_running(True)
    scene.knobs.turn("num_envs", 4)
    scene.knobs.turn("learning_rate", 0.5)
    game.frames(2)
    game.click(scene.word(texts.SABOTAGE).box.center)
    game.frames(2)
    assert game.top is scene  # and not the scene of a fault


def test_what_acts_now_is_shown_beside_what_is_set(panel: tuple[Driver, Panel], monkeypatch: pytest.MonkeyPatch):
    game, scene = panel
    knobs = scene.knobs
    knobs.set_running(True)
    knobs.show_in_force(in_force(MODERN, 50_000, 400))
    rate, last = scene.knob("learning_rate"), scene.knob("final_learning_rate")
    assert rate.now == pytest.approx(1.65e-3)
    assert not rate.idle
    assert last.now is None
    written = words_drawn(game, monkeypatch)
    assert texts.KNOB_NOW.format(value="0.00165") in written
    assert "0.003" in written, "and what is set stays"

    knobs.show_in_force(in_force(MODERN, 100_000, 900))
    assert rate.now is None
    assert rate.idle == texts.KNOBS_IDLE["learning_rate"]
    assert not last.idle
    assert rate.colour != last.colour
    scene.form.focus(rate)
    written = words_drawn(game, monkeypatch)
    assert texts.KNOB_IDLE in written
    assert rate.idle.split(",")[0] in " ".join(written)

    knobs.set_running(False)
    assert not rate.idle, "a new run begins with it"


def test_what_is_not_turned_on_says_so(panel: tuple[Driver, Panel]):
    game, scene = panel
    turn_to(game, scene, "memory")
    exponent, batch = scene.knob("priority_exponent"), scene.knob("success_batch_size")
    assert exponent.idle == "Changes nothing while Prioritised is off."
    assert batch.idle == "Changes nothing while Success pass is off."
    scene.knobs.turn("prioritised", True)
    scene.knobs.turn("success_pass", True)
    assert not exponent.idle
    assert not batch.idle


def words_drawn(game: Driver, monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Return what is written in a frame."""
    with monkeypatch.context() as patch:
        written = words_written(patch)
        game.frames(1)
    return written


def test_a_sabotage_that_waits_is_explained_and_the_run_keeps_its_name(
    panel: tuple[Driver, Panel], monkeypatch: pytest.MonkeyPatch
):
    game, scene = panel
    scene.knobs.set_running(True)
    game.click(scene.word(texts.SABOTAGE).box.center)
    word, sentence, measured = texts.SABOTAGES["no_n_step"]
    game.click(scene.word(word).box.center)
    assert scene.knobs.name == "Modern", "that is what still flies"
    assert not scene.knobs.changed
    written = " ".join(words_drawn(game, monkeypatch))
    assert texts.KNOBS_STARTS_ANEW_AS.format(name=word) in written
    assert sentence in written
    assert measured in written
    game.click(scene.word(texts.KNOBS_UNDO).box.center)
    assert not scene.knobs.waiting
    game.click(scene.word(texts.SABOTAGE).box.center)
    game.click(scene.word(word).box.center)
    game.click(scene.word(texts.KNOBS_APPLY).box.center)
    assert scene.knobs.name == word
