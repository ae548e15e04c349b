"""Games that a test opens, one after another in the same player's folder; all of them are closed in the end."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from itertools import count
from multiprocessing import active_children
from typing import Any

import pygame

from game.core.scene import Scene
from game.core.settings import TOP_RUNG, SettingsFile
from game.scenes import scene_of
from game.scenes.menus.menu import MenuScene
from game.shell.app import App
from game.ui.context import Context
from tests.support.driver import Driver

OpenGame = Callable[..., Driver]


@contextmanager
def games(context: Context) -> Iterator[OpenGame]:
    """Yield what opens a game; its clock ticks 1/60 s a frame."""
    opened: list[Driver] = []

    def open_it(
        first: Scene | Callable[..., Scene] | None = None,
        *arguments: Any,
        tutored: bool = True,
        ladder: bool = False,
        first_run: bool = False,
        **options: Any,
    ) -> Driver:
        """Open the game with a scene that is given, or made by its class or a function, with these arguments."""

        def make(context: Context) -> Scene:
            return first if isinstance(first, Scene) else (first or MenuScene)(context, *arguments, **options)

        for driver in opened:
            driver.app.settings_writer.wait()
        context.settings = SettingsFile(context.user_dir).load()
        context.settings.tutored |= tutored  # or a first flight would teach
        if not first_run:  # or it would go slowly, and offer a lesson
            context.settings.slow_runs, context.settings.lesson_offered = False, True
        if not ladder and context.settings.rung < 0:
            context.settings.rung = TOP_RUNG  # or free flights would begin above the pad
        frames = count()
        opened.append(Driver(App(context, make, now=lambda: next(frames) / 60, scene_of=scene_of, capped=False)))
        return opened[-1]

    try:
        yield open_it
    finally:
        for driver in reversed(opened):  # whatever one has closed, the others still have scenes to leave
            driver.app.close()
    end = time.monotonic() + 20.0
    while active_children() and time.monotonic() < end:  # on a busy machine, one that was ended takes a moment to go
        time.sleep(0.01)
    assert not active_children()
    pygame.event.get() if pygame.display.get_init() else None
