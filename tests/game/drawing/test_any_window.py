"""In windows of any shape: nothing leaves the view, no two texts meet, and read-outs stand at its edges."""

import math
from typing import Any

import numpy as np
import pygame
import pytest
from hypothesis import given, settings
from hypothesis import settings as examples
from hypothesis import strategies as st

from game.core import texts
from game.drawing.canvas import PAGE, Canvas
from game.scenes.menus.settings import SettingsScene
from game.scenes.watch.watched import MANY
from game.ui.context import Context
from game.world.camera import LAND_REACH, WIDEST, Camera, CameraTarget
from game.world.landscape.backdrop import Backdrop
from game.world.stage import Stage
from tests.support.driver import Driver
from tests.support.screens import crashed, opened, save_settings
from tests.support.written import Written

SHAPES = [(1290, 430), (640, 1280)]  # three to one, one to two


def reshape(driver: Driver, size: tuple[int, int]) -> None:
    driver.resize(size)
    driver.frames(10)


def places(written: Written, driver: Driver) -> dict[str, tuple[float, float]]:
    page = written.turn(driver.app.canvas)
    driver.app.draw()
    canvas, reading = driver.app.canvas, driver.app.canvas.reading
    return {note.text: reading.points(canvas.pixels(note.box.center)) for note in page.notes}


@examples(deadline=None, max_examples=15)
@given(st.floats(1 / 3, 3.0), st.floats(-4, 4), st.floats(WIDEST, 2.0))
def test_every_window_shows_the_page_of_the_world_and_more(shape: float, across: float, zoom: float):
    canvas = Canvas(pygame.Surface((round(600 * math.sqrt(shape)), round(600 / math.sqrt(shape)))))
    camera = Camera()
    camera.cut(CameraTarget(across, zoom).on_land())
    page, view = camera.view(1.0), camera.view(1.0).filling(canvas)
    seen = pygame.FRect(canvas.surface.get_rect()).inflate(4, 4)
    for corner in (PAGE.topleft, PAGE.topright, PAGE.bottomleft, PAGE.bottomright):
        place = page.metres(corner)
        assert seen.collidepoint(view.pixels(place).tolist())
        assert view.metres(view.points(place)) == pytest.approx(place)
        assert canvas.pixels(view.points(place).tolist()) == pytest.approx(view.pixels(place), abs=1e-6)
    assert view.points((0, 0))[1] - canvas.view.bottom == pytest.approx(page.points((0, 0))[1] - PAGE.bottom)


@pytest.mark.parametrize("size", [(960, 320), (320, 640)])
def test_sky_and_land_fill_the_window_wherever_the_camera_goes(size: tuple[int, int]):
    canvas, nothing = Canvas(pygame.Surface(size)), (255, 0, 255)
    moon = Backdrop(size, np.random.default_rng(5))
    for across, zoom in ((-LAND_REACH, WIDEST), (0.0, 1.0), (LAND_REACH, 2.0)):
        camera = Camera()
        camera.cut(CameraTarget(across, zoom).on_land())
        canvas.surface.fill(nothing)
        moon.draw(canvas, camera)
        assert not (pygame.surfarray.array3d(canvas.surface) == nothing).all(axis=2).any()
        # The plain reaches to both sides: under its line it is darker than the sky above.
        row = round(float(camera.view(1.0).filling(canvas).pixels((0.0, 0.0))[1]))
        ground = pygame.surfarray.array3d(canvas.surface)[:, min(row, size[1] - 1)]
        assert np.ptp(ground.astype(int).sum(axis=1)) < 200


def test_a_choice_and_a_hint_at_the_foot_are_pressed_where_they_are_seen(open_game, context, written):
    save_settings(context)
    driver = opened(open_game, "WatchScene")
    for size, count in zip(SHAPES, (MANY, 1), strict=True):
        reshape(driver, size)
        seen = places(written, driver)
        driver.click(seen[texts.WATCH_MANY[count == MANY]])
        assert driver.top.swarm.env.num_envs == count, size
        driver.click(seen["pause"])
        assert "PauseScene" in driver.top_name, size
        driver.key(pygame.K_ESCAPE)
        driver.frames(2)


