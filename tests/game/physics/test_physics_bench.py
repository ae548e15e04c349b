"""The gallery's sliders and plot, and the screen of one step, by mouse, keyboard and gamepad."""

from collections.abc import Callable

import numpy as np
import pygame
import pytest

from game.core import texts
from game.drawing.tokens import HUMAN
from game.scenes.physics.scene import GRAVITIES, PhysicsScene
from game.scenes.physics.step_scene import PhysicsStepScene
from game.ui.rows import ChoiceRow
from game.ui.widgets import Slider, TextButton
from game.world.bodies import scale_force
from tests.support.driver import Driver
from tests.support.screens import fallen
from tests.support.written import words_written

Open = Callable[..., Driver]
MOON, EARTH = GRAVITIES


def gallery(driver: Driver) -> PhysicsScene:
    assert isinstance(driver.top, PhysicsScene)
    return driver.top


def step(driver: Driver) -> PhysicsStepScene:
    assert isinstance(driver.top, PhysicsStepScene)
    return driver.top


def slider(driver: Driver, name: str) -> Slider:
    found = driver.widget(texts.QUANTITIES[name][0])
    assert isinstance(found, Slider)
    return found


def press(driver: Driver, label: str) -> None:
    """Click on a word of the form."""
    box = driver.widget(label).box
    driver.click((box.left + 6, box.centery))


# Quantities


def test_a_slider_is_dragged_and_the_exhibit_begins_anew_with_its_value(open_game: Open):
    driver = open_game(PhysicsScene, "slopes")
    driver.frames(30)
    box = slider(driver, "degrees").box
    driver.move((box.left + 200, box.centery))
    driver.post(pygame.MOUSEBUTTONDOWN, pos=driver.to_window((box.left + 150, box.centery)), button=1)
    for x in (160, 170, 180):
        driver.move((box.left + x, box.centery))
    driver.post(pygame.MOUSEBUTTONUP, pos=driver.to_window((box.left + 180, box.centery)), button=1)
    driver.frames(2)
    exhibit = gallery(driver).exhibit
    assert exhibit.values["degrees"] == slider(driver, "degrees").value < 30
    assert exhibit.steps < 5
    assert np.degrees(exhibit.boxes[0].angle[0]) == pytest.approx(-exhibit.values["degrees"], abs=0.1)  # type: ignore[attr-defined]


@pytest.mark.parametrize("pad", [False, True])
def test_a_quantity_is_changed_without_a_mouse_and_put_back(open_game: Open, pad: bool):
    driver = open_game(PhysicsScene, "bounce")

    def go(key: int, button: int) -> None:
        if pad:
            driver.button(button)
        else:
            driver.key(key)

    go(pygame.K_DOWN, pygame.CONTROLLER_BUTTON_DPAD_DOWN)  # into the room, and up again on its other side
    for _ in range(4):
        if driver.form.focused is not slider(driver, "restitution"):
            go(pygame.K_UP, pygame.CONTROLLER_BUTTON_DPAD_UP)
    assert driver.form.focused is slider(driver, "restitution")
    go(pygame.K_LEFT, pygame.CONTROLLER_BUTTON_DPAD_LEFT)
    driver.frames(2)
    assert gallery(driver).exhibit.values["restitution"] == pytest.approx(0.7)
    assert "e = 0.70" in texts.EXHIBITS["bounce"][2]["falling"].format(**gallery(driver).exhibit.figures())
    while driver.form.focused is not driver.widget(texts.LAW_START_VALUES):
        go(pygame.K_DOWN, pygame.CONTROLLER_BUTTON_DPAD_DOWN)
    go(pygame.K_RETURN, pygame.CONTROLLER_BUTTON_A)
    assert gallery(driver).exhibit.values["restitution"] == 0.75
    assert slider(driver, "restitution").value == 0.75


