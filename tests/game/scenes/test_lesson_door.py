"""Into a lesson from Train: by a word, a click on a lander, a mark on the charts, after a step; and back to the run."""

import pygame

from game.core import texts
from game.core.worker import WorkerState
from game.scenes.lesson.scene import LessonScene
from game.scenes.train.scene import TrainScene
from game.ui.virtual_pointer import VirtualPointer
from tests.support.driver import Driver
from tests.support.small import learn, pause, toggle


def start(driver: Driver) -> None:
    learn(driver, 6)
    pause(driver)
    driver.frames(30)


def place_of(driver: Driver, slot: int) -> tuple[float, float]:
    """Where a lander stands on the screen."""
    swarm = driver.top.view.swarms.shown
    x, y = next(
        (x, y) for y in range(0, 430, 4) for x in range(0, 830, 4) if swarm.slot_at((x, y)) == slot
    )  # fmt: skip
    return x, y


def test_a_word_opens_the_lesson_of_a_lander_in_the_air(train: Driver) -> None:
    """A run that is paused stays so; one that goes on waits for the lesson, and goes on."""
    start(train)
    scene = train.top
    train.press_on(texts.LESSON_WHY)
    train.wait(lambda: isinstance(train.top, LessonScene))
    assert not train.top.lesson.flown.observations[:-1, -2:].any(), "on no foot"
    assert train.top.lesson.decisions == scene.run.swarm_state.decisions
    before = train.top.lesson
    train.press_on(texts.LESSON_ANOTHER)
    train.wait(lambda: train.top.lesson is not before)
    train.frames(3)
    train.key(pygame.K_ESCAPE)
    assert train.top is scene
    train.frames(5)
    assert train.top is scene, "one lesson is opened once"
    assert scene.run.state is WorkerState.PAUSED
    toggle(train)
    train.press_on(texts.LESSON_WHY)
    train.wait(lambda: isinstance(train.top, LessonScene))
    assert scene.run.state is WorkerState.PAUSED
    stood = scene.run.swarm_state.decisions
    train.frames(10)
    train.key(pygame.K_ESCAPE)
    train.wait(lambda: scene.run.swarm_state.decisions > stood)


def test_a_click_chooses_a_lander_and_another_opens_its_lesson_and_so_do_keys_alone(train: Driver) -> None:
    start(train)
    scene = train.top
    place = place_of(train, 2)
    train.click(place)
    assert scene.view.swarms.shown.chosen == 2
    assert train.top is scene
    train.click(place)
    train.wait(lambda: isinstance(train.top, LessonScene))
    assert train.top.lesson.flown.slot == 2
    train.frames(3)
    train.key(pygame.K_ESCAPE)
    place = place_of(train, 3)
    pointer = next(each for each in scene.form.widgets if isinstance(each, VirtualPointer) and each.box.top < 200)
    scene.form.focus(pointer)
    train.key(pygame.K_RETURN)
    assert pointer.typing
    pointer.place.update(place)
    train.key(pygame.K_RETURN)
    assert scene.view.swarms.shown.chosen == 3
    train.key(pygame.K_RETURN)
    train.wait(lambda: isinstance(train.top, LessonScene))
    assert train.top.lesson.flown.slot == 3


def test_without_a_run_a_note_says_what_to_do(train: Driver) -> None:
    train.press_on(texts.LESSON_WHY)
    train.frames(2)
    assert isinstance(train.top, TrainScene)
    assert train.said == texts.LESSON_NO_RUN
