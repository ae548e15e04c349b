"""A lesson on the screen: its frames by keys, mouse and gamepad, whose numbers are those of the learning step."""

from collections.abc import Callable
from itertools import pairwise
from typing import Any

import numpy as np
import pygame
import pytest
from game.lesson.agent_frames import agent_frames
from game.lesson.alone_frame import AloneFrame
from game.lesson.code import CODE
from game.lesson.error_frame import ErrorFrame
from game.lesson.frame import SMALL_PICTURE
from game.lesson.gradient_frame import GradientFrame
from game.lesson.moment_frame import in_units, sensed

from ai.agent.decision import in_points
from ai.explain.agent_lesson import Lesson
from ai.nn.costs import COSTS
from game.core import texts
from game.drawing.canvas import Canvas
from game.panels.figures import number, points
from game.scenes.lesson.scene import LessonScene
from tests.support.driver import Driver
from tests.support.lessons import SMALL, in_view, lesson_from, lesson_of, shown
from tests.support.written import words_written

Open = Callable[..., Driver]
FRAMES = 8


@pytest.fixture(params=sorted(SMALL))
def lesson(request: pytest.FixtureRequest) -> Lesson:
    return lesson_of(request.param)


@pytest.fixture
def driver(open_game: Open, lesson: Lesson) -> Driver:
    opened = open_game(LessonScene, lesson)
    opened.frames(3)
    return opened


def test_it_opens_on_this_memory_alone_which_walks_to_its_target_press_by_press(driver: Driver, lesson: Lesson):
    frame, scale, action = driver.top.frame, lesson.config.reward_scale, int(lesson.cell.action)
    assert isinstance(frame, AloneFrame)
    assert frame.alone.way == [pytest.approx(float(lesson.predicted[action]), abs=1e-6)]
    for word in (texts.LESSON_ALONE_ONCE, texts.LESSON_ALONE_ONCE):
        label = next(label for label in frame.labels if label.text == word)
        driver.click(in_view(label.box.center))
    off = [abs(value - lesson.target) for value in frame.alone.way]
    assert len(off) == 3
    assert off[0] > off[1] > off[2], "each press brings it nearer"
    label = next(label for label in frame.labels if label.text == texts.LESSON_ALONE_GO)
    driver.click(in_view(label.box.center))
    driver.skip(400)
    assert frame.alone.arrived
    assert not frame.going
    words = shown(driver, 0)
    assert points(frame.alone.way[-1] / scale) in words
    assert points(lesson.target / scale) in words
    assert abs(frame.alone.way[-1] - lesson.target) < 0.011 * off[0]
    moved = (frame.alone.outputs - lesson.predicted) / scale
    assert all(points(float(each)) in words for each in moved)
    assert np.abs(np.delete(moved, action)).max() > 0, "the others move with it: they share the weights"
    frame.again()
    assert len(frame.alone.way) == 1


def test_frames_say_what_the_numbers_beside_them_leave_open(lesson: Lesson):
    frames = [part.frame for part in agent_frames(lesson)]
    best, action = int(lesson.predicted.argmax()), int(lesson.cell.action)
    higher = points(float(lesson.predicted[best]) / lesson.config.reward_scale)
    assert (f"a higher value, {higher}" in frames[2].sentence) == (best != action), (
        "why another was flown than the one with this value"
    )
    words = " ".join(label.text for label in frames[4].labels)
    assert ("No copy stands still" in words) == (not lesson.config.target_judges)
    assert ("Layer normalisation" in words) == (not lesson.config.target_judges)
    gradient = frames[6]
    assert isinstance(gradient, GradientFrame)
    adam = lesson.config.optimizer == "adam"
    assert (texts.LESSON_DOWNHILL[1] in gradient.sentence) == adam
    moved, uphill = lesson.step.taken, 0
    for place in gradient.step.strongest(lesson.step.gradient, 200):
        gradient.pick(place)
        index = gradient.step.index(place)
        said = any(texts.LESSON_UPHILL.startswith(label.text) for label in gradient.labels if len(label.text) > 10)
        assert said == (lesson.step.gradient[index] * moved[index] < 0), place
        uphill += said
    assert bool(uphill) == adam, "plain steps never go uphill, and some of Adam's do"


# The ways through it


def test_all_frames_by_keys(driver: Driver):
    names = ("alone", "moment", "values", "happened", "target", "error", "gradient", "after")
    for number_, name in enumerate(names):
        assert driver.top.current == number_
        assert driver.top.frame.name == texts.LESSON_FRAMES[name][0]
        driver.key(pygame.K_RIGHT)
    assert driver.top.current == FRAMES - 1
    driver.keys(*[pygame.K_LEFT] * 9)
    assert driver.top.current == 0


