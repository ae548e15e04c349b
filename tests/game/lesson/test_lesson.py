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
from ai.nn.costs import COSTS
from game.core import texts
from game.explain.figures import number, percent, points
from game.scenes.lesson.alone import AloneFrame
from game.scenes.lesson.flight import in_units, sensed
from game.scenes.lesson.frame import case_of
from game.scenes.lesson.frames import parts_of
from game.scenes.lesson.network import GradientFrame, NetworkFrame
from game.scenes.lesson.scene import LessonScene
from game.scenes.lesson.update import AfterFrame, ErrorFrame
from tests.support.driver import Driver
from tests.support.lessons import SMALL, digit_lesson_of, lesson_from, lesson_of, shown

Open = Callable[..., Driver]
NAMES = ("alone", "moment", "values", "happened", "target", "error", "gradient", "after")
ALONE, MOMENT, VALUES, HAPPENED, TARGET, ERROR, GRADIENT, AFTER = range(len(NAMES))


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
    modern.resize((800, 600))  # in which cards stand in two lines
    modern.key(pygame.K_F1)
    modern.frames(2)
    assert scene.cards._boxes[-1].top > scene.cards._boxes[0].bottom
    modern.click(scene.cards._boxes[TARGET].center)
    assert scene.current == TARGET, "while numbers are explained"


def test_the_code_is_folded_until_asked_for_and_lit_where_the_frame_is_made(driver: Driver, lesson: Lesson):
    words = shown(driver, TARGET)
    assert not any("def targets" in word for word in words)
    driver.key(pygame.K_c)
    words = shown(driver, ERROR)
    assert driver.top.in_code
    line = driver.top.code.line
    assert str(line.number) in words
    text = dict(driver.top.code.source.lines)[line.number].strip()
    assert any(len(word) > 4 and text.startswith(word.strip()) for word in words)
    begins = {MOMENT: "rows", HAPPENED: "self._returns", TARGET: "targets", ERROR: "errors", AFTER: "values"}
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
    before = driver.top.code.index
    driver.widget(texts.LESSON_LINE).set(before - 1)
    assert driver.top.code.index == before - 1


def test_every_line_stands_in_the_source_and_its_numbers_are_listed(lesson: Lesson):
    lines = [(part.code, line) for part in parts_of(lesson) for line in part.code.lines]
    assert len(lines) > 100
    for code, line in lines:
        code.index = code.lines.index(line)
        assert line.number in dict(code.source.lines), f"{line.function}, line {line.number}"
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
    for check in (moment_and_values_are_those_given_and_answered, what_happened_shows_each_decisions_pay,
                  the_target_is_a_sum_that_says_who_judges, the_curve_is_the_costs_own, pulls_add_up_to_the_step,
                  a_units_sum_adds_up_to_its_value):  # fmt: skip
        with subtests.test(check.__name__):
            check(driver, lesson)


def moment_and_values_are_those_given_and_answered(driver: Driver, lesson: Lesson):
    words = shown(driver, MOMENT)
    for feature, value in enumerate(in_units(lesson.cell.state).tolist()):
        assert {texts.INPUTS[feature], sensed(value, feature), number(float(lesson.state[feature]))} <= set(words)
    words = shown(driver, VALUES)
    for value in in_points(lesson.predicted, lesson.config.reward_scale).tolist():
        assert f"{value:.2f}".replace("-", "−") in words


def what_happened_shows_each_decisions_pay(driver: Driver, lesson: Lesson):
    words, flown = shown(driver, HAPPENED), lesson.flown
    assert flown is not None
    assert points(float(lesson.cell.reward) / lesson.config.reward_scale) in words
    for feature, value in enumerate(in_units(lesson.cell.next_state).tolist()):
        assert sensed(value, feature) in words
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


def the_curve_is_the_costs_own(driver: Driver, lesson: Lesson):
    words, frame, cost = shown(driver, ERROR), driver.top.frame, COSTS[lesson.config.cost]()
    assert isinstance(frame, ErrorFrame)
    for error in (-2.5, -0.1, 0.0, 0.4, 3.0):
        assert frame.cost_of(error) == cost(np.array([error]), np.zeros(1))
    push = frame.push_of(lesson.error) * lesson.weight / len(lesson.batch_errors)
    assert lesson.derivative == pytest.approx(push, rel=1e-5)
    assert number(lesson.derivative).lstrip("−") in {word.lstrip("+−") for word in words}


def test_a_better_action_and_steps_uphill_are_given_their_reason(lesson: Lesson):
    frames = [part.frame for part in parts_of(lesson)]
    best, action = int(lesson.predicted.argmax()), int(lesson.cell.action)
    higher = points(float(lesson.predicted[best]) / lesson.config.reward_scale)
    assert (f"a higher value, {higher}" in frames[VALUES].sentence) == (best != action)
    gradient, adam = frames[GRADIENT], lesson.config.optimizer == "adam"
    assert isinstance(gradient, GradientFrame)
    assert (texts.LESSON_DOWNHILL[1] in gradient.sentence) == adam
    uphill = 0
    for gradient.rank in range(24):
        index = gradient.weight.place
        assert gradient.uphill == (lesson.step.gradient[index] * lesson.step.taken[index] < 0)
        uphill += gradient.uphill
    assert bool(uphill) == adam, "plain steps never go uphill, and some of Adam's do"


