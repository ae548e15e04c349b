"""The game without a window: SDL draws into memory, and a clock of our own ticks 1/60 s a frame."""

import gc
import os

os.environ["SDL_VIDEODRIVER"] = "dummy"
os.environ["SDL_AUDIODRIVER"] = "dummy"

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pygame
import pytest

from ai.lander.pilots import ScriptedPilot
from game.core import texts
from game.core.settings import TOP_RUNG, Settings
from game.digits import kept
from game.drawing import typeface
from game.flight import networks
from game.ui.context import Context
from tests.support.driver import Driver
from tests.support.games import OpenGame, games
from tests.support.written import words_written

pytest.register_assert_rewrite("tests.game.tour.checkers", "tests.game.tour.walks")
pygame.font.init()  # as long as the tests run, in whatever order


@pytest.fixture(autouse=True, scope="module")
def small_heap() -> Iterator[None]:
    """Keep what tests leave out of later collections: each game that is closed or left collects once."""
    yield
    gc.freeze()


@pytest.fixture(autouse=True)
def networks_unread() -> None:
    """Forget networks that were read: a test may have put other numbers into them."""
    networks.kept.clear()
    kept.forget()


@pytest.fixture(autouse=True)
def usual_text() -> Iterator[None]:
    """Leave the language as it was found, and nothing that was written in another: both are the process's."""
    read, language = texts.MENU, texts.LANGUAGE
    yield
    if language != texts.LANGUAGE:
        texts.choose(language)
    if texts.MENU is not read:
        typeface.forget()


@pytest.fixture
def context(tmp_path: Path) -> Context:
    return Context(tmp_path / "user", Settings(rung=TOP_RUNG), rng=np.random.default_rng(1))


@pytest.fixture
def written(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """All texts that are written from now on."""
    return words_written(monkeypatch)


@pytest.fixture
def open_game(context: Context) -> Iterator[OpenGame]:
    with games(context) as open_it:
        yield open_it


@pytest.fixture
def game(open_game: OpenGame) -> Driver:
    return open_game()


@pytest.fixture
def scripted_network(monkeypatch: pytest.MonkeyPatch) -> None:
    """The scripted pilot stands in for the network."""
    monkeypatch.setattr(networks, "chosen", lambda *_: networks.Network("stand-in", ScriptedPilot()))
