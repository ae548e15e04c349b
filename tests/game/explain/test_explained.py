"""Words and bars explain themselves: to the mouse, to keys and to a gamepad."""

import inspect
from collections.abc import Callable
from itertools import product
from typing import Any

import pygame
import pytest

from ai.agent.agent import DeepQAgent
from ai.lander.environment import LanderEnv
from game.core import texts
from game.core.source import source_of
from game.drawing.canvas import Canvas
from game.explain.code_listing import draw_listing
from game.explain.explained import Explained
from game.explain.readouts import PILOT, flight_readouts
from game.scenes.learn.pay import config_of
from game.scenes.play.scene import PlayScene
from game.scenes.watch.scene import WatchScene
from tests.support.driver import Driver

Open = Callable[..., Driver]


@pytest.fixture
def watching(open_game: Open) -> Driver:
    driver = open_game(WatchScene, seed=2)
    driver.frames(10)
    return driver


def shows(driver: Driver, written: list[str], sentence: str) -> bool:
    """Whether a sentence is on the screen, however it is broken into lines."""
    written.clear()
    driver.app.draw()
    return sentence in " ".join(written)


def areas(driver: Driver) -> dict[str, pygame.FRect]:
    driver.app.draw()
    return {area.what: area.box for area in driver.app.canvas.explained}


def test_everything_in_watch_is_explained(watching: Driver):
    watching.key(pygame.K_SPACE)
    watching.press_on(texts.MORE[0])
    watching.frames(2)
    watching.top._choose_map(1)
    watching.frames(12)
    named = areas(watching)
    inputs = [
        what for what in named if what in {text.format(unit=u) for text in texts.EXPLAIN_INPUTS for u in (10 / 3, 2)}
    ]
    assert len(inputs) == 9
    for what in (
        texts.EXPLAIN_WATCH, texts.EXPLAIN_EXPECTED, texts.EXPLAIN_VALUE,
        *readouts_explained(watching.top.swarm.env),
        *texts.EXPLAIN_CHOICES, texts.EXPLAIN_MAP,
    ):  # fmt: skip
        assert what in named
    assert all(area.now() == area.now() for area in watching.app.canvas.explained)


def readouts_explained(env: LanderEnv) -> list[str]:
    """What each read-out is that a pilot needs all the time."""
    return [readout.what for name, readout in flight_readouts(env).items() if name in PILOT]


def test_a_mouse_at_rest_is_shown_what_it_points_at(watching: Driver, written: list[str]):
    watching.key(pygame.K_SPACE)
    descent = readouts_explained(scene(watching).swarm.env)[1]
    assert "2.0 m/s" in descent, "what a touchdown allows"
    watching.move(areas(watching)[descent].center)
    assert not shows(watching, written, descent)
    watching.frames(40)
    assert shows(watching, written, descent)
    watching.move((640, 300))
    assert not shows(watching, written, descent)
    watching.frames(40)
    assert not shows(watching, written, descent)


def scene(driver: Driver) -> WatchScene:
    assert isinstance(driver.top, WatchScene)
    return driver.top


def test_one_key_goes_from_area_to_area(watching: Driver, written: list[str]):
    scene(watching).playback.stopped = True
    order = list(areas(watching))
    for press, place in (
        (lambda: watching.key(pygame.K_F1), 0),
        (lambda: watching.button(pygame.CONTROLLER_BUTTON_DPAD_RIGHT), 1),
        (lambda: watching.keys(pygame.K_RIGHT, pygame.K_LEFT), 1),
        (lambda: watching.keys(pygame.K_LEFT, pygame.K_LEFT), -1),
        (lambda: watching.keys(pygame.K_F1, pygame.K_F1), 0),  # the same key ends it
    ):
        press()
        assert shows(watching, written, order[place])
    before = scene(watching).swarm.env.steps[0]
    watching.key(pygame.K_PERIOD)  # and other keys do what they do
    watching.frames(3)
    assert scene(watching).swarm.env.steps[0] > before
    watching.button(pygame.CONTROLLER_BUTTON_B)
    assert watching.top_name == "WatchScene"
    assert not shows(watching, written, order[0])
    watching.key(pygame.K_ESCAPE)
    assert "PauseScene" in watching.top_name


def test_f1_shows_what_the_network_thinks_in_flight_and_explains_all_in_the_pause(open_game: Open, written: list[str]):
    driver = open_game(PlayScene, seed=4)
    driver.frames(5)
    assert set(readouts_explained(driver.top.flight.env)) <= areas(driver).keys()
    for shown in (True, False):
        driver.key(pygame.K_F1)
        assert driver.saved()["show_thinking"] is shown
    driver.key(pygame.K_ESCAPE)
    driver.frames(3)
    assert texts.LANDINGS_TITLE not in written, "nobody has asked, and F1 is off again"
    assert texts.EXPLAIN_READOUTS["fuel"] in areas(driver)
    driver.key(pygame.K_F1)
    explained = [area.what for area in driver.app.canvas.explained]
    assert shows(driver, written, explained[0])
    driver.key(pygame.K_RIGHT)
    assert shows(driver, written, explained[1])


# Listing of code: it shows the lines of the function that runs, and keeps the current one in sight.


def test_the_source_has_the_lines_of_the_file_but_not_the_docstring():
    source = source_of(DeepQAgent.gradient_step)
    lines, first = inspect.getsourcelines(DeepQAgent.gradient_step)
    assert source.path == "ai/agent/agent.py"
    assert source.name == "DeepQAgent.gradient_step"
    assert source.lines[0][0] == first
    for number, text in source.lines:
        assert lines[number - first].strip() == text.strip()
    assert not any('"""' in text for _, text in source.lines)
    assert "# fmt" in inspect.getsource(config_of)
    assert not any("# fmt" in text for _, text in source_of(config_of).lines), "nor remarks for tools"
    assert source_of(len) is None


def test_the_current_line_is_in_sight_however_little_room_there_is():
    source = source_of(DeepQAgent.train_step)
    for room, (number, _) in product((60, 400), source.lines):
        canvas: Any = Canvas(pygame.Surface((1280, 720)))
        written = []
        canvas.text = lambda string, *_, **__: written.append(string)  # noqa: B023
        draw_listing(canvas, (40, 40, 500, room), source, number, {})
        assert str(number) in written


def test_escape_is_not_eaten_where_nothing_is_explained():
    explained, canvas = Explained(), Canvas(pygame.Surface((800, 600)))
    explained.action().run()
    canvas.explain((9000, 20, 50, 20), "scrolled out of sight")
    explained.draw(canvas)
    assert not explained.handle_event(pygame.event.Event(pygame.KEYDOWN, key=pygame.K_ESCAPE))
    explained.action().run()
    canvas.explain((20, 20, 50, 20), "in sight")
    explained.draw(canvas)
    assert explained.handle_event(pygame.event.Event(pygame.KEYDOWN, key=pygame.K_ESCAPE))
    assert not explained.stepping
