"""Drawing changes nothing but pixels: no scene, no widget and no session is another after it than before."""

import threading
from collections.abc import Callable

import pygame
import pytest

from game.scenes.menu_background import LOADER
from game.ui.context import Context
from tests.support.driver import Driver
from tests.support.screens import FLOWN, OVER_OTHERS, SCREENS, opened, settle
from tests.support.state import state_of
from tests.support.tour import stock


def changed(driver: Driver) -> set[str]:
    """Draw twice, and return what is not as it was."""
    for thread in threading.enumerate():
        if thread.name == LOADER:
            thread.join()  # what it loads comes at any moment, and is none of the drawing's doing
    ways = set()
    scenes = driver.app.scenes
    for alpha in (0.0, 0.5):
        before = state_of(scenes)
        scenes.draw(driver.app.canvas, alpha)
        after = state_of(scenes)
        # What there is only once was None before, and then a picture, or the other way round.
        differing = {way for way in before.keys() | after.keys() if before.get(way) != after.get(way)}
        ways |= {way for way in differing if {before.get(way), after.get(way)} != {"None", None}}
    return ways


@pytest.mark.parametrize("name", [*SCREENS, *FLOWN, *OVER_OTHERS])
def test_drawing_changes_no_state(open_game: Callable[..., Driver], context: Context, name: str):
    if name in {"LogbookScene", "MissionsScene", "NetworksScene"}:
        stock(context)
    settle(context)
    driver = opened(open_game, name)
    assert not changed(driver)
    for frames in (1, 7, 40):
        driver.frames(frames)
        driver.app.scenes.update()  # and before anybody has drawn what that did
        assert not changed(driver)
    driver.app.canvas.surface.fill((0, 0, 0))
    scenes = driver.app.scenes
    pictures = []
    for _ in range(2):
        scenes.draw(driver.app.canvas, 0.5)
        pictures.append(pygame.surfarray.array3d(driver.app.canvas.surface))
    assert (pictures[0] == pictures[1]).all()


@pytest.mark.parametrize("keys", [(pygame.K_m,), (pygame.K_SPACE, pygame.K_g, pygame.K_UP, pygame.K_F1)])
def test_neither_does_it_while_watch_is_touched_and_explained(
    open_game: Callable[..., Driver], context: Context, keys: tuple[int, ...]
):
    settle(context)
    driver = opened(open_game, "WatchScene")
    driver.keys(*keys)
    for frames in (1, 3, 15):
        driver.frames(frames)
        driver.app.scenes.update()
        assert not changed(driver)


def test_neither_does_it_while_one_scene_gives_way_to_another(open_game: Callable[..., Driver], context: Context):
    driver = open_game(SCREENS["MenuScene"])
    driver.frames(5)
    driver.app.show(SCREENS["SettingsScene"])
    for _ in range(15):
        assert not changed(driver)
        driver.app.scenes.update()
