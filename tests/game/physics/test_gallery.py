"""The gallery: exhibits and sliders by mouse, keyboard and gamepad; and the screen of one step."""

import argparse
from collections.abc import Callable
from typing import Any

import numpy as np
import pygame
import pytest

from game.cli import add_commands
from game.core import texts
from game.core.scene import Route
from game.drawing.tokens import HUMAN, NET
from game.scenes.physics.exhibits import EXHIBITS
from game.scenes.physics.scene import GRAVITIES, PhysicsScene
from game.scenes.physics.step_scene import PhysicsStepScene
from tests.support.driver import Driver
from tests.support.player import Player
from tests.support.screens import fallen

Open = Callable[..., Driver]
EARTH = GRAVITIES[1]


@pytest.fixture
def gallery(open_game: Open) -> Driver:
    driver = open_game(PhysicsScene)
    driver.press_on(texts.MORE[0])
    return driver


def scene(driver: Driver) -> Any:
    assert isinstance(driver.top, PhysicsScene)
    return driver.top


def seen(driver: Driver, body) -> tuple[float, float]:
    """Where a body is seen, in points."""
    x, y = scene(driver).view(1.0).points(body.position[0]).tolist()
    return x, y


def shows(driver: Driver, colour: tuple[int, int, int], area: pygame.typing.RectLike) -> int:
    """How many pixels of an area, in points, have a colour."""
    driver.app.draw()
    box = driver.app.canvas.reading.rect(*pygame.FRect(area))
    pixels = pygame.surfarray.array3d(driver.app.canvas.surface)[box.left : box.right, box.top : box.bottom]
    return int((np.abs(pixels.astype(int) - colour).max(axis=2) < 12).sum())


def press(driver: Driver, kind: int, points: tuple[float, float]) -> None:
    driver.post(kind, pos=driver.to_window(points), button=1)


def slider(driver: Driver, name: str) -> Any:
    return driver.widget(texts.QUANTITIES[name][0])


def click(driver: Driver, label: str) -> None:
    box = driver.widget(label).box
    driver.click((box.left + 6, box.centery))


# Exhibits


def test_exhibits_are_chosen_by_keys_mouse_and_pad(gallery: Driver):
    names = list(EXHIBITS)
    gallery.form.focus(gallery.form.widgets[0])
    for press_it, number in (
        (lambda: gallery.key(pygame.K_RIGHT), 1),
        (lambda: gallery.click(gallery.choice(texts.EXHIBITS[names[0]][0])._places[3].center), 3),
        (lambda: gallery.button(pygame.CONTROLLER_BUTTON_DPAD_LEFT), 2),
    ):
        press_it()
        assert scene(gallery).chosen == names[number]


def test_gravity_is_chosen(gallery: Driver):
    first = scene(gallery).exhibit
    gallery.choice(texts.PHYSICS_GRAVITIES[0]).choose(1)
    assert scene(gallery).exhibit is not first
    assert scene(gallery).exhibit.world.gravity.tolist() == [0.0, -EARTH]
    gallery.choice(texts.EXHIBITS["stack"][0]).choose(1)
    assert scene(gallery).exhibit.world.gravity.tolist() == [0.0, -EARTH]


# A hand


def test_the_mouse_takes_hold_pulls_and_lets_go(open_game: Open):
    driver = open_game(PhysicsScene, "stack")
    disc = scene(driver).exhibit.ball
    start = seen(driver, disc)
    press(driver, pygame.MOUSEBUTTONDOWN, start)
    target = (start[0] + 40, start[1] - 100)
    driver.move(target)
    assert shows(driver, HUMAN, (start[0] - 10, start[1] - 110, 60, 120)) > 40
    driver.frames(90)
    assert np.abs(np.subtract(seen(driver, disc), target)).max() < 2
    press(driver, pygame.MOUSEBUTTONUP, target)
    assert scene(driver).grip is None


def test_what_cannot_move_or_has_left_the_room_is_not_gripped_and_runs_over_no_control(open_game: Open):
    driver = open_game(PhysicsScene, "slopes")
    physics = scene(driver)
    press(driver, pygame.MOUSEBUTTONDOWN, tuple(physics.view(1.0).points((-8.0, 2.0))))  # the slope
    assert physics.grip is None
    driver.choice(texts.EXHIBITS["stack"][0]).choose(0)
    box, picture = physics.exhibit.bodies[0], physics.room_row.picture
    area = (picture.left, picture.top - 40, 300, 38)
    before = shows(driver, NET, area), shows(driver, HUMAN, area)
    for y, gripped in ((picture.top - 10, False), (picture.top + 10, True)):
        box.position = physics.view(1.0).metres((430.0, y))
        physics.playback.stopped = True
        physics.playback.step()
        press(driver, pygame.MOUSEBUTTONDOWN, (430.0, y))
        assert (physics.grip is not None) is gripped
        assert gripped or (shows(driver, NET, area), shows(driver, HUMAN, area)) == before


