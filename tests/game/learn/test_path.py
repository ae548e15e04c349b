"""The path: its list, a chapter's page that grows, progress, and every way to move through it."""

import re
import shutil
from collections.abc import Callable
from pathlib import Path

import pygame
import pytest

from game.core import texts
from game.core.assets import MODELS_DIR
from game.core.scene import push
from game.core.settings import Settings
from game.scenes.learn import scene as chapter_scene
from game.scenes.learn.list import LearnScene
from game.scenes.learn.path import PATH, following, is_done
from game.scenes.learn.scene import ChapterScene
from game.ui.context import Context
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


def done(driver: Driver, key: str) -> bool:
    return is_done(driver.app.context.settings, key)


def test_the_list_opens_on_the_first_chapter_that_is_not_done_and_leads_into_it(open_game: Open, context: Context):
    # What was noted once is read, and what is damaged counts as not done.
    noted = {KEYS[0]: {"guess": 1, "page": 3, "done": True}, KEYS[1]: {"done": True}, KEYS[2]: {"done": 1}, KEYS[3]: 3}
    save_settings(context, learnt=noted)
    driver = open_game(LearnScene)
    assert driver.top.chosen == KEYS[2]
    driver.keys(pygame.K_DOWN, pygame.K_RETURN)
    driver.frames(20)
    assert isinstance(driver.top, ChapterScene)
    assert (driver.top.key, driver.top.begun) == (KEYS[3], False)
    driver.key(pygame.K_RETURN)  # the first answer is in focus
    assert (driver.top.begun, driver.top.guess) == (True, 0)
    driver.key(pygame.K_ESCAPE)
    driver.frames(20)
    assert isinstance(driver.top, LearnScene)
    assert driver.top.chosen == KEYS[3], "the one that was left"
    save_settings(context, learnt={key: {"done": True} for key in KEYS})
    assert open_game(LearnScene).top.chosen == KEYS[0]
    for learnt in ([], 7, "x"):
        assert Settings.from_dict({"learnt": learnt, "text_size": "large"}) == Settings(text_size="large")


def test_enter_keeps_a_choice_and_shows_the_picture_that_it_is_about(open_game: Open, context: Context):
    save_settings(context, text_size="largest")
    driver = open_game(ChapterScene, "daring")
    driver.resize((1024, 768))
    driver.key(pygame.K_RETURN)
    scene = driver.top
    scene.panel.scroll(-scene.panel.height)
    driver.keys(pygame.K_RIGHT, pygame.K_RIGHT, pygame.K_RETURN)
    assert scene.chapter.choice == 2
    assert scene._picture.box.top < scene.panel.box.centery
    assert scene.form.focused.box.top >= scene.panel.box.top


@pytest.mark.parametrize("key", KEYS)
def test_a_chapter_grows_in_two_languages_and_leads_on(open_game: Open, context: Context, key: str, monkeypatch):
    save_settings(context)
    driver = open_game(ChapterScene, key)
    scene, words, answers = driver.top, texts.LEARN[key], texts.LEARN_ANSWERS[key]
    came: int | None = None
    monkeypatch.setattr(type(scene.chapter), "why", lambda _: "shown")
    monkeypatch.setattr(type(scene.chapter), "verdict", lambda _: came)
    assert not scene.panel.overflows
    assert words["task"] not in written(driver, monkeypatch)
    with driver.speaking("de"):
        assert texts.LEARN[key]["question"] in written(driver, monkeypatch)
    driver.press_on(answers[1])
    said = written(driver, monkeypatch)
    assert not re.findall(r"(?<![\w.])-\d", said), "a hyphen stands for a minus"
    for part in (texts.LEARN_YOU_SAID, answers[1], words["task"][:30]):
        assert part in said
    scene.chapter.found()
    said = written(driver, monkeypatch)
    assert texts.LEARN_UNSETTLED in said
    assert "shown" in said
    assert not done(driver, key)
    for came in (0, 1, None):
        scene.chapter.found()
        driver.frames(2)
        assert done(driver, key), "a later try that answers nothing takes nothing back"
        said = written(driver, monkeypatch)
        assert (texts.LEARN_UNSETTLED if came is None else texts.LEARN_CAME[came == 1]) in said
    scene.chapter.tried, scene.chapter.changed = False, True
    driver.frames(2)
    assert not scene.finding, "another try has shown nothing yet"
    scene.chapter.found()
    driver.frames(2)
    driver.press_on(words["door"])
    driver.frames(2)
    assert driver.top_name not in ("ChapterScene", "ErrorScene")
    driver = open_game(ChapterScene, key)
    assert (texts.LEARN_TO_CHAPTER in driver.hints()) == bool(following(key))
    driver.key(pygame.K_n)
    driver.frames(2)
    assert driver.top.key == (following(key) or key)


