"""In windows of any shape: nothing leaves the view, no two texts meet, and read-outs stand at its edges."""

import math

import numpy as np
import pygame
import pytest
from hypothesis import given
from hypothesis import settings as examples
from hypothesis import strategies as st

from game.core import texts
from game.drawing.canvas import PAGE, Canvas
from game.scenes.play.help import HELP
from game.ui.context import Context
from game.world.camera import LAND_REACH, WIDEST, Camera, CameraTarget
from game.world.landscape.backdrop import Backdrop
from tests.support.driver import Driver
from tests.support.flights import play
from tests.support.screens import crashed, opened, save_settings
from tests.support.written import Written

SHAPES = [(1290, 430), (640, 1280), (800, 800)]  # three to one, one to two, square


def reshape(driver: Driver, size: tuple[int, int]) -> None:
    driver.resize(size)
    driver.frames(10)


def boxes(written: Written, driver: Driver) -> dict[str, pygame.FRect]:
    page = written.turn(driver.app.canvas)
    driver.app.draw()
    return {note.text: note.box for note in page.notes}


def test_read_outs_keep_their_distance_from_the_edges(open_game, context: Context):
    save_settings(context)
    driver = opened(open_game, "Play")

    def places() -> list[tuple[pygame.FRect, str, str]]:
        areas = {area.what: area.box for area in driver.app.canvas.explained}
        return [
            (areas[texts.EXPLAIN_READOUTS["altitude"]], "left", "bottom"),
            (areas[texts.EXPLAIN_READOUTS["tilt"]], "left", "bottom"),
        ]

    before = places()
    for size in (*SHAPES, (1720, 720)):
        reshape(driver, size)
        for (now, *edges), (usual, *_) in zip(places(), before, strict=True):
            for edge in edges:
                away = getattr(now, edge) - getattr(driver.app.canvas.view, edge)
                wanted = getattr(usual, edge) - getattr(PAGE, edge)
                assert away == pytest.approx(wanted, abs=3.0), size  # letters have whole pixels


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


@pytest.mark.parametrize("size", [(960, 320), (320, 640), (480, 480), (640, 360)])
def test_sky_and_land_fill_the_window_wherever_the_camera_goes(size: tuple[int, int]):
    canvas, nothing = Canvas(pygame.Surface(size)), (255, 0, 255)
    moon = Backdrop(size, np.random.default_rng(5), reduced_motion=True)
    for across in (-LAND_REACH, 0.0, LAND_REACH):
        for zoom in (WIDEST, 1.0, 2.0):
            camera = Camera()
            camera.cut(CameraTarget(across, zoom).on_land())
            canvas.surface.fill(nothing)
            moon.draw(canvas, camera, 0.0)
            left = (pygame.surfarray.array3d(canvas.surface) == nothing).all(axis=2)
            assert not left.any()
            # The plain reaches to both sides: under its line it is darker than the sky above.
            row = round(float(camera.view(1.0).filling(canvas).pixels((0.0, 0.0))[1]))
            ground = pygame.surfarray.array3d(canvas.surface)[:, min(row, size[1] - 1)]
            assert np.ptp(ground.astype(int).sum(axis=1)) < 200


def test_help_is_chosen_by_the_mouse_where_it_is_seen(open_game, context, written: Written):
    save_settings(context, three_pads=True)
    driver = opened(open_game, "Play")
    canvas = driver.app.canvas
    for size, word in zip(SHAPES, ("guide", "off", "guard"), strict=True):
        reshape(driver, size)
        driver.click(canvas.reading.points(canvas.pixels(boxes(written, driver)[texts.HELP[word]].center)))
        assert driver.app.context.settings.assist == HELP[word], size


def test_a_choice_at_the_foot_and_a_hint_at_the_head_are_pressed_where_they_are_seen(open_game, context, written):
    save_settings(context)
    driver = opened(open_game, "WatchScene")
    for size, count in zip(SHAPES, (16, 64, 1), strict=True):
        reshape(driver, size)
        seen = boxes(written, driver)
        driver.click(seen[str(count)].center)
        assert driver.top.swarm.env.num_envs == count, size
        driver.click(seen["pause"].center)
        assert "PauseScene" in driver.top_name, size
        driver.key(pygame.K_ESCAPE)
        driver.frames(2)


def test_a_stopped_lander_is_dragged_where_it_is_seen(open_game, context: Context):
    save_settings(context)
    driver = opened(open_game, "WatchScene")
    reshape(driver, SHAPES[1])
    driver.key(pygame.K_SPACE)
    watch = driver.top
    canvas = driver.app.canvas
    place = canvas.points(watch.world.camera.view(1.0).filling(canvas).pixels(watch.swarm.env.position[0]).tolist())
    x, y = watch.swarm.env.position[0].tolist()
    driver.move(place)
    driver.post(pygame.MOUSEBUTTONDOWN, pos=driver.to_window(place), button=1)
    driver.move((place[0] - 64, place[1]))
    driver.post(pygame.MOUSEBUTTONUP, pos=driver.to_window((place[0] - 64, place[1])), button=1)
    moved = watch.swarm.env.position[0]
    assert moved[0] < x - 0.5
    assert moved[1] == pytest.approx(y, abs=0.2)


@pytest.mark.parametrize("size", SHAPES)
def test_the_panel_that_explains_stands_at_the_right_edge(open_game, context, written: Written, size: tuple[int, int]):
    save_settings(context, three_pads=True, assist=0.4, show_thinking=True)
    driver = opened(open_game, "Play")
    reshape(driver, size)
    driver.frames(3)
    driver.post(pygame.KEYDOWN, key=pygame.K_UP, mod=0)
    driver.frames(25)  # later the craft is behind the panel in the narrowest window, which then makes way
    page = written.turn(driver.app.canvas)
    driver.app.draw()
    reading, canvas = driver.app.canvas.reading, driver.app.canvas
    box = play(driver).flown.copilot_panel.box(reading)
    assert box.right == pytest.approx(reading.view.right, abs=40)
    right = canvas.view.left + box.right * reading.scale / canvas.scale
    assert any(panel.right == pytest.approx(right, abs=1) for panel in page.panels)


def test_the_window_may_change_while_something_is_asked(open_game, context: Context):
    save_settings(context)
    driver = opened(open_game, "QuestionDialog")
    for size in (SHAPES[0], (1280, 720)):
        reshape(driver, size)
    assert driver.top_name == "QuestionDialog"


@pytest.mark.parametrize(
    ("asked", "got"), [((400, 800), (640, 800)), ((900, 200), (900, 360)), ((640, 360), (640, 360))]
)
def test_a_window_too_small_to_read_grows_again(open_game, asked: tuple[int, int], got: tuple[int, int]):
    driver = open_game()
    driver.resize(asked)
    assert driver.app.window.size == got
    assert driver.app.canvas.scale >= 0.5


def test_a_crash_is_not_hidden(open_game, context: Context):
    save_settings(context)
    driver = opened(open_game, "Play")
    reshape(driver, (640, 1280))
    crashed(driver)
    flight = play(driver).flight
    canvas = driver.app.canvas
    place = play(driver).flown.scenery.view(1.0).filling(canvas).pixels(flight.env.position[0]).tolist()
    assert canvas.surface.get_rect().collidepoint(place)