def test_the_gradient_and_the_step_of_any_weight_are_the_optimizers(driver: Driver, lesson: Lesson):
    driver.resize((1280, 1400))
    step = lesson.step
    for rank in (1, 5):
        driver.top.show(GRADIENT)
        driver.widget(texts.LESSON_PICK_WEIGHT).set(rank)
        words, frame = {word.lstrip("+") for word in shown(driver, GRADIENT)}, driver.top.frame
        assert isinstance(frame, GradientFrame)
        weight, index = frame.weight, frame.weight.place
        sizes = np.sort(np.abs(np.concatenate([each.weights.ravel() for each in links_of(frame)])))
        assert abs(float(step.gradient[index])) == pytest.approx(float(sizes[-rank]))
        weights = frame.step.weights[weight.link].weights
        assert weights[weight.start, weight.end] == step.values_before[index]
        assert {number(float(step.gradient[index])), number(-float(step.taken[index]))} <= words
        assert number(float(step.values_after[index])) in words
        if lesson.config.optimizer == "adam":
            assert number(0.1 * float(step.optimizer_after["gradient_sum"][index])) in words
            assert number(0.001 * float(step.optimizer_after["square_sum"][index])) in words
    whose = driver.choice(texts.LESSON_WHOSE[1])
    whose.choose(1)
    assert frame.alone
    assert frame._network.gradients == pytest.approx(step.share)


def links_of(frame: GradientFrame) -> list[Link]:
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
    assert pulls is not None
    assert pulls.own + pulls.others + pulls.earlier + pulls.bend == pytest.approx((after - before) * scale, abs=1e-9)
    assert pulls.own * lesson.error < 0, "a memory's own gradient pulls its value towards the target"
    assert abs(pulls.bend) < 0.2 * (abs(pulls.own) + abs(pulls.others) + abs(pulls.earlier))
    if lesson.config.optimizer == "sgd":
        assert pulls.earlier == pytest.approx(0.0, abs=1e-6)


def a_units_sum_adds_up_to_its_value(driver: Driver, lesson: Lesson):
    frame = driver.top.parts[VALUES].frame
    assert isinstance(frame, NetworkFrame)
    assert_sums_add_up(frame)
    last = frame.unit(len(frame.view.columns) - 1, int(lesson.cell.action)).split("\n")[-1]
    assert last.endswith(points(float(lesson.predicted[int(lesson.cell.action)]) / lesson.config.reward_scale))
    driver.top.show(VALUES)
    assert frame.step.unit_name(1, int(frame.view.columns[1].units[0])) in explained(driver)


def assert_sums_add_up(frame: NetworkFrame) -> None:
    for column in range(1, len(frame.view.columns)):
        for unit in frame.view.columns[column].units.tolist():
            figures = figures_of(frame.unit(column, unit))
            at = [word for word, _ in figures].index(texts.LESSON_STAGES["sum"])
            assert sum(figure for _, figure in figures[:at]) == pytest.approx(figures[at][1], rel=0.02, abs=0.005)


# An image of the digit network


@pytest.mark.parametrize("preset", ["classic", "modern"])
def test_an_image_is_shown_in_seven_frames_as_well(open_game: Open, preset: str):
    lesson = digit_lesson_of(preset)
    driver = open_game(LessonScene, lesson)
    driver.frames(2)
    digit = int(lesson.labels[lesson.step.row])
    words = [shown(driver, place) for place in range(len(driver.top.parts))]
    assert len(words) == 7
    assert texts.LESSON_LABEL.format(digit=digit) in words[0]
    for column, values in ((2, lesson.outputs), (2, lesson.probabilities_before), (3, lesson.target)):
        assert {number(value) for value in values.tolist()} <= set(words[column])
    assert {number(value) for value in lesson.derivative.tolist()} <= {word.lstrip("+") for word in words[4]}
    assert number(lesson.step.gradient_length) in " ".join(words[5])
    for each in (lesson.probabilities_before, lesson.probabilities_after):
        assert number(float(each[digit])) in " ".join(words[6])
    frame = driver.top.parts[1].frame
    assert isinstance(frame, NetworkFrame)
    assert_sums_add_up(frame)


def test_a_dueling_network_and_one_without_source_are_shown(open_game: Open, monkeypatch: pytest.MonkeyPatch):
    lesson = lesson_from(SMALL["modern"].changed(dueling=True, normalise_inputs=True, optimizer="momentum"), 60)
    monkeypatch.setattr("game.scenes.lesson.frame.source_of", lambda _: None)
    driver = open_game(LessonScene, lesson)
    driver.top.show_code()
    for place in range(len(NAMES)):
        assert any(texts.LESSON_NO_SOURCE.startswith(word) for word in shown(driver, place) if len(word) > 20)