def test_a_wreck_is_on_the_picture(open_game, context: Context, monkeypatch: pytest.MonkeyPatch):
    save_settings(context)
    driver, pictures = opened(open_game, "Play"), []
    driver.resize((640, 360))
    crashed(driver)
    for draw in (Stage._draw_wreck, lambda *_: None):
        monkeypatch.setattr(Stage, "_draw_wreck", draw)
        driver.frames()
        pictures.append(pygame.surfarray.array2d(driver.app.canvas.surface))
    assert (pictures[0] != pictures[1]).sum() > 100


def test_a_window_too_small_to_read_grows_again(open_game):
    driver = open_game()
    for asked, got in (((400, 800), (640, 800)), ((900, 200), (900, 360)), ((640, 360), (640, 360))):
        driver.resize(asked)
        assert driver.app.window.size == got
        assert driver.app.canvas.scale >= 0.5


# At any size of the window, the picture is sharp and the mouse meets what it sees.

SIZES = [(1366, 768), (3440, 1440), (720, 1280)]


@settings(deadline=None, max_examples=25)
@given(st.integers(320, 4000), st.integers(320, 4000))
def test_the_view_reaches_to_the_edges_of_any_window_with_the_page_in_its_middle(width: int, height: int):
    canvas = Canvas(pygame.Surface((width, height)))
    view, pixel = canvas.view, 1 / canvas.scale
    assert view.inflate(2 * pixel, 2 * pixel).contains(PAGE)
    assert view.center == pytest.approx(PAGE.center, abs=2 * pixel)
    assert canvas.pixels(view.topleft) == pytest.approx((0, 0), abs=1)
    assert canvas.pixels(view.bottomright) == pytest.approx((width, height), abs=1)
    assert canvas.reading.pixels(canvas.reading.view.bottomright) == pytest.approx((width, height), abs=1)
    assert canvas.above(30 * canvas.scale / canvas.type).view == view, "so much stands on the ground"
    assert canvas.above(200).view.height == pytest.approx(view.height + 40 - 200 * canvas.type / canvas.scale)


def test_a_click_meets_the_switch_it_sees_and_none_beside_it(open_game, context: Context):
    game: Driver = open_game(SettingsScene)
    for size in SIZES:
        game.resize(size)
        clicked(game, game.app.context, size)


def clicked(game: Driver, context: Context, size: tuple[int, int]) -> None:
    assert game.app.canvas.origin == tuple((w - s) // 2 for w, s in zip(size, game.app.canvas.size, strict=True))
    toggle = game.widget(texts.SETTINGS["reduced_motion"][0])
    for _ in range(9):
        if toggle.box.bottom > toggle.seen.bottom + 1:  # scrolled away in a low window
            game.post(pygame.MOUSEWHEEL, x=0, y=-1)
    box = pygame.FRect(toggle.box)
    for place in ((box.left + 2, box.top + 2), (box.right - 3, box.bottom - 3), box.center):
        before = context.settings.reduced_motion
        game.click(place)
        assert context.settings.reduced_motion is not before
    for place in ((box.left - 8, box.top + 2), (box.right + 8, box.centery)):
        saved = context.settings.to_dict()
        game.click(place)
        assert context.settings.to_dict() == saved


def test_full_screen_and_back_keeps_size_and_mouse(open_game, context: Any):
    game: Driver = open_game(SettingsScene)
    game.resize((1000, 700))
    for _ in range(2):
        game.key(pygame.K_F11)
        game.frames(10)
        assert context.settings.full_screen
        game.click(game.widget(texts.SETTINGS["reduced_motion"][0]).box.center)
        game.key(pygame.K_RETURN, pygame.KMOD_ALT)
        game.frames(10)
        assert not context.settings.full_screen
        assert game.app.window.size == (1000, 700)
        game.click(game.widget(texts.SETTINGS["reduced_motion"][0]).box.center)
    assert not context.settings.reduced_motion