def test_a_chapter_is_done_once_a_try_has_answered_its_question(open_game: Open, context: Context, monkeypatch):
    save_settings(context)
    driver = open_game(ChapterScene, "neuron")
    scene, answers = driver.top, texts.LEARN_ANSWERS["neuron"]
    driver.press_on(answers[0])
    scene.chapter.model.set(0, -1.0)
    for _ in range(400):
        scene.chapter.update()
    said = written(driver, monkeypatch)
    assert scene.finding in said, "a try that answers nothing is told, too"
    assert texts.LEARN_UNSETTLED in said
    driver.press_on(texts.LEARN_NEURON_HINT)
    while scene.chapter.model.seconds < 10.1:
        scene.chapter.update()
    said = written(driver, monkeypatch)
    assert driver.saved()["learnt"]["neuron"]["done"] is True
    there = texts.LEARN_NEURON_FLIGHT["there"].format(seconds=10)
    for part in (there, texts.LEARN_YOU_SAID, answers[0], texts.LEARN_CAME[False], answers[2], scene.finding):
        assert part in said
    driver.key(pygame.K_ESCAPE)
    assert not open_game(ChapterScene, "neuron").top.begun, "opened again, it asks for a guess again"


def test_the_line_that_did_it_is_shown_in_place_of_the_picture(open_game: Open, context: Context, monkeypatch):
    save_settings(context)
    driver = open_game(ChapterScene, "downhill")
    scene = driver.top
    scene.begin()
    scene.in_code = True
    scene.build()
    assert scene.chapter.code().function.__name__ in written(driver, monkeypatch)
    driver.press_on(texts.LEARN_CODE[True])
    assert not scene.in_code
    monkeypatch.setattr(chapter_scene, "source_of", lambda _: None)
    driver.press_on(texts.LEARN_CODE[False])
    assert texts.LESSON_NO_SOURCE in written(driver, monkeypatch)


def test_a_finding_comes_by_itself_and_leaving_ends_a_run(open_game: Open, context: Context, monkeypatch):
    save_settings(context)
    driver = open_game(ChapterScene, "choice")
    scene = driver.top
    scene.begin()
    for action in (scene.chapter.model.worst, scene.chapter.model.best):
        scene.chapter.begin_with(action)
        while scene.chapter.model.running:
            scene.chapter.update()
        driver.frames(2)
    assert done(driver, "choice")
    assert scene.chapter.why().split()[0] in written(driver, monkeypatch)
    driver = open_game(ChapterScene, "pay")
    scene = driver.top
    scene.begin()
    driver.press_on(texts.LEARN_PAY_TRAIN)
    assert scene.chapter.learning
    driver.app.close()
    assert not scene.chapter.learning


def test_a_slider_that_is_held_is_not_taken_away(open_game: Open, context: Context):
    save_settings(context)
    driver = open_game(ChapterScene, "neuron")
    scene = driver.top
    scene.begin()
    driver.frames(2)
    slider = driver.widget(texts.LEARN_NEURON_INPUTS[0])
    driver.post(pygame.MOUSEBUTTONDOWN, pos=driver.to_window(slider.box.center), button=1)
    assert slider.held
    scene.chapter.found()
    driver.frames(5)
    assert slider in scene.form.widgets
    driver.post(pygame.MOUSEBUTTONUP, pos=driver.to_window(slider.box.center), button=1)
    driver.frames(2)
    assert slider not in scene.form.widgets
    assert scene.finding


def test_controls_hold_still_and_the_way_on_stays_in_sight_while_a_page_grows(open_game: Open, context: Context):
    save_settings(context)
    driver = open_game(ChapterScene, "plane")
    scene = driver.top
    scene.begin(0)
    driver.frames(2)
    before = {widget.key: widget.box for widget in scene.form.widgets}
    driver.frames(400)
    assert scene.finding
    after = {widget.key: widget.box for widget in scene.form.widgets}
    assert before.items() <= after.items()
    driver.resize((900, 500))
    driver.frames(2)
    assert scene.panel.overflows
    assert texts.LEARN_TO_CHAPTER in driver.hints()


@pytest.mark.slow
def test_what_its_six_tries_have_shown_leaves_chapter_6_its_title(open_game: Open):
    driver = open_game(ChapterScene, "choice")
    driver.resize((1280, 720))
    driver.top.begin(1)
    model = driver.top.chapter.model
    for action in range(len(model.values)):
        model.begin_with(action)
        driver.wait(lambda: model.over)
    driver.frames(5)
    assert driver.top.came is not None
    assert driver.top.panel.scrolled == 0


@pytest.mark.parametrize(
    ("key", "network"), [("choice", "lander/modern/online"), ("backwards", "digits/classic/network")]
)
def test_a_chapter_whose_network_is_damaged_is_not_entered_and_says_why(
    open_game: Open, context: Context, tmp_path: Path, key: str, network: str
):
    context.models_dir = tmp_path / "models"
    shutil.copytree(MODELS_DIR, context.models_dir)
    (context.models_dir / network / "layer-0-bias.npy").write_bytes(b"")
    driver = open_game(LearnScene)
    driver.app.scenes.apply(push("chapter", key))
    assert driver.top_name == "LearnScene"
    assert "layer-0-bias.npy" in driver.said
