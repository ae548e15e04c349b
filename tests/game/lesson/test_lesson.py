"""A lesson on the screen: its frames by keys, mouse and gamepad, whose numbers are those of the learning step."""

from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pygame
import pytest

from ai.agent.decision import in_points
from ai.explain.agent_lesson import Lesson
from ai.explain.inspection import Link, links
from ai.explain.learning_step import Value
from game.core import texts
from game.explain.figures import number, percent, points
from game.scenes.lesson.alone import AloneFrame
from game.scenes.lesson.flight import in_units, sensed
from game.scenes.lesson.frame import case_of
from game.scenes.lesson.frames import parts_of
from game.scenes.lesson.network import NetworkFrame
from game.scenes.lesson.scene import LessonScene
from game.scenes.lesson.update import AfterFrame
from tests.support.driver import Driver
from tests.support.lessons import SMALL, lesson_from, lesson_of, shown

Open = Callable[..., Driver]
NAMES = ("alone", "happened", "target", "network", "after")
ALONE, HAPPENED, TARGET, NETWORK, AFTER = range(len(NAMES))


@pytest.fixture(params=sorted(SMALL))
def lesson(request: pytest.FixtureRequest) -> Lesson:
    return lesson_of(request.param)


def opened(open_game: Open, lesson: Lesson) -> Driver:
    driver = open_game(LessonScene, lesson)
    driver.frames(3)
    return driver


@pytest.fixture
def driver(open_game: Open, lesson: Lesson) -> Driver:
    return opened(open_game, lesson)


@pytest.fixture
def modern(open_game: Open) -> Driver:
    return opened(open_game, lesson_of("modern"))


def explained(driver: Driver) -> dict[str, str]:
    """Return what can be asked on the screen, and what is answered."""
    driver.frames(1)
    return {area.what: area.now() for area in driver.app.canvas.explained}


def figures_of(explanation: str) -> list[tuple[str, float]]:
    """Return the words and the figures of an explanation."""
    rows = (line.split("\t") for line in explanation.split("\n") if "\t" in line)
    return [(word, float(figure.replace("−", "-").replace("k", "e3"))) for word, figure in rows]


def test_figures_have_no_minus_before_a_zero_and_percent_has_its_space():
    assert [points(value) for value in (-0.001, 0.0, -0.006, 12.3, float("nan"))] == [
        "+0.00", "+0.00", "−0.01", "+12.30", "–"
    ]  # fmt: skip
    assert [percent(share) for share in (0.0, -0.001, 0.346, 1.0)] == ["0 %", "0 %", "35 %", "100 %"]
    assert [number(value) for value in (0.000012345, -2e-6, 1e-30, 0.25)] == ["0.000012", "−0.0000020", "~0", "0.2500"]
    assert sensed(-0.001, 0) == texts.LESSON_UNITS[0].format(value="0.00")


# The ways through it


def test_all_frames_by_keys_by_mouse_and_by_gamepad(modern: Driver):
    scene = modern.top
    for place, name in enumerate(NAMES):
        assert scene.current == place
        assert scene.frame.name == texts.LESSON_FRAMES[name][0]
        assert not scene.panel.overflows, name
        assert texts.LESSON_TITLE not in explained(modern), "the strip of cards is not covered"
        modern.key(pygame.K_RIGHT)
    modern.keys(*[pygame.K_LEFT] * 9)
    assert scene.current == ALONE
    modern.click(scene.cards._boxes[AFTER].center)
    assert scene.current == AFTER
    modern.button(pygame.CONTROLLER_BUTTON_LEFTSHOULDER)
    assert scene.current == AFTER - 1
    modern.resize((640, 480))  # in which cards stand in two lines
    modern.key(pygame.K_F1)
    modern.frames(2)
    assert scene.cards._boxes[-1].top > scene.cards._boxes[0].bottom
    modern.click(scene.cards._boxes[TARGET].center)
    assert scene.current == TARGET, "while numbers are explained"