def test_values_stay_while_other_exhibits_are_looked_at(open_game: Open):
    driver = open_game(PhysicsScene, "spin")
    slider(driver, "reach").set(0.5)
    driver.frames(2)
    driver.keys(pygame.K_n, pygame.K_b)
    assert gallery(driver).exhibit.values == {"reach": 0.5, "impulse": 0.4}
    assert slider(driver, "reach").value == 0.5


def test_an_exhibit_of_many_bodies_waits_until_the_slider_rests(open_game: Open):
    driver = open_game(PhysicsScene, "heap")
    driver.frames(5)
    first = gallery(driver).exhibit
    slider(driver, "count").set(40.0)
    driver.frames(3)
    assert gallery(driver).exhibit is first
    driver.frames(6)
    assert len(gallery(driver).exhibit.bodies) == 40


# The plot


def test_a_run_adds_its_point_to_the_plot(open_game: Open):
    driver = open_game(PhysicsScene, "spin")
    driver.key(pygame.K_g)
    panel = gallery(driver).bench.panel
    assert panel is not None
    assert panel.points == []
    driver.frames(40)
    [(value, result)] = panel.points
    assert (value, result) == (1.2, pytest.approx(panel.law))
    gallery(driver).draw(driver.app.canvas, 1.0)
    box = panel.box
    pixels = pygame.surfarray.array3d(driver.app.canvas.surface)[box.left : box.right, box.top : box.bottom]
    assert int((np.abs(pixels.astype(int) - HUMAN).max(axis=2) < 12).sum()) > 15
    slider(driver, "impulse").set(0.8)  # the plot turns to the quantity changed last
    driver.frames(40)
    panel = gallery(driver).bench.panel
    assert panel is not None
    assert panel.name == "impulse"
    assert [value for value, _ in panel.points] == [0.4, 0.8]
    driver.key(pygame.K_g)
    assert gallery(driver).bench.panel is None


def test_the_whole_range_is_measured_while_the_exhibit_waits(open_game: Open):
    driver = open_game(PhysicsScene, "spin")
    press(driver, texts.LAW_PLOT)
    press(driver, texts.LAW_MEASURE)
    bench = gallery(driver).bench
    assert bench.measuring is not None
    assert bench.panel is not None
    before = gallery(driver).exhibit.steps
    driver.wait(lambda: bench.measuring is None)
    assert gallery(driver).exhibit.steps <= before + 2
    assert len(bench.panel.points) == 9
    assert isinstance(driver.widget(texts.LAW_MEASURE), TextButton)  # offered again


def test_measuring_can_be_stopped_and_what_was_measured_stays(open_game: Open):
    driver = open_game(PhysicsScene, "heap")
    press(driver, texts.LAW_PLOT)
    press(driver, texts.LAW_MEASURE)
    driver.frames(3)
    press(driver, texts.LAW_CANCEL)
    assert gallery(driver).bench.measuring is None
    steps = gallery(driver).exhibit.steps
    driver.frames(5)
    assert gallery(driver).exhibit.steps > steps


def test_nothing_is_gripped_through_the_panel(open_game: Open):
    driver = open_game(PhysicsScene, "stack")
    scene = gallery(driver)
    driver.key(pygame.K_g)
    assert scene.bench.panel is not None
    places = [tuple(scene.view(1.0).points(body.position[0]).tolist()) for body in scene.exhibit.bodies]
    place = next(place for place in places if scene.bench.covers(place))
    driver.post(pygame.MOUSEBUTTONDOWN, pos=driver.to_window(place), button=1)
    assert scene.grip is None
    driver.key(pygame.K_g)
    driver.post(pygame.MOUSEBUTTONDOWN, pos=driver.to_window(place), button=1)
    assert scene.grip is not None


@pytest.mark.parametrize("gravity", GRAVITIES)
def test_the_legend_of_forces_has_the_scale_of_the_lines(gravity: float):
    force, length = scale_force(gravity)
    assert 24 < length <= 60
    assert length / force == pytest.approx(6.0 / gravity)


# One step