def test_pausing_and_leaving_the_window_let_go(gallery: Driver):
    physics = scene(gallery)
    for leave in (lambda: gallery.post(pygame.WINDOWFOCUSLOST), lambda: gallery.key(pygame.K_ESCAPE)):
        press(gallery, pygame.MOUSEBUTTONDOWN, seen(gallery, physics.exhibit.ball))
        assert physics.grip is not None
        leave()
        assert physics.grip is None
    assert "PauseScene" in gallery.top_name


# Time


def test_space_stops_a_period_steps_and_r_begins_anew(gallery: Driver):
    before = scene(gallery).exhibit.steps
    gallery.frames(24)
    assert scene(gallery).exhibit.steps - before == pytest.approx(24, abs=1)
    gallery.key(pygame.K_SPACE)
    before = scene(gallery).exhibit.steps
    gallery.frames(10)
    gallery.keys(pygame.K_PERIOD, pygame.K_PERIOD)
    gallery.button(pygame.CONTROLLER_BUTTON_RIGHTSTICK)
    assert scene(gallery).exhibit.steps == before + 3
    gallery.key(pygame.K_r)
    assert scene(gallery).exhibit.steps == 0


# What is drawn


def test_contacts_are_drawn_in_blue_when_asked_for(gallery: Driver):
    gallery.frames(10)
    column = scene(gallery).room_row.picture
    assert shows(gallery, NET, column) <= 100
    gallery.press_on(texts.PHYSICS_CONTACTS)
    assert shows(gallery, NET, column) > 100


def test_f1_explains_one_thing_after_the_other(gallery: Driver):
    gallery.key(pygame.K_F1)
    assert scene(gallery).explained.stepping
    gallery.frames(1)
    assert {area.what for area in gallery.app.canvas.explained} >= set(texts.EXPLAIN_PHYSICS.values())
    gallery.key(pygame.K_ESCAPE)
    assert not scene(gallery).explained.stepping


# Quantities


def test_a_quantity_is_changed_without_a_mouse_and_stays(open_game: Open):
    player = Player(open_game(PhysicsScene, "bounce"), "pad")
    for _ in range(12):
        if player.form.focused is not slider(player, "restitution"):
            player.press("down")
    player.press("left")
    player.frames(2)
    for exhibit in (0, 3):  # to another exhibit and back
        player.choice(texts.EXHIBITS["stack"][0]).choose(exhibit)
    assert scene(player).exhibit.values["restitution"] == slider(player, "restitution").value == pytest.approx(0.7)


# One step


def test_the_step_is_opened_from_the_gallery_and_left_again(gallery: Driver):
    gallery.frames(30)
    gallery.key(pygame.K_SPACE)
    below = scene(gallery)
    poses = below.exhibit.poses
    click(gallery, texts.PHYSICS_STEP)
    record = gallery.top.record
    gallery.key(pygame.K_ESCAPE)
    assert gallery.top is below
    assert np.array_equal(below.exhibit.poses, poses)
    gallery.key(pygame.K_PERIOD)
    assert below.exhibit.poses.tobytes() == record.after[0].tobytes()  # as the last piece says


def test_pieces_are_walked_through_by_keys_and_chosen_with_the_mouse(open_game: Open):
    driver = open_game(lambda context: PhysicsStepScene(context, fallen()))
    shown = driver.top
    assert shown.pieces == ["boxes", "axes", "contact", "forces", "impulses", "motion"]
    for piece in shown.pieces:
        assert shown.piece == piece
        driver.key(pygame.K_PERIOD)
        driver.frames(1)
    first = shown.pair
    driver.press_on(texts.STEP_OTHER)
    assert shown.pair is not first
    assert shown.piece == "motion"
    driver.click(driver.choice(texts.STEP_PIECES["axes"][0])._places[1].center)
    assert shown.piece == "axes"
    driver.click(driver.hints()[texts.HINT_NEXT_PIECE])
    assert shown.piece == "contact"


# The command


def test_the_command_opens_the_exhibit_and_names_those_there_are(monkeypatch, tmp_path, capsys):
    opened = []
    monkeypatch.setattr("game.start.play", lambda *_, begin: opened.append(begin) or 0)
    parser = argparse.ArgumentParser()
    add_commands(parser.add_subparsers())
    arguments = parser.parse_args(["physics", "--exhibit", "drag"])
    arguments.user_dir, arguments.full_screen = tmp_path, False
    assert arguments.run(arguments) == 0
    assert opened == [Route("physics", ("drag",))]
    with pytest.raises(SystemExit):
        parser.parse_args(["physics", "--exhibit", "trebuchet"])
    said = capsys.readouterr().err
    assert "trebuchet" in said
    assert "stack" in said
