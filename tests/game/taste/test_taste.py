"""The screen on which a network is brought up, through real events, with its run in this process but for one test."""

import pygame
import pytest

from ai.training import upbringing
from ai.training.preferences import FIRST, NEITHER, SECOND
from ai.training.upbringing import UPBRINGING
from game.core import texts
from game.scenes.taste import scene as screen
from game.scenes.taste.scene import TasteScene
from game.training.library import Library
from game.ui.entry import EntryRow
from tests.support import inline_worker
from tests.support.driver import Driver
from tests.support.tastes import flight

SMALL = UPBRINGING.changed(hidden=(8,), num_envs=16, learning_starts=64, batch_size=16, gradient_steps=1)


@pytest.fixture(autouse=True)
def soon(monkeypatch):
    """Ask soon, about few flights of a small network."""
    for name, value in {"BEFORE": 16 * 20, "EACH": 16 * 4, "_STARTS": 4, "_COPIES": 3}.items():
        monkeypatch.setattr(upbringing, name, value)
    monkeypatch.setattr(screen, "UPBRINGING", SMALL)


@pytest.fixture
def taste(open_game, monkeypatch) -> Driver:
    """The screen, which has asked."""
    inline_worker.install(monkeypatch.setattr)
    return ask(open_game(TasteScene))


def ask(driver: Driver) -> Driver:
    """Wait until something is asked."""
    driver.wait(lambda: driver.top.pair.question is not None)
    return driver


def test_each_key_gives_its_answer_and_another_question_comes(taste, monkeypatch):
    given: list[int] = []
    answer = TasteScene.answer
    monkeypatch.setattr(TasteScene, "answer", lambda scene, which: (given.append(which), answer(scene, which))[1])
    for count, key in enumerate((pygame.K_LEFT, pygame.K_RIGHT, pygame.K_DOWN), 1):
        question = taste.top.pair.question
        taste.key(key)
        ask(taste)
        assert taste.top.run.asked.answers == count
        assert taste.top.pair.question is not question
    assert given == [FIRST, SECOND, NEITHER]


def test_a_click_on_a_flight_likes_it_better_and_backspace_takes_that_back(taste):
    taste.frames(2)
    taste.click(taste.top.pair.halves[1].box.center)
    taste.wait(lambda: taste.top.run.asked.answers == 1)
    taste.key(pygame.K_BACKSPACE)
    taste.wait(lambda: taste.top.run.asked.answers == 0)
    assert texts.TASTE_BACK not in [each.label for each in taste.form.widgets], "there is nothing to take back"


def test_by_gamepad_alone(taste):
    taste.button(pygame.CONTROLLER_BUTTON_DPAD_LEFT)
    ask(taste)
    assert taste.top.run.asked.answers == 1
    taste.button(pygame.CONTROLLER_BUTTON_BACK)
    taste.frames(2)
    assert taste.top.explained.stepping


def test_with_one_switch_the_hints_answer_too(taste, context):
    context.settings.one_switch = True
    stops = taste.app.scan.stops(taste.top, taste.app.canvas)
    labels = [stop.widget.label for stop in stops]
    assert {texts.TASTE_THIS, texts.TASTE_THAT, texts.TASTE_NEITHER} <= set(labels)
    stops[labels.index(texts.TASTE_THAT)].widget.press()
    taste.wait(lambda: taste.top.run.asked.answers == 1)


def test_flights_go_three_times_as_fast_as_life_and_again_on_a_key(taste):
    pair = taste.top.pair
    pair.ask((flight(decisions=30), flight(8.0, decisions=60)))
    taste.frames(41)  # 30 decisions of 1/15 s, three times as fast
    assert (pair.over(0), pair.over(1)) == (True, False)
    taste.frames(41)
    assert pair.over(1)
    taste.key(pygame.K_r)
    assert not pair.over(0)


def test_what_is_kept_is_a_network_as_any_other(taste, context):
    taste.key(pygame.K_LEFT)
    ask(taste)
    taste.press_on(texts.MORE[0])
    taste.press_on(texts.TASTE_KEEP)
    taste.the(EntryRow).text = "mine"
    taste.key(pygame.K_RETURN)
    taste.wait(lambda: isinstance(taste.top, TasteScene) and Library(context.user_dir).runs())
    [kept] = Library(context.user_dir).runs()
    assert (kept.name, kept.flyable, kept.problem) == ("mine", True, "")


def test_choices_and_network_go_on_at_the_next_visit(taste, open_game):
    for _ in range(2):
        taste.key(pygame.K_LEFT)
        ask(taste)
    decisions = taste.top.run.swarm_state.decisions
    taste.app.close()
    again = ask(open_game(TasteScene))
    assert again.top.run.asked.answers == 2
    assert again.top.run.swarm_state.decisions >= decisions


def test_starting_anew_keeps_what_was_brought_up(taste, context):
    taste.key(pygame.K_LEFT)
    ask(taste)
    taste.press_on(texts.MORE[0])
    taste.press_on(texts.TASTE_ANEW)
    ask(taste)
    assert taste.top.run.asked.answers == 0
    assert [run.name for run in Library(context.user_dir).runs()] == [texts.TASTE_NAME]


def test_in_a_process_of_its_own(open_game):
    driver = open_game(TasteScene)
    driver.wait(lambda: driver.top.now.swarm.swarm_state is not None)
    assert driver.top.pair.question is None
    assert not driver.top.run.problem
