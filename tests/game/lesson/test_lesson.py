"""A lesson on the screen: its cards by keys, mouse and gamepad, whose numbers are those of the learning step."""

from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pygame
import pytest

from ai.explain.agent_lesson import Lesson
from ai.explain.inspection import links
from ai.explain.learning_step import Value
from game.core import texts
from game.explain.figures import number, percent, points
from game.scenes.lesson.again import AgainCard
from game.scenes.lesson.card import case_of
from game.scenes.lesson.cards import parts_of
from game.scenes.lesson.moment import in_units, said_action, sensed
from game.scenes.lesson.scene import LessonScene
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


def written(figure: str) -> float:
    """Return the number that a figure on the screen says."""
    return float(figure.replace("−", "-").replace("k", "e3").lstrip("+× "))


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
        assert scene.parts[place].card.name == texts.LESSON_CARDS[name][0]
        modern.key(pygame.K_RIGHT)
    modern.keys(*[pygame.K_LEFT] * 9)
    assert scene.current == MOMENT
    modern.click(scene.cards._places[AGAIN].center)
    assert scene.current == AGAIN
    modern.button(pygame.CONTROLLER_BUTTON_LEFTSHOULDER)
    assert scene.current == AGAIN - 1


def test_the_code_is_folded_until_asked_for_and_lit_where_the_card_is_made(driver: Driver, lesson: Lesson):
    words = shown(driver, TARGET)
    assert not any("def targets" in word for word in words)
    driver.press_on(texts.STEP_CODE[0])
    words = shown(driver, TARGET)
    code = driver.top.parts[TARGET].code
    assert str(code.line.number) in words
    text = dict(code.source.lines)[code.line.number].strip()
    assert any(len(word) > 4 and text.startswith(word.strip()) for word in words)
    assert {number(lesson.target), number(lesson.discount)} <= set(words), "beside the lines, as the agent computes"
    assert texts.LESSON_SCALE.format(scale=f"{lesson.config.reward_scale:g}") in words


def test_each_card_has_a_line_that_ran_and_stands_in_its_source(lesson: Lesson):
    parts = parts_of(lesson)
    for part in parts[VALUES:]:
        line, source = part.code.line, part.code.source
        assert line is not None
        assert source is not None
        assert line.number in dict(source.lines), f"{line.function}, line {line.number}"
        assert line.values
    begins = {CAME: "self._returns", TARGET: "targets", AGAIN: "values"}
    for place, name in begins.items():
        line, source = parts[place].code.line, parts[place].code.source
        assert line is not None
        assert source is not None
        assert name in line.values, place
        assert "_start" not in dict(source.lines)[line.number], "the sum itself, not its empty beginning"
    assert case_of(Value("", (3,), np.array([0.5, 0, 1]))) == "0.5000 0 1.000"


def test_another_language_changes_all_words_at_once(modern: Driver):
    modern.top.show(AGAIN)
    english = modern.top.parts[AGAIN].card.sentence
    with modern.speaking("de"):
        assert [part.card.name for part in modern.top.parts] == [texts.LESSON_CARDS[name][0] for name in NAMES]
        assert modern.top.parts[AGAIN].card.sentence != english


# The numbers of each card


def test_the_moment_and_its_values_are_those_of_the_memory(driver: Driver, lesson: Lesson):
    words = shown(driver, MOMENT)
    for feature, value in enumerate(in_units(lesson.cell.state).tolist()):
        assert {texts.INPUTS[feature], sensed(value, feature)} <= set(words)
    words = shown(driver, VALUES)
    assert {points(value) for value in (lesson.predicted / lesson.config.reward_scale).tolist()} <= set(words)
    for action in (int(lesson.cell.action), int(lesson.predicted.argmax())):
        assert said_action(action) in driver.top.parts[VALUES].card.sentence


def test_what_came_shows_each_decisions_pay(driver: Driver, lesson: Lesson):
    words, flown = shown(driver, CAME), lesson.flown
    assert flown is not None
    assert points(float(lesson.cell.reward) / lesson.config.reward_scale) in words
    for state in (lesson.cell.state, lesson.cell.next_state):
        for feature, value in enumerate(in_units(state).tolist()):
            assert {texts.INPUTS[feature], sensed(value, feature)} <= set(words)
    explanations, total = explained(driver), 0.0
    for place, reward in enumerate(flown.rewards.tolist()):
        factor = lesson.config.discount**place
        assert {points(reward), f"× {factor:.4f}", points(reward * factor)} <= set(words)
        total += written(points(reward * factor))
        rows = (row.split("\t") for row in explanations[texts.LESSON_DECISION.format(number=place + 1)].split("\n"))
        parts = {word: written(figure) for word, figure in rows}
        assert sum(parts.values()) == pytest.approx(reward, abs=0.04)
        assert set(parts) == {texts.REWARD_PARTS[name][0] for name, paid in flown.parts.items() if paid[place]}
    assert total == pytest.approx(float(lesson.cell.reward) / lesson.config.reward_scale, abs=0.03)


