"""Drawing changes nothing but pixels: no scene, no widget and no session is another after it than before."""

from collections.abc import Callable
from types import FunctionType, MethodType
from typing import Any

import numpy as np
import pygame
import pytest

from game.audio.mixer import Sound
from game.drawing.canvas import Canvas
from game.drawing.paint_cache import PaintCache
from game.drawing.sky import NightSky
from game.ui.context import Context
from tests.game.drawing.test_text_size import FLOWN, opened
from tests.game.scenes.test_walks import OVER_OTHERS, SCREENS
from tests.support.driver import Driver
from tests.support.tour import stock

# Kept so as not to be painted again: of these, drawing may make as it likes.
PICTURES = (Canvas, pygame.Surface, PaintCache, NightSky)
SHARED = (Context, Sound)
COUNTS = {"redraws"}  # of paintings, for tests
PLAIN = (int, float, complex, str, bytes, bool, type(None), type, range)


def is_picture(value: object) -> bool:
    """Whether something is a picture, or a place for some."""
    if isinstance(value, tuple | list):
        return any(map(is_picture, value))
    if isinstance(value, dict):
        return any(map(is_picture, value.values()))
    return isinstance(value, PICTURES)


def state_of(thing: object) -> dict[str, Any]:
    """Return all that a scene holds, by the way there; each object once."""
    found: dict[str, Any] = {}
    ahead, known = [("", thing)], {id(thing)}
    while ahead:
        way, value = ahead.pop()
        inside: list[tuple[str, object]] = []
        if isinstance(value, np.random.Generator):
            found[way] = str(value.bit_generator.state)
        elif isinstance(value, np.ndarray):
            found[way] = (value.shape, value.tobytes())
        elif isinstance(value, PLAIN):
            found[way] = repr(value)
        elif isinstance(value, dict):
            found[way] = repr([key if isinstance(key, PLAIN) else type(key) for key in value])
            inside = [(f"{way}[{number}]", each) for number, each in enumerate(value.values())]
        elif isinstance(value, list | tuple | pygame.Rect | pygame.FRect):
            found[way] = len(value)
            inside = [(f"{way}[{number}]", each) for number, each in enumerate(value)]
        elif isinstance(value, FunctionType | MethodType):
            found[way] = value.__qualname__
        else:
            found[way] = type(value).__name__
            if type(value).__module__.partition(".")[0] in {"game", "ai", "engine"} and not isinstance(value, SHARED):
                inside = [(f"{way}.{name}", each) for name, each in parts(value) if name not in COUNTS]
        for place, each in inside:
            if not is_picture(each) and (isinstance(each, PLAIN) or id(each) not in known):
                known.add(id(each))
                ahead.append((place, each))
    return found


def parts(value: object) -> list[tuple[str, object]]:
    slots = [name for kind in type(value).__mro__ for name in getattr(kind, "__slots__", ())]
    return [*getattr(value, "__dict__", {}).items(), *((name, getattr(value, name, None)) for name in slots)]


def changed(driver: Driver) -> set[str]:
    """Draw twice, and return what is not as it was."""
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
    driver = opened(open_game, context, name, "normal")
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


def test_neither_does_it_while_one_scene_gives_way_to_another(open_game: Callable[..., Driver], context: Context):
    driver = open_game(SCREENS["MenuScene"])
    driver.frames(5)
    driver.app.show(SCREENS["SettingsScene"])
    for _ in range(15):
        assert not changed(driver)
        driver.app.scenes.update()
