"""Edges of the area: seen, heard and said before a craft leaves; and what comes down beside the pad."""

from collections.abc import Callable

import numpy as np
import pygame
import pytest

from ai.flights.recording import AREA
from ai.lander.environment import LIMITS, LanderEnv, Outcome
from ai.lander.ground import hilly
from ai.lander.rules import AREAS
from ai.lander.sensing import NEAR, near_edges
from game.audio.flight_sounds import FlightSound
from game.drawing.canvas import Canvas
from game.flight.flight import Flight, Recording
from game.flight.replay import ReplayedFlight
from game.scenes.play.words import dangers
from game.world.camera import View
from game.world.landscape.ground import draw_edges
from game.world.stage import Stage
from game.world.wreck import Wreck
from tests.support.listener import Listener


def placed(*state: float, area: int = AREA) -> LanderEnv:
    env = LanderEnv(1, 0, frame_skip=1, limits=LIMITS.in_area(area))
    env.reset()
    env.place(np.ones(1, bool), np.array([state], float))
    return env


@pytest.mark.parametrize(("state", "side"), [((27, 10, 2, 0, 0, 0), "right"), ((-27, 10, -2, 0, 0, 0), "left"),
                                             ((0, 26, 0, 2, 0, 0), "above")])  # fmt: skip
def test_an_edge_is_named_shines_and_sounds_before_it_is_crossed(state: tuple[float, ...], side: str):
    env, sound = placed(*state), Listener()
    [edge] = near_edges(env)
    assert (edge.side, edge.ahead) == (side, True)
    assert edge.away == pytest.approx(3)
    assert any("3 m" in text for text in dangers(env))
    heard = FlightSound(sound, env)
    heard.follow(np.zeros(3))
    assert "edge" in sound.heard()
    canvas = Canvas(pygame.Surface((1280, 720)))
    draw_edges(canvas, View(1.0, (0.0, 16.0), 0.6), env, (255, 90, 60))
    assert np.ptp(pygame.surfarray.array3d(canvas.surface), axis=(0, 1)).max() > 40


def test_far_from_every_edge_nothing_is_announced():
    env = placed(30 - NEAR - 1, 10, 2, 0, 0, 0)
    assert near_edges(env) == []
    canvas = Canvas(pygame.Surface((1280, 720)))
    draw_edges(canvas, View(1.0), env, (255, 90, 60))
    assert not np.ptp(pygame.surfarray.array3d(canvas.surface), axis=(0, 1)).any()


def test_people_have_more_room_and_old_recordings_the_room_they_had():
    assert all(new > old for new, old in zip(AREAS[AREA], AREAS[0], strict=True))
    assert LanderEnv(1, 0).limits == LIMITS  # networks are trained in the first area
    for area, (half_width, ceiling) in enumerate(AREAS):
        limits = ReplayedFlight(Recording(3, "random", area=area)).env.limits
        assert (limits.half_width, limits.ceiling) == (half_width, ceiling)
    old, new = (Flight(3, area=area) for area in range(2))
    for flight in (old, new):
        flight.env.place(np.ones(1, bool), np.array([[21.5, 12.0, 3.0, 0, 0, 0]]))
        for _ in range(30):
            flight.step(0)
    assert (old.outcome, new.outcome) == (Outcome.OUT_OF_BOUNDS, Outcome.FLYING)


def test_a_craft_that_is_whole_comes_to_rest_upright_beside_the_pad(subtests: pytest.Subtests):
    for seed in range(8):
        with subtests.test(seed=seed):
            rng = np.random.default_rng(seed)
            env = LanderEnv(1, seed, frame_skip=1, ground=hilly(rng) if seed % 2 else None)
            env.reset()
            for _ in range(200):
                x, lean = rng.uniform(-16, 16), rng.uniform(-0.35, 0.35)
                env.place(
                    np.ones(1, bool), np.array([[x, env.lowest(x, lean) + 0.05, rng.uniform(-1, 1), -1.0, lean, 0.0]])
                )
                while env.outcome[0] == Outcome.FLYING:
                    env.fly(np.zeros(1, int))
                if env.intact[0]:
                    break
            assert env.intact[0]
            whole = Wreck(env, 0, np.random.default_rng(0))
            for _ in range(430):
                whole.step()
            x, _, angle = whole.pose(1.0)
            assert not whole.moves
            assert abs(angle) < 1.0
            assert abs(x - env.position[0, 0]) < 2.5


def test_down_softly_beside_the_pad_is_a_touch_and_no_blast():
    env, sound = placed(9, 2.2, 0, -0.4, 0, 0), Listener()
    heard = FlightSound(sound, env)
    stage = Stage(env, np.random.default_rng(0))
    ended: Callable[[], bool] = lambda: bool(env.outcome[0] != Outcome.FLYING)  # noqa: E731
    while not ended():
        env.fly(np.zeros(1, int))
        heard.follow(np.zeros(3))
        stage.follow(np.zeros(1, bool), np.array([ended()]))
    sounds = sound.heard()
    assert "touchdown" in sounds
    assert not {"crash", "slow_crash"} & set(sounds)
    assert not stage.flash.any()
    assert stage.sprite().image != "wreck"