def test_the_code_is_folded_until_asked_for_and_lit_where_the_frame_is_made(driver: Driver, lesson: Lesson):
    words = shown(driver, TARGET)
    assert not any("def targets" in word for word in words)
    driver.key(pygame.K_c)
    words = shown(driver, AFTER)
    assert driver.top.in_code
    line = driver.top.code.line
    assert str(line.number) in words
    text = dict(driver.top.code.source.lines)[line.number].strip()
    assert any(len(word) > 4 and text.startswith(word.strip()) for word in words)
    begins = {HAPPENED: "self._returns", TARGET: "targets", AFTER: "values"}
    for place, name in begins.items():
        code = driver.top.parts[place].code
        assert name in code.line.values, place
        assert "_start" not in dict(code.source.lines)[code.line.number], "the sum itself, not its empty beginning"
    driver.resize((1300, 720))  # so that what was painted already is painted again
    words = shown(driver, TARGET)
    target = lesson.target / lesson.config.reward_scale
    assert number(target) in words, "beside the line, in points as all else on the screen"
    assert number(lesson.target) not in words
    assert number(lesson.discount) in words


def test_each_frame_has_a_line_that_ran_and_stands_in_its_source(lesson: Lesson):
    for part in parts_of(lesson)[HAPPENED:]:
        line, source = part.code.line, part.code.source
        assert line is not None
        assert source is not None
        assert line.number in dict(source.lines), f"{line.function}, line {line.number}"
        assert line.values
    assert case_of(Value("", (3,), np.array([0.5, 0, 1]))) == "0.5000 0 1.000"


# This memory alone


def test_it_opens_on_this_memory_alone_which_walks_to_its_target_press_by_press(driver: Driver, lesson: Lesson):
    frame, scale, action = driver.top.frame, lesson.config.reward_scale, int(lesson.cell.action)
    assert isinstance(frame, AloneFrame)
    assert frame.alone.way == [pytest.approx(float(lesson.predicted[action]), abs=1e-6)]
    driver.press_on(texts.LESSON_ALONE_ONCE)
    driver.press_on(texts.LESSON_ALONE_ONCE)
    off = [abs(value - lesson.target) for value in frame.alone.way]
    assert all(later < earlier for earlier, later in pairwise(off)), "each press brings it nearer"
    assert len(off) == 3
    driver.press_on(texts.LESSON_ALONE_GO)
    driver.skip(400)
    assert frame.alone.arrived
    assert not frame.going
    words = shown(driver, ALONE)
    assert points(frame.alone.way[-1] / scale) in words
    assert points(lesson.target / scale) in words
    assert abs(frame.alone.way[-1] - lesson.target) < 0.011 * off[0]
    moved = (frame.alone.outputs - lesson.predicted) / scale
    assert all(points(float(each)) in words for each in moved)
    assert np.abs(np.delete(moved, action)).max() > 0, "the others move with it: they share the weights"
    driver.press_on(texts.LESSON_ALONE_AGAIN)
    assert len(frame.alone.way) == 1


def test_another_language_changes_all_words_at_once(modern: Driver):
    modern.press_on(texts.LESSON_ALONE_ONCE)
    english = modern.top.frame.sentence
    with modern.speaking("de"):
        assert [part.frame.name for part in modern.top.parts] == [texts.LESSON_FRAMES[name][0] for name in NAMES]
        assert modern.top.frame.sentence != english
        assert len(modern.top.frame.alone.way) == 2, "what was tried stays"


# The numbers of each frame


def test_the_numbers_of_each_frame_are_those_of_the_learning_step(
    driver: Driver, lesson: Lesson, subtests: pytest.Subtests
):
    for check in (values_are_those_answered, what_happened_shows_each_decisions_pay,
                  the_target_is_a_sum_that_says_who_judges, pulls_add_up_to_the_step,
                  a_units_sum_adds_up_to_its_value):  # fmt: skip
        with subtests.test(check.__name__):
            check(driver, lesson)


