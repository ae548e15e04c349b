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
from game.digits.cells import CellPicker
from game.scenes.digits.answer import DigitBars
from game.scenes.digits.inside import DigitInsideScene
from game.scenes.digits.sums import figure
from game.scenes.digits.sums_tab import SumsTab
from game.scenes.digits.why_not import WhyNotTab
from game.ui.context import Context
from tests.support.driver import Driver
from tests.support.player import Player
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


def maps(driver: Driver) -> list[CellPicker]:
    return [each for each in driver.form.widgets if isinstance(each, CellPicker) and len(each.tiles) == 1]


def tiles(driver: Driver) -> list[CellPicker]:
    return [each for each in driver.form.widgets if isinstance(each, CellPicker) and len(each.tiles) > 1]


def test_the_unit_that_is_followed_leads_from_a_patch_to_the_answer(inside: Driver, modern, nine):
    walk = scene(inside).walk
    assert walk.number == 0
    probabilities = modern.predict(nine)[0]
    assert walk.value(len(walk.stages)) == pytest.approx(probabilities.max(), abs=1e-6)
    places = list(walk.places)
    for number in range(1, len(walk.stages) + 1):
        inside.key(pygame.K_n)
        assert walk.number == number
    assert walk.at_answer
    assert walk.places == places, "looking on changes nothing of the way"
    inside.key(pygame.K_n)
    assert walk.at_answer
    inside.key(pygame.K_b)
    assert walk.number == len(walk.stages) - 1


def test_each_map_that_is_followed_is_the_one_in_which_the_last_number_stands(inside: Driver):
    walk = scene(inside).walk
    for number in range(1, len(walk.stages)):
        inside.key(pygame.K_n)
        place = walk.places[number - 1]
        assert place is not None
        row, column, channel = place
        assert walk.channel == channel
        assert walk.stage.inputs[row, column, channel] == walk.value(number - 1)


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
        while walk.number < number + 1:
            inside.key(pygame.K_n)
        inside.key(pygame.K_b)
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


def test_the_mouse_moves_the_window_and_lights_maps_and_patches(inside: Driver):
    walk = scene(inside).walk
    digit, given = maps(inside)
    inside.move(digit.place(10, 12).center)
    assert walk.unit.corner == (8, 10), "the window's middle is where the mouse is"
    assert digit.window == (8, 10, 13, 15)
    inside.move(given.place(20, 3).center)
    assert walk.place[:2] == (20, 3)
    assert digit.window == (20, 3, 25, 8), "the patch of the pixel that is pointed at lights"
    (filters,) = tiles(inside)
    inside.move(filters.place(1, 4).center)
    assert walk.place == (20, 3, filters.columns + 4)
    assert filters.cell == (1, 4)
    np.testing.assert_array_equal(np.sign(given.tiles[0]), np.sign(walk.stage.outputs[:, :, walk.place[2]]))
    inside.click(scene(inside)._stages._places[3].center)
    assert walk.number == 3
    read_maps = tiles(inside)[0]
    inside.move(read_maps.place(0, 5).center)
    assert walk.channel == 5


def test_arrows_take_hold_of_the_window_and_let_go(inside: Driver):
    walk, player = scene(inside).walk, Player(inside, "pad")
    digit = maps(inside)[0]
    player.press("down", "up")  # from now on there is no mouse in use
    inside.form.focus(digit)
    scene(inside).look_at((10, 10, walk.place[2]))
    row, column, channel = walk.place
    player.press("confirm", "down", "down", "left")
    assert digit.typing
    assert walk.place == (row + 2, column - 1, channel)
    player.hold("up", down=True)
    inside.frames(60)
    player.hold("up", down=False)
    assert walk.place[0] < row - 5
    player.press("back")
    assert not inside.form.typing
    assert inside.top_name == "DigitInsideScene"
    at = walk.place
    player.press("down")
    assert walk.place == at
    assert inside.form.focused is not digit


