"""A lesson on the screen: its cards by keys, mouse and gamepad, whose numbers are those of the learning step."""

from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pygame
import pytest

from ai.explain.agent_lesson import Lesson
from ai.explain.learning_step import Value
from game.core import texts
from game.explain.figures import number, percent, points
from game.scenes.lesson.again import AgainCard
from game.scenes.lesson.card import case_of
from game.scenes.lesson.cards import learning_step, parts_of
from game.scenes.lesson.moment import in_units, said_action, sensed
from game.scenes.lesson.scene import LessonScene
from game.scenes.lesson.step import Pulls
from game.scenes.lesson.target import TargetCard
from tests.support.driver import Driver
from tests.support.lessons import SMALL, lesson_from, lesson_of, shown

Open = Callable[..., Driver]
NAMES = ("moment", "values", "came", "target", "again")
MOMENT, VALUES, CAME, TARGET, AGAIN = range(len(NAMES))


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


def test_all_cards_by_keys_by_mouse_and_by_gamepad(modern: Driver):
    scene = modern.top
    for place, name in enumerate(NAMES):
        assert scene.current == place
        assert scene.card.name == texts.LESSON_CARDS[name][0]
        assert texts.LESSON_TITLE not in explained(modern), "the strip of cards is not covered"
        modern.key(pygame.K_RIGHT)
    modern.keys(*[pygame.K_LEFT] * 9)
    assert scene.current == MOMENT
    modern.click(scene.cards._boxes[AGAIN].center)
    assert scene.current == AGAIN
    modern.button(pygame.CONTROLLER_BUTTON_LEFTSHOULDER)
    assert scene.current == AGAIN - 1
    modern.resize((640, 480))  # in which cards stand in two lines
    modern.key(pygame.K_F1)
    modern.frames(2)
    assert scene.cards._boxes[-1].top > scene.cards._boxes[0].bottom
    modern.click(scene.cards._boxes[CAME].center)
    assert scene.current == CAME, "while numbers are explained"


def test_the_code_is_folded_until_asked_for_and_lit_where_the_card_is_made(driver: Driver, lesson: Lesson):
    words = shown(driver, TARGET)
    assert not any("def targets" in word for word in words)
    driver.press_on(texts.STEP_CODE[0])
    words = shown(driver, AGAIN)
    assert driver.top.in_code
    line = driver.top.code.line
    assert str(line.number) in words
    text = dict(driver.top.code.source.lines)[line.number].strip()
    assert any(len(word) > 4 and text.startswith(word.strip()) for word in words)
    begins = {CAME: "self._returns", TARGET: "targets", AGAIN: "values"}
    for place, name in begins.items():
        code = driver.top.parts[place].code
        assert name in code.line.values, place
        assert "_start" not in dict(code.source.lines)[code.line.number], "the sum itself, not its empty beginning"
    assert driver.top.parts[AGAIN].code.line.function == "Optimizer.step", "the step, and no copy to the target"
    driver.resize((1300, 720))  # so that what was painted already is painted again
    words = shown(driver, TARGET)
    target = lesson.target / lesson.config.reward_scale
    assert number(target) in words, "beside the line, in points as all else on the screen"
    assert number(lesson.target) not in words
    assert number(lesson.discount) in words


def test_each_card_has_a_line_that_ran_and_stands_in_its_source(lesson: Lesson):
    for part in parts_of(lesson)[VALUES:]:
        line, source = part.code.line, part.code.source
        assert line is not None
        assert source is not None
        assert line.number in dict(source.lines), f"{line.function}, line {line.number}"
        assert line.values
    assert case_of(Value("", (3,), np.array([0.5, 0, 1]))) == "0.5000 0 1.000"


def test_another_language_changes_all_words_at_once(modern: Driver):
    modern.top.show(AGAIN)
    modern.press_on(texts.LESSON_ONCE)
    english, count = modern.top.card.sentence, len(modern.top.card.alone.way)
    with modern.speaking("de"):
        assert [part.card.name for part in modern.top.parts] == [texts.LESSON_CARDS[name][0] for name in NAMES]
        assert modern.top.card.sentence != english
        assert len(modern.top.card.alone.way) == count, "what was tried stays"


# The numbers of each card


