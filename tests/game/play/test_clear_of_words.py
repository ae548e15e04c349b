"""What flies and what is said keep clear of each other: paths, panels, read-outs, hints."""

from collections.abc import Callable

import numpy as np
import pygame
import pytest

from ai.lander.environment import Outcome
from game.core import texts
from game.drawing.canvas import Canvas
from game.drawing.tokens import VIEW_SIZE
from game.flight import networks
from game.scenes.play.scene import PlayScene
from game.ui.context import Context
from tests.support.driver import Driver
from tests.support.flights import play
from tests.support.reading import Weighs

Open = Callable[..., Driver]
READ_OUTS = 640


@pytest.fixture
def shared(open_game: Open, context: Context, monkeypatch: pytest.MonkeyPatch) -> Driver:
    monkeypatch.setattr(networks, "chosen", lambda *_: networks.Network("stand-in", Weighs()))
    context.settings.assist, context.settings.reduced_motion = 0.5, True
    context.settings.show_thinking = True
    context.settings_file.save(context.settings)
    driver = open_game(PlayScene, 4)
    driver.frames(2)
    return driver


def place(driver: Driver, *state: float) -> None:
    play(driver).flown.waiting = False
    play(driver).flight.env.place(np.ones(1, bool), np.array([state]))


def drawn(monkeypatch: pytest.MonkeyPatch, *kinds: str) -> list[tuple[float, float]]:
    """Note where dots and markers are drawn from now on."""
    places: list[tuple[float, float]] = []
    for kind in kinds:
        monkeypatch.setattr(Canvas, kind, note(getattr(Canvas, kind), places, 1 if kind == "marker" else 0))
    return places


def note(draw: Callable[..., None], places: list[tuple[float, float]], at: int) -> Callable[..., None]:
    def noted(canvas: Canvas, *args: object, **more: object) -> None:
        places.append(args[at])
        draw(canvas, *args, **more)

    return noted


def test_the_panel_gives_way_to_a_craft_that_the_camera_can_not_keep_clear(shared: Driver, monkeypatch):
    panels: list[bool] = []
    copilot_panel = play(shared).flown.copilot_panel
    monkeypatch.setattr(copilot_panel, "draw", lambda *_: panels.append(True))
    place(shared, 0, 12, 0, 0, 0, 0)
    shared.frames(4)
    assert panels
    box = play(shared).flown.copilot_panel.box(shared.app.canvas.reading)
    x, y = play(shared).flown.scenery.view(1.0).metres(box.center).tolist()
    place(shared, x, y, 0, 0, 0, 0)
    shared.frames(2)  # it leaps there between two steps
    panels.clear()
    shared.frames(3)
    assert not panels


def test_no_dotted_way_leads_through_what_is_said_before_a_flight(open_game: Open, monkeypatch):
    driver = open_game(PlayScene, 4)
    driver.frames(40)
    scene = play(driver)
    x, y = scene.flight.env.position[0].tolist()
    scene.flown.path_preview.drift.path = np.linspace((x, y), (x, y + 14), 20)  # straight up, through all words
    places = drawn(monkeypatch, "dot", "marker")
    scene.flown.path_preview.draw(
        driver.app.canvas, scene.flown.scenery.view(driver.app.canvas.scale), scene.flown.scenery.clear.head
    )
    assert places
    assert min(row for _, row in places) > scene.flown.scenery.clear.head


def test_a_mark_on_the_way_of_coasting_says_whether_the_network_still_lands_from_there(open_game: Open, monkeypatch):
    driver = open_game(PlayScene, 4)
    place(driver, 0.0, 12.0, 1.0, 0.0, 0, 0)
    flown, canvas = play(driver).flown, driver.app.canvas
    flown.path_preview.drift.path = np.linspace((0.0, 12.0), (9.0, 3.0), 55)  # a metre a second either way
    view, shapes = flown.scenery.view(canvas.scale), []
    monkeypatch.setattr(Canvas, "marker", lambda self, shape, at, *_: shapes.append((shape, at)))
    for coasting, shape, key in (((0.8, True), "circle", "lands"), ((0.5, False), "cross", "lost")):
        shapes.clear()
        canvas.explained.clear()
        flown.path_preview.draw(canvas, view, 0.0, coasting)
        x, y = view.metres(dict(shapes)[shape]).tolist()
        assert (x, 12.0 - y) == pytest.approx((coasting[0], coasting[0]), abs=0.05)
        (mark,) = canvas.explained
        assert mark.now() == texts.EXPLAIN_COASTING_NOW[key].format(seconds=coasting[0])
    flown.path_preview.draw(canvas, view, 0.0)
    assert len(canvas.explained) == 1


@pytest.mark.parametrize("state", [(29.9, 3.0, 6.0, 0.0, 0, 0), (0, 28.9, 0, 6.0, 0, 0), (-29.9, 12, -6.0, 0, 0, 0)])
@pytest.mark.parametrize("calm", [True, False])
def test_a_craft_that_is_lost_lies_on_no_words(open_game: Open, context: Context, monkeypatch, state, calm: bool):
    context.settings.reduced_motion = calm
    context.settings_file.save(context.settings)
    driver = open_game(PlayScene, 4)
    place(driver, *state)
    driver.frames(10)
    assert play(driver).flight.outcome is Outcome.OUT_OF_BOUNDS
    canvas = driver.app.canvas
    places = drawn(monkeypatch, "marker")
    play(driver).flown.scenery.draw_craft(canvas, 1.0)
    ((x, y),) = places
    assert 0 < x < 1280
    assert 80 < y < READ_OUTS


def test_the_flight_keeps_off_the_panel(shared: Driver):
    place(shared, 0, 12, 0, 0, 0, 0)
    shared.frames(6)
    flown = play(shared).flown
    assert flown.clear.right < flown.copilot_panel.box(shared.app.canvas.reading).left
    shared.key(pygame.K_F1)
    shared.frames(2)
    assert not flown.thinks
    assert flown.clear.right == VIEW_SIZE[0]
