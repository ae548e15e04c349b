"""Land takes longer to paint than a frame may last: it is rough at once, and whole a few frames later."""

from collections.abc import Callable, Iterator

import numpy as np
import pygame
import pytest

from ai.lander.descent import LegStart, leg_of
from game.drawing.canvas import Canvas
from game.drawing.paint import PIECE
from game.drawing.paint_cache import A_FRAME, PaintCache, idle, paint_on, painted, spread
from game.scenes.menus.menu import MenuScene
from game.scenes.play.descent import Descent
from game.scenes.play.scene import PlayScene
from game.shell.app import App
from game.world.camera import Camera, CameraTarget
from game.world.landscape.backdrop import Backdrop, landscape
from game.world.landscape.ground import begin_hills, draw_ground
from game.world.landscape.themes import LOOKS, MOON
from tests.support.descent import stand_on
from tests.support.driver import Driver
from tests.support.flights import play
from tests.support.screens import save_settings

Open = Callable[..., Driver]
MOST = A_FRAME + PIECE  # a piece is begun while the frame's share is not used up


@pytest.fixture
def in_pieces() -> Iterator[None]:
    """Play as in the game; tests of other things have each picture at once."""
    landscape.cache_clear()
    spread(A_FRAME)
    finish()  # what other tests have left
    yield
    spread(0)
    landscape.cache_clear()


def finish() -> list[int]:
    """Paint all that is unfinished, and return how many pixels each frame painted."""
    frames = []
    while not idle():
        frames.append(paint_on())
    return frames


def land(size: tuple[int, int], look: str = "moon", leg: int = 0) -> Callable[[], np.ndarray]:
    """Return what takes a picture of the land, (columns, rows, 3), of a leg if wished."""
    canvas, camera = Canvas(pygame.Surface(size)), Camera()
    camera.cut(CameraTarget(0.0, 1.3))
    moon = Backdrop(size, np.random.default_rng(5), look=LOOKS.get(look, MOON))

    def picture() -> np.ndarray:
        moon.draw(canvas, camera)
        if leg:
            draw_ground(canvas, camera.view(canvas.scale).filling(canvas), leg_of(7, LegStart(leg)).ground)
        return pygame.surfarray.array3d(canvas.surface).astype(int)

    return picture


def test_in_pieces_the_same_picture_comes_of_it_as_at_once(in_pieces: None):
    picture = land(size := (300, 480), look := "night", leg := 4)
    rough = picture()
    frames = finish()
    assert len(frames) > 5
    assert max(frames) <= MOST
    whole = picture()
    spread(0)
    assert np.array_equal(whole, land(size, look, leg)())
    assert np.abs(rough - whole).mean() < 3  # of 255: the same land, but for what is fine
    assert not np.array_equal(rough, whole)


def costs(app: App, until: Callable[[], bool]) -> list[int]:
    """Play drawn frames until something holds; return how many pixels of land each of them painted."""
    found = []
    while not until():
        before = painted()
        app.tick()
        found.append(painted() - before)
    return found


@pytest.mark.usefixtures("scripted_network")
def test_the_next_leg_is_painted_before_it_begins_and_no_frame_paints_much(open_game: Open, context, in_pieces: None):
    save_settings(context)
    driver = open_game(PlayScene, 5, challenge=Descent())
    challenge = play(driver).challenge
    assert isinstance(challenge, Descent)
    driver.app.tick()
    assert max(costs(driver.app, idle)) <= MOST
    driver.app.tick()  # begins the leg after this one
    assert not idle()
    assert max(costs(driver.app, idle)) <= MOST
    scene = play(driver)
    scene.flown.waiting = False
    stand_on(scene.flight.env, 0)
    assert max(costs(driver.app, lambda: challenge.begins.number == 2)) <= MOST
    before = painted()
    driver.app.draw()
    assert painted() == before, "all of it was there"
    assert max(costs(driver.app, idle), default=0) <= MOST


def test_what_lies_ahead_waits_for_what_is_seen(in_pieces: None):
    picture, view = land((640, 360)), Camera().view(0.5)
    picture()
    begin_hills(leg_of(8, LegStart(2)).ground, view)
    of_the_land = sum(finish())
    begin_hills(leg_of(8, LegStart(2)).ground, view)
    of_the_leg = sum(finish())
    assert 0 < of_the_leg < of_the_land


def test_the_window_may_change_its_size_while_its_land_is_painted(open_game: Open, context, in_pieces: None):
    save_settings(context)
    driver = open_game(MenuScene)
    for size in ((700, 400), (640, 360)):
        driver.resize(size)
        assert not idle()
    assert max(costs(driver.app, idle)) <= MOST
    driver.app.draw()
    whole = pygame.surfarray.array3d(driver.app.canvas.surface)
    spread(0)
    landscape.cache_clear()
    driver.app.draw()
    assert np.array_equal(whole, pygame.surfarray.array3d(driver.app.canvas.surface))


def test_land_that_nobody_wants_any_more_is_not_painted_on(in_pieces: None):
    picture = land((640, 360))
    picture()
    assert not idle()
    del picture
    assert idle()


def test_a_frame_that_has_painted_a_rough_picture_paints_no_more(in_pieces: None):
    paint_on()
    rough = painted()
    picture = land((1920, 1080))
    picture()
    assert painted() - rough > A_FRAME
    assert paint_on() == 0  # later, in frames of their own
    assert paint_on() > 0


# Pictures that are kept: painted when what they show changes, and only then.


def had_to_paint(kept: PaintCache, canvas: Canvas, *shown: object) -> list[object]:
    """Return what of `shown` had to be painted."""
    seen: list[object] = []
    for each in shown:
        kept.draw(canvas, (10, 20, 30, 40), each, lambda _, each=each: seen.append(each))  # type: ignore[misc]
    return seen


def test_what_has_not_changed_is_not_painted_again():
    canvas = Canvas(pygame.Surface((1280, 720)))
    assert had_to_paint(PaintCache(), canvas, "a", "a", "b", "b", "a") == ["a", "b", "a"]
    assert had_to_paint(PaintCache(2), canvas, "a", "b", "a", "b", "c", "b", "a") == ["a", "b", "c", "a"]


def test_another_scale_is_painted_anew_and_the_picture_stands_in_its_box():
    kept = PaintCache()
    for size in ((1280, 720), (640, 360)):
        canvas = Canvas(pygame.Surface(size))
        kept.draw(canvas, (100, 40, 20, 20), "dot", lambda sheet: sheet.fill(sheet.rect(5, 5, 2, 2), (255, 0, 0)))
        lit = pygame.mask.from_threshold(canvas.surface, (255, 0, 0), (1, 1, 1)).get_bounding_rects()
        assert lit == [canvas.rect(105, 45, 2, 2)]
