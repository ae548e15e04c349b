"""From patch to answer, and why not another digit: by keys, by mouse and by gamepad."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pygame
import pytest

from ai.digits.classifier import DigitClassifier
from ai.digits.config import DIGIT_PRESETS, build_digit_network
from ai.digits.mnist import load_part
from ai.nn import CostFunctions, FullyConnectedLayer, LayerNormalisation, NeuralNetwork
from game.core import texts
from game.core.assets import MODELS_DIR
from game.scenes.digits.answer import DigitBars
from game.scenes.digits.inside import DigitInsideScene
from game.scenes.digits.map_row import MapRow
from game.scenes.digits.sums import figure
from game.scenes.digits.sums_tab import SumsTab
from game.scenes.digits.why_not import WhyNotTab
from game.ui.context import Context
from tests.support.driver import Driver
from tests.support.player import DEVICES, Player
from tests.support.screens import save_settings
from tests.support.written import words_written

Open = Callable[..., Driver]


@pytest.fixture(scope="module")
def modern():
    return DigitClassifier.load(MODELS_DIR / "digits" / "modern")


@pytest.fixture(scope="module")
def nine():
    return load_part("test")[0][7]


@pytest.fixture
def inside(open_game: Open, context: Context, modern, nine) -> Driver:
    save_settings(context)
    return opened(open_game, modern, nine)


def opened(open_game: Open, classifier: DigitClassifier, image: np.ndarray) -> Driver:
    """Look at the sums of a network."""
    driver = open_game(DigitInsideScene, classifier, image)
    driver.top.choose(driver.top.sums)
    driver.frames(3)
    return driver


def scene(driver: Driver) -> SumsTab:
    assert isinstance(driver.top, DigitInsideScene)
    assert driver.top.tab is driver.top.sums
    return driver.top.sums


def maps(driver: Driver) -> list[MapRow]:
    return [each for each in driver.form.widgets if isinstance(each, MapRow)]


def test_the_unit_that_is_followed_leads_from_a_patch_to_the_answer(inside: Driver, modern, nine):
    walk = scene(inside).walk
    assert walk.number == 0
    assert walk.places[-1][2] == modern.predict(nine)[0].argmax()
    places = list(walk.places)
    for number in range(1, len(walk.stages)):
        scene(inside).choose(number)
        assert walk.channel == walk.places[number - 1][2], "the map in which the last number stands"
    assert walk.at_answer
    assert walk.places == places, "looking on changes nothing of the way"


def test_three_tabs_do_not_pile_up(inside: Driver):
    tabs = inside.choice(texts.SUMS_TITLE)
    for index, tab in ((0, "why_not"), (2, "dreams"), (1, "sums"), (0, "why_not")):
        inside.click(inside.choice(texts.SUMS_TITLE)._places[index].center)
        assert inside.top.tab is getattr(inside.top, tab)
    assert tabs.options[0] == texts.WHY_NOT_TITLE.format(digit=inside.top.why_not.asked)
    inside.key(pygame.K_ESCAPE)
    assert not inside.app.scenes.running, "it was the only scene"


def test_all_figures_of_the_sum_are_written(inside: Driver, monkeypatch):
    walk, words = scene(inside).walk, words_written(monkeypatch)
    for number in (0, 1, 3, 6, 8):
        words.clear()
        scene(inside).choose(number)
        inside.frames(1)
        unit: Any = walk.unit
        channel = walk.channel if unit.weights is not None else 0
        shown = [*unit.products[:, :, channel].ravel()]
        assert figure(unit.output, 3) in words, number
        if unit.weights is not None:
            shown += [*unit.patch[:, :, walk.channel].ravel(), *unit.weights[:, :, walk.channel].ravel()]
            assert figure(unit.bias, 3) in words, number
            assert unit.total == pytest.approx(unit.output, abs=1e-4)
        assert {figure(float(value)) for value in shown} <= set(words), number


def test_the_mouse_moves_the_window_and_chooses_a_map(inside: Driver):
    walk = scene(inside).walk
    digit, given = maps(inside)
    inside.move(digit.pixels((10, 12, 11, 13)).center)
    assert walk.unit.corner == (8, 10), "the window's middle is where the mouse is"
    inside.widget(texts.PATCH_GAVE).set(9)
    assert walk.place == (8, 10, 9)
    inside.move(given.pixels((3, 4, 4, 5)).center)
    assert walk.place == (3, 4, 9)
    inside.click(inside.choice(texts.PATCH_STAGES["pooling"])._places[3].center)
    assert walk.number == 3


@pytest.mark.parametrize("device", DEVICES)
def test_the_window_is_moved_without_a_mouse(inside: Driver, device: str):
    walk, player = scene(inside).walk, Player(inside, device)
    player.press("down", "up")  # from now on there is no mouse in use
    inside.form.focus(maps(inside)[0])
    player.press("confirm")
    before = walk.place
    player.hold("up", down=True)
    inside.frames(20)
    player.hold("up", down=False)
    assert walk.place[0] < before[0]
    player.press("back")
    assert not inside.form.typing
    assert inside.top_name == "DigitInsideScene"


def strange(kind: str) -> DigitClassifier:
    if kind == "normalised":
        network = NeuralNetwork(*CostFunctions.use_mse()).add_layer(FullyConnectedLayer(784, 12))
        network.add_layer(LayerNormalisation(12)).add_layer(FullyConnectedLayer(12, 10)).add_layer(
            LayerNormalisation(10)
        )
        return DigitClassifier(network)
    changes = {
        "deep": {"filters": (4, 5), "kernel": 3, "hidden": (300, 7), "activation": "leaky_relu"},
        "plain": {"convolutions": False, "hidden": (1100,), "activation": "tanh", "output_activation": True},
    }
    return DigitClassifier(
        build_digit_network(DIGIT_PRESETS["modern"].changed(**changes[kind]), np.random.default_rng(1))
    )


@pytest.mark.parametrize("kind", ["deep", "plain", "normalised"])
def test_networks_of_other_shapes_can_be_gone_through(open_game: Open, context: Context, nine, kind: str):
    save_settings(context)
    driver = opened(open_game, strange(kind), nine)
    walk = scene(driver).walk
    for number in range(len(walk.stages)):
        scene(driver).choose(number)
        driver.frames(1)
        for picture in maps(driver):
            driver.move(picture.pixels((0, 0, 1, 1)).center)
        assert (walk.unit is None) == (walk.stage.kind == "other")


# Why not


@pytest.fixture(scope="module")
def classic():
    return DigitClassifier.load(MODELS_DIR / "digits" / "classic")  # which is measured sooner


@pytest.fixture
def why_not(open_game: Open, context: Context, classic, nine) -> Driver:
    save_settings(context)
    return open_game(DigitInsideScene, classic, nine)


def measured(driver: Driver) -> WhyNotTab:
    top = driver.top.why_not
    while top.contrast.left:
        top.update()
    driver.frames(2)
    return top


def test_another_digit_is_asked_about_and_its_ink_changed(why_not: Driver, classic, nine):
    why_not.click(why_not.the(DigitBars).place(8).center)
    why_not.form.focus(why_not.the(DigitBars))
    why_not.button(pygame.CONTROLLER_BUTTON_DPAD_UP)
    why_not.button(pygame.CONTROLLER_BUTTON_A)
    top = measured(why_not)
    assert top.asked == 7
    take = top.changes[0]
    why_not.press_on(texts.WHY_NOT_TAKE_IT)
    labels = [widget.label for widget in why_not.form.widgets]
    assert texts.WHY_NOT_PUT_IT not in labels, "while it measures"
    assert top.image.sum() < nine.sum()
    assert classic.predict(top.image)[0][7] > classic.predict(nine)[0][7]
    assert top.contrast.scores[7] == pytest.approx(take.after, abs=1e-4)
    why_not.press_on(texts.WHY_NOT_UNDO)
    np.testing.assert_array_equal(top.image, nine)


def test_what_it_reads_by_now_is_not_asked_about(why_not: Driver):
    top = measured(why_not)
    first, asked = top.contrast.answer, top.asked
    while top.contrast.answer == first:
        change = max(top.changes, key=lambda each: each.after)
        why_not.press_on((texts.WHY_NOT_TAKE_IT, texts.WHY_NOT_PUT_IT)[change.ink])
        measured(why_not)
    assert top.contrast.answer == asked
    assert top.asked != asked


def test_what_is_said_of_ink_is_true(why_not: Driver, classic, monkeypatch):
    why_not.key(pygame.K_7)
    top, words = measured(why_not), words_written(monkeypatch)
    why_not.resize((1600, 900))  # paints everything anew
    said = " ".join(words)
    assert len(top.changes) == 2
    for change in top.changes:
        network = classic.network
        after = network.predict(classic.shaped(top.contrast.changed(change.row, change.column, change.ink)))[0]
        before = network.predict(classic.shaped(top.image))[0]
        assert after[7] > before[7]
        assert f"{figure(float(after[7]))} instead of {figure(float(before[7]))}" in said


def test_the_map_says_what_is_for_the_asked_digit_and_what_is_for_the_answer(why_not: Driver, classic):
    why_not.key(pygame.K_7)
    top = measured(why_not)

    def lead(image) -> float:
        scores = classic.network.predict(classic.shaped(image))[0]
        return float(scores[7] - scores[9])

    for inked, says in ((True, -1), (False, 1)):  # ink that is for it makes the lead less when it is taken away
        shown = np.where((top.image > 0) == inked, top.says, 0.0)
        for place in (shown.argmin(), shown.argmax()):
            row, column = np.unravel_index(place, shown.shape)
            gained = lead(top.contrast.changed(int(row), int(column), 1 - inked)) - lead(top.image)
            assert np.sign(gained) == says * np.sign(shown[row, column]) != 0


def test_its_own_answer_is_not_asked_about(why_not: Driver, written: list[str]):
    why_not.key(pygame.K_9)
    measured(why_not)
    assert texts.WHY_NOT_SAME in " ".join(written)
    labels = [widget.label for widget in why_not.form.widgets]
    assert texts.WHY_NOT_TAKE_IT not in labels, "nothing can be pressed that would do nothing"


def test_a_network_that_cannot_be_asked_says_so(open_game: Open, context: Context, nine, monkeypatch):
    save_settings(context)
    words = words_written(monkeypatch)
    driver = open_game(DigitInsideScene, strange("normalised"), nine)
    driver.frames(3)
    driver.key(pygame.K_3)
    assert driver.top.why_not.contrast is None
    assert texts.WHY_NOT_STRANGE.split(",")[0][:20] in " ".join(words)


# Ten dreams


def test_all_ten_dreams_go_on_together(open_game: Open, context: Context, modern, nine):
    save_settings(context)
    driver = open_game(DigitInsideScene, modern, nine)
    dreams = driver.top.dreams
    driver.top.choose(dreams)
    driver.skip(10 * 4)
    assert {dream.step for dream in dreams.dreams} == {4}
