"""The dream and the quiz, through real pygame events."""

from collections.abc import Callable

import numpy as np
import pygame
import pytest

from ai.digits.classifier import DigitClassifier
from ai.digits.mnist import TEST, bright, read_part
from game.core import texts
from game.core.assets import MODELS_DIR
from game.digits.cells import CellPicker
from game.scenes.digits.answer import DigitBars
from game.scenes.digits.dream import DreamScene
from game.scenes.digits.quiz import QuizScene
from game.scenes.digits.quiz_rules import ROUNDS, QuizGame
from game.ui.rows import SliderRow
from game.ui.widget import Widget
from tests.support.driver import Driver
from tests.support.pen import SEVEN, stroke


@pytest.fixture(scope="module")
def classifier():
    return DigitClassifier.load(MODELS_DIR / "digits" / "classic")


# Dream


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


# Quiz


def test_a_drawing_is_read_and_a_shown_digit_answered(open_game: Callable[..., Driver], classifier):
    game = open_game(QuizScene, classifier)
    game.frames(2)
    scene = game.top
    scene.contest.round.digit = 7
    stroke(game, SEVEN)
    game.key(pygame.K_RETURN)
    assert scene.contest.rounds[0].answer == 7
    assert scene.contest.score("draw") == (1, 1)
    stroke(game, SEVEN)
    assert len(scene.pad.strokes) == 1, "what was read stays as it is"
    game.key(pygame.K_RETURN)
    assert scene.contest.round.kind == "read"
    game.click(game.widget(str(scene.contest.round.digit)).box.center)
    assert scene.contest.score("read") == (1, 1)
    game.button(pygame.CONTROLLER_BUTTON_A)
    assert scene.contest.place == 2
    assert scene.pad.empty


def test_strokes_are_undone_and_cleared_until_they_are_read(open_game: Callable[..., Driver], classifier):
    game = open_game(QuizScene, classifier)
    game.frames(2)
    game.key(pygame.K_RETURN)
    assert game.said == texts.QUIZ_NOTHING, "an empty pad is not handed in"
    assert game.top.contest.round.answer is None
    stroke(game, SEVEN)
    stroke(game, [(100, 200), (150, 400)])
    game.key(pygame.K_z)
    assert len(game.top.pad.strokes) == 1
    game.key(pygame.K_c)
    assert game.top.pad.empty
    game.button(pygame.CONTROLLER_BUTTON_Y)
    assert len(game.top.pad.strokes) == 1
    game.keys(pygame.K_RETURN, pygame.K_c)
    assert not game.top.pad.empty


def test_ten_rounds_and_again(open_game: Callable[..., Driver], classifier):
    game = open_game(QuizScene, classifier)
    game.frames(2)
    scene = game.top
    while current := scene.contest.round:
        if current.kind == "draw":
            stroke(game, SEVEN)
            game.key(pygame.K_RETURN)
        else:
            game.key(pygame.K_0 + current.digit)
        shown = {each for each in scene.form.manager.get_sprite_group().sprites() if isinstance(each, Widget)}
        assert shown == {*scene.form.widgets}, "words that have done their work are gone"
        game.key(pygame.K_RETURN)
    assert scene.contest.score("read") == (5, 5)
    assert scene.contest.lead == 1
    assert scene.contest.place == ROUNDS
    game.resize((960, 540))
    game.key(pygame.K_RETURN)
    assert scene.contest.place == 0


# The quiz without a screen.


@pytest.fixture(scope="module")
def samples():
    images, labels = read_part(TEST)
    return images[:400], labels[:400]


@pytest.fixture
def contest(classifier, samples):
    images, labels = samples
    return QuizGame(classifier, images, labels, np.random.default_rng(0))


def draw(contest, samples, digit):
    """Draw as neatly as the clearest of the samples."""
    images, labels = samples
    clear = contest.classifier.predict(bright(images))[:, digit] * (labels == digit)
    contest.submit(images[clear.argmax()])


def test_drawing_and_reading_take_turns_and_each_side_gets_a_point_for_what_it_reads(contest, samples):
    assert [each.kind for each in contest.rounds] == ["draw", "read"] * (ROUNDS // 2)
    asked = [each.digit for each in contest.rounds if each.kind == "draw"]
    assert len(set(asked)) == len(asked)
    while current := contest.round:
        if current.kind == "draw":
            draw(contest, samples, current.digit)
        else:
            contest.read(current.digit if contest.place < 5 else (current.digit + 1) % 10)
        contest.go_on()
    assert contest.score("draw") == (5, 5)
    assert contest.score("read") == (2, 5)
    assert contest.lead == -1


def test_a_round_is_answered_once_and_not_left_without_an_answer(contest, samples):
    contest.go_on()
    assert contest.place == 0
    contest.read(3)
    assert contest.round.answer is None, "it is not for the player to read"
    draw(contest, samples, contest.round.digit)
    answer = contest.round.answer
    contest.submit(np.zeros((28, 28), np.float32))
    assert contest.round.answer == answer


def test_the_digits_to_read_are_written_worse_than_most(contest, classifier, samples):
    while contest.look():
        assert contest.rounds[1].image is None, "a few at a time"
    asked = [each.probabilities.max() for each in contest.rounds if each.kind == "read"]
    assert max(asked) < np.median(classifier.predict(samples[0]).max(axis=1))


def test_without_images_everything_is_drawn(classifier):
    contest = QuizGame(classifier, np.zeros((0, 28, 28), np.float32), np.zeros(0, np.uint8), np.random.default_rng(0))
    assert {each.kind for each in contest.rounds} == {"draw"}
    assert contest.lead == 0
