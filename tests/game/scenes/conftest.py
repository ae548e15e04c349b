"""Watch, and the scenes that train, with small runs beside the window or within its process."""

from collections.abc import Callable
from pathlib import Path

import pytest

from game.core.scene import Scene
from game.scenes.train.scene import MORE, TrainScene
from game.scenes.watch.scene import WatchScene
from game.ui.context import Context
from tests.support import inline_worker
from tests.support.driver import Driver
from tests.support.small import LANDERS


@pytest.fixture
def watching(open_game: Callable[..., Driver], context: Context, tmp_path: Path) -> Driver:
    """Watch, with the scripted pilot alone."""
    context.models_dir = tmp_path / "models"
    return open_game(WatchScene, seed=2)


@pytest.fixture
def small_run() -> tuple[Callable[[Context], Scene], object]:
    """The scene that is opened and what it will train; files about another scene have a fixture of this name."""
    return TrainScene, LANDERS


@pytest.fixture
def beside(open_game: Callable[..., Driver], small_run: tuple[Callable[[Context], Scene], object]) -> Driver:
    """The screen with all its words, and processes of their own for its runs."""
    scene, config = small_run
    driver = open_game(scene)
    driver.frames(2)
    driver.app.context.unfold(MORE)
    driver.top.knobs.ask(config)
    driver.top.run.seed = 3
    driver.frames(1)
    return driver


@pytest.fixture
def train(beside: Driver, monkeypatch: pytest.MonkeyPatch) -> Driver:
    """The screen, with its runs within this process."""
    inline_worker.install(monkeypatch.setattr)
    return beside
