"""What the pointer tells in a lesson, and the lesson of an image: sums that add up to the numbers of the step."""

from collections.abc import Callable

import pygame
import pytest
from game.lesson.frame import Explanation
from game.lesson.gradient_frame import GradientFrame
from game.lesson.network_frame import NetworkFrame
from game.lesson.step import WeightPlace

from ai.explain.agent_lesson import Lesson
from game.core import texts
from game.panels.figures import number, points
from game.scenes.lesson.scene import LessonScene
from game.ui.tooltip import TooltipRow
from tests.support.driver import Driver
from tests.support.lessons import SMALL, digit_lesson_of, in_view, lesson_of, shown

Open = Callable[..., Driver]
FRAMES = 7


@pytest.fixture(params=sorted(SMALL))
def lesson(request: pytest.FixtureRequest) -> Lesson:
    return lesson_of(request.param)


@pytest.fixture
def driver(open_game: Open, lesson: Lesson) -> Driver:
    opened = open_game(LessonScene, lesson)
    opened.frames(3)
    return opened


def figure(row: TooltipRow) -> float:
    return float(row.figure.replace("−", "-").replace("k", "e3"))


def test_a_units_sum_adds_up_to_its_value(driver: Driver, lesson: Lesson):
    driver.top.show(2)
    frame = driver.top.frame
    assert isinstance(frame, NetworkFrame)
    for column in range(1, len(frame.view.columns)):
        for place in range(len(frame.view.columns[column].units)):
            told: Explanation = frame.unit(column, place)
            rows = [row.word for row in told.rows]
            at = rows.index(texts.LESSON_STAGES["sum"])
            assert sum(map(figure, told.rows[:at])) == pytest.approx(figure(told.rows[at]), rel=0.02, abs=0.005)
    last = frame.unit(len(frame.view.columns) - 1, int(lesson.cell.action))
    predicted = float(lesson.predicted[int(lesson.cell.action)]) / lesson.config.reward_scale
    assert last.rows[-1].figure == points(predicted)


def test_every_number_of_every_picture_explains_itself(driver: Driver):
    for number_, part in enumerate(driver.top.parts):
        driver.top.show(number_)
        for label in part.frame.labels:
            if label.explanation is None:
                continue
            driver.move(in_view(label.box.center))
            assert part.frame.pointed is not None, label.text
            assert part.frame.pointed.explanation is not None


def test_the_link_under_the_mouse_tells_its_weight_and_slope(driver: Driver, lesson: Lesson):
    driver.top.show(6)
    frame = driver.top.frame
    assert isinstance(frame, GradientFrame)
    place = WeightPlace(1, 2, 3)
    told = frame.link(place)
    index = frame.step.index(place)
    inputs, units = len(lesson.state), lesson.config.hidden[0]
    norm = 2 * units if lesson.config.layer_normalisation else 0
    assert index == inputs * units + units + norm + 2 * lesson.config.hidden[1] + 3
    figures = [row.figure.lstrip("+") for row in told.rows]
    assert number(float(lesson.step.values_before[index])) in figures
    assert number(float(lesson.step.gradient[index])) in figures
    assert number(float(lesson.step.share[index])) in figures
    assert number(-float(lesson.step.taken[index])) in figures


# An image of the digit network


@pytest.mark.parametrize("preset", ["classic", "modern"])
def test_an_image_is_shown_in_seven_frames_as_well(open_game: Open, preset: str):
    lesson = digit_lesson_of(preset)
    driver = open_game(LessonScene, lesson)
    driver.frames(2)
    digit = int(lesson.labels[lesson.step.row])
    assert len(driver.top.parts) == FRAMES
    words = [shown(driver, frame) for frame in range(FRAMES)]
    assert texts.LESSON_LABEL.format(digit=digit) in words[0]
    for value in lesson.outputs.tolist():
        assert f"{value:.2f}".replace("-", "−") in words[1] or lesson.config.dropout
        assert number(value) in words[2]
    for value in lesson.probabilities_before.tolist():
        assert number(value) in words[2]
    for value in lesson.target.tolist():
        assert number(value) in words[3]
    for value in lesson.derivative.tolist():
        assert any(word.lstrip("+") == number(value) for word in words[4])
    assert number(lesson.step.gradient_length) in " ".join(words[5])
    before, after = (float(each[digit]) for each in (lesson.probabilities_before, lesson.probabilities_after))
    assert any(number(before) in word and number(after) in word for word in words[6])
    for part in driver.top.parts:
        for number_, line in enumerate(part.code.lines):
            part.code.index = number_
            assert line.number in dict(part.code.source.lines)


@pytest.mark.parametrize("preset", ["classic", "modern"])
def test_a_units_sum_of_a_digit_network_adds_up(open_game: Open, preset: str):
    driver = open_game(LessonScene, digit_lesson_of(preset))
    driver.top.show(1)
    driver.frames(2)
    frame = driver.top.frame
    assert isinstance(frame, NetworkFrame)
    for column in range(1, len(frame.view.columns)):
        told = frame.unit(column, 0)
        at = [row.word for row in told.rows].index(texts.LESSON_STAGES["sum"])
        assert sum(map(figure, told.rows[:at])) == pytest.approx(figure(told.rows[at]), rel=0.02, abs=0.005)


def test_a_pixel_tells_its_ink(open_game: Open):
    lesson = digit_lesson_of("classic")
    driver = open_game(LessonScene, lesson)
    driver.frames(2)
    driver.move(in_view((14.0 * 10 + 7, 14.0 * 20 + 7)))
    told = driver.top.frame.pointed.explanation
    assert told.lines == (texts.LESSON_PIXEL.format(row=21, column=11),)
    assert told.rows[0].figure == f"{float(lesson.image[20, 10]):.3f}"


def test_frame_cards_take_a_click_while_keys_move_a_pointer(driver: Driver):
    driver.key(pygame.K_RETURN)
    assert driver.top.pointer.typing
    for card in (3, 5):
        driver.click(driver.top.strip.box(card).center)
        assert driver.top.current == card
