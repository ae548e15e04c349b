import argparse
import subprocess
import sys
from collections.abc import Callable

import numpy as np
import pygame
import pytest

from game.cli import add_commands
from game.core import texts
from game.drawing.tokens import HUMAN, MUTE, NET
from game.scenes.physics.exhibits import EXHIBITS
from game.scenes.physics.falls import Slopes
from game.scenes.physics.momentum import Spin
from game.scenes.physics.piles import Stack
from game.scenes.physics.scene import GRAVITIES, PhysicsScene
from tests.game.tour.checkers import changed_by_drawing
from tests.support.driver import Driver
from tests.support.window import ROOT

Open = Callable[..., Driver]
_, EARTH = GRAVITIES


@pytest.fixture
def gallery(open_game: Open) -> Driver:
    return open_game(PhysicsScene)


def scene(driver: Driver) -> PhysicsScene:
    assert isinstance(driver.top, PhysicsScene)
    return driver.top


def name(driver: Driver) -> str:
    return scene(driver).chosen


def seen(driver: Driver, body) -> tuple[float, float]:
    """Where a body is seen, in points."""
    x, y = scene(driver).view(1.0).points(body.position[0]).tolist()
    return x, y


def shows(driver: Driver, colour: tuple[int, int, int], area: pygame.Rect) -> int:
    scene(driver).draw(driver.app.canvas, 1.0)
    pixels = pygame.surfarray.array3d(driver.app.canvas.surface)[area.left : area.right, area.top : area.bottom]
    return int((np.abs(pixels.astype(int) - colour).max(axis=2) < 12).sum())


def press(driver: Driver, kind: int, points: tuple[float, float]) -> None:
    driver.post(kind, pos=driver.to_window(points), button=1)


def test_exhibits_are_chosen_by_keys_mouse_and_pad(gallery: Driver):
    names = list(EXHIBITS)
    gallery.key(pygame.K_RIGHT)
    assert name(gallery) == names[1]
    gallery.key(pygame.K_n)
    assert name(gallery) == names[2]
    gallery.keys(pygame.K_b, pygame.K_b, pygame.K_b)
    assert name(gallery) == names[-1]
    gallery.key(pygame.K_n)
    assert name(gallery) == names[0]
    tabs = gallery.choice(texts.EXHIBITS[names[0]][0])
    gallery.click((tabs.row.lefts[3] + 4, tabs.box.centery))
    assert name(gallery) == names[3]
    gallery.button(pygame.CONTROLLER_BUTTON_RIGHTSHOULDER)
    assert name(gallery) == names[4]
    gallery.button(pygame.CONTROLLER_BUTTON_DPAD_LEFT)
    assert name(gallery) == names[3]


def test_gravity_is_chosen_and_the_exhibit_begins_anew(gallery: Driver):
    first = scene(gallery).exhibit
    gallery.keys(pygame.K_DOWN, pygame.K_DOWN, pygame.K_RIGHT)
    assert scene(gallery).exhibit is not first
    assert scene(gallery).exhibit.world.gravity.tolist() == [0.0, -EARTH]


def test_the_mouse_takes_hold_pulls_and_lets_go(open_game: Open):
    driver = open_game(PhysicsScene, "spin")
    exhibit = scene(driver).exhibit
    assert isinstance(exhibit, Spin)
    disc = exhibit.turning[0]
    start = seen(driver, disc)
    press(driver, pygame.MOUSEBUTTONDOWN, start)
    assert scene(driver).grip is not None
    target = (start[0] + 40, start[1] - 160)
    driver.move(target)
    assert shows(driver, HUMAN, pygame.Rect(start, (60, 180)).move(-10, -170)) > 60
    driver.frames(90)
    assert np.abs(np.subtract(seen(driver, disc), target)).max() < 2
    press(driver, pygame.MOUSEBUTTONUP, target)
    assert scene(driver).grip is None
    driver.move((900, 660))
    driver.frames(30)
    assert np.abs(np.subtract(seen(driver, disc), target)).max() < 4


def test_a_thrown_ball_topples_a_column(gallery: Driver):
    exhibit = scene(gallery).exhibit
    assert isinstance(exhibit, Stack)
    press(gallery, pygame.MOUSEBUTTONDOWN, seen(gallery, exhibit.ball))
    gallery.move((900, 400))
    gallery.frames(30)
    press(gallery, pygame.MOUSEBUTTONUP, (900, 400))
    gallery.frames(150)
    assert exhibit.columns[0][-1].position[0, 1] != pytest.approx(7.6, abs=1.0)


def test_what_cannot_move_and_what_is_a_widget_is_not_taken_hold_of(gallery: Driver):
    gallery.keys(pygame.K_n, pygame.K_n)
    exhibit = scene(gallery).exhibit
    assert isinstance(exhibit, Slopes)
    press(gallery, pygame.MOUSEBUTTONDOWN, tuple(scene(gallery).view(1.0).points((-8.0, 2.0))))
    assert scene(gallery).grip is None


