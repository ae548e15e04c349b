"""The game without a window: SDL draws into memory, and a clock of our own ticks 1/60 s a frame."""

import os
import time

os.environ["SDL_VIDEODRIVER"] = "dummy"
os.environ["SDL_AUDIODRIVER"] = "dummy"

from collections.abc import Callable, Iterator
from itertools import count
from multiprocessing import active_children
from pathlib import Path
from typing import Any

import numpy as np
import pygame
import pytest

from ai.lander.pilots import ScriptedPilot
from game.core.scene import Scene
from game.core.settings import TOP_RUNG, Settings, SettingsFile
from game.digits import kept
from game.drawing import typeface
from game.drawing.canvas import Canvas
from game.flight import networks
from game.scenes import scene_of
from game.scenes.menu import MenuScene
from game.shell.app import App
from game.ui.context import Context
from tests.support.driver import Driver

pygame.font.init()  # as long as the tests run, in whatever order


@pytest.fixture(autouse=True)
def networks_unread() -> None:
    """Forget networks that were read: a test may have put other numbers into them."""
    networks.kept.clear()
    kept.forget()


@pytest.fixture(autouse=True)
def usual_text_size() -> Iterator[None]:
    """Leave text as large as it was found: its size is the process's, and the last game may have made it larger."""
    yield
    typeface.grow(1.0)


@pytest.fixture
def context(tmp_path: Path) -> Context:
    return Context(tmp_path / "user", Settings(rung=TOP_RUNG), rng=np.random.default_rng(1))


@pytest.fixture
def written(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """All texts that are written from now on."""
    strings: list[str] = []
    text = Canvas.text

    def note(self: Canvas, string: str, *args: object, **words: object) -> pygame.FRect:
        strings.append(string)
        return text(self, string, *args, **words)  # type: ignore[arg-type]

    monkeypatch.setattr(Canvas, "text", note)
    return strings


@pytest.fixture
def open_game(context: Context) -> Iterator[Callable[..., Driver]]:
    opened: list[Driver] = []

    def open_it(
        first: Scene | Callable[..., Scene] | None = None,
        *arguments: Any,
        tutored: bool = True,
        ladder: bool = False,
        **options: Any,
    ) -> Driver:
        """Open the game with a scene that is given, or made by its class or a function, with these arguments."""

        def make(context: Context) -> Scene:
            return first if isinstance(first, Scene) else (first or MenuScene)(context, *arguments, **options)

        for driver in opened:
            driver.app.settings_writer.wait()
        context.settings = SettingsFile(context.user_dir).load()
        context.settings.tutored |= tutored  # or a first flight would teach
        if not ladder and context.settings.rung < 0:
            context.settings.rung = TOP_RUNG  # or free flights would begin above the pad
        frames = count()
        opened.append(Driver(App(context, make, now=lambda: next(frames) / 60, scene_of=scene_of, capped=False)))
        return opened[-1]

    yield open_it
    for driver in reversed(opened):  # whatever one has closed, the others still have scenes to leave
        driver.app.close()
    end = time.monotonic() + 20.0
    while active_children() and time.monotonic() < end:  # on a busy machine, one that was ended takes a moment to go
        time.sleep(0.01)
    assert not active_children()
    pygame.event.get() if pygame.display.get_init() else None


@pytest.fixture
def game(open_game: Callable[..., Driver]) -> Driver:
    return open_game()


@pytest.fixture
def scripted_network(monkeypatch: pytest.MonkeyPatch) -> None:
    """The scripted pilot stands in for the network."""
    monkeypatch.setattr(networks, "chosen", lambda *_: networks.Network("stand-in", ScriptedPilot()))
