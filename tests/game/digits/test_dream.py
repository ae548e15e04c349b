"""The dream, through real pygame events."""

from collections.abc import Callable

import numpy as np
import pygame
import pytest

from ai.digits.classifier import DigitClassifier
from game.core import texts
from game.core.assets import MODELS_DIR
from game.digits.cells import CellPicker
from game.scenes.digits.answer import DigitBars
from game.scenes.digits.dream import DreamScene
from game.ui.rows import SliderRow
from tests.support.driver import Driver


@pytest.fixture(scope="module")
def classifier():
    return DigitClassifier.load(MODELS_DIR / "digits" / "classic")


def test_the_digit_that_is_looked_at_is_dreamt_first_and_then_the_others(open_game: Callable[..., Driver], classifier):
    game = open_game(DreamScene, classifier, 3)
    while not game.top.dreams[3].done:
        game.frames(1)
    assert game.top.dreams[3].probabilities.argmax() == 3
    assert game.top.dreams[5].step == 0
    game.frames(20)
    assert game.top.dreams[0].step > 0


def test_keys_mouse_and_pad_choose_a_digit(open_game: Callable[..., Driver], classifier):
    game = open_game(DreamScene, classifier, 3)
    game.key(pygame.K_7)
    assert game.top.digit == 7
    game.click(game.the(CellPicker).place(0, 2).center)
    assert game.top.digit == 2
    game.click(game.the(DigitBars).place(9).center)
    assert game.top.digit == 9
    game.button(pygame.CONTROLLER_BUTTON_RIGHTSHOULDER)
    assert game.top.digit == 0
    game.button(pygame.CONTROLLER_BUTTON_LEFTSHOULDER)
    assert game.top.digit == 9


def test_other_settings_begin_another_dream(open_game: Callable[..., Driver], classifier):
    drawing = np.zeros((28, 28), np.float32)
    drawing[5:23, 12:16] = 1
    game = open_game(DreamScene, classifier, 1, drawing)
    game.frames(30)
    game.form.focus(game.the(SliderRow))
    before = game.top.dreams[1]
    game.key(pygame.K_LEFT)
    assert game.top.dreams[1] is not before
    assert game.top.dreams[1].calm == pytest.approx(0.6)
    game.choice(texts.DREAM_STARTS[1]).choose(1)
    np.testing.assert_array_equal(game.top.dreams[1].image, drawing)
    game.frames(30)
    game.key(pygame.K_r)
    assert game.top.dreams[1].step < 5
    game.key(pygame.K_ESCAPE)
    assert not game.app.scenes.running  # it was the only scene
