"""The gallery: exhibits, sliders and plot by mouse, keyboard and gamepad; and the screen of one step."""

import argparse
import subprocess
import sys
from collections.abc import Callable
from typing import Any

import numpy as np
import pygame
import pytest

from game.cli import add_commands
from game.core import texts
from game.drawing.tokens import HUMAN, NET
from game.scenes.physics.bodies import scale_force
from game.scenes.physics.exhibits import EXHIBITS
from game.scenes.physics.scene import GRAVITIES, PhysicsScene
from game.scenes.physics.step_scene import PhysicsStepScene
from game.ui.rows import ChoiceRow
from tests.support.driver import Driver
from tests.support.screens import fallen
from tests.support.window import ROOT
from tests.support.written import words_written

Open = Callable[..., Driver]
MOON, EARTH = GRAVITIES


@pytest.fixture
def gallery(open_game: Open) -> Driver:
    driver = open_game(PhysicsScene)
    driver.press_on(texts.PHYSICS_MORE[0])
    return driver


def scene(driver: Driver) -> Any:
    assert isinstance(driver.top, PhysicsScene)
    return driver.top


def step(driver: Driver) -> PhysicsStepScene:
    assert isinstance(driver.top, PhysicsStepScene)
    return driver.top


def seen(driver: Driver, body) -> tuple[float, float]:
    """Where a body is seen, in points."""
    x, y = scene(driver).view(1.0).points(body.position[0]).tolist()
    return x, y


def shows(driver: Driver, colour: tuple[int, int, int], area: pygame.typing.RectLike) -> int:
    """How many pixels of an area, in points, have a colour."""
    driver.app.draw()
    box = scene(driver).laid_on(driver.app.canvas).rect(*pygame.FRect(area))
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
        (lambda: gallery.key(pygame.K_n), 2),
        (lambda: gallery.keys(pygame.K_b, pygame.K_b, pygame.K_b), -1),
        (lambda: gallery.key(pygame.K_n), 0),
        (lambda: gallery.click(gallery.choice(texts.EXHIBITS[names[0]][0])._places[3].center), 3),
        (lambda: gallery.button(pygame.CONTROLLER_BUTTON_RIGHTSHOULDER), 4),
        (lambda: gallery.button(pygame.CONTROLLER_BUTTON_DPAD_LEFT), 3),
    ):
        press_it()
        assert scene(gallery).chosen == names[number]


def test_gravity_is_chosen_and_is_offered_only_where_there_is_any(gallery: Driver):
    assert all("m/s²" in words for words in texts.PHYSICS_GRAVITIES)
    assert [name for name, kind in EXHIBITS.items() if kind.weightless] == ["spin"]
    first = scene(gallery).exhibit
    gallery.choice(texts.PHYSICS_GRAVITIES[0]).choose(1)
    assert scene(gallery).exhibit is not first
    assert scene(gallery).exhibit.world.gravity.tolist() == [0.0, -EARTH]
    for _ in EXHIBITS:
        gallery.key(pygame.K_n)
        offered = [each for each in gallery.form.widgets if texts.PHYSICS_GRAVITIES[0] in getattr(each, "options", ())]
        assert bool(offered) is not scene(gallery).exhibit.weightless


# A hand


def test_the_mouse_takes_hold_pulls_and_lets_go(open_game: Open):
    driver = open_game(PhysicsScene, "spin")
    disc = scene(driver).exhibit.turning[0]
    start = seen(driver, disc)
    press(driver, pygame.MOUSEBUTTONDOWN, start)
    assert scene(driver).grip is not None
    target = (start[0] + 40, start[1] - 100)
    driver.move(target)
    assert shows(driver, HUMAN, (start[0] - 10, start[1] - 110, 60, 120)) > 40
    driver.frames(90)
    assert np.abs(np.subtract(seen(driver, disc), target)).max() < 2
    press(driver, pygame.MOUSEBUTTONUP, target)
    assert scene(driver).grip is None
    driver.move((1200, 660))
    driver.frames(30)
    assert np.abs(np.subtract(seen(driver, disc), target)).max() < 4


def test_a_thrown_ball_topples_a_column(gallery: Driver):
    exhibit = scene(gallery).exhibit
    press(gallery, pygame.MOUSEBUTTONDOWN, seen(gallery, exhibit.ball))
    there = tuple(scene(gallery).view(1.0).points((5.6, 5.0)))
    gallery.move(there)
    gallery.frames(30)
    press(gallery, pygame.MOUSEBUTTONUP, there)
    gallery.frames(150)
    assert exhibit.columns[0][-1].position[0, 1] != pytest.approx(7.6, abs=1.0)