def test_all_frames_by_mouse(driver: Driver):
    for number_ in reversed(range(FRAMES)):
        driver.click(driver.top.strip.box(number_).center)
        assert driver.top.current == number_


def test_a_card_takes_a_click_while_keys_point_at_numbers(driver: Driver):
    driver.key(pygame.K_RETURN)
    assert driver.top.pointer.typing
    driver.click(driver.top.strip.box(3).center)
    assert driver.top.current == 3


def test_all_frames_by_gamepad(driver: Driver):
    for number_ in range(FRAMES):
        assert driver.top.current == number_
        driver.button(pygame.CONTROLLER_BUTTON_DPAD_RIGHT)
    driver.button(pygame.CONTROLLER_BUTTON_LEFTSHOULDER)
    assert driver.top.current == FRAMES - 2
    before = driver.top.code.index
    driver.button(pygame.CONTROLLER_BUTTON_DPAD_DOWN)
    assert driver.top.code.index == before + 1


def test_numbers_are_pointed_at_without_a_mouse(open_game: Open):
    driver = open_game(LessonScene, lesson_of("modern"))
    driver.frames(2)
    driver.keys(pygame.K_RIGHT, pygame.K_RIGHT, pygame.K_RETURN)
    assert driver.top.pointer.typing
    unit = driver.top.frame.view.centres[1][0]
    driver.top.pointer.place.update(unit[0] - 12, unit[1])
    driver.post(pygame.KEYDOWN, key=pygame.K_RIGHT, mod=0)
    driver.frames(1)
    driver.post(pygame.KEYUP, key=pygame.K_RIGHT, mod=0)
    assert driver.top.frame.pointed is not None
    assert driver.top.current == 2, "the arrows move the pointer now"
    driver.key(pygame.K_ESCAPE)
    assert isinstance(driver.top, LessonScene)
    assert driver.top.frame.pointed is None


def test_a_gamepads_pointer_picks_a_weight(open_game: Open):
    driver = open_game(LessonScene, lesson_of("modern"))
    driver.frames(2)
    for _ in range(6):
        driver.button(pygame.CONTROLLER_BUTTON_DPAD_RIGHT)
    frame = driver.top.frame
    assert isinstance(frame, GradientFrame)
    label = frame.labels[1]
    driver.button(pygame.CONTROLLER_BUTTON_A)
    driver.top.pointer.place.update(in_view(label.box.center))
    driver.button(pygame.CONTROLLER_BUTTON_A)
    assert frame.alone


def test_lines_are_stepped_through_and_stand_in_the_source(driver: Driver, lesson: Lesson):
    seen = 0
    for part in driver.top.parts:
        begin = part.code.index
        for place, line in enumerate(part.code.lines):
            part.code.index = place
            assert line.number in dict(part.code.source.lines), f"{line.function}, line {line.number}"
            seen += 1
        part.code.index = begin
    assert seen > 100
    driver.top.show(4)
    code = driver.top.code
    before = code.index
    assert "targets" in code.line.values, "the walk begins where the target is set"
    driver.keys(pygame.K_UP, pygame.K_UP, pygame.K_DOWN)
    assert code.index == before - 1
    driver.keys(*[pygame.K_UP] * (before + 5))
    assert code.index == 0


def test_lines_and_their_numbers_are_on_the_screen(driver: Driver):
    words = shown(driver, 5)
    line, source = driver.top.code.line, driver.top.code.source
    assert str(line.number) in words
    text = dict(source.lines)[line.number].strip()
    assert any(word and text.startswith(word) for word in words)
    assert line.values
    for name in line.values:
        assert name in words


def test_the_numbers_of_a_line_are_listed_under_the_mouse(driver: Driver, lesson: Lesson):
    driver.top.show(6)
    code = driver.top.code
    code.index = next(number_ for number_, line in enumerate(code.lines) if "output_error" in line.values)
    row = [*code.line.values].index("output_error")
    driver.move((CODE.left + 60, CODE.top + 308 + 18 * row + 26))
    assert code.pointed is not None
    assert code.pointed[0].name == "output_error"
    with pytest.MonkeyPatch.context() as patch:
        words = words_written(patch)
        driver.frames(1)
    assert f"[{int(lesson.cell.action)}]" in words
    assert number(lesson.derivative) in words
    driver.key(pygame.K_DOWN)
    assert code.pointed is None


def test_the_line_that_does_it_is_lit_at_first_with_this_cases_numbers_beside_the_lines(driver: Driver, lesson: Lesson):
    sets = {1: "rows", 3: "self._returns", 4: "targets", 5: "errors", 7: "values"}
    for frame, name in sets.items():
        code = driver.top.parts[frame].code
        assert name in code.line.values
        assert "_start" not in dict(code.source.lines)[code.line.number], "the sum itself, not its empty beginning"
    words = shown(driver, 4)
    target = lesson.target / lesson.config.reward_scale
    assert words.count(number(target)) >= 2, "beside the line, and below, in points as all else on the screen"
    assert number(lesson.target) not in words
    assert number(lesson.discount) in words


