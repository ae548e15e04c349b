"""Of both scenes that train: what is seen first, in windows of any shape, and what a failure leaves behind."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pygame
import pytest

from game.core import texts
from game.core.scene import Scene
from game.drawing.canvas import Canvas
from game.scenes.train import scene
from game.scenes.train.digits import digit_training
from game.scenes.train.landers import INSIDE
from game.scenes.train.scene import MORE, TrainScene
from game.training.library import DigitModels, Library
from game.ui.context import Context
from tests.game.tour.checkers import MOST_WORDS
from tests.support.driver import Driver
from tests.support.written import Written

WINDOWS = (((1280, 720), "largest"), ((800, 600), "normal"), ((720, 1280), "normal"))
SCENES = (TrainScene, digit_training)


def written_in(driver: Driver, monkeypatch: pytest.MonkeyPatch) -> tuple[list[str], list[str]]:
    """What is written in a frame, and which texts lie on one another."""
    with monkeypatch.context() as patch:
        notes = Written(patch.setattr)
        for chart in driver.top.charts.charts:
            chart._sheet = None  # painted anew
        driver.frames(1)
        found = notes.page(driver.app.canvas.reading).notes
    return [note.text for note in found], [
        f"{one.text!r} on {other.text!r}"
        for number, one in enumerate(found)
        for other in found[number + 1 :]
        if one.box.inflate(-2, -2).colliderect(other.box.inflate(-2, -2)) and one.box != other.box
    ]


def test_what_was_opened_stays_open(open_game: Callable[..., Driver]) -> None:
    driver = open_game(TrainScene)
    for name, words in ((MORE, texts.MORE), (INSIDE, texts.TRAIN_LOOK)):
        driver.press_on(words[0])
        driver.frames(1)
        assert name in driver.saved()["opened"].split()
    again = open_game(TrainScene)
    again.frames(1)
    assert again.top.view.fills
    again.key(pygame.K_ESCAPE)
    again.frames(1)
    assert again.widget(texts.TRAIN_EXPERIMENTS)


def test_few_words_beside_a_run_and_none_lies_on_another_in_any_window(
    train: Driver, monkeypatch: pytest.MonkeyPatch, subtests: pytest.Subtests
) -> None:
    """Whatever is open, while a run goes on and a question waits; labels of landers are beside what they name."""
    driver, settings = train, train.app.context.settings
    driver.press_on(texts.TRAIN_START)
    driver.wait(lambda: len(driver.top.run.history) >= 6)
    driver.press_on(texts.TRAIN_PAUSE)
    driver.app.context.unfold(MORE)  # it was open
    driver.frames(14)
    words = [word for word in " ".join(written_in(driver, monkeypatch)[0]).split() if any(map(str.isalpha, word))]
    assert len(words) <= MOST_WORDS, words  # at first sight `tests/game/tour` counts them
    driver.top.knobs.turn("n_step", 3)
    for size, text_size in WINDOWS:
        settings.text_size = text_size
        driver.resize(size)
        for opened in ("", MORE, INSIDE):
            with subtests.test(size=size, text_size=text_size, opened=opened):
                settings.opened = ""
                for name in opened.split():
                    driver.app.context.unfold(name)
                driver.frames(14)
                lying = written_in(driver, monkeypatch)[1]
                assert not [pair for pair in lying if repr(texts.SWARM_BEST) not in pair]


def held(folder: Path) -> bool:
    """Whether somebody holds the place of the runs of landers, or of digits, that have no name."""
    collections = Library(folder), DigitModels(folder)
    free = [each.hold() for each in collections]
    for each in collections:
        each.release()
    return not all(free)


@pytest.mark.parametrize("first", SCENES)
def test_one_that_cannot_be_built_lets_go_of_the_place_of_its_runs(
    context: Context, monkeypatch: pytest.MonkeyPatch, first: Callable[[Context], Scene]
) -> None:
    def fail(*_: Any, **__: Any) -> None:
        raise ValueError("no knobs")

    monkeypatch.setattr(scene, "RunSettings", fail)
    with pytest.raises(ValueError, match="no knobs") as kept:  # and with it, the scene
        first(context)
    assert not held(context.user_dir)
    del kept


@pytest.mark.parametrize("first", SCENES)
def test_nothing_shows_through_the_title(open_game: Callable[..., Driver], first: Callable[[Context], Scene]) -> None:
    driver = open_game(first)
    driver.frames(2)
    pictures = []
    for behind in ("black", "white"):
        canvas = Canvas(pygame.Surface((1280, 720)))
        canvas.surface.fill(behind)
        driver.top.status.draw(canvas, driver.top._layout)
        pictures.append(pygame.image.tobytes(canvas.surface.subsurface((40, 26, 300, 34)), "RGB"))
    assert pictures[0] == pictures[1]
