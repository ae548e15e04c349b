import numpy as np
import pygame
import pytest

from ai.lander.environment import PARAMS, LanderEnv, Outcome
from ai.lander.missions import MISSIONS
from ai.lander.rules import FOOT_CENTRE, FOOT_SIZE, HULL
from engine import Sprite
from game.drawing.canvas import Canvas
from game.world import lander as art
from game.world.camera import View
from game.world.landscape.backdrop import Backdrop
from game.world.landscape.themes import LOOKS, look_of
from game.world.landscape.wind import Wind
from game.world.particles import DUST
from game.world.paths import draw_stretch
from game.world.stage import Stage


@pytest.fixture
def canvas() -> Canvas:
    return Canvas(pygame.Surface((640, 360)))


def pixels(surface: pygame.Surface) -> np.ndarray:
    return pygame.surfarray.array3d(surface)


def test_the_art_fits_the_physics():
    scale = 64.0
    craft = art.painted(scale, 0, (0, 0), art.LANDER)
    cover = pygame.surfarray.array_alpha(craft) > 128
    middle = craft.get_width() // 2
    columns, rows = np.flatnonzero(cover.any(axis=1)), np.flatnonzero(cover.any(axis=0))
    assert abs((columns[0] - middle) / scale + FOOT_CENTRE[0] + FOOT_SIZE[0] / 2) < 0.04
    assert abs((columns[-1] - middle) / scale - FOOT_CENTRE[0] - FOOT_SIZE[0] / 2) < 0.04
    assert abs((rows[-1] + 1 - middle) / scale - PARAMS.stand) < 0.03
    across = cover[:, round(middle - 0.03 * scale)]  # at the hull's widest
    assert abs((np.flatnonzero(across)[-1] - middle) / scale - max(x for x, _ in HULL)) < 0.06


@pytest.mark.parametrize("before", [(900.0, 300.0), (250.0, 900.0)])
def test_a_line_of_two_points_is_drawn_alike_whatever_was_drawn_before(canvas: Canvas, before: tuple[float, float]):
    ends = [(248.7245776677237, 302.21186801448243), (253.0597146377713, 306.56827854735695)]
    canvas.surface.fill((0, 0, 0))
    pygame.draw.aaline(canvas.surface, (200, 100, 50), *ends)
    alone = pixels(canvas.surface)
    pygame.draw.aalines(canvas.surface, (0, 0, 0), False, [*ends, before])
    canvas.surface.fill((0, 0, 0))
    draw_stretch(canvas.surface, (200, 100, 50), ends)
    assert np.array_equal(pixels(canvas.surface), alone)


def test_every_mission_has_the_sky_and_the_ground_of_its_world():
    canvas = Canvas(pygame.Surface((160, 90)))

    def colours(look: str) -> np.ndarray:
        """Mean colour above the horizon and below it, (2, 3)."""
        Backdrop(canvas.size, np.random.default_rng(7), look=LOOKS[look]).paint(canvas.surface)
        picture = pygame.surfarray.array3d(canvas.surface).astype(float)
        return np.array([picture[:, 30:65].mean(axis=(0, 1)), picture[:, 80:].mean(axis=(0, 1))])

    dawn, mars, earth, night = (colours(look_of(mission)) for mission in ("fall", "mars", "earth", "night"))
    assert (mars[:, 0] > 1.4 * mars[:, 2]).all()  # red
    assert earth[0, 2] > 1.3 * earth[0, 0]  # blue
    assert earth[1, 1] > earth[1, 0]  # green rather than grey
    assert (night.sum(axis=1) < 0.6 * dawn.sum(axis=1)).all()
    assert look_of("") == look_of("fall")
    assert set(LOOKS) >= {look_of(mission) for mission in MISSIONS}


def test_wind_is_seen_to_go_its_way_and_is_a_matter_of_time_alone():
    env = MISSIONS["wind"].begin()
    canvas, view = Canvas(pygame.Surface((640, 360))), View(0.5)
    wind = Wind(env, DUST)

    def seen(seconds: float) -> np.ndarray:
        env.steps[:] = round(60 * seconds)
        wind.follow()
        canvas.surface.fill((0, 0, 0))
        wind.draw(canvas.surface, view, 1.0)
        return pixels(canvas.surface)

    first = seen(1.0)
    assert first.any()
    assert not np.array_equal(seen(1.1), first)
    assert np.array_equal(seen(1.0), first)
    env.outcome[:] = Outcome.LANDED
    assert not np.array_equal(seen(1.0), first)  # it goes on blowing


@pytest.mark.parametrize("calm", [False, True])
def test_a_lander_is_one_sprite_and_what_a_crash_leaves_another(calm: bool):
    env = LanderEnv(1, seed=3, frame_skip=1)
    env.reset()
    stage = Stage(env, np.random.default_rng(0), calm)
    assert stage.sprite() == Sprite(env.lander, art.LANDER, art.SIZE)
    assert stage.sprite(size=0.5).size == pytest.approx((art.REACH, art.REACH))
    while env.outcome[0] == Outcome.FLYING:
        env.step(np.array([0]))
        stage.follow(np.array([False]), env.outcome != Outcome.FLYING)
    assert env.outcome[0] == Outcome.CRASHED
    wreck = stage.sprite()
    assert wreck.image == art.WRECK
    assert (wreck.body is env.lander) is calm  # otherwise it tumbles in a world of its own
    env.reset()
    stage.follow(np.array([False]), np.array([False]))
    assert stage.sprite() == Sprite(env.lander, art.LANDER, art.SIZE), "the next flight, in the same slot"
    assert stage.pose_after(1.0) is None