def test_pausing_lets_go(gallery: Driver):
    exhibit = scene(gallery).exhibit
    assert isinstance(exhibit, Stack)
    physics = scene(gallery)
    press(gallery, pygame.MOUSEBUTTONDOWN, seen(gallery, exhibit.ball))
    gallery.key(pygame.K_ESCAPE)
    assert "PauseScene" in gallery.top_name
    assert physics.grip is None
    gallery.frames(3)
    gallery.key(pygame.K_ESCAPE)
    assert gallery.top is physics


def test_space_stops_a_period_steps_and_r_begins_anew(gallery: Driver):
    gallery.frames(5)
    gallery.key(pygame.K_SPACE)
    before = scene(gallery).exhibit.steps
    gallery.frames(10)
    assert scene(gallery).exhibit.steps == before
    gallery.keys(pygame.K_PERIOD, pygame.K_PERIOD)
    assert scene(gallery).exhibit.steps == before + 2
    gallery.button(pygame.CONTROLLER_BUTTON_RIGHTSTICK)
    assert scene(gallery).exhibit.steps == before + 3
    gallery.key(pygame.K_r)
    assert scene(gallery).exhibit.steps == 0
    gallery.button(pygame.CONTROLLER_BUTTON_Y)
    gallery.frames(5)
    assert scene(gallery).exhibit.steps >= 5


@pytest.mark.parametrize(("slower", "speed"), [(0, 1.0), (1, 0.5), (2, 0.25), (5, 0.25)])
def test_slow_motion(gallery: Driver, slower: int, speed: float):
    gallery.keys(*[pygame.K_MINUS] * slower)
    before = scene(gallery).exhibit.steps
    gallery.frames(40)
    assert scene(gallery).exhibit.steps - before == pytest.approx(40 * speed, abs=1)


def test_contacts_are_drawn_in_blue_when_asked_for(gallery: Driver):
    column = pygame.Rect(360, 240, 320, 360)
    gallery.frames(10)
    assert shows(gallery, NET, column) == 0
    gallery.key(pygame.K_c)
    gallery.frames(2)
    assert shows(gallery, NET, column) > 100
    gallery.key(pygame.K_c)
    assert shows(gallery, NET, column) == 0


def test_every_exhibit_is_drawn_at_every_size_and_drawing_changes_nothing(gallery: Driver):
    gallery.key(pygame.K_c)
    for size in ((1000, 800), (1920, 1080)):
        gallery.resize(size)
        for _ in EXHIBITS:
            gallery.key(pygame.K_n)
            gallery.frames(2)
            assert not changed_by_drawing(gallery)


def test_between_two_steps_bodies_are_drawn_in_between(open_game: Open):
    driver = open_game(PhysicsScene, "bounce")
    driver.keys(pygame.K_MINUS, pygame.K_MINUS)
    driver.frames(41)
    pictures = []
    for alpha in (0.0, 0.9):
        scene(driver).draw(driver.app.canvas, alpha)
        pictures.append(pygame.surfarray.array3d(driver.app.canvas.surface))
    assert not np.array_equal(*pictures)


# The command


def test_the_command_opens_the_exhibit_over_the_menu(monkeypatch, tmp_path):
    opened: list[Driver] = []

    def stay(app, stop) -> int:
        driver = Driver(app)
        opened.append(driver)
        driver.frames(3)
        assert name(driver) == "drag"
        driver.keys(pygame.K_ESCAPE, pygame.K_UP, pygame.K_RETURN)  # Pause, Leave
        assert driver.top_name == "MenuScene"
        app.close()
        return 0

    monkeypatch.setattr("game.shell.app.App.run", stay)
    parser = argparse.ArgumentParser()
    add_commands(parser.add_subparsers())
    arguments = parser.parse_args(["physics", "--exhibit", "drag"])
    arguments.user_dir, arguments.full_screen = tmp_path, False
    assert arguments.run(arguments) == 0
    assert opened


def test_an_exhibit_that_is_not_there_is_named(tmp_path):
    command = [sys.executable, str(ROOT / "main.py"), "physics", "--exhibit", "trebuchet"]
    finished = subprocess.run(command, capture_output=True, check=False, text=True, timeout=300)
    assert finished.returncode == 2
    assert "trebuchet" in finished.stderr
    assert "stack" in finished.stderr


def test_sleeping_bodies_are_drawn_faintly_until_something_stirs_them(gallery: Driver):
    def brightness(body) -> float:
        scene(gallery).draw(gallery.app.canvas, 1.0)
        x, y = seen(gallery, body)
        return float(pygame.surfarray.array3d(gallery.app.canvas.surface)[int(x) - 24 : int(x) + 24, int(y)].mean())

    exhibit = scene(gallery).exhibit
    assert isinstance(exhibit, Stack)
    box, other = exhibit.columns[0][4], exhibit.columns[1][4]
    gallery.frames(10)
    awake = brightness(box)
    legend = pygame.Rect(330, 664, 380, 18)
    assert not shows(gallery, MUTE, legend)
    gallery.frames(140)
    assert exhibit.world.asleep[0, box.index]
    assert brightness(box) < 0.9 * awake
    assert shows(gallery, MUTE, legend) > 20
    box.apply_force((0.0, 1.0))
    gallery.frames(2)
    assert brightness(box) == pytest.approx(awake, rel=0.02)
    assert brightness(other) < 0.9 * awake