def test_arrows_move_any_window_and_back(inside: Driver):
    walk = scene(inside).walk
    for _ in range(3):
        inside.key(pygame.K_n)
        walk.look_at((3, 3, walk.place[2]))
        inside.form.focus(maps(inside)[0])
        inside.keys(pygame.K_RETURN, pygame.K_RIGHT, pygame.K_LEFT, pygame.K_LEFT)
        there = walk.place
        inside.keys(pygame.K_RIGHT, pygame.K_UP, pygame.K_RIGHT)
        assert walk.place == (there[0] - 1, there[1] + 2, there[2])
        inside.key(pygame.K_ESCAPE)


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
    for _ in range(len(walk.stages)):
        driver.frames(1)
        for picker in [*maps(driver), *tiles(driver)]:
            driver.move(picker.place(0, 0).center)
        assert (walk.unit is None) == (walk.stage.kind == "other")
        driver.key(pygame.K_n)
    assert walk.at_answer
    driver.frames(2)


# Why not


@pytest.fixture
def why_not(open_game: Open, context: Context, modern, nine) -> Driver:
    save_settings(context)
    return open_game(DigitInsideScene, modern, nine)


def measured(driver: Driver) -> WhyNotTab:
    top = driver.top.why_not
    while not top.contrast.done:
        driver.skip()
    driver.frames(2)
    return top


@pytest.mark.parametrize("device", ["mouse", "pad"])
def test_another_digit_is_asked_about_and_its_ink_changed(why_not: Driver, modern, nine, device: str):
    if device == "mouse":
        why_not.click(why_not.the(DigitBars).place(7).center)
    while why_not.top.why_not.asked != 7:
        why_not.button(pygame.CONTROLLER_BUTTON_RIGHTSHOULDER)
    top = measured(why_not)
    take = top.seen.take
    why_not.press_on(texts.WHY_NOT_TAKE_IT)
    assert top.image.sum() < nine.sum()
    assert modern.predict(top.image)[0][7] > modern.predict(nine)[0][7]
    assert top.contrast.scores[7] == pytest.approx(take.after, abs=1e-4)
    if device == "pad":
        why_not.button(pygame.CONTROLLER_BUTTON_X)
    else:
        why_not.key(pygame.K_r)
    np.testing.assert_array_equal(top.image, nine)


def test_what_is_said_of_ink_is_true(why_not: Driver, modern, monkeypatch):
    why_not.key(pygame.K_7)
    top, words = measured(why_not), words_written(monkeypatch)
    why_not.resize((1600, 900))  # paints everything anew
    said = " ".join(words)
    for change in (top.seen.take, top.seen.put):
        network = modern.network
        after = network.predict(modern.shaped(top.contrast.changed(change.row, change.column, change.ink)))[0]
        before = network.predict(modern.shaped(top.image))[0]
        assert after[7] > before[7]
        assert f"{figure(float(after[7]))} instead of {figure(float(before[7]))}" in said


def test_its_own_answer_has_its_score_beside_it_and_is_not_asked_about(why_not: Driver, modern, monkeypatch):
    words = words_written(monkeypatch)
    why_not.key(pygame.K_9)
    top = measured(why_not)
    score = float(modern.network.predict(modern.shaped(top.image))[0][9])
    assert any(each.endswith(texts.WHY_NOT_SCORE.format(score=figure(score))) for each in words)
    assert texts.WHY_NOT_SAME in " ".join(words)
    image = top.image
    why_not.press_on(texts.WHY_NOT_TAKE_IT)
    assert top.image is image


def test_a_network_that_cannot_be_asked_says_so(open_game: Open, context: Context, nine, monkeypatch):
    save_settings(context)
    words = words_written(monkeypatch)
    driver = open_game(DigitInsideScene, strange("normalised"), nine)
    driver.frames(3)
    driver.keys(pygame.K_3, pygame.K_r)
    assert driver.top.why_not.contrast is None
    assert texts.WHY_NOT_STRANGE.split(",")[0][:20] in " ".join(words)


# Ten dreams


def test_all_ten_dreams_go_on_together_and_begin_anew(open_game: Open, context: Context, modern, nine):
    save_settings(context)
    driver = open_game(DigitInsideScene, modern, nine)
    dreams = driver.top.dreams
    driver.top.choose(dreams)
    driver.skip(10 * 40)
    assert {dream.step for dream in dreams.dreams} == {40}
    assert sum(dream.probabilities.argmax() == dream.digit for dream in dreams.dreams) >= 9
    driver.key(pygame.K_r)
    assert max(dream.step for dream in dreams.dreams) < 3