def test_shapes_and_numbers_below_the_listing_never_touch(driver: Driver, monkeypatch: pytest.MonkeyPatch):
    drawn: list[tuple[str, pygame.FRect, int]] = []
    text = Canvas.text

    def listen(self: Canvas, words: str, *arguments: Any, **options: Any) -> pygame.FRect:
        box = text(self, words, *arguments, **options)
        if self is not driver.app.canvas and box.top > 300:  # on the sheet of the code, below the listing
            drawn.append((words, pygame.FRect(box), id(self)))
        return box

    monkeypatch.setattr(Canvas, "text", listen)
    for frame in range(1, FRAMES):
        driver.top.show(frame)
        for _ in range(12):
            drawn.clear()
            driver.key(pygame.K_DOWN)
            driver.frames(1)
            names = list(driver.top.code.line.values)
            for name, box, sheet in [each for each in drawn if each[0] in names]:
                row = sorted((other for _, other, its in drawn if its == sheet and abs(other.bottom - box.bottom) < 4),
                             key=lambda each: each.left)  # fmt: skip
                assert all(one.right <= two.left for one, two in pairwise(row)), name


def test_every_part_of_the_pay_has_its_name_beside_its_colour(driver: Driver, lesson: Lesson):
    words = shown(driver, 3)
    assert lesson.flown is not None
    for name, paid in lesson.flown.parts.items():
        assert (texts.REWARD_PARTS[name][0] in words) == bool(paid.any())


def test_every_card_has_a_picture_that_is_painted_once(driver: Driver, monkeypatch: pytest.MonkeyPatch):
    for part in driver.top.parts:
        sheet = driver.app.canvas.sheet(*SMALL_PICTURE)
        before = pygame.image.tobytes(sheet.surface, "RGBA")
        part.frame.paint_small(sheet)
        assert pygame.image.tobytes(sheet.surface, "RGBA") != before
        monkeypatch.setattr(part.frame, "paint_small", lambda _: pytest.fail("painted again"))
    driver.top.show(3)
    driver.frames(3)


# The numbers are the lesson's


def test_the_moment_shows_the_nine_inputs(driver: Driver, lesson: Lesson):
    words = shown(driver, 1)
    for feature, value in enumerate(in_units(lesson.cell.state).tolist()):
        assert texts.INPUTS[feature] in words
        assert sensed(value, feature) in words
        assert number(float(lesson.state[feature])) in words


def test_the_values_are_the_networks(driver: Driver, lesson: Lesson):
    words = shown(driver, 2)
    for value in in_points(lesson.predicted, lesson.config.reward_scale).tolist():
        assert f"{value:.2f}".replace("-", "−") in words


def test_what_happened_shows_the_pay_of_each_decision(driver: Driver, lesson: Lesson):
    words = shown(driver, 3)
    assert lesson.flown is not None
    for reward in lesson.flown.rewards.tolist():
        assert points(reward) in words
    assert points(float(lesson.cell.reward) / lesson.config.reward_scale) in words
    for feature, value in enumerate(in_units(lesson.cell.next_state).tolist()):
        assert sensed(value, feature) in words


def test_the_target_is_a_sum_that_can_be_read(driver: Driver, lesson: Lesson):
    words, scale = shown(driver, 4), lesson.config.reward_scale
    for value in (lesson.target, float(lesson.cell.reward), lesson.next_value):
        assert points(value / scale) in words
    assert f"{lesson.discount:.3f}" in words
    judged = lesson.config.target_judges
    assert (texts.LESSON_PICK in words) == (judged and lesson.config.double)
    assert (texts.LESSON_PICK_AND_JUDGE in words) == (judged and not lesson.config.double)
    assert (texts.LESSON_NEWEST_JUDGES in words) == (not judged)
    for value in in_points(lesson.next_judged, scale).tolist():
        assert points(value) in words


def test_a_target_at_the_end_of_a_flight_says_that_nothing_comes_after(open_game: Open):
    config = SMALL["modern"].changed(n_step=3)
    lesson = next(
        found for turns in range(40, 200) if (found := lesson_from(config, turns)).cell.terminal or turns == 199
    )
    assert lesson.cell.terminal
    driver = open_game(LessonScene, lesson)
    words = shown(driver, 4)
    assert texts.LESSON_PART_ENDED in words
    assert points(lesson.target / config.reward_scale) in words
    assert lesson.target == pytest.approx(float(lesson.cell.reward))
    assert set(texts.LESSON_OUTCOMES) & set(shown(driver, 3))


