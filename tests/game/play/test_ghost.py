from collections.abc import Callable

import numpy as np
import pygame
import pytest

from ai.flights.recording import Recording
from ai.lander.environment import PARAMS, LanderEnv, Outcome
from ai.lander.pilots import ScriptedPilot
from game.core.scene import Push
from game.flight import networks
from game.flight.choosers import Alone
from game.flight.flight import Flight
from game.flight.networks import DECISION_STEPS
from game.scenes.menus.menu import MenuScene
from game.scenes.play.ghost import Ghost
from game.scenes.play.scene import PlayScene
from game.world.camera import Camera, View
from tests.game.play.ends import end, place
from tests.support.driver import Driver
from tests.support.flights import begun, play

PAD = float(PARAMS.pad_top + PARAMS.stand + 0.01)
FALLING = (8, 3, 0, -3, 0, 0)


class Idle:
    """A rival that never touches anything."""

    def act(self, observation: np.ndarray, *, held: np.ndarray | None = None) -> np.ndarray:
        return np.zeros(len(observation), int)


@pytest.fixture
def duel(open_game: Callable[..., Driver], monkeypatch: pytest.MonkeyPatch) -> Callable[..., Driver]:
    monkeypatch.setattr(networks, "chosen", lambda *_: networks.Network("stand-in", ScriptedPilot()))

    def begin(rival: object, flown: int = 0) -> Driver:
        driver = open_game(MenuScene)
        driver.app.scenes.apply(Push(PlayScene(driver.app.context, 12, rival=rival, rival_name="checkpoint 14 s")))
        driver.frames(1)
        if flown:
            driver.post(pygame.KEYDOWN, key=pygame.K_UP, mod=0, unicode="", scancode=0)
            driver.frames(flown)
        return driver

    return begin


def ghost(driver: Driver) -> Ghost:
    found = play(driver).flown.ghost
    assert found is not None
    return found


def test_a_ghost_flies_as_the_rival_would_alone():
    pilot, ghost = ScriptedPilot(), Ghost(Flight(Recording(7, "random"), Alone(ScriptedPilot())), "pilot")
    env = LanderEnv(1, 7, frame_skip=DECISION_STEPS)
    observation = env.reset()
    assert np.array_equal(env.position, ghost.flight.env.position)
    for _ in range(60):
        observation = env.step(pilot.act(observation, held=env.actions)).observation
        for _ in range(DECISION_STEPS):
            ghost.step()
        assert np.array_equal(env.position, ghost.flight.env.position)
        assert np.array_equal(env.velocity, ghost.flight.env.velocity)


def test_both_begin_at_one_place_and_time_and_yours_is_the_same_as_without_a_ghost(duel):
    driver = duel(ScriptedPilot())
    driver.frames(30)
    mine, theirs = play(driver).flight, ghost(driver).flight
    assert np.array_equal(mine.env.position, theirs.env.position)
    assert mine.env.steps[0] == theirs.env.steps[0] == 0
    driver.post(pygame.KEYDOWN, key=pygame.K_UP, mod=0, unicode="", scancode=0)
    driver.frames(60)
    assert mine.env.steps[0] == theirs.env.steps[0] > 10
    assert not np.array_equal(mine.env.position, theirs.env.position)
    alone = begun(12)
    for push in mine.recording.pushes:
        alone.step(push)
    assert np.array_equal(alone.env.position, mine.env.position)


def test_retry_and_a_new_start_are_for_both_and_escape_leaves_after_the_end(duel):
    driver = duel(Idle())
    for key, same in ((pygame.K_r, True), (pygame.K_n, False)):
        first = play(driver).flight.env.position.copy()
        end(driver, FALLING)
        driver.key(key)
        mine, theirs = play(driver).flight, ghost(driver).flight
        assert play(driver).waiting
        assert np.array_equal(mine.env.position, theirs.env.position)
        assert np.array_equal(mine.env.position, first) is same
    end(driver, FALLING)
    driver.key(pygame.K_ESCAPE)
    assert driver.top_name == "MenuScene"


def test_a_ghost_that_still_flies_is_said_to_and_flies_on(duel):
    driver = duel(ScriptedPilot())
    end(driver, FALLING)
    assert play(driver).ending.card.compared == {"checkpoint 14 s": "still flying"}
    while not ghost(driver).flight.over:
        driver.skip()
    assert play(driver).ending.card.compared == {"checkpoint 14 s": "landed"}


def test_of_two_who_land_the_card_says_who_was_first():
    ghost, yours = Ghost(Flight(Recording(1, "random"), Alone(Idle())), "rival"), LanderEnv(1, 1, frame_skip=1)
    yours.reset()
    for env in (ghost.flight.env, yours):
        place(env, 0, PAD, 0, 0, 0, 0)
        while env.outcome[0] == Outcome.FLYING:
            env.step(np.zeros(1, int))
    ended = ghost.flight.env.steps.copy()
    for later, said in ((2.0, "2.0 s after you"), (-1.5, "1.5 s before you"), (0.0, "at the same time")):
        ghost.flight.env.steps[:] = ended + round(60 * later)
        assert said in ghost.result(yours)


def test_a_ghost_is_seen_and_marked_at_the_edge_where_the_camera_leaves_it_out(duel):
    driver = duel(Idle(), flown=60)
    canvas, ghostly = driver.app.canvas, ghost(driver)
    place = ghostly.flight.env.position[0]
    canvas.surface.fill((0, 0, 0))
    ghostly.draw(canvas, Camera().view(canvas.scale), 1.0)
    x, y = Camera().view(canvas.scale).pixels(place).astype(int).tolist()
    around = pygame.surfarray.array3d(canvas.surface)[x - 40 : x + 40, y - 40 : y + 40].astype(int)
    assert (around[..., 2] - around[..., 0]).max() > 40  # it is blue
    assert 0.05 < (around.sum(axis=2) > 30).mean() < 0.8
    for aside, marked in ((0.0, False), (60.0, True)):
        canvas.surface.fill((0, 0, 0))
        ghostly.draw(canvas, View(canvas.scale, (place[0] - aside, place[1])), 1.0)
        rim = pygame.surfarray.array3d(canvas.surface)[-canvas.px(30) :, :, 2]
        assert (rim > 100).any() is np.bool_(marked)
