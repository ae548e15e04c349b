import numpy as np
import pygame
import pytest

from ai.lander.environment import PARAMS, LanderEnv, Outcome
from ai.lander.missions import MISSIONS
from ai.lander.rules import FOOT_CENTRE, FOOT_SIZE, HULL
from game.drawing.canvas import Canvas
from game.drawing.sky import NightSky, beside
from game.world import lander as art
from game.world.camera import Camera, View
from game.world.craft import draw_crowd, stand
from game.world.flame import HUMAN_PLUME, LEVELS, plume
from game.world.landscape.backdrop import Backdrop
from game.world.landscape.pad import draw_pad
from game.world.landscape.themes import LOOKS, look_of
from game.world.landscape.wind import Wind
from game.world.particles import DUST, Particles, Relief
from game.world.paths import Trails, draw_dotted, draw_faint, draw_stretch
from game.world.stage import Stage
from tests.support.driver import Driver

SIZES = [(1280, 720), (640, 360), (1000, 800)]


@pytest.fixture
def canvas() -> Canvas:
    return Canvas(pygame.Surface((640, 360)))


def pixels(surface: pygame.Surface) -> np.ndarray:
    return pygame.surfarray.array3d(surface)


@pytest.mark.parametrize("scale", [0.5, 1.0, 1.5])
def test_metres_become_pixels_and_points_and_come_back(scale: float):
    view = View(scale, centre=(1.0, 10.0), zoom=1.2)
    places = np.array([[-20.0, 0.0], [0.0, 1.6], [3.3, 22.0]])
    assert np.allclose(view.metres(view.points(places)), places)
    assert np.allclose(view.pixels(places), view.points(places) * scale)


def test_at_rest_the_view_shows_the_whole_width_and_the_surface_stands_above_the_read_outs():
    view = Camera().view(1.0)
    left, right = view.points([[-20, PARAMS.ground], [20, PARAMS.ground]])
    assert (left[0], right[0]) == (0, 1280)
    assert 600 < left[1] < 656


@pytest.mark.parametrize("window", SIZES)
def test_the_same_chance_paints_the_same_moon(window: tuple[int, int]):
    canvas = Canvas(pygame.Surface(window))
    pictures = []
    for _ in range(2):
        Backdrop(canvas.size, np.random.default_rng(7)).draw(canvas, Camera(), 1.0)
        pictures.append(pixels(canvas.surface))
    assert np.array_equal(*pictures)
    assert pictures[0].any(axis=2).mean() > 0.99  # the whole view is painted


def test_reduced_motion_stills_the_stars_and_motion_does_not(canvas: Canvas):
    for reduced in (True, False):
        backdrop = Backdrop(canvas.size, np.random.default_rng(7), reduced)
        pictures = []
        for time in (0.0, 2.0):
            backdrop.draw(canvas, Camera(), time)
            pictures.append(pixels(canvas.surface))
        assert np.array_equal(*pictures) is reduced


def test_no_star_is_where_words_are(game: Driver):
    canvas = game.app.canvas
    moon, night = Backdrop(canvas.size, np.random.default_rng(7)), NightSky(np.random.default_rng(7), stars=900)
    words = pygame.FRect(450, 40, 700, 200)
    area = pygame.Rect(canvas.rect(*words))
    for draw in (lambda: moon.draw(canvas, Camera(), 1.0), lambda: night.draw(canvas)):
        glare = []
        for written in (False, True, False):
            if written:
                canvas.panel(words)
            canvas.turn_page()
            draw()
            picture = pixels(canvas.surface).max(axis=2).astype(int)[area.left : area.right, area.top : area.bottom]
            glare.append((picture > np.median(picture) + 60).sum())
        assert glare[1] == 0
        assert glare[0] == glare[2] > 20, "they come back when the words are gone"


def test_the_art_fits_the_physics():
    scale = 64.0
    craft = art.painted(scale, 0, (0, 0))
    cover = pygame.surfarray.array_alpha(craft) > 128
    middle = craft.get_width() // 2
    columns, rows = np.flatnonzero(cover.any(axis=1)), np.flatnonzero(cover.any(axis=0))
    assert abs((columns[0] - middle) / scale + FOOT_CENTRE[0] + FOOT_SIZE[0] / 2) < 0.04
    assert abs((columns[-1] - middle) / scale - FOOT_CENTRE[0] - FOOT_SIZE[0] / 2) < 0.04
    assert abs((rows[-1] + 1 - middle) / scale - PARAMS.stand) < 0.03
    across = cover[:, round(middle - 0.03 * scale)]  # at the hull's widest
    assert abs((np.flatnonzero(across)[-1] - middle) / scale - max(x for x, _ in HULL)) < 0.06


def test_a_small_lander_still_stands_on_its_feet():
    for angle in (0.0, 0.4):
        x, y = stand(2.0, 5.0, angle, 0.4)
        foot = np.array([x, y]) + 0.4 * PARAMS.stand * np.array([np.sin(angle), -np.cos(angle)])
        assert np.allclose(foot, np.array([2.0, 5.0]) + PARAMS.stand * np.array([np.sin(angle), -np.cos(angle)]))