def test_what_cannot_move_is_not_taken_hold_of(open_game: Open):
    driver = open_game(PhysicsScene, "slopes")
    press(driver, pygame.MOUSEBUTTONDOWN, tuple(scene(driver).view(1.0).points((-8.0, 2.0))))
    assert scene(driver).grip is None


def test_what_flies_out_of_the_room_runs_over_no_control_and_is_not_gripped_there(gallery: Driver):
    physics = scene(gallery)
    box, picture = physics.exhibit.bodies[0], physics.room_row.picture
    area = (picture.left, picture.top - 40, 300, 38)
    before = shows(gallery, NET, area), shows(gallery, HUMAN, area)
    for y, gripped in ((picture.top - 10, False), (picture.top + 10, True)):
        place = (430.0, y)
        box.position = physics.view(1.0).metres(place)
        physics.playback.stopped = True
        physics.playback.step()
        press(gallery, pygame.MOUSEBUTTONDOWN, place)
        assert (physics.grip is not None) is gripped
        assert gripped or (shows(gallery, NET, area), shows(gallery, HUMAN, area)) == before
        press(gallery, pygame.MOUSEBUTTONUP, place)


@pytest.mark.parametrize("way", ["pause", "focus"])
def test_pausing_and_leaving_the_window_let_go(gallery: Driver, way: str):
    physics = scene(gallery)
    press(gallery, pygame.MOUSEBUTTONDOWN, seen(gallery, physics.exhibit.ball))
    assert physics.grip is not None
    if way == "pause":
        gallery.key(pygame.K_ESCAPE)
        assert "PauseScene" in gallery.top_name
    else:
        gallery.post(pygame.WINDOWFOCUSLOST)
    assert physics.grip is None


# Time


def test_space_stops_a_period_steps_and_r_begins_anew(gallery: Driver):
    gallery.frames(5)
    gallery.key(pygame.K_SPACE)
    before = scene(gallery).exhibit.steps
    gallery.frames(10)
    assert scene(gallery).exhibit.steps == before
    gallery.keys(pygame.K_PERIOD, pygame.K_PERIOD)
    gallery.button(pygame.CONTROLLER_BUTTON_RIGHTSTICK)
    assert scene(gallery).exhibit.steps == before + 3
    gallery.key(pygame.K_r)
    assert scene(gallery).exhibit.steps == 0
    gallery.button(pygame.CONTROLLER_BUTTON_Y)
    gallery.frames(5)
    assert scene(gallery).exhibit.steps >= 5


def test_slow_motion(gallery: Driver):
    for speed in (1.0, 0.5, 0.25, 0.25):
        before = scene(gallery).exhibit.steps
        gallery.frames(40)
        assert scene(gallery).exhibit.steps - before == pytest.approx(40 * speed, abs=1)
        gallery.key(pygame.K_MINUS)


def test_between_two_steps_bodies_are_drawn_in_between(open_game: Open):
    driver = open_game(PhysicsScene, "bounce")
    driver.keys(pygame.K_MINUS, pygame.K_MINUS)
    driver.frames(41)
    pictures = []
    for alpha in (0.0, 0.9):
        scene(driver).draw_on(driver.app.canvas, alpha)
        pictures.append(pygame.surfarray.array3d(driver.app.canvas.surface))
    assert not np.array_equal(*pictures)


# What is drawn


def test_contacts_are_drawn_in_blue_when_asked_for(gallery: Driver):
    gallery.frames(10)
    column = scene(gallery).room_row.picture
    assert shows(gallery, NET, column) == 0
    gallery.key(pygame.K_c)
    gallery.frames(2)
    assert shows(gallery, NET, column) > 100
    gallery.key(pygame.K_c)
    assert shows(gallery, NET, column) == 0
    for gravity in GRAVITIES:
        force, length = scale_force(gravity)
        assert 24 < length <= 60
        assert length / force == pytest.approx(6.0 / gravity)


def test_sleeping_bodies_are_drawn_faintly_until_something_stirs_them(gallery: Driver, monkeypatch: pytest.MonkeyPatch):
    def brightness(body) -> float:
        gallery.app.draw()
        x, y = seen(gallery, body)
        return float(pygame.surfarray.array3d(gallery.app.canvas.surface)[int(x) - 14 : int(x) + 14, int(y)].mean())

    words = words_written(monkeypatch)
    exhibit = scene(gallery).exhibit
    box, other = exhibit.columns[0][4], exhibit.columns[1][4]
    gallery.frames(10)
    awake = brightness(box)
    assert texts.PHYSICS_ASLEEP not in words
    gallery.frames(140)
    assert exhibit.world.asleep[0, box.index]
    assert brightness(box) < 0.9 * awake
    assert texts.PHYSICS_ASLEEP in words
    box.apply_force((0.0, 1.0))
    gallery.frames(2)
    assert brightness(box) == pytest.approx(awake, rel=0.02)
    assert brightness(other) < 0.9 * awake


