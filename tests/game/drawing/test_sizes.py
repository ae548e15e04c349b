"""At any size of the window, the picture is sharp and the mouse meets what it sees."""

from itertools import product
from typing import Any

import pygame
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from game.core import texts
from game.drawing.canvas import PAGE, Canvas
from game.drawing.tokens import VIEW_SIZE
from game.scenes.menus.settings import SettingsScene
from game.ui.context import Context
from tests.support.driver import Driver

SIZES = [(1366, 768), (1000, 700), (3440, 1440), (640, 360), (720, 1280), (1921, 1079), (2560, 1600)]


def test_points_and_pixels_lead_to_each_other(subtests: pytest.Subtests):
    for size in SIZES:
        with subtests.test(size=size):
            canvas = Canvas(pygame.Surface(size))
            for corner in ((0, 0), VIEW_SIZE):
                pixels = [round(p * canvas.scale + o) for p, o in zip(corner, canvas.origin, strict=True)]
                assert all(-1 <= p <= limit + 1 for p, limit in zip(pixels, size, strict=True))
            for x, y in ((0, 0), (1, 719), (640, 360), (1279.5, 3)):
                box = canvas.rect(x, y, 1, 1)
                assert canvas.points(box.topleft) == pytest.approx((x, y), abs=1 / canvas.scale)


@settings(deadline=None, max_examples=25)
@given(st.integers(320, 4000), st.integers(320, 4000))
def test_the_view_reaches_to_the_edges_of_any_window_with_the_page_in_its_middle(width: int, height: int):
    canvas = Canvas(pygame.Surface((width, height)))
    view, pixel = canvas.view, 1 / canvas.scale
    assert view.inflate(2 * pixel, 2 * pixel).contains(PAGE)
    assert view.center == pytest.approx(PAGE.center, abs=2 * pixel)
    assert canvas.rect(*view) == pygame.Rect(0, 0, width, height)
    for across, down in product((-1, 0, 1), repeat=2):
        moved = canvas.at(across, down)
        corner = canvas.points(moved.pixels((0, 0)))  # of the moved page, on the canvas
        wanted = (
            (0.0, view.right - 1280, view.left)[across],
            (0.0, view.bottom - 720, view.top)[down],
        )
        assert corner == pytest.approx(wanted, abs=2 * pixel)
        assert moved.at(across, down).origin == pytest.approx(moved.origin, abs=1)
        assert moved.points((0, 0)) == pytest.approx(moved.view.topleft, abs=2 * pixel)  # the window's corner


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
    for _ in range(3):
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
