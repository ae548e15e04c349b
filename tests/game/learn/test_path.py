"""The path: its list, the three pages of a chapter, progress, and every way to move through it."""

import re
from collections.abc import Callable

import pygame
import pytest

from game.core import texts
from game.core.settings import Settings
from game.scenes.learn import scene as chapter_scene
from game.scenes.learn.list import LearnScene
from game.scenes.learn.path import PATH, Progress, following
from game.scenes.learn.scene import PREDICT, TRY, WHY, ChapterScene
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
    begin = {"neuron": "hint"}
    for page, label in enumerate((texts.LEARN_ANSWERS[key][1], texts.LEARN_ON[TRY], "")):
        assert scene.page == page
        if page == TRY and key in begin:
            getattr(scene.chapter, begin[key])()
            driver.skip(20)
        said = written(driver, monkeypatch)
        assert page > TRY or not scene.panel.overflows
        assert not re.findall(r"(?<![\w.])-\d", said), "a hyphen stands for a minus"
        if page == PREDICT:
            question = texts.LEARN[key]["question"]
            with driver.speaking("de"):
                assert question not in written(driver, monkeypatch)
        if label:
            driver.click(driver.widget(label).box.center)
    assert Progress(driver.app.context.settings).answer(key) == texts.LEARN_ANSWERS[key][1]
    assert (texts.LEARN_NEXT_CHAPTER in driver.hints()) == (following(key) is not None)
    driver.key(pygame.K_b)
    driver.button(pygame.CONTROLLER_BUTTON_RIGHTSHOULDER)
    assert scene.page == WHY
    driver.press_on(scene.chapter.words["door"])
    driver.frames(2)
    assert driver.top_name not in ("ChapterScene", "ErrorScene")
    driver = open_game(ChapterScene, key)
    driver.top.turn_to(WHY)
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
    assert driver.top.form.focused.label == texts.LEARN_TO_CHAPTER
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


@pytest.mark.parametrize("key", KEYS)
def test_the_line_that_did_it_is_shown_in_place_of_the_picture_where_it_has_numbers(
    open_game: Open, context: Context, key: str, monkeypatch
):
    save_settings(context)
    driver = open_game(ChapterScene, key)
    scene = driver.top
    scene.turn_to(WHY)
    driver.frames(2)
    words = [each.label for each in driver.form.widgets if isinstance(each, ButtonRow)]
    code = scene.chapter.code()
    assert (texts.LEARN_CODE[False] in words) == (code is not None)
    if code is None:
        return
    scene.in_code = True
    scene.reword()
    assert code.function.__name__ in written(driver, monkeypatch)
    driver.press_on(texts.LEARN_CODE[True])
    assert not scene.in_code


def test_the_list_opens_on_the_first_chapter_that_is_not_done(open_game: Open, context: Context):
    done = {"done": True}
    save_settings(context, learnt={KEYS[0]: done, KEYS[1]: done, KEYS[3]: done}, chapter=KEYS[3])
    assert open_game(LearnScene).top.chosen == KEYS[2]
    save_settings(context, learnt={KEYS[0]: done}, chapter=KEYS[4])
    assert open_game(LearnScene).top.chosen == KEYS[4], "it was begun"
    save_settings(context, learnt=dict.fromkeys(KEYS, done), chapter=KEYS[2])
    assert open_game(LearnScene).top.chosen == KEYS[0]


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
            scene.chapter.tried = True
            scene.turn_to(WHY)
            assert not progress.done(key)
            assert texts.LEARN_UNSETTLED not in written(driver, monkeypatch), "nothing was said"
            progress.note(key, guess=0)
            scene.reword()
            assert (texts.LEARN_UNSETTLED in written(driver, monkeypatch)) == (key in texts.LEARN_UNDECIDED)
            patch.setattr(type(scene.chapter), "verdict", lambda _: 1)
            scene.turn_to(WHY)
            assert progress.done(key)
            patch.setattr(type(scene.chapter), "verdict", lambda _: None)
            scene.turn_to(WHY)
            assert progress.done(key), "a later try that answers nothing takes nothing back"
        driver.app.close()


def test_a_try_that_ends_while_its_why_is_open_is_waited_for_and_said(open_game: Open, context: Context, monkeypatch):
    save_settings(context)
    for key, begin, end in (("choice", "", 500), ("pay", texts.LEARN_PAY_TRAIN, 0)):
        driver = open_game(ChapterScene, key)
        scene, progress = driver.top, Progress(driver.app.context.settings)
        scene.turn_to(TRY)
        if begin:
            driver.press_on(begin)
        else:  # the second of two flights, which settle the question
            best, worst = scene.chapter.best, scene.chapter.worst
            scene.chapter.begin_with(worst)
            driver.skip(end)
            scene.chapter.begin_with(best)
        scene.turn_to(WHY)
        assert texts.LEARN_STILL_RUNS in written(driver, monkeypatch), "not that it is to be tried first"
        assert not progress.done(key)
        driver.skip(end)
        if end:
            assert progress.done(key)
            assert scene.chapter.why().split()[0] in written(driver, monkeypatch)
        driver.app.close()
        assert not scene.chapter.running or end, "leaving a chapter ends its run"


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
    before = {"neuron": {"guess": 1, "page": 3, "done": True}, "plane": {"page": 2}}  # as it was noted once
    progress = Progress(Settings.from_dict({"learnt": before}))
    assert [progress.state(key) for key in ("neuron", "plane", "daring")] == [2, 1, 0]
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
            for page in (TRY, WHY, TRY):
                driver.top.turn_to(page)
                assert driver.top.chapter.problem.split()[0] in written(driver, monkeypatch)
                driver.key(pygame.K_r)
    monkeypatch.setattr(chapter_scene, "source_of", lambda _: None)
    driver = open_game(ChapterScene, "neuron")
    driver.top.turn_to(WHY)
    driver.press_on(texts.LEARN_CODE[False])
    assert texts.LESSON_NO_SOURCE in written(driver, monkeypatch)