def test_the_curve_is_the_costs_own(driver: Driver, lesson: Lesson):
    words = shown(driver, 5)
    frame = driver.top.frame
    assert isinstance(frame, ErrorFrame)
    cost = COSTS[lesson.config.cost]()
    for error in (-2.5, -0.1, 0.0, 0.4, 3.0):
        assert frame.cost_of(error) == cost(np.array([error]), np.zeros(1))
    # What goes back is the slope of the curve, shared by the batch.
    push = frame.push_of(lesson.error) * lesson.weight / len(lesson.batch_errors)
    assert lesson.derivative == pytest.approx(push, rel=1e-5)
    assert any(number(abs(lesson.derivative)) in word for word in words)


def test_the_gradient_and_the_step_of_a_weight_are_the_optimizers(driver: Driver, lesson: Lesson):
    words = shown(driver, 6)
    frame = driver.top.frame
    assert isinstance(frame, GradientFrame)
    assert frame.weight is not None
    index = frame.step.index(frame.weight)
    step = lesson.step
    for value in (step.gradient[index], -step.taken[index]):
        assert any(word.lstrip("+") == number(float(value)) for word in words)
    assert number(float(step.values_after[index])) in words
    assert number(float(np.linalg.norm(step.share))) in words
    if lesson.config.optimizer == "adam":
        assert number(0.1 * float(step.optimizer_after["gradient_sum"][index])) in words
        assert number(0.001 * float(step.optimizer_after["square_sum"][index])) in words


def test_another_weight_is_picked_by_a_click_on_its_link(driver: Driver):
    driver.top.show(6)
    driver.frames(2)
    frame = driver.top.frame
    assert isinstance(frame, GradientFrame)
    before = frame.weight
    edge = next(each for each in reversed(frame.view.edges) if each.column == 0)
    (x0, y0), (x1, y1) = frame.view.centres[0][edge.start], frame.view.centres[1][edge.end]
    driver.click((x0 + 0.4 * (x1 - x0), y0 + 0.4 * (y1 - y0)))
    assert frame.weight is not None
    frame.pick(before)
    assert frame.weight == before


def test_the_share_alone_flows_back_when_it_is_asked_for(driver: Driver, lesson: Lesson):
    driver.top.show(6)
    driver.frames(2)
    frame = driver.top.frame
    assert isinstance(frame, GradientFrame)
    driver.click(in_view(frame.labels[1].box.center))
    assert frame.alone
    driver.click(in_view(frame.labels[0].box.center))
    assert not frame.alone


def test_after_the_step_the_value_and_its_pulls_are_told(driver: Driver, lesson: Lesson):
    words, scale = shown(driver, 7), lesson.config.reward_scale
    frame, action = driver.top.frame, int(lesson.cell.action)
    before, after = (float(each[action]) / scale for each in (lesson.predicted, lesson.predicted_after))
    assert any(points(before) in word and points(after) in word for word in words)
    pulls = frame.pulls
    moved = (after - before) * scale
    assert pulls.own + pulls.others + pulls.earlier + pulls.bend == pytest.approx(moved, abs=1e-9)
    assert pulls.own * lesson.error < 0, "a memory's own gradient pulls its value towards the target"
    assert abs(pulls.bend) < 0.2 * (abs(pulls.own) + abs(pulls.others) + abs(pulls.earlier))
    if lesson.config.optimizer == "sgd":
        assert pulls.earlier == pytest.approx(0.0, abs=1e-6)
    largest = int(np.argmax(np.abs(lesson.step.taken)))
    shown_steps = {word.lstrip("+") for word in words}
    step = frame.step.strongest(lesson.step.taken, 1)[0]
    assert number(-float(lesson.step.taken[frame.step.index(step)])) in shown_steps
    assert abs(lesson.step.taken[largest]) >= abs(lesson.step.taken[frame.step.index(step)])


# Bad days


def test_a_dueling_network_and_one_without_source_are_shown(open_game: Open, monkeypatch: pytest.MonkeyPatch):
    lesson = lesson_from(SMALL["modern"].changed(dueling=True, normalise_inputs=True, optimizer="momentum"), 60)
    monkeypatch.setattr("game.lesson.code.source_of", lambda _: None)
    driver = open_game(LessonScene, lesson)
    for frame in range(FRAMES):
        words = shown(driver, frame)
        assert words
    driver.move((500, 400))
    driver.top.show(6)
    driver.move((600, 350))
    driver.frames(2)


def test_a_window_of_another_size_shows_the_same(driver: Driver):
    driver.resize((1000, 700))
    for frame in range(FRAMES):
        driver.top.show(frame)
        driver.frames(2)
    assert driver.top.current == FRAMES - 1
