import math

import numpy as np
import pytest

from ai.lander.conditions import Conditions
from ai.lander.environment import LIMITS, PARAMS, LanderEnv
from ai.lander.ground import Ground, hilly
from game.drawing.tokens import VIEW_SIZE
from game.flight.flight import Flight
from game.world import framing
from game.world.camera import CLOSEST, GROUND_LINE, GROUND_ROW, WIDEST, Camera, CameraTarget, ClearArea, View
from game.world.landscape.sheet import WorldPicture


def placed(start: list[float], ground: Ground | None = None, conditions: Conditions | None = None) -> LanderEnv:
    env = LanderEnv(1, 0, frame_skip=1, ground=ground, conditions=conditions or Conditions())
    env.reset()
    env.place(np.ones(1, bool), np.array([start]))
    return env


def anywhere(rng: np.random.Generator) -> list[float]:
    """Any state that a flight may be in, its corners included."""
    x, y = rng.uniform(-LIMITS.half_width, LIMITS.half_width), rng.uniform(2.6, LIMITS.ceiling)
    return [x, y, *rng.uniform(-9, 9, 2).tolist(), rng.uniform(-3, 3), 0.0]


def seen(view: View, place: tuple[float, float], edge: float = 0.0) -> bool:
    x, y = view.points(place).tolist()
    return edge <= x <= VIEW_SIZE[0] - edge and edge <= y <= VIEW_SIZE[1] - edge


def test_craft_and_pad_are_in_every_shot_of_any_state():
    rng = np.random.default_rng(1)
    env = placed([0.0, 9.0, 0, 0, 0, 0])
    for _ in range(3000):
        start = anywhere(rng)
        env.place(np.ones(1, bool), np.array([start]))
        camera = Camera()
        camera.cut(framing.framed(env))
        view = camera.view(1.0)
        assert seen(view, (start[0], start[1]), 20)
        assert seen(view, (-PARAMS.pad_width / 2, PARAMS.pad_top))
        assert seen(view, (PARAMS.pad_width / 2, PARAMS.pad_top))
        assert WIDEST <= view.zoom <= CLOSEST


@pytest.mark.parametrize("ground", [hilly(np.random.default_rng(seed)) for seed in range(3)])
def test_of_several_pads_the_one_below_is_in_the_shot(ground: Ground):
    rng = np.random.default_rng(2)
    env = placed([0.0, 9.0, 0, 0, 0, 0], ground)
    for _ in range(500):
        pad = ground.pads[rng.integers(len(ground.pads))]
        env.place(np.ones(1, bool), np.array([[pad.x + rng.uniform(-4, 4), rng.uniform(6, 20), 0, 0, 0, 0]]))
        camera = Camera()
        camera.cut(framing.framed(env))
        assert seen(camera.view(1.0), (pad.left, pad.top))
        assert seen(camera.view(1.0), (pad.right, pad.top))


def test_a_moving_pad_is_followed():
    env = placed([3.0, 8.0, 0, 0, 0, 0], conditions=Conditions(swing=4.0, swing_period=18.0))
    for _ in range(270):
        env.step(np.array([3]))
    camera = Camera()
    camera.cut(framing.framed(env))
    assert seen(camera.view(1.0), (float(env.pad[0, 0]) + 3.0, float(env.pad[0, 1])))


def test_a_craft_that_is_faster_than_the_camera_never_leaves_the_view():
    rng = np.random.default_rng(3)
    camera = Camera()
    env = placed([0.0, 9.0, 0, 0, 0, 0])
    camera.cut(framing.framed(env))
    for _ in range(2000):  # leaps across the world at every step
        start = anywhere(rng)
        env.place(np.ones(1, bool), np.array([start]))
        framing.follow(camera, env)
        assert seen(camera.view(1.0), (start[0], start[1]))
        assert WIDEST - 1e-9 <= camera.shot.zoom <= CLOSEST + 1e-9


def test_the_camera_comes_nearer_on_the_way_down_and_the_ground_stays_on_its_row():
    zooms = []
    for height in (18.0, 10.0, 5.0, 2.6):
        camera = Camera()
        camera.cut(framing.framed(placed([0.0, height, 0, 0, 0, 0])))
        view = camera.view(1.0)
        zooms.append(view.zoom)
        assert view.points((3.0, GROUND_LINE))[1] == pytest.approx(GROUND_ROW)
    assert zooms == sorted(zooms)
    assert zooms[0] < 1.1
    assert zooms[-1] == CLOSEST


def test_the_camera_reaches_a_shot_that_stays_without_going_past_it():
    camera = Camera()
    camera.cut(CameraTarget(-8.0, 0.8))
    shots = []
    for _ in range(360):
        camera.follow(CameraTarget(5.0, 1.9))
        shots.append(camera.shot)
    across, zoom = np.array([shot.across for shot in shots]), np.array([shot.zoom for shot in shots])
    assert (np.diff(across) > 0).all()
    assert (np.diff(zoom) > 0).all()
    assert across[-1] == pytest.approx(5.0, abs=0.01)
    assert zoom[-1] == pytest.approx(1.9, abs=0.01)
    assert np.abs(np.diff(across, 2)).max() < 0.03  # and never jerks: metres a step, in a step


