"""The path: its list, the four pages of a chapter, progress, and every way to move through it."""

import re
from collections.abc import Callable

import pygame
import pytest

from game.core import texts
from game.core.settings import Settings
from game.scenes.learn import scene as chapter_scene
from game.scenes.learn.list import LearnScene
from game.scenes.learn.path import PATH, Progress, following
from game.scenes.learn.scene import CODE, PREDICT, TRY, WHY, ChapterScene
from game.ui.context import Context
from game.ui.rows import ButtonRow, ChoiceRow
from tests.support.driver import Driver
from tests.support.screens import save_settings
from tests.support.written import words_written

Open = Callable[..., Driver]
KEYS = list(PATH)


def written(driver: Driver, monkeypatch: pytest.MonkeyPatch) -> str:
    """Return all that is written on the screen."""
    with monkeypatch.context() as patch:
        words = words_written(patch)
        driver.frames(2)
    return " ".join(words)


def test_the_list_leads_into_a_chapter_and_remembers_where_one_was(open_game: Open, context: Context):
    save_settings(context)
    driver = open_game(LearnScene)
    driver.keys(pygame.K_DOWN, pygame.K_RETURN)
    driver.frames(20)
    assert isinstance(driver.top, ChapterScene)
    assert (driver.top.key, driver.top.page) == (KEYS[1], PREDICT)
    driver.key(pygame.K_RETURN)  # the first answer is in focus
    assert driver.top.page == TRY
    assert driver.saved()["learnt"][KEYS[1]]["guess"] == 0
    assert driver.saved()["chapter"] == KEYS[1]
    driver.key(pygame.K_ESCAPE)
    driver.frames(20)
    assert isinstance(driver.top, LearnScene)
    assert driver.top.chosen == KEYS[1]
    driver.key(pygame.K_RETURN)
    driver.frames(20)
    assert driver.top.page == TRY


@pytest.mark.parametrize("key", KEYS)
def test_a_chapter_is_gone_through_in_two_languages_and_leads_on(
    open_game: Open, context: Context, key: str, monkeypatch
):
    save_settings(context)
    driver = open_game(ChapterScene, key)
    scene = driver.top
    begin = {"neuron": "hint", "moment": "go"}
    for page, label in enumerate((texts.LEARN_ANSWERS[key][1], texts.LEARN_ON[TRY], texts.LEARN_ON[WHY], "")):
        assert scene.page == page
        if page == TRY and key in begin:
            getattr(scene.chapter, begin[key])()
            driver.skip(20)
        said = written(driver, monkeypatch)
        assert page > TRY or not scene.panel.overflows
        assert not re.findall(r"(?<![\w.])-\d", said), "a hyphen stands for a minus"
        if page in (PREDICT, CODE):
            question = texts.LEARN[key]["question"]
            with driver.speaking("de"):
                assert question not in written(driver, monkeypatch)
        if label:
            driver.click(driver.widget(label).box.center)
    assert Progress(driver.app.context.settings).answer(key) == texts.LEARN_ANSWERS[key][1]
    assert (texts.LEARN_NEXT_CHAPTER in driver.hints()) == (following(key) is not None)
    driver.key(pygame.K_b)
    driver.button(pygame.CONTROLLER_BUTTON_RIGHTSHOULDER)
    assert scene.page == CODE
    driver.press_on(scene.chapter.words["door"])
    driver.frames(2)
    assert driver.top_name not in ("ChapterScene", "ErrorScene")
    driver = open_game(ChapterScene, key)
    driver.top.turn_to(CODE)
    driver.press_on(texts.LEARN_TO_CHAPTER if following(key) else texts.LEARN_TO_LIST)
    driver.frames(2)
    assert driver.top.key == (following(key) or key)


def test_a_chapter_is_done_once_it_was_tried_and_its_why_read(open_game: Open, context: Context, monkeypatch):
    save_settings(context)
    driver = open_game(ChapterScene, "neuron")
    scene, progress = driver.top, Progress(driver.app.context.settings)
    scene.turn_to(WHY)
    assert not progress.done("neuron")
    assert texts.LEARN_TRY_FIRST in written(driver, monkeypatch)
    scene.turn_to(TRY)
    driver.press_on(texts.LEARN_NEURON_HINT)
    driver.skip(650)
    assert scene.chapter.tried
    progress.note("neuron", guess=0)
    driver.press_on(texts.LEARN_ON[TRY])
    assert progress.done("neuron")
    assert driver.saved()["learnt"]["neuron"]["done"] is True
    assert driver.top.form.focused.label == texts.LEARN_ON[WHY], "on to the code, before the way out"
    said, answers = written(driver, monkeypatch), texts.LEARN_ANSWERS["neuron"]
    for part in (texts.LEARN_YOU_SAID, answers[0], texts.LEARN_CAME[False], answers[2]):
        assert part in said
    progress.note("neuron", guess=2)
    said = written(driver, monkeypatch)
    scene.turn_to(WHY)
    assert texts.LEARN_CAME[True] in written(driver, monkeypatch)
    shown = scene.chapter.why()
    scene.turn_to(TRY)
    driver.key(pygame.K_r)
    assert not scene.chapter.tried
    scene.turn_to(WHY)
    assert shown in written(driver, monkeypatch), "begun anew, it says what the try before has shown"
    driver.key(pygame.K_ESCAPE)
    driver.frames(20)
    driver = open_game(ChapterScene, "neuron")
    assert driver.top.page == PREDICT, "opened again, it asks for a guess again"
    driver.top.turn_to(WHY)
    said = written(driver, monkeypatch)
    assert shown in said, "and says what the last try has shown"
    assert texts.LEARN_TRY_FIRST not in said
    assert texts.LEARN_CAME[True] in said
    monkeypatch.setattr(texts, "LANGUAGE", "de")
    driver.top.reword()
    assert shown not in written(driver, monkeypatch), "but not in another language"