def test_the_step_is_opened_from_the_gallery_and_left_again(open_game: Open):
    driver = open_game(PhysicsScene, "stack")
    driver.frames(30)
    driver.key(pygame.K_SPACE)
    below = gallery(driver)
    poses = below.exhibit.poses
    press(driver, texts.LAW_STEP)
    record = step(driver).record
    driver.key(pygame.K_ESCAPE)
    assert driver.top is below
    assert np.array_equal(below.exhibit.poses, poses)
    driver.frames(40)
    driver.key(pygame.K_PERIOD)
    assert below.exhibit.poses.tobytes() == record.after[0].tobytes()  # as the last piece says


@pytest.mark.parametrize("pad", [False, True])
def test_pieces_are_walked_through_without_a_mouse(open_game: Open, pad: bool):
    driver = open_game(lambda context: PhysicsStepScene(context, fallen()))
    scene = step(driver)
    kinds = []
    for _ in range(len(scene.pieces)):
        kinds.append(scene.piece.kind)
        if pad:
            driver.button(pygame.CONTROLLER_BUTTON_DPAD_RIGHT)
        else:
            driver.key(pygame.K_RIGHT)
    assert scene.piece.kind == "end"
    assert kinds == [piece.kind for piece in scene.pieces]
    assert {"boxes", "axes", "contact", "forces", "memory", "impulses", "motion", "end"} <= set(kinds)
    first = scene.pair
    if pad:
        driver.button(pygame.CONTROLLER_BUTTON_RIGHTSHOULDER)
    else:
        driver.key(pygame.K_n)
    assert scene.pair is not first
    assert scene.piece.kind == "end"


def test_pieces_are_chosen_and_followed_with_the_mouse(open_game: Open):
    driver = open_game(lambda context: PhysicsStepScene(context, fallen()))
    scene = step(driver)
    driver.frames(2)
    word = texts.STEP_PIECES["impulses"][0]
    tabs = driver.choice(word)
    assert isinstance(tabs, ChoiceRow)
    driver.click(tabs._places[list(tabs.options).index(word)].center)
    assert scene.piece.kind == "impulses"
    assert scene.piece.impulse is not None
    assert scene.piece.impulse.iteration == 1
    driver.click(driver.hints()[texts.HINT_NEXT_PIECE])
    assert scene.piece is scene.pieces[scene.place]
    assert scene.piece.impulse.iteration == 2


# What stands on the screen


def test_f1_explains_one_thing_after_the_other(open_game: Open, monkeypatch: pytest.MonkeyPatch):
    driver, words = open_game(PhysicsScene, "stack"), words_written(monkeypatch)
    explained = gallery(driver).explained
    driver.key(pygame.K_F1)
    assert explained.stepping
    told = set()
    for _ in range(12):
        words.clear()
        driver.frames(1)
        told |= {what for what in texts.EXPLAIN_PHYSICS.values() if what[:20] in " ".join(words)}
        driver.key(pygame.K_F1)
    assert told == set(texts.EXPLAIN_PHYSICS.values())
    driver.key(pygame.K_ESCAPE)
    assert not gallery(driver).explained.stepping


def test_what_flies_behind_the_controls_is_not_gripped_there(open_game: Open):
    driver = open_game(PhysicsScene, "stack")
    scene = gallery(driver)
    [box, *_] = scene.exhibit.bodies
    for y, gripped in ((140.0, False), (170.0, True)):
        place = (430.0, y)
        box.position = scene.view(1.0).metres(place)
        scene.playback.stopped = True
        scene.playback.step()
        driver.post(pygame.MOUSEBUTTONDOWN, pos=driver.to_window(place), button=1)
        assert (scene.grip is not None) is gripped
        driver.post(pygame.MOUSEBUTTONUP, pos=driver.to_window(place), button=1)


def test_the_plot_follows_the_size_of_text(open_game: Open):
    driver = open_game(PhysicsScene, "stack")
    driver.key(pygame.K_g)
    before = gallery(driver).bench.panel
    driver.key(pygame.K_ESCAPE)
    assert driver.top_name == "PauseScene"
    driver.key(pygame.K_ESCAPE)
    assert gallery(driver).bench.panel is not before