def test_f1_explains_one_thing_after_the_other(gallery: Driver, monkeypatch: pytest.MonkeyPatch):
    words = words_written(monkeypatch)
    gallery.key(pygame.K_F1)
    assert scene(gallery).explained.stepping
    explained_texts = set()
    for _ in range(24):
        words.clear()
        gallery.frames(1)
        explained_texts |= {what for what in texts.EXPLAIN_PHYSICS.values() if what[:20] in " ".join(words)}
        gallery.key(pygame.K_RIGHT)
    assert explained_texts == set(texts.EXPLAIN_PHYSICS.values())
    gallery.key(pygame.K_ESCAPE)
    assert not scene(gallery).explained.stepping


# Quantities


def test_a_slider_is_dragged_and_the_exhibit_begins_anew_with_its_value(open_game: Open):
    driver = open_game(PhysicsScene, "slopes")
    driver.frames(30)
    left, right = slider(driver, "degrees")._track
    y = slider(driver, "degrees").box.centery
    press(driver, pygame.MOUSEBUTTONDOWN, (right, y))
    for share in (0.7, 0.5, 0.3):
        driver.move((left + share * (right - left), y))
    press(driver, pygame.MOUSEBUTTONUP, (left + 0.3 * (right - left), y))
    driver.frames(2)
    exhibit = scene(driver).exhibit
    assert exhibit.values["degrees"] == slider(driver, "degrees").value < 30
    assert exhibit.steps < 5
    assert np.degrees(exhibit.boxes[0].angle[0]) == pytest.approx(-exhibit.values["degrees"], abs=0.1)


@pytest.mark.parametrize("pad", [False, True])
def test_a_quantity_is_changed_without_a_mouse_and_put_back(open_game: Open, pad: bool):
    driver = open_game(PhysicsScene, "bounce")

    def go(key: int, button: int) -> None:
        if pad:
            driver.button(button)
        else:
            driver.key(key)

    for _ in range(12):
        if driver.form.focused is not slider(driver, "restitution"):
            go(pygame.K_DOWN, pygame.CONTROLLER_BUTTON_DPAD_DOWN)
    go(pygame.K_LEFT, pygame.CONTROLLER_BUTTON_DPAD_LEFT)
    driver.frames(2)
    assert scene(driver).exhibit.values["restitution"] == pytest.approx(0.7)
    assert "e = 0.70" in texts.EXHIBITS["bounce"][2]["falling"].format(**scene(driver).exhibit.figures())
    while driver.form.focused is not driver.widget(texts.LAW_START_VALUES):
        go(pygame.K_DOWN, pygame.CONTROLLER_BUTTON_DPAD_DOWN)
    go(pygame.K_RETURN, pygame.CONTROLLER_BUTTON_A)
    assert scene(driver).exhibit.values["restitution"] == slider(driver, "restitution").value == 0.75


def test_values_stay_while_other_exhibits_are_looked_at(open_game: Open):
    driver = open_game(PhysicsScene, "spin")
    slider(driver, "reach").set(0.5)
    driver.frames(2)
    driver.keys(pygame.K_n, pygame.K_b)
    assert scene(driver).exhibit.values == {"reach": 0.5, "impulse": 0.4}
    assert slider(driver, "reach").value == 0.5


def test_an_exhibit_of_many_bodies_waits_until_the_slider_rests(open_game: Open):
    driver = open_game(PhysicsScene, "heap")
    driver.frames(5)
    first = scene(driver).exhibit
    slider(driver, "count").set(40.0)
    driver.frames(3)
    assert scene(driver).exhibit is first
    driver.frames(6)
    assert len(scene(driver).exhibit.bodies) == 40


# The plot


def test_a_run_adds_its_point_to_the_plot(open_game: Open):
    driver = open_game(PhysicsScene, "spin")
    driver.key(pygame.K_g)
    assert scene(driver).plot.points == []
    driver.frames(40)
    [(value, result)] = scene(driver).plot.points
    assert (value, result) == (1.2, pytest.approx(scene(driver).plot.law))
    assert shows(driver, HUMAN, scene(driver).plot._chart.plot.inflate(8, 8)) > 15
    slider(driver, "impulse").set(0.8)  # the plot turns to the quantity changed last
    driver.frames(40)
    assert scene(driver).plot.name == "impulse"
    assert [value for value, _ in scene(driver).plot.points] == [0.4, 0.8]
    driver.key(pygame.K_g)
    assert scene(driver).plot is None


