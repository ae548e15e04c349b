"""The path: its list, the four pages of a chapter, progress, and every way to move through it."""

from collections.abc import Callable

import pygame
import pytest

from game.core import texts
from game.core.settings import Settings
from game.scenes.learn import scene as chapter_scene
from game.scenes.learn.list import LearnScene
from game.scenes.learn.path import PAGES, PATH, Progress, following
from game.scenes.learn.scene import ChapterScene
from game.scenes.menus.menu import MenuScene
from game.ui.context import Context
from tests.support.driver import Driver
from tests.support.screens import settle
from tests.support.written import words_written

Open = Callable[..., Driver]
KEYS = list(PATH)


def test_learn_is_a_word_of_the_menu_and_leads_to_physics(open_game: Open):
    driver = open_game(MenuScene)
    driver.press_on(texts.MENU["learn"][0])
    driver.frames(40)
    assert driver.top_name == "LearnScene"
    driver.press_on(texts.LEARN_PHYSICS)
    assert driver.top_name == "PhysicsScene"


def test_the_list_leads_into_a_chapter_and_remembers_where_one_was(open_game: Open, context: Context):
    settle(context)
    driver = open_game(LearnScene)
    driver.keys(pygame.K_DOWN, pygame.K_RETURN)
    driver.frames(20)
    scene = driver.top
    assert isinstance(scene, ChapterScene)
    assert scene.key == KEYS[1]
    assert PAGES[scene.page] == "predict"
    driver.key(pygame.K_RETURN)  # the first answer is in focus
    assert PAGES[scene.page] == "try"
    assert driver.saved()["learnt"][KEYS[1]]["guess"] == 0
    assert driver.saved()["chapter"] == KEYS[1]
    driver.key(pygame.K_ESCAPE)
    driver.frames(20)
    assert driver.top_name == "LearnScene"
    assert driver.top.chosen == KEYS[1]
    driver.key(pygame.K_RETURN)
    driver.frames(20)
    assert PAGES[driver.top.page] == "try"


@pytest.mark.parametrize("key", KEYS)
def test_a_chapter_is_gone_through_by_keys_alone(open_game: Open, context: Context, key: str):
    settle(context)
    driver = open_game(ChapterScene, key)
    scene = driver.top
    for page in range(1, len(PAGES)):
        driver.frames(3)
        driver.key(pygame.K_n)
        assert scene.page == page
    driver.frames(3)
    driver.key(pygame.K_b)
    assert PAGES[scene.page] == "why"
    driver.frames(2)
    driver.key(pygame.K_n)
    driver.press_on(texts.LEARN_TO_CHAPTER if following(key) else texts.LEARN_TO_LIST)
    driver.frames(20)
    if after := following(key):
        assert driver.top.key == after


@pytest.mark.parametrize("key", KEYS)
def test_a_chapter_is_gone_through_by_mouse_alone(open_game: Open, context: Context, key: str):
    settle(context)
    driver = open_game(ChapterScene, key)
    scene = driver.top
    for label in (texts.LEARN_ANSWERS[key][1], texts.LEARN_ON[1], texts.LEARN_ON[2]):
        driver.frames(2)
        box = driver.widget(label).box
        driver.click((box.left + 10, box.centery))
    assert PAGES[scene.page] == "code"
    assert Progress(driver.app.context.settings).answer(key) == texts.LEARN_ANSWERS[key][1]
    box = driver.widget(scene.chapter.words["door"]).box
    driver.click((box.left + 10, box.centery))
    driver.frames(30)
    assert not isinstance(driver.top, ChapterScene)
    assert driver.top_name != "ErrorScene"


@pytest.mark.parametrize("key", KEYS)
def test_a_chapter_is_gone_through_by_gamepad_alone(open_game: Open, context: Context, key: str):
    settle(context)
    driver = open_game(ChapterScene, key)
    driver.button(pygame.CONTROLLER_BUTTON_A)
    assert PAGES[driver.top.page] == "try"
    for _ in range(2):
        driver.button(pygame.CONTROLLER_BUTTON_RIGHTSHOULDER)
    assert PAGES[driver.top.page] == "code"
    driver.button(pygame.CONTROLLER_BUTTON_LEFTSHOULDER)
    assert PAGES[driver.top.page] == "why"


