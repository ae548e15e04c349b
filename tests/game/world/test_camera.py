from collections.abc import Callable

import numpy as np
import pygame
import pytest

from ai.lander.descent import LegStart
from ai.lander.environment import LIMITS, PARAMS
from ai.lander.push import KEYS
from game.drawing.canvas import Canvas
from game.drawing.paint_cache import A_FRAME, paint_on, spend, spread
from game.drawing.tokens import TEXT_SIZES, VIEW_SIZE
from game.flight.flight import Flight
from game.world import framing
from game.world.callouts import draw_factors
from game.world.camera import CLOSEST, FARTHEST, GROUND_LINE, GROUND_ROW, Camera, CameraTarget, ClearArea, View
from game.world.landscape.sheet import WorldPicture
from tests.support.flights import begun
from tests.support.landers import placed, put


def anywhere(rng: np.random.Generator) -> list[float]:
    """Any state that a flight may be in, its corners included."""
    x, y = rng.uniform(-LIMITS.half_width, LIMITS.half_width), rng.uniform(2.6, LIMITS.ceiling)
    return [x, y, *rng.uniform(-9, 9, 2).tolist(), rng.uniform(-3, 3), 0.0]


def seen(view: View, place: tuple[float, float], edge: float = 0.0) -> bool:
    x, y = view.points(place).tolist()
    return edge <= x <= VIEW_SIZE[0] - edge and edge <= y <= VIEW_SIZE[1] - edge


def test_craft_and_pad_are_in_every_shot_of_any_state():
    rng = np.random.default_rng(1)
    env = placed((0.0, 9.0))
    for _ in range(600):
        start = anywhere(rng)
        put(env, start)
        camera = Camera()
        camera.cut(framing.framed(env))
        view = camera.view(1.0)
        assert seen(view, (start[0], start[1]), 20)
        assert seen(view, (-PARAMS.pad_width / 2, PARAMS.pad_top))
        assert seen(view, (PARAMS.pad_width / 2, PARAMS.pad_top))
        assert FARTHEST <= view.zoom <= CLOSEST


def test_a_craft_that_is_faster_than_the_camera_never_leaves_the_view():
    rng = np.random.default_rng(3)
    camera = Camera()
    env = placed((0.0, 9.0))
    camera.cut(framing.framed(env))
    for _ in range(500):  # leaps across the world at every step
        start = anywhere(rng)
        put(env, start)
        framing.follow(camera, env)
        assert seen(camera.view(1.0), (start[0], start[1]))
        assert FARTHEST - 1e-9 <= camera.shot.zoom <= CLOSEST + 1e-9


def test_the_camera_comes_nearer_on_the_way_down_and_the_ground_stays_on_its_row():
    zooms = []
    for height in (18.0, 10.0, 5.0, 2.6):
        camera = Camera()
        camera.cut(framing.framed(placed((0.0, height))))
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