def test_two_cameras_that_see_the_same_move_the_same_and_drawing_moves_none():
    cameras = [Camera(), Camera()]
    for camera in cameras:
        camera.cut(CameraTarget())
    for step in range(100):
        for camera in cameras:
            camera.follow(CameraTarget(math.sin(step / 9), 1.4))
        cameras[0].view(1.0, 0.3)
    assert cameras[0].view(1.0, 0.5) == cameras[1].view(1.0, 0.5)


def test_a_picture_in_between_lies_between():
    camera = Camera()
    camera.cut(CameraTarget())
    for _ in range(20):
        camera.follow(CameraTarget(9.0, 1.6))
    places = [camera.view(1.0, alpha).centre[0] for alpha in (0.0, 0.5, 1.0)]
    assert places == sorted(places)
    assert places[0] < places[2]


def test_a_blow_shakes_the_view_a_little_and_not_for_long():
    camera = Camera()
    camera.cut(CameraTarget())
    camera.shake(9.0)
    away = []
    for _ in range(120):
        camera.follow(CameraTarget())
        away.append(np.abs(camera.view(1.0).points((0.0, 5.0)) - View(1.0).points((0.0, 5.0))).max())
    assert 2.0 < max(away) <= 9.0
    assert max(away[30:]) < 1.0
    assert max(away[60:]) == 0.0


def test_a_camera_that_is_given_nothing_rests():
    assert Camera().view(1.5) == View(1.5)


def test_what_is_scaled_stays_where_it_belongs():
    import pygame

    picture = pygame.Surface((960, 96), pygame.SRCALPHA)
    picture.fill((0, 0, 0, 0))
    picture.fill((255, 255, 255, 255), (480, 48, 48, 48))  # 1 m square, its corner at (0, 4)
    sheet = WorldPicture(picture, 48.0)
    for zoom, across in ((0.8, 0.0), (1.0, 2.0), (1.5, -1.3), (2.0, 4.0)):
        view = View(1.0, (across, 5.0), zoom, CLOSEST)
        surface = pygame.Surface(VIEW_SIZE)
        sheet.draw(surface, view, (-10.0, 5.0))
        rows, columns = np.nonzero(pygame.surfarray.array3d(surface)[..., 0].T > 128)
        x, y = view.pixels((0.0, 4.0)).tolist()
        assert abs(columns.min() - x) <= 1.5
        assert abs(rows.min() - y) <= 1.5
        assert abs(columns.max() + 1 - x - 32 * zoom) <= 1.5


def test_what_is_scaled_fills_the_view_while_the_camera_pans_and_zooms_and_others_take_the_time():
    import pygame

    from game.drawing.paint_cache import A_FRAME, paint_on, spend, spread

    picture = pygame.Surface((4000, 160), pygame.SRCALPHA)
    picture.fill((255, 255, 255, 255))
    sheet, surface = WorldPicture(picture, 48.0), pygame.Surface(VIEW_SIZE)
    spread(A_FRAME)
    try:
        for step in range(240):
            zoom = 1.3 + 0.7 * np.sin(step / 20)  # faster than any camera
            spend(A_FRAME)
            surface.fill((0, 0, 0))
            sheet.draw(surface, View(1.0, (8 * np.sin(step / 15), 2.0), zoom, CLOSEST), (-40.0, 3.0))
            rows = np.flatnonzero(pygame.surfarray.array3d(surface)[640, :, 0] > 100)
            assert (pygame.surfarray.array3d(surface)[:, rows[len(rows) // 2], 0] > 200).all()
            assert abs(len(rows) - min(32 * zoom * 160 / 48, VIEW_SIZE[1] - rows[0])) <= 2
            paint_on()
    finally:
        spread(0)


def test_every_flight_begins_with_all_its_pads_in_view(subtests: pytest.Subtests):
    for seed in range(12):
        with subtests.test(seed=seed):
            env = Flight(seed, pads=3).env
            view = framing.framed(env, clear=ClearArea(head=196.0)).view(1.0)
            assert all(seen(view, (edge, pad.top)) for pad in env.ground.pads for edge in (pad.left, pad.right))


@pytest.mark.parametrize("pads", [1, 3])
def test_over_whole_flights_the_camera_is_smooth_and_craft_and_pad_are_seen(pads: int):
    rng = np.random.default_rng(7)
    for seed in range(3):
        flight, camera, action = Flight(seed, pads=pads, area=0), Camera(), 0
        camera.cut(framing.framed(flight.env))
        shots = []
        for step in range(500):
            if step % 20 == 0:
                action = int(rng.choice(6))
            flight.step(action)
            if flight.over:
                break
            framing.follow(camera, flight.env)
            shots.append((camera.shot.across, camera.shot.zoom))
            assert seen(camera.view(1.0), tuple(flight.env.position[0]), 40)
            assert pads > 1 or seen(camera.view(1.0), flight.env.pad[0])
        assert np.abs(np.diff(shots, 2, axis=0)).max() < 0.01  # metres across, and zoom, a step in a step