def test_a_chapter_is_done_once_it_was_tried_and_its_why_read(open_game: Open, context: Context, monkeypatch):
    settle(context)
    driver = open_game(ChapterScene, "neuron")
    scene, progress = driver.top, Progress(driver.app.context.settings)
    scene.turn_to(2)
    assert not progress.done("neuron")
    words = words_written(monkeypatch)
    driver.frames(2)
    assert any(texts.LEARN_TRY_FIRST.startswith(word) for word in words if word)
    scene.turn_to(1)
    driver.press_on(texts.LEARN_NEURON_HINT)
    driver.skip(650)
    assert scene.chapter.tried
    Progress(driver.app.context.settings).note("neuron", guess=0)
    driver.press_on(texts.LEARN_ON[1])
    assert progress.done("neuron")
    assert driver.saved()["learnt"]["neuron"]["done"] is True
    assert driver.top.form.focused.label == texts.LEARN_ON[2], "on to the code, before the way out"
    words.clear()
    driver.frames(2)
    said = " ".join(words)
    answers = texts.LEARN_ANSWERS["neuron"]
    for told in (texts.LEARN_GUESSED.format(guess=answers[0]), texts.LEARN_DIFFERS.format(answer=answers[2])):
        assert told in said
    driver.key(pygame.K_ESCAPE)
    driver.frames(20)
    again = open_game(ChapterScene, "neuron")
    assert PAGES[again.top.page] == "predict", "opened again, it asks for a guess again"


def test_a_try_that_ends_while_its_why_is_open_is_told_there(open_game: Open, context: Context):
    settle(context)
    driver = open_game(ChapterScene, "plane")
    scene, progress = driver.top, Progress(driver.app.context.settings)
    scene.turn_to(1)
    driver.skip(50)
    scene.turn_to(2)
    assert not progress.done("plane")
    driver.skip(270)
    assert scene.chapter.tried
    assert progress.done("plane")


def test_damaged_progress_counts_as_nothing_done_and_the_path_goes_on(open_game: Open, context: Context):
    damaged = {"neuron": 3, "plane": {"guess": "two", "page": 99, "done": 1}, "downhill": {"guess": -1, "page": True}}
    settle(context, learnt=damaged, chapter="gone")
    driver = open_game(LearnScene)
    progress = Progress(driver.app.context.settings)
    for key in ("neuron", "plane", "downhill"):
        assert (progress.guess(key), progress.page(key), progress.done(key)) == (None, 0, False)
        assert progress.answer(key) == ""
    driver.frames(3)
    driver.key(pygame.K_RETURN)
    driver.frames(20)
    assert isinstance(driver.top, ChapterScene)
    driver.key(pygame.K_RETURN)
    assert progress.guess("neuron") == 0


def test_a_guess_beyond_the_answers_is_no_answer():
    settings = Settings(learnt={"neuron": {"guess": 3}})
    assert Progress(settings).answer("neuron") == ""


@pytest.mark.parametrize("learnt", [[], 7, "x"])
def test_settings_with_another_kind_of_progress_still_load(learnt: object):
    assert Settings.from_dict({"learnt": learnt, "text_size": "large"}) == Settings(text_size="large")


def test_without_source_code_the_page_says_so(open_game: Open, context: Context, monkeypatch: pytest.MonkeyPatch):
    settle(context)
    monkeypatch.setattr(chapter_scene, "source_of", lambda _: None)
    driver = open_game(ChapterScene, "neuron")
    driver.top.turn_to(3)
    words = words_written(monkeypatch)
    driver.frames(2)
    assert texts.LEARN_NO_SOURCE in words


def test_leaving_a_chapter_ends_its_run(open_game: Open, context: Context):
    settle(context)
    driver = open_game(LearnScene)
    driver.app.show(lambda context: ChapterScene(context, "pay"))
    driver.frames(20)
    scene = driver.top
    scene.turn_to(1)
    driver.press_on(texts.LEARN_PAY_TRAIN)
    driver.frames(5)
    assert scene.chapter.running
    driver.app.close()
    assert not scene.chapter.running


def test_the_last_page_of_the_path_names_no_next_chapter(open_game: Open, context: Context):
    settle(context)
    for key in (KEYS[-1], KEYS[0]):
        scene = open_game(ChapterScene, key).top
        scene.turn_to(3)
        told = [getattr(action, "hint", "") for action in scene.actions()]
        assert (texts.LEARN_NEXT_CHAPTER in told) == (key == KEYS[0])


def test_a_page_read_too_early_says_that_the_run_still_learns(open_game: Open, context: Context, monkeypatch):
    settle(context)
    driver = open_game(ChapterScene, "pay")
    driver.top.turn_to(1)
    driver.press_on(texts.LEARN_PAY_TRAIN)
    driver.top.turn_to(2)
    words = words_written(monkeypatch)
    driver.frames(2)
    assert any(texts.LEARN_STILL_LEARNS.startswith(word) for word in words if len(word) > 5)
    driver.top.chapter.close()
    driver.frames(2)
    assert any(texts.LEARN_TRY_FIRST.startswith(word) for word in words if len(word) > 5)