def test_what_is_scaled_fills_the_view_while_the_camera_pans_and_zooms_and_others_take_the_time():
    picture = pygame.Surface((4000, 160), pygame.SRCALPHA)
    picture.fill((255, 255, 255, 255))
    sheet, surface = WorldPicture(picture, 48.0), pygame.Surface(VIEW_SIZE)
    spread(A_FRAME)
    try:
        for step in range(30):
            zoom = 1.3 + 0.7 * np.sin(step / 5)  # faster than any camera
            spend(A_FRAME)
            surface.fill((0, 0, 0))
            sheet.draw(surface, View(1.0, (8 * np.sin(step / 4), 2.0), zoom, CLOSEST), (-40.0, 3.0))
            rows = np.flatnonzero(pygame.surfarray.array3d(surface)[640, :, 0] > 100)
            assert (pygame.surfarray.array3d(surface)[:, rows[len(rows) // 2], 0] > 200).all()
            assert abs(len(rows) - min(32 * zoom * 160 / 48, VIEW_SIZE[1] - rows[0])) <= 2
            paint_on()
    finally:
        spread(0)


@pytest.mark.parametrize("pads", [1, 3])
def test_over_whole_flights_the_camera_is_smooth_and_craft_and_pad_are_seen(pads: int):
    rng = np.random.default_rng(7)
    for seed in range(2):
        flight, camera, action = begun(seed, pads=pads), Camera(), 0
        flight.env.limits = LIMITS  # it ends before an edge comes into view
        camera.cut(framing.framed(flight.env))
        shots = []
        for step in range(500):
            if step % 20 == 0:
                action = int(rng.choice(6))
            flight.step(KEYS[action])
            if flight.over:
                break
            framing.follow(camera, flight.env)
            shots.append((camera.shot.across, camera.shot.zoom))
            assert seen(camera.view(1.0), tuple(flight.env.position[0]), 40)
            assert pads > 1 or seen(camera.view(1.0), flight.env.pad[0])
        assert np.abs(np.diff(shots, 2, axis=0)).max() < 0.01  # metres across, and zoom, a step in a step


# Score factors stand above their pads, readable, and brighter as one is understood to be meant.

Drawn = dict[str, tuple[pygame.FRect, float]]


@pytest.fixture
def look(monkeypatch: pytest.MonkeyPatch) -> Callable[..., Drawn]:
    canvas, drawn, write = Canvas(pygame.Surface((1280, 720))), {}, Canvas.text

    def noted(self: Canvas, string: str, *args: object, **more: object) -> pygame.FRect:
        box = write(self, string, *args, **more)
        drawn[string] = box, more["alpha"]
        return box

    monkeypatch.setattr(Canvas, "text", noted)

    def seen(flight: Flight, head: float = 104.0, zoom: float = 1.0) -> Drawn:
        drawn.clear()
        canvas.zoom = zoom
        draw_factors(canvas, view_of(), flight, flight.env.position[0], ClearArea(head=head))
        return dict(drawn)

    return seen


def view_of() -> View:
    return Camera().view(1.0)


def test_each_of_several_pads_has_its_factor_above_it_at_every_size_of_text(look):
    flight = begun(3, pads=3)
    for zoom in TEXT_SIZES.values():
        seen = look(flight, zoom=zoom)
        assert set(seen) == {"×1", "×3", "×5"}
        for pad in flight.env.ground.pads:
            box, _ = seen[f"×{pad.factor}"]
            x, deck = view_of().points((pad.x, pad.top)).tolist()
            assert box.centerx == pytest.approx(x, abs=1)
            assert deck - 60 < box.bottom < deck
            assert box.height >= 15


def test_a_factor_stands_below_its_pad_where_words_reach_down_to_it(look):
    flight = begun(3, pads=3)
    above, below = (look(flight, head) for head in (104.0, 700.0))
    for pad in flight.env.ground.pads:
        word, (_, deck) = f"×{pad.factor}", view_of().points((pad.x, pad.top)).tolist()
        assert above[word][0].bottom < deck < below[word][0].centery


def test_a_single_goal_has_none_and_a_flat_spot_brings_both(look):
    flight = begun(3)
    assert not look(flight)
    for number in range(1, 6):
        flight = begun(3, leg=LegStart(number))
        factors = {f"×{pad.factor}" for pad in flight.env.ground.pads if pad.factor}
        assert set(look(flight)) == (factors if len(factors) > 1 else set())


def test_the_pad_that_is_aimed_at_is_brightest(look):
    flight = begun(3, pads=3)
    for number, pad in enumerate(flight.env.ground.pads):
        flight.env.target[:] = number
        alphas = {word: alpha for word, (_, alpha) in look(flight).items()}
        assert max(alphas, key=alphas.__getitem__) == f"×{pad.factor}"
        assert min(alphas.values()) > 0.4  # the others can be read as well


def test_a_factor_gives_way_to_a_craft_that_comes_near(look):
    flight = begun(3, pads=3)
    pad = flight.env.ground.pads[1]
    word, alphas = f"×{pad.factor}", []
    for height in (8.0, 4.5, 3.5):
        flight.env.place(np.ones(1, bool), np.array([[pad.x, pad.top + height, 0, 0, 0, 0]]))
        alphas.append(look(flight).get(word, (None, 0.0))[1])
    assert alphas[0] > alphas[1] > alphas[2]
    flight.env.place(np.ones(1, bool), np.array([[pad.x, pad.top + 1.5, 0, 0, 0, 0]]))
    seen = look(flight)
    assert word not in seen
    assert len(seen) == 2