def test_a_button_is_chosen_and_what_has_a_value_is_changed(open_game: Open, context: Context):
    save_settings(context)
    form = open_game(ChapterScene, "neuron").top.form
    for widget in form.widgets:
        form.focus(widget)
        assert form.changes.hint == (texts.HINT_CHOOSE if isinstance(widget, ButtonRow) else texts.HINT_CHANGE)
    assert {ButtonRow, ChoiceRow} <= set(map(type, form.widgets))


def test_a_chapter_is_not_done_before_its_question_is_answered(open_game: Open, context: Context, monkeypatch):
    save_settings(context)
    for key in KEYS:
        driver = open_game(ChapterScene, key)
        scene, progress = driver.top, Progress(driver.app.context.settings)
        with monkeypatch.context() as patch:
            patch.setattr(type(scene.chapter), "why", lambda _: "shown")
            patch.setattr(type(scene.chapter), "verdict", lambda _: None)
            scene.chapter.tried, scene.chapter.complete = True, True
            scene.turn_to(WHY)
            assert progress.done(key) == (key == "own"), "only a list of steps is done when all of them are"
            patch.setattr(type(scene.chapter), "verdict", lambda _: 1)
            scene.turn_to(WHY)
            assert progress.done(key)
            patch.setattr(type(scene.chapter), "verdict", lambda _: None)
            scene.turn_to(WHY)
            assert progress.done(key), "a later try that answers nothing takes nothing back"
        driver.app.close()


def test_a_try_that_ends_while_its_why_is_open_is_waited_for_and_said(open_game: Open, context: Context, monkeypatch):
    save_settings(context)
    for key, begin, end in (("moment", texts.LEARN_MOMENT_GO, 500), ("pay", texts.LEARN_PAY_TRAIN, 0)):
        driver = open_game(ChapterScene, key)
        scene, progress = driver.top, Progress(driver.app.context.settings)
        scene.turn_to(TRY)
        driver.press_on(begin)
        scene.turn_to(WHY)
        assert texts.LEARN_STILL_RUNS in written(driver, monkeypatch), "not that it is to be tried first"
        assert not progress.done(key)
        driver.skip(end)
        if end:
            assert progress.done(key)
            assert scene.chapter.why().split()[0] in written(driver, monkeypatch)
        driver.app.close()
        assert not scene.chapter.running or end, "leaving a chapter ends its run"


def test_a_chapter_of_steps_is_done_when_all_of_them_are(open_game: Open, context: Context):
    save_settings(context, learnt={"own": {"done": True}})
    driver = open_game(ChapterScene, "own")
    progress, chapter = Progress(driver.app.context.settings), driver.top.chapter
    assert not progress.done("own"), "it says 0 of 6"
    chapter.tried = True
    driver.top.turn_to(WHY)
    assert not progress.done("own")
    chapter.complete = True
    driver.top.turn_to(WHY)
    assert progress.done("own")


def test_damaged_progress_counts_as_nothing_done_and_the_path_goes_on(open_game: Open, context: Context):
    damaged = {"neuron": 3, "plane": {"guess": "two", "done": 1}, "downhill": {"guess": -1}}
    save_settings(context, learnt=damaged, chapter="gone")
    driver = open_game(LearnScene)
    progress = Progress(driver.app.context.settings)
    for key in ("neuron", "plane", "downhill"):
        assert (progress.guess(key), progress.done(key)) == (None, False)
        assert progress.answer(key) == ""
    driver.frames(3)
    driver.key(pygame.K_RETURN)
    driver.frames(20)
    assert isinstance(driver.top, ChapterScene)
    driver.key(pygame.K_RETURN)
    assert progress.guess("neuron") == 0
    before = {"neuron": {"guess": 1, "page": 3, "done": True}, "moment": {"page": 2}}  # as it was noted once
    progress = Progress(Settings.from_dict({"learnt": before}))
    assert [progress.state(key) for key in ("neuron", "moment", "own")] == [2, 1, 0]
    assert progress.guess("neuron") == 1
    beyond = Progress(Settings(learnt={"neuron": {"guess": 3}}))
    assert (beyond.guess("neuron"), beyond.answer("neuron")) == (None, ""), "it has three answers"
    for why, came in ((3, 9), (None, -1), ([], "2")):
        kept = Progress(Settings(learnt={"neuron": {"why": why, "language": "en", "came": came}}))
        assert kept.shown("neuron") == ("", None)
    for learnt in ([], 7, "x"):
        assert Settings.from_dict({"learnt": learnt, "text_size": "large"}) == Settings(text_size="large")


def test_what_cannot_be_read_is_said_and_the_chapter_stays_usable(
    open_game: Open, context: Context, monkeypatch, tmp_path
):
    save_settings(context)
    for key, missing in (("backwards", "models_dir"), ("backwards", "assets_dir"), ("choice", "models_dir")):
        with monkeypatch.context() as patch:
            patch.setattr(context, missing, tmp_path)
            driver = open_game(ChapterScene, key)
            for page in (TRY, WHY, CODE, TRY):
                driver.top.turn_to(page)
                assert driver.top.chapter.problem.split()[0] in written(driver, monkeypatch)
                driver.key(pygame.K_r)
    monkeypatch.setattr(chapter_scene, "source_of", lambda _: None)
    driver = open_game(ChapterScene, "neuron")
    driver.top.turn_to(CODE)
    assert texts.LESSON_NO_SOURCE in written(driver, monkeypatch)