def values_are_those_answered(driver: Driver, lesson: Lesson):
    words = shown(driver, NETWORK)
    for value in in_points(lesson.predicted, lesson.config.reward_scale).tolist():
        assert f"{value:.2f}".replace("-", "−") in words


def what_happened_shows_each_decisions_pay(driver: Driver, lesson: Lesson):
    words, flown = shown(driver, HAPPENED), lesson.flown
    assert flown is not None
    assert points(float(lesson.cell.reward) / lesson.config.reward_scale) in words
    for state in (lesson.cell.state, lesson.cell.next_state):
        for feature, value in enumerate(in_units(state).tolist()):
            assert {texts.INPUTS[feature], sensed(value, feature)} <= set(words)
    explanations = explained(driver)
    for place, (reward, factor) in enumerate(
        zip(flown.rewards.tolist(), lesson.config.discount ** np.arange(len(flown.rewards)), strict=True)
    ):
        assert points(reward) in words
        assert points(reward * factor) in words
        *parts, (_, whole) = figures_of(explanations[texts.LESSON_DECISION.format(number=place + 1)])
        assert whole == pytest.approx(reward, abs=0.006)
        assert sum(paid for _, paid in parts) == pytest.approx(reward, abs=0.04)
        assert {word for word, _ in parts} == {
            texts.REWARD_PARTS[name][0] for name, paid in flown.parts.items() if paid[place]
        }


def the_target_is_a_sum_that_says_who_judges(driver: Driver, lesson: Lesson):
    words, scale, config = shown(driver, TARGET), lesson.config.reward_scale, lesson.config
    for value in (lesson.target, float(lesson.cell.reward), lesson.next_value):
        assert points(value / scale) in words
    assert f"{texts.LESSON_ERROR} {points(lesson.error / scale)}" in words
    assert f"{lesson.discount:.3f}" in words
    assert (texts.LESSON_PICK in words) == (config.target_judges and config.double)
    assert (texts.LESSON_PICK_AND_JUDGE in words) == (config.target_judges and not config.double)
    assert (texts.LESSON_NEWEST_JUDGES in words) == (not config.target_judges)
    for value in in_points(lesson.next_judged, scale).tolist():
        assert points(value) in words
    for said in ("The slower copy only flies", "Layer normalisation"):
        assert (said in " ".join(words)) == (not config.target_judges), "what stands in for the copy"


def test_a_target_at_the_end_of_a_flight_says_that_nothing_comes_after(open_game: Open):
    config = SMALL["modern"].changed(n_step=3)
    lesson = next(found for turns in range(40, 200) if (found := lesson_from(config, turns)).cell.terminal)
    driver = open_game(LessonScene, lesson)
    words = shown(driver, TARGET)
    assert texts.LESSON_PART_ENDED in words
    assert points(lesson.target / config.reward_scale) in words
    assert lesson.target == pytest.approx(float(lesson.cell.reward))
    assert set(texts.LESSON_OUTCOMES) & set(shown(driver, HAPPENED))


def test_a_better_action_is_given_its_reason(lesson: Lesson):
    frame = parts_of(lesson)[NETWORK].frame
    best, action = int(lesson.predicted.argmax()), int(lesson.cell.action)
    higher = points(float(lesson.predicted[best]) / lesson.config.reward_scale)
    assert (f"a higher value, {higher}" in frame.sentence) == (best != action)
    assert isinstance(frame, NetworkFrame)
    assert frame.weight is not None
    index = frame.weight.place
    assert frame.uphill == (lesson.step.gradient[index] * lesson.step.taken[index] < 0)
    assert not frame.uphill or lesson.config.optimizer == "adam", "plain steps never go uphill"