def test_the_moment_and_its_values_are_those_of_the_memory(driver: Driver, lesson: Lesson):
    words = shown(driver, MOMENT)
    for feature, value in enumerate(in_units(lesson.cell.state).tolist()):
        assert {texts.INPUTS[feature], sensed(value, feature)} <= set(words)
    words = shown(driver, VALUES)
    values = (lesson.predicted / lesson.config.reward_scale).tolist()
    assert {points(value) for value in values} <= set(words)
    taken, best = int(lesson.cell.action), int(lesson.predicted.argmax())
    assert said_action(taken) in driver.top.card.sentence
    assert (points(values[best]) in driver.top.card.sentence) or best == taken


def test_what_came_shows_each_decisions_pay(driver: Driver, lesson: Lesson):
    words, flown = shown(driver, CAME), lesson.flown
    assert flown is not None
    assert points(float(lesson.cell.reward) / lesson.config.reward_scale) in words
    for state in (lesson.cell.state, lesson.cell.next_state):
        for feature, value in enumerate(in_units(state).tolist()):
            assert {texts.INPUTS[feature], sensed(value, feature)} <= set(words)
    explanations, total = explained(driver), 0.0
    for place, (reward, factor) in enumerate(
        zip(flown.rewards.tolist(), lesson.config.discount ** np.arange(len(flown.rewards)), strict=True)
    ):
        assert {points(reward), f"× {factor:.4f}", points(reward * factor)} <= set(words)
        assert written(points(reward * factor)) == pytest.approx(
            written(points(reward)) * float(f"{factor:.4f}"), abs=0.02
        )
        total += written(points(reward * factor))
        *parts, (_, whole) = figures_of(explanations[texts.LESSON_DECISION.format(number=place + 1)])
        assert whole == pytest.approx(reward, abs=0.006)
        assert sum(paid for _, paid in parts) == pytest.approx(reward, abs=0.04)
        assert {word for word, _ in parts} == {
            texts.REWARD_PARTS[name][0] for name, paid in flown.parts.items() if paid[place]
        }
    assert total == pytest.approx(float(lesson.cell.reward) / lesson.config.reward_scale, abs=0.03)


def written(figure: str) -> float:
    """Return the number that a figure on the screen says."""
    return float(figure.replace("−", "-").replace("k", "e3").lstrip("+× "))


def test_the_target_and_a_weights_step_can_be_recomputed_from_what_is_painted(driver: Driver, lesson: Lesson):
    driver.resize((1280, 1400))
    words, scale = shown(driver, TARGET), lesson.config.reward_scale
    at = words.index(texts.LESSON_PART_PAY)
    target, pay, discount, value = (written(words[at + step]) for step in (-5, -1, 3, 7))
    assert target == pytest.approx(pay + discount * value, abs=0.02)
    assert target == pytest.approx(lesson.target / scale, abs=0.006)
    assert f"{texts.LESSON_ERROR} {points(lesson.error / scale)}" in words
    slope, error, rate, step, before, now = (
        written(words[words.index(texts.LESSON_STEP_PARTS[name][0]) - 1])
        for name in ("slope", "error", "rate", "step", "before", "now")
    )
    assert error == pytest.approx(lesson.error / scale, abs=0.006)
    assert step == pytest.approx(-slope * error * rate, rel=3e-3, abs=1e-9)
    assert now == pytest.approx(before + step, abs=2e-4 * max(abs(before), abs(now), abs(step)))
    card = driver.top.card
    assert isinstance(card, TargetCard)
    assert card.weight is not None
    moved = card.step.taken
    assert before == pytest.approx(float(moved.values_before[card.weight.place]), rel=1e-4)
    assert now == pytest.approx(float(moved.values_after[card.weight.place]), rel=1e-3)
    for said in ("The slower copy only flies", "Layer normalisation"):
        assert (said in " ".join(words)) == (not lesson.config.target_judges), "what stands in for the copy"
    nexts = explained(driver)[texts.LESSON_NEXT_HELP]
    assert all(points(float(value) / scale) in nexts for value in lesson.next_judged)


def test_the_gradient_is_that_of_this_memory_alone(driver: Driver, lesson: Lesson):
    driver.top.show(TARGET)
    card = driver.top.card
    assert isinstance(card, TargetCard)
    share, gradient = (each.astype(float) for each in (lesson.step.share, card.step.taken.gradient))
    along = float(share @ gradient) / float(np.linalg.norm(share) * np.linalg.norm(gradient))
    assert along == pytest.approx(1.0, abs=1e-4), "the same direction as its share of the batch's"
    ways = driver.choice(texts.LESSON_WAYS[1])
    ways.choose(0)
    assert card.view.show == "activations"
    ways.choose(1)
    assert card.view.show == "gradients"


