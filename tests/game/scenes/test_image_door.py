"""Into the lesson of an image from digit training, from there to another image of the batch, and back to the run."""

from collections.abc import Callable

import pygame
import pytest

from game.core import texts
from game.core.worker import WorkerState
from game.scenes.lesson.scene import LessonScene
from game.scenes.train.digits import DigitTrainingScene
from tests.support.driver import Driver
from tests.support.lessons import digit_lesson_of
from tests.support.small import DIGITS, learn, pause


@pytest.fixture
def small_run() -> tuple[type[DigitTrainingScene], object]:
    return DigitTrainingScene, DIGITS


def open_lesson(driver: Driver) -> None:
    learn(driver, 1)
    driver.form.focus(driver.widget(texts.LESSON_WHY))
    driver.key(pygame.K_RETURN)
    driver.wait(lambda: isinstance(driver.top, LessonScene))
    driver.frames(3)


def test_a_word_opens_the_lesson_of_the_first_image_and_the_run_goes_on_afterwards(train: Driver) -> None:
    scene = train.top
    open_lesson(train)
    lesson = train.top.lesson
    assert lesson.step.row == 0
    assert lesson.config == DIGITS
    assert scene.run.state is WorkerState.PAUSED
    train.frames(10)
    train.key(pygame.K_ESCAPE)
    assert train.top is scene
    train.wait(lambda: scene.run.history["step"][-1] > lesson.taken)
    assert train.top is scene, "one lesson is opened once"


def test_another_image_of_the_same_batch_keeps_the_frame_and_the_last_is_followed_by_the_first(train: Driver) -> None:
    learn(train, 1)
    pause(train)
    train.press_on(texts.LESSON_WHY)
    train.wait(lambda: isinstance(train.top, LessonScene))
    train.frames(3)
    first = train.top.lesson
    train.keys(*[pygame.K_RIGHT] * 3)
    for row in range(1, DIGITS.batch_size + 1):
        train.key(pygame.K_r)
        train.wait(lambda row=row: train.top.lesson.step.row == row % DIGITS.batch_size)  # type: ignore[misc]
        lesson = train.top.lesson
        assert train.top.current == 3
        assert lesson.taken == first.taken, "a paused run stays where it is"
        assert (lesson.labels == first.labels).all(), "and so does its batch"
        assert train.top.parts[0].frame.figure == texts.LESSON_LABEL.format(digit=lesson.labels[lesson.step.row])
    assert (train.top.lesson.image == first.image).all()


def test_a_run_that_has_ended_leaves_the_lesson_as_it_is(train: Driver) -> None:
    scene = train.top
    open_lesson(train)
    lesson = train.top.lesson
    scene.run.close()
    train.key(pygame.K_r)
    train.frames(5)
    assert train.top.lesson is lesson
    assert train.said == texts.LESSON_NO_RUN
    train.key(pygame.K_ESCAPE)
    train.press_on(texts.LESSON_WHY)
    assert train.top is scene


def test_a_lesson_without_a_run_offers_no_other_image(open_game: Callable[..., Driver]) -> None:
    driver = open_game(LessonScene, digit_lesson_of("classic"))
    driver.frames(2)
    assert texts.LESSON_ANOTHER_IMAGE not in [hint.meaning for hint in driver.top.hints]