def test_another_language_is_spoken_at_once(gallery: Driver, monkeypatch: pytest.MonkeyPatch):
    gallery.key(pygame.K_g)
    words = words_written(monkeypatch)
    with gallery.speaking("de"):
        words.clear()
        gallery.frames(1)
        assert scene(gallery).plot._what == texts.LAWS[scene(gallery).exhibit.name][0]
        assert texts.LAW_STEP in words
        assert texts.EXHIBITS["heap"][0] in words


def test_the_plot_follows_the_size_of_text_and_of_the_window(gallery: Driver):
    gallery.key(pygame.K_g)
    chart = scene(gallery).plot._chart
    before = chart.box.size
    gallery.write_in("largest")
    gallery.frames(2)
    assert chart.box.size != before
    gallery.write_in("normal")
    gallery.frames(2)
    assert chart.box.size == before


def test_the_whole_range_is_measured_while_the_exhibit_waits(open_game: Open):
    driver = open_game(PhysicsScene, "spin")
    click(driver, texts.LAW_PLOT)
    click(driver, texts.LAW_MEASURE)
    before = scene(driver).exhibit.steps
    driver.wait(lambda: scene(driver).measuring is None)
    assert scene(driver).exhibit.steps <= before + 2
    assert len(scene(driver).plot.points) == 9
    assert driver.widget(texts.LAW_MEASURE)  # offered again


def test_measuring_can_be_stopped(open_game: Open):
    driver = open_game(PhysicsScene, "heap")
    click(driver, texts.LAW_PLOT)
    click(driver, texts.LAW_MEASURE)
    driver.frames(3)
    click(driver, texts.LAW_CANCEL)
    assert scene(driver).measuring is None
    steps = scene(driver).exhibit.steps
    driver.frames(5)
    assert scene(driver).exhibit.steps > steps


# One step


def test_the_step_is_opened_from_the_gallery_and_left_again(gallery: Driver):
    gallery.frames(30)
    gallery.key(pygame.K_SPACE)
    below = scene(gallery)
    poses = below.exhibit.poses
    click(gallery, texts.LAW_STEP)
    record = step(gallery).record
    gallery.key(pygame.K_ESCAPE)
    assert gallery.top is below
    assert np.array_equal(below.exhibit.poses, poses)
    gallery.frames(40)
    gallery.key(pygame.K_PERIOD)
    assert below.exhibit.poses.tobytes() == record.after[0].tobytes()  # as the last piece says


@pytest.mark.parametrize("pad", [False, True])
def test_pieces_are_walked_through_without_a_mouse(open_game: Open, pad: bool):
    driver = open_game(lambda context: PhysicsStepScene(context, fallen()))
    shown, kinds = step(driver), []
    for _ in range(len(shown.pieces)):
        kinds.append(shown.piece.kind)
        if pad:
            driver.button(pygame.CONTROLLER_BUTTON_DPAD_RIGHT)
        else:
            driver.key(pygame.K_RIGHT)
    assert shown.piece.kind == "end"
    assert kinds == [piece.kind for piece in shown.pieces]
    assert {"boxes", "axes", "contact", "forces", "memory", "impulses", "motion", "end"} <= set(kinds)
    first = shown.pair
    if pad:
        driver.button(pygame.CONTROLLER_BUTTON_RIGHTSHOULDER)
    else:
        driver.key(pygame.K_n)
    assert shown.pair is not first
    assert shown.piece.kind == "end"


def test_pieces_are_chosen_and_followed_with_the_mouse(open_game: Open):
    driver = open_game(lambda context: PhysicsStepScene(context, fallen()))
    shown = step(driver)
    driver.frames(2)
    word = texts.STEP_PIECES["impulses"][0]
    tabs = driver.choice(word)
    assert isinstance(tabs, ChoiceRow)
    driver.click(tabs._places[list(tabs.options).index(word)].center)
    assert shown.piece.impulse is not None
    assert shown.piece.impulse.iteration == 1
    driver.click(driver.hints()[texts.HINT_NEXT_PIECE])
    assert shown.piece is shown.pieces[shown.place]
    assert shown.piece.impulse.iteration == 2


# The command


def test_the_command_opens_the_exhibit_over_the_menu(monkeypatch, tmp_path):
    opened: list[Driver] = []

    def stay(app, stop) -> int:
        driver = Driver(app)
        opened.append(driver)
        driver.frames(3)
        assert scene(driver).chosen == "drag"
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
