import json
import os
import sys
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

import platformdirs
import pygame
import pytest

from ai.agent.agent import DeepQAgent
from ai.training.config import Config
from game.core import texts
from game.core.scene import Pop, Push
from game.scenes.menus.menu import MenuScene
from game.scenes.networks.scene import NetworksScene
from game.training.library import Library
from game.ui.context import Context
from game.ui.entry import EntryRow
from game.ui.listing import ListRow
from tests.support.driver import Driver

Open = Callable[..., Driver]
DESCRIBED = {
    "env": "lander",
    "preset": "modern",
    "changes": {"care": 0.8},
    "seed": 3,
    "decisions": 5000,
    "seconds": 61.5,
    "best": {"success": 0.75},
}
UP, DOWN, RIGHT, ENTER, ESCAPE = pygame.K_UP, pygame.K_DOWN, pygame.K_RIGHT, pygame.K_RETURN, pygame.K_ESCAPE


@pytest.fixture
def library(context: Context, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Library:
    context.models_dir = tmp_path / "shipped"
    monkeypatch.setattr(platformdirs, "user_documents_dir", lambda: str(tmp_path / "Documents"))
    write(context.models_dir / "lander" / "modern")
    return Library(context.user_dir)


def write(folder: Path, **described: object) -> Path:
    """A small network that flies, and what is said of it."""
    DeepQAgent(config=Config(hidden=(4,))).save(folder)
    (folder / "training.json").write_text(json.dumps({**DESCRIBED, **described}))
    return folder


@pytest.fixture
def three(library: Library) -> Library:
    """Runs called a, b and c, the first the latest."""
    for age, name in enumerate("abc"):
        folder = write(library.folder / name)
        (folder / "last").mkdir()
        os.utime(folder / "training.json", (2e9 - age, 2e9 - age))
    return library


@pytest.fixture
def open_runs(open_game: Open, library: Library) -> Callable[..., Driver]:
    def begin(**arguments: object) -> Driver:
        driver = open_game(MenuScene)
        driver.app.scenes.apply(Push(NetworksScene(driver.app.context, **arguments)))
        driver.frames(2)
        return driver

    return begin


def scene(driver: Driver) -> NetworksScene:
    assert isinstance(driver.top, NetworksScene)
    return driver.top


def shown(driver: Driver) -> str:
    run = scene(driver).chosen
    assert run is not None
    return run.name


def verbs(driver: Driver) -> list[str]:
    return [label for label, _ in scene(driver).verbs]


def naming(driver: Driver) -> bool:
    return any(isinstance(widget, EntryRow) for widget in driver.form.widgets)


def click(driver: Driver, label: str) -> None:
    word = driver.widget(label)
    driver.click((word.box.left + 8, word.box.centery))


def click_row(driver: Driver, number: int) -> None:
    box = driver.the(ListRow).box
    driver.click((box.left + 20, box.top + ListRow.pad + 30 * number + 15))


def type_text(driver: Driver, text: str) -> None:
    driver.frames(2)
    driver.post(pygame.TEXTINPUT, text=text)


def test_the_latest_runs_come_first_and_the_games_own_last(open_runs, three: Library):
    driver = open_runs()
    assert [run.name for run in scene(driver).items] == ["a", "b", "c", "modern"]
    assert driver.the(ListRow).rows[0][:3] == ("a", "75.0 %", "2033-05-18")
    assert "Go on training" in verbs(driver)
    driver.keys(DOWN, DOWN, DOWN)
    assert shown(driver) == "modern"
    assert verbs(driver) == [texts.RUN_WATCH, texts.RUN_FLY]


def test_without_any_network_the_screen_still_stands(open_runs, context: Context, tmp_path: Path):
    context.models_dir = tmp_path / "nothing"
    driver = open_runs()
    driver.keys(ENTER, RIGHT)
    assert driver.top_name == "NetworksScene"
    driver.keys(DOWN, RIGHT, ENTER)  # Back
    assert driver.top_name == "MenuScene"


def test_the_keyboard_renames_what_flies_on(open_runs, three: Library, context: Context):
    driver = open_runs()
    context.settings.model = "b"
    driver.keys(DOWN, ENTER, DOWN, DOWN, DOWN)
    assert scene(driver).form.focused.label == texts.RUN_RENAME
    driver.key(ENTER)
    type_text(driver, "moon / walker?")
    driver.key(ENTER)
    assert sorted(run.name for run in three.runs()) == ["a", "c", "moon  walker"]
    assert shown(driver) == context.settings.model == "moon  walker"


def test_a_name_that_is_taken_is_explained_and_can_be_changed_or_left(open_runs, three: Library):
    driver = open_runs()
    click(driver, texts.RUN_RENAME)
    type_text(driver, "B")
    driver.key(ENTER)
    assert "already" in driver.said
    assert driver.form.typing
    click(driver, texts.NAMING_LEAVE)
    assert not naming(driver)
    click(driver, texts.RUN_RENAME)
    driver.keys(pygame.K_DELETE, pygame.K_n, pygame.K_SPACE)  # Delete clears the line, and letters are no commands
    type_text(driver, "B2")
    click(driver, texts.NAMING_KEEP)
    assert sorted(run.name for run in three.runs()) == ["B2", "b", "c"]


def test_what_is_deleted_is_asked_for_once_and_gone_for_good(open_runs, three: Library):
    driver = open_runs()
    click_row(driver, 1)
    click(driver, texts.RUN_DELETE)
    assert driver.top_name == "QuestionDialog"
    click(driver, texts.RUN_KEEP)
    assert shown(driver) == "b"
    click(driver, texts.RUN_DELETE)
    click(driver, texts.RUN_DELETE)
    assert shown(driver) == "c"  # what took its place
    assert not (three.folder / "b").exists()
    assert sorted(run.name for run in three.runs()) == ["a", "c"]


def test_the_games_own_networks_are_not_to_be_changed(open_runs, context: Context, three: Library):
    """Deleting all there is leaves a screen that works."""
    driver = open_runs()
    for _ in range(3):
        click(driver, texts.RUN_DELETE)
        click(driver, texts.RUN_DELETE)
    assert three.runs() == []
    assert (context.models_dir / "lander" / "modern").is_dir()
    assert shown(driver) == "modern"
    assert verbs(driver) == [texts.RUN_WATCH, texts.RUN_FLY]


def test_what_cannot_be_done_is_said_and_the_screen_stays(open_runs, three: Library, monkeypatch: pytest.MonkeyPatch):
    driver = open_runs()
    for run in three.runs():
        three.delete(run.name)  # somebody else was faster
    click(driver, texts.RUN_DELETE)
    click(driver, texts.RUN_DELETE)
    assert "not there" in driver.said
    assert shown(driver) == "modern"


def test_a_damaged_run_is_shown_with_its_problem(open_runs, three: Library):
    (three.folder / "a" / "config.json").unlink()
    driver = open_runs()
    assert scene(driver).chosen.problem == "config.json is missing"
    assert verbs(driver) == [texts.RUN_RENAME, texts.RUN_DELETE]
    chosen: list[str] = []
    driver = open_runs(choose=chosen.append)
    driver.keys(pygame.K_HOME, ENTER)
    assert not chosen, "it cannot fly"
    assert driver.top_name == "NetworksScene"


def test_watch_and_fly_with_the_chosen_one_and_come_back_to_it(open_runs, three: Library, context: Context):
    driver = open_runs()
    for verb, name in ((texts.RUN_WATCH, "WatchScene"), (texts.RUN_FLY, "PlayScene")):
        click_row(driver, 1)
        click(driver, verb)
        assert driver.top_name == name
        assert getattr(driver.top, "flyer", driver.top).network.name == "b"
        assert context.settings.model == "b"
        driver.keys(ESCAPE, UP, ENTER)  # pause, leave
        assert shown(driver) == "b"


def test_go_on_training_opens_a_training_of_that_folder_or_what_the_opener_wants(
    open_runs, three: Library, monkeypatch: pytest.MonkeyPatch
):
    asked: list[Path] = []
    stand_in = SimpleNamespace(TrainScene=lambda context, resume: (asked.append(resume), MenuScene(context))[1])
    monkeypatch.setitem(sys.modules, "game.scenes.train.scene", stand_in)
    driver = open_runs()
    click(driver, texts.RUN_TRAIN)
    driver = open_runs(train=lambda folder: (asked.append(folder), Pop())[1])
    click(driver, texts.RUN_TRAIN)
    assert asked == [three.folder / "a"] * 2
    assert driver.top_name == "MenuScene"


@pytest.mark.parametrize("way", ["enter", "word", "second click"])
def test_choosing_hands_the_name_back_and_closes(open_runs, three: Library, way: str):
    chosen: list[str] = []
    driver = open_runs(choose=chosen.append)
    assert shown(driver) == "modern"  # the one that flies now
    driver.key(pygame.K_HOME)
    if way == "enter":
        driver.keys(DOWN, ENTER)
    else:
        click_row(driver, 1)
        click(driver, texts.RUN_CHOOSE) if way == "word" else click_row(driver, 1)
    assert chosen == ["b"]
    assert driver.top_name == "MenuScene"


def test_a_folder_that_is_dropped_is_copied_in(open_runs, three: Library, tmp_path: Path):
    write(tmp_path / "from a friend")
    driver = open_runs()
    driver.post(pygame.DROPFILE, file=str(tmp_path / "from a friend" / "config.json"))
    assert shown(driver) == "from a friend"
    driver.post(pygame.DROPFILE, file=str(tmp_path))
    assert "no folder with a network" in driver.said