def test_a_target_at_the_end_of_a_flight_says_that_nothing_comes_after(open_game: Open):
    config = SMALL["modern"].changed(n_step=3)
    lesson = next(found for turns in range(40, 200) if (found := lesson_from(config, turns)).cell.terminal)
    driver = open_game(LessonScene, lesson)
    words = shown(driver, TARGET)
    assert texts.LESSON_PART_ENDED in words
    assert points(lesson.target / config.reward_scale) in words
    assert lesson.target == pytest.approx(float(lesson.cell.reward))
    assert set(texts.LESSON_OUTCOMES) & set(shown(driver, CAME))


def test_the_same_moment_again_comes_nearer_to_its_target_until_it_is_there(driver: Driver, lesson: Lesson):
    scale, action = lesson.config.reward_scale, int(lesson.cell.action)
    driver.top.show(AGAIN)
    card = driver.top.card
    assert isinstance(card, AgainCard)
    assert len(card.alone.way) == 2, "the step of the card before is taken"
    assert card.alone.way[0] == pytest.approx(float(lesson.predicted[action]), abs=1e-6)
    driver.skip(1200)
    assert card.alone.arrived
    assert not card.going
    off = [abs(value - lesson.target) for value in card.alone.way]
    assert all(later < earlier for earlier, later in pairwise(off)), "each step brings it nearer"
    assert off[-1] < 0.011 * off[0]
    words, sentence = shown(driver, AGAIN), card.sentence
    assert {points(card.alone.way[-1] / scale), points(lesson.target / scale)} <= set(words)
    assert texts.LESSON_NEARER in sentence
    assert f" {len(card.alone.way) - 1} times" in sentence
    moved = (card.alone.outputs - lesson.predicted) / scale
    assert all(points(float(each)) in words for each in moved)
    assert np.abs(np.delete(moved, action)).max() > 0, "the others move with it: they share the weights"
    driver.press_on(texts.LESSON_ANEW)
    driver.press_on(texts.LESSON_ONCE)
    assert not card.going


def test_more_says_what_moved_the_value_in_the_runs_own_step(driver: Driver, lesson: Lesson):
    driver.top.show(AGAIN)
    driver.press_on(texts.LESSON_MORE[0])
    scale, action = lesson.config.reward_scale, int(lesson.cell.action)
    words = " ".join(shown(driver, AGAIN))
    before, after = (float(each[action]) / scale for each in (lesson.predicted, lesson.predicted_after))
    assert points(before, 4) in words
    assert points(after, 4) in words
    pulls = Pulls.of(learning_step(lesson, lesson.step), lesson.derivative, (after - before) * scale)
    assert sum(pulls) == pytest.approx((after - before) * scale, abs=1e-9)
    assert pulls.own * lesson.error < 0, "a memory's own gradient pulls its value towards the target"
    assert abs(pulls.bend) < 0.2 * sum(map(abs, pulls[:3]))
    if lesson.config.optimizer == "sgd":
        assert pulls.earlier == pytest.approx(0.0, abs=1e-6)


def test_a_units_sum_adds_up_to_its_value_as_it_is_written(driver: Driver, lesson: Lesson):
    card = driver.top.parts[TARGET].card
    assert isinstance(card, TargetCard)
    for column in range(1, len(card.view.columns)):
        for unit in card.view.columns[column].units.tolist():
            figures = figures_of(card.unit(column, unit))
            at = [word for word, _ in figures].index(texts.LESSON_STAGES["sum"])
            assert sum(figure for _, figure in figures[:at]) == pytest.approx(figures[at][1], abs=5e-4)
    last = card.unit(len(card.view.columns) - 1, int(lesson.cell.action)).split("\n")[-1]
    assert last.endswith(points(float(lesson.predicted[int(lesson.cell.action)]) / lesson.config.reward_scale))
    driver.top.show(TARGET)
    assert card.step.unit_name(1, int(card.view.columns[1].units[0])) in explained(driver)


def test_a_dueling_network_and_one_without_source_are_shown(open_game: Open, monkeypatch: pytest.MonkeyPatch):
    lesson = lesson_from(SMALL["modern"].changed(dueling=True, normalise_inputs=True, optimizer="momentum"), 60)
    monkeypatch.setattr("game.scenes.lesson.card.source_of", lambda _: None)
    driver = open_game(LessonScene, lesson)
    driver.top.show_code()
    for place in range(len(NAMES)):
        assert any(texts.LESSON_NO_SOURCE.startswith(word) for word in shown(driver, place) if len(word) > 20)
