"""The quiz without a screen."""

import numpy as np
import pytest

from ai.digits.classifier import DigitClassifier
from ai.digits.mnist import TEST, bright, read_part
from game.core.assets import MODELS_DIR
from game.scenes.digits.quiz_rules import ROUNDS, QuizGame


@pytest.fixture(scope="module")
def classifier():
    return DigitClassifier.load(MODELS_DIR / "digits" / "classic")


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


def test_drawing_and_reading_take_turns(contest):
    assert [each.kind for each in contest.rounds] == ["draw", "read"] * (ROUNDS // 2)
    asked = [each.digit for each in contest.rounds if each.kind == "draw"]
    assert len(set(asked)) == len(asked)


def test_each_side_gets_a_point_for_what_it_reads(contest, samples):
    while contest.round:
        current = contest.round
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