def test_fire_grows_with_thrust_and_none_is_no_fire():
    assert plume(HUMAN_PLUME, 32.0, 0.3, 0.0, 0) is None
    weak, strong = (plume(HUMAN_PLUME, 32.0, 0.3, thrust, 0) for thrust in (1 / LEVELS, 1.0))
    assert weak is not None
    assert strong is not None
    assert pixels(strong[0]).sum() > 3 * pixels(weak[0]).sum()


def test_particles_move_in_update_and_never_in_draw(canvas: Canvas):
    view = Camera().view(canvas.scale)
    particles = Particles(np.random.default_rng(1), Relief(LanderEnv()), PARAMS.gravity)
    for _ in range(30):
        particles.blow(0.0, 1.0)
    particles.burst(np.array([0.0, 3.0]), np.array([1.0, -4.0]))
    pictures = []
    for _ in range(2):
        canvas.surface.fill((30, 30, 40))
        particles.draw(canvas.surface, view, 0.5)
        pictures.append(pixels(canvas.surface))
    assert np.array_equal(*pictures)
    for _ in range(300):
        particles.update()
    canvas.surface.fill((30, 30, 40))
    particles.draw(canvas.surface, view, 1.0)
    assert (pixels(canvas.surface) == (30, 30, 40)).all()  # all gone


@pytest.mark.parametrize("count", [1, 16])
def test_everything_draws_and_draws_alike_twice(canvas: Canvas, count: int):
    env = LanderEnv(count, 3, frame_skip=1)
    env.reset()
    stage, trails = Stage(env, np.random.default_rng(0)), Trails(count)
    nobody = np.zeros(count, bool)
    for _ in range(90):
        env.step(np.full(count, 4))
        stage.follow(~nobody, nobody)
        trails.follow(env.position, env.outcome, nobody, nobody)
    trails.follow(env.position, env.outcome, nobody, ~nobody)
    view = Camera().view(canvas.scale)
    poses = np.concatenate([env.position, env.angle[:, None]], axis=1)
    pictures = []
    for _ in range(2):
        canvas.surface.fill((10, 10, 20))
        draw_pad(canvas, view, (0.0, 1.6), 6.0, 0.4)
        trails.draw(canvas, view, 0)
        draw_dotted(canvas, view, np.array([[0.0, 12.0], [2.0, 9.0], [3.0, 2.0]]), (255, 196, 112))
        stage.draw_fires(canvas, view, poses, ~nobody, 0.5)
        draw_crowd(canvas, view, poses[~nobody], 0.5)
        stage.draw_lander(canvas, view, poses[0])
        stage.draw_dust(canvas, view, 0.5)
        pictures.append(pixels(canvas.surface))
    assert np.array_equal(*pictures)


def test_a_line_fades_out_below_the_words_at_the_head(canvas: Canvas):
    upright = np.stack([np.full(91, 320.0), np.arange(-30.0, 331.0, 4.0)], axis=1)
    canvas.surface.fill((0, 0, 0))
    draw_faint(canvas.surface, upright, (255, 255, 255), 1.0, head=100.0)
    light = pixels(canvas.surface)[320, :, 0].astype(int)
    assert not light[:98].any()
    assert (light[170:320] > 240).all()
    assert (np.diff(light[100:170]) >= 0).all()


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
    canvas = Canvas(pygame.Surface((320, 180)))

    def colours(look: str) -> np.ndarray:
        """Mean colour above the horizon and below it, (2, 3)."""
        Backdrop(canvas.size, np.random.default_rng(7), reduced_motion=True, look=LOOKS[look]).paint(canvas.surface)
        picture = pygame.surfarray.array3d(canvas.surface).astype(float)
        return np.array([picture[:, 60:130].mean(axis=(0, 1)), picture[:, 160:].mean(axis=(0, 1))])

    dawn, mars, earth, night = (colours(look_of(mission)) for mission in ("fall", "mars", "earth", "night"))
    assert (mars[:, 0] > 1.4 * mars[:, 2]).all()  # red
    assert earth[0, 2] > 1.3 * earth[0, 0]  # blue
    assert earth[1, 1] > earth[1, 0]  # green rather than grey
    assert (night.sum(axis=1) < 0.6 * dawn.sum(axis=1)).all()
    assert np.array_equal(colours(look_of("")), dawn)
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


def test_what_is_beside_words_lies_in_no_box():
    words = [pygame.Rect(10, 10, 20, 5), pygame.Rect(40, 0, 1, 1)]
    places = np.array([[10.0, 10.0], [29.9, 14.9], [30.0, 12.0], [20.0, 15.0], [40.5, 0.5], [0.0, 0.0]])
    assert beside(places, words).tolist() == [False, False, True, True, False, True]
    assert beside(places, []).all()