def test_the_gradient_and_the_step_of_the_steepest_weight_are_the_optimizers(driver: Driver, lesson: Lesson):
    driver.resize((1280, 1400))
    step = lesson.step
    driver.top.show(NETWORK)
    frame = driver.top.frame
    assert isinstance(frame, NetworkFrame)
    frame.turn(1)
    words = {word.lstrip("+") for word in shown(driver, NETWORK)}
    weight = frame.weight
    assert weight is not None
    index = weight.place
    sizes = np.abs(np.concatenate([each.weights.ravel() for each in links_of(frame)]))
    assert abs(float(step.gradient[index])) == pytest.approx(float(sizes.max()))
    weights = frame.step.weights[weight.link].weights
    assert weights[weight.start, weight.end] == step.values_before[index]
    assert {number(float(step.gradient[index])), number(-float(step.taken[index]))} <= words
    assert number(float(step.values_after[index])) in words
    if lesson.config.optimizer == "adam":
        assert number(0.1 * float(step.optimizer_after["gradient_sum"][index])) in words
        assert number(0.001 * float(step.optimizer_after["square_sum"][index])) in words
    ways = driver.choice(texts.LESSON_WAYS[2])
    ways.choose(1)
    assert frame._network.gradients == pytest.approx(step.gradient)
    assert frame.view.show == "gradients"
    ways.choose(2)
    assert frame._network.gradients == pytest.approx(step.share)
    ways.choose(0)
    assert frame.view.show == "activations"


def links_of(frame: NetworkFrame) -> list[Link]:
    """Return the slopes of the links between the network's stages."""
    network = frame.step.network.copy()
    network.values = frame.step.taken.gradient
    return links(network)


def pulls_add_up_to_the_step(driver: Driver, lesson: Lesson):
    words, scale = " ".join(shown(driver, AFTER)), lesson.config.reward_scale
    frame, action = driver.top.frame, int(lesson.cell.action)
    assert isinstance(frame, AfterFrame)
    before, after = (float(each[action]) / scale for each in (lesson.predicted, lesson.predicted_after))
    assert points(before) in words
    assert points(after) in words
    pulls = frame.pulls
    assert pulls.own + pulls.others + pulls.earlier + pulls.bend == pytest.approx((after - before) * scale, abs=1e-9)
    assert pulls.own * lesson.error < 0, "a memory's own gradient pulls its value towards the target"
    assert abs(pulls.bend) < 0.2 * (abs(pulls.own) + abs(pulls.others) + abs(pulls.earlier))
    if lesson.config.optimizer == "sgd":
        assert pulls.earlier == pytest.approx(0.0, abs=1e-6)


def a_units_sum_adds_up_to_its_value(driver: Driver, lesson: Lesson):
    frame = driver.top.parts[NETWORK].frame
    assert isinstance(frame, NetworkFrame)
    assert_sums_add_up(frame)
    last = frame.unit(len(frame.view.columns) - 1, int(lesson.cell.action)).split("\n")[-1]
    assert last.endswith(points(float(lesson.predicted[int(lesson.cell.action)]) / lesson.config.reward_scale))
    driver.top.show(NETWORK)
    assert frame.step.unit_name(1, int(frame.view.columns[1].units[0])) in explained(driver)


def assert_sums_add_up(frame: NetworkFrame) -> None:
    for column in range(1, len(frame.view.columns)):
        for unit in frame.view.columns[column].units.tolist():
            figures = figures_of(frame.unit(column, unit))
            at = [word for word, _ in figures].index(texts.LESSON_STAGES["sum"])
            assert sum(figure for _, figure in figures[:at]) == pytest.approx(figures[at][1], rel=0.02, abs=0.005)


def test_a_dueling_network_and_one_without_source_are_shown(open_game: Open, monkeypatch: pytest.MonkeyPatch):
    lesson = lesson_from(SMALL["modern"].changed(dueling=True, normalise_inputs=True, optimizer="momentum"), 60)
    monkeypatch.setattr("game.scenes.lesson.frame.source_of", lambda _: None)
    driver = open_game(LessonScene, lesson)
    driver.top.show_code()
    for place in range(len(NAMES)):
        assert any(texts.LESSON_NO_SOURCE.startswith(word) for word in shown(driver, place) if len(word) > 20)
