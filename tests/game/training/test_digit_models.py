"""Networks of the player's own in Draw a digit."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pygame
import pytest

from ai.digits.classifier import DigitClassifier
from ai.digits.config import DIGIT_PRESETS, build_digit_network
from game.core.assets import MODELS_DIR
from game.scenes.digits.reader import saliency
from game.scenes.digits.scene import DigitsScene
from game.training.library import DigitModels, called, models_by_name
from game.ui.context import Context
from tests.support.driver import Driver
from tests.support.pen import draw, guess, strokes
from tests.support.screens import save_settings

CONFIGS = [
    DIGIT_PRESETS["classic"].changed(hidden=(8,), dropout=0.4),  # dropout comes before all weights
    DIGIT_PRESETS["modern"].changed(filters=(64,), kernel=1, hidden=(16,)),
    DIGIT_PRESETS["modern"].changed(filters=(8, 16), hidden=(256, 128), kernel=9),
]


def save(context: Context, name: str, config=CONFIGS[0]) -> Path:
    folder = DigitModels(context.user_dir).folder / name
    DigitClassifier(build_digit_network(config, np.random.default_rng(0))).save(folder)
    return folder


@pytest.fixture
def own(context: Context) -> list[str]:
    for number, config in enumerate(CONFIGS):
        save(context, f"Reader {number}", config)
    return [f"Reader {number}" for number in range(len(CONFIGS))]


def reading(open_game: Callable[..., Driver], context: Context) -> Driver:
    """Draw a digit, with its readers to choose from."""
    save_settings(context, opened="digits")
    return open_game(DigitsScene)


def test_names_are_those_of_folders_and_none_hides_another(context: Context):
    for name in ("zero", "Modern", ".training"):
        save(context, name)
    (DigitModels(context.user_dir).folder / "notes").mkdir()
    found = models_by_name(MODELS_DIR, context.user_dir)
    assert list(found) == ["modern", "classic", "Modern (yours)", "zero"]
    assert [called(name) for name in found] == ["Modern", "Classic", "Modern (yours)", "zero"]


@pytest.mark.parametrize("config", CONFIGS)
def test_networks_of_any_shape_are_explained(context: Context, config):
    why = saliency(DigitClassifier.load(save(context, "own", config)), np.eye(28, dtype=np.float32))
    assert np.isfinite(why).all()


def test_each_of_them_can_be_chosen(open_game: Callable[..., Driver], own: list[str], context: Context):
    driver = reading(open_game, context)
    draw(driver, strokes(3))
    reader = driver.choice(own[0])
    assert reader.options == ["Modern", "Classic", *own]
    for index, name in reversed(list(enumerate(["modern", "classic", *own]))):
        driver.choice(own[0]).choose(index)
        assert driver.top.chosen == name
        guess(driver)
        assert set(driver.top.reading.probabilities) == {driver.top.chosen, driver.top.live.other}


def test_what_was_trained_meanwhile_stands_beside_the_others(open_game: Callable[..., Driver], context: Context):
    driver = reading(open_game, context)
    driver.press_on("Train")
    assert driver.top_name == "TrainScene"
    save(context, "mine")
    driver.key(pygame.K_ESCAPE)
    assert driver.choice("Modern").options[-1] == "mine"


def test_a_damaged_one_is_named_and_stepped_over(open_game: Callable[..., Driver], context: Context, own: list[str]):
    (DigitModels(context.user_dir).folder / own[0] / "config.json").write_text("{", encoding="utf-8")
    driver = reading(open_game, context)
    driver.choice(own[0]).choose(2)
    assert driver.top.chosen == "modern"
    assert "config.json" in driver.top.live.problems[own[0]]
    assert own[0] not in driver.choice(own[1]).options
    draw(driver, strokes(3))
    guess(driver)
    driver.frames(3)


def test_fixes_of_a_network_of_ones_own_lie_with_it(context: Context):
    folder = save(context, "mine")
    mine = models_by_name(MODELS_DIR, context.user_dir)["mine"]
    fix = mine.fixes / "0001"
    DigitClassifier.load(folder).save(fix)
    assert mine.versions() == [fix, folder]
    folder.rename(folder.with_name("ours"))
    assert models_by_name(MODELS_DIR, context.user_dir)["ours"].fixed()