def test_the_target_and_a_weights_step_can_be_recomputed_from_what_is_painted(driver: Driver, lesson: Lesson):
    driver.resize((1280, 1400))
    words, scale = shown(driver, TARGET), lesson.config.reward_scale
    at = words.index(texts.LESSON_PART_PAY)
    target, pay, discount, value = (written(words[at + step]) for step in (-5, -1, 3, 7))
    assert target == pytest.approx(pay + discount * value, abs=0.02)
    assert target == pytest.approx(lesson.target / scale, abs=0.006)
    slope, error, rate, step, before, now = (written(words[words.index(name) - 1]) for name in texts.LESSON_STEP_PARTS)
    assert error == pytest.approx(lesson.error / scale, abs=0.006)
    assert step == pytest.approx(-slope * error * rate, rel=3e-3, abs=1e-9)
    assert now == pytest.approx(before + step, abs=2e-4 * max(abs(before), abs(now), abs(step)))
    card = driver.top.parts[TARGET].card
    assert isinstance(card, TargetCard)
    assert card.weight is not None
    twin = card._network.copy()
    twin.values = card.taken.values_after
    weights = (links(network)[card.weight[0]].weights[card.weight[1:]] for network in (card._network, twin))
    assert (before, now) == pytest.approx(tuple(map(float, weights)), rel=1e-3)
    modern = not lesson.config.target_judges
    assert ("copy only flies" in " ".join(words)) == modern, "what the copy does"


def test_the_network_is_shown_forward_and_back(driver: Driver):
    driver.top.show(TARGET)
    card = driver.top.parts[TARGET].card
    for index, show in enumerate(("activations", "gradients")):
        driver.choice(texts.LESSON_WAYS[1]).choose(index)
        assert card.view.show == show


def test_a_target_at_the_end_of_a_flight_says_that_nothing_comes_after(open_game: Open):
    config = SMALL["modern"].changed(n_step=3)
    lesson = next(found for turns in range(40, 200) if (found := lesson_from(config, turns)).cell.terminal)
    driver = open_game(LessonScene, lesson)
    words = shown(driver, TARGET)
    assert texts.LESSON_PART_ENDED in words
    assert texts.LESSON_ROLES["ended"] in words
    assert points(lesson.target / config.reward_scale) in words
    assert lesson.target == pytest.approx(float(lesson.cell.reward))
    assert set(texts.LESSON_OUTCOMES) & set(shown(driver, CAME))


def test_the_same_moment_again_comes_nearer_to_its_target_until_it_is_there(driver: Driver, lesson: Lesson):
    scale, action = lesson.config.reward_scale, int(lesson.cell.action)
    driver.top.show(AGAIN)
    card = driver.top.parts[AGAIN].card
    assert isinstance(card, AgainCard)
    assert len(card.alone.way) == 2, "the step of the card before is taken"
    assert card.alone.way[0] == pytest.approx(float(lesson.predicted[action]), abs=1e-6)
    while card.going:
        card.update(still=False)
    assert card.alone.arrived
    off = [abs(value - lesson.target) for value in card.alone.way]
    assert all(later < earlier for earlier, later in pairwise(off)), "each step brings it nearer"
    assert off[-1] < 0.011 * off[0]
    for part in (points(card.alone.way[-1] / scale), points(lesson.target / scale), f" {len(off) - 1} times"):
        assert part in card.sentence
    words, moved = shown(driver, AGAIN), (card.alone.outputs - lesson.predicted) / scale
    assert all(points(float(each)) in words for each in moved)
    assert np.abs(np.delete(moved, action)).max() > 0, "the others move with it: they share the weights"
    driver.press_on(texts.LESSON_ANEW)
    driver.press_on(texts.LESSON_ONCE)
    assert not card.going


def test_a_dueling_network_and_one_without_source_are_shown(open_game: Open, monkeypatch: pytest.MonkeyPatch):
    lesson = lesson_from(SMALL["modern"].changed(dueling=True, normalise_inputs=True, optimizer="momentum"), 60)
    monkeypatch.setattr("game.scenes.lesson.card.source_of", lambda _: None)
    driver = open_game(LessonScene, lesson)
    driver.top.show_code()
    for place in range(len(NAMES)):
        assert any(texts.LESSON_NO_SOURCE.startswith(word) for word in shown(driver, place) if len(word) > 20)
