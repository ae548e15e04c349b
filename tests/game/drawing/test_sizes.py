"""At any size of the window, the picture is sharp and the mouse meets what it sees."""

import pygame
import pytest

from game.drawing.canvas import Canvas
from game.drawing.tokens import VIEW_SIZE
from game.scenes.settings import SettingsScene
from game.ui.context import Context
from tests.support.driver import Driver

SIZES = [(1366, 768), (1000, 700), (3440, 1440), (640, 360), (720, 1280), (1921, 1079), (2560, 1600)]


@pytest.mark.parametrize("size", SIZES)
def test_points_and_pixels_lead_to_each_other(size: tuple[int, int]):
    canvas = Canvas(pygame.Surface(size))
    for corner in ((0, 0), VIEW_SIZE):
        pixels = [round(p * canvas.scale + o) for p, o in zip(corner, canvas.offset, strict=True)]
        assert all(-1 <= p <= limit + 1 for p, limit in zip(pixels, size, strict=True))
    for place in ((0, 0), (1, 719), (640, 360), (1279.5, 3)):
        box = canvas.in_window((*place, 1, 1))
        assert canvas.to_points(box.topleft) == pytest.approx(place, abs=1 / canvas.scale)


@pytest.mark.parametrize("size", SIZES)
def test_the_view_fits_in_the_middle_and_is_drawn_in_the_windows_own_pixels(size: tuple[int, int]):
    window = pygame.Surface(size)
    canvas = Canvas(window)
    left, top = canvas.surface.get_abs_offset()
    assert canvas.surface.get_abs_parent() is window  # nothing is scaled on its way to the screen
    width, height = canvas.surface.get_size()
    assert abs(2 * left + width - size[0]) <= 1
    assert abs(2 * top + height - size[1]) <= 1
    assert width == size[0] or height == size[1]
    assert width / height == pytest.approx(16 / 9, rel=0.01)


@pytest.mark.parametrize("size", SIZES)
def test_a_click_meets_the_switch_it_sees_and_none_beside_it(open_game, context: Context, size: tuple[int, int]):
    game: Driver = open_game(SettingsScene)
    game.resize(size)
    assert game.app.canvas.offset == tuple((w - s) // 2 for w, s in zip(size, game.app.canvas.size, strict=True))
    toggle = game.top.form.widgets[1]
    box = pygame.FRect(toggle.box)
    for place in ((box.left + 2, box.top + 2), (box.right - 3, box.bottom - 3), box.center):
        before = context.settings.reduced_motion
        game.click(place)
        assert context.settings.reduced_motion is not before
    for place in ((box.left - 8, box.top + 2), (box.right + 8, box.centery)):
        before = context.settings.to_dict()
        game.click(place)
        assert context.settings.to_dict() == before


def test_full_screen_and_back_keeps_size_and_mouse(open_game, context: Context):
    game: Driver = open_game(SettingsScene)
    game.resize((1000, 700))
    for _ in range(3):
        game.key(pygame.K_F11)
        game.frames(10)
        assert context.settings.full_screen
        game.click(game.top.form.widgets[1].box.center)
        game.key(pygame.K_RETURN, pygame.KMOD_ALT)
        game.frames(10)
        assert not context.settings.full_screen
        assert game.app.window.size == (1000, 700)
        game.click(game.top.form.widgets[1].box.center)
    assert not context.settings.reduced_motion
