from collections.abc import Callable

import numpy as np
import pygame
import pytest

from ai.lander.environment import PARAMS, LanderEnv, Outcome
from ai.lander.pilots import ScriptedPilot
from game.core.scene import Push
from game.flight import networks
from game.flight.flight import DECISION_STEPS, Flight
from game.scenes.menus.menu import MenuScene
from game.scenes.play.ghost import Ghost
from game.scenes.play.scene import PlayScene
from game.world.camera import Camera, View
from tests.support.driver import Driver

Open = Callable[..., Driver]
MAIN = pygame.K_UP
PAD = float(PARAMS.pad_top + PARAMS.stand + 0.01)


class Idle:
    """A rival that never touches anything."""

    def act(self, observation: np.ndarray, *, held: np.ndarray | None = None) -> np.ndarray:
        return np.zeros(len(observation), int)


@pytest.fixture
def duel(open_game: Open, monkeypatch: pytest.MonkeyPatch) -> Callable[..., Driver]:
    monkeypatch.setattr(networks, "chosen", lambda *_: networks.Network("stand-in", ScriptedPilot()))

    def begin(rival: object, seed: int = 12) -> Driver:
        driver = open_game(MenuScene)
        play = PlayScene(driver.app.context, seed, rival=rival, rival_name="checkpoint 14 s")
        driver.app.scenes.apply(Push(play))
        driver.frames(1)
        return driver

    return begin


def scene(driver: Driver) -> PlayScene:
    assert isinstance(driver.top, PlayScene)
    return driver.top


def ghost(driver: Driver) -> Ghost:
    found = scene(driver).flown.ghost
    assert found is not None
    return found


def press(driver: Driver, key: int) -> None:
    driver.post(pygame.KEYDOWN, key=key, mod=0, unicode="", scancode=0)


def end(driver: Driver, *start: float) -> None:
    """Bring the player's own flight to its end from a state near the ground."""
    play = scene(driver)
    play.flown.waiting = False
    play.flight.env.place(np.ones(1, bool), np.array([start]))
    while play.ending.shown < 1:
        driver.skip()


def test_a_ghost_flies_as_the_rival_would_alone():
    pilot, ghost = ScriptedPilot(), Ghost(Flight(7, ScriptedPilot()), "pilot")
    env = LanderEnv(1, 7, frame_skip=DECISION_STEPS)
    observation = env.reset()
    assert np.array_equal(env.position, ghost.flight.env.position)
    for _ in range(60):
        observation = env.step(pilot.act(observation, held=env.actions)).observation
        for _ in range(DECISION_STEPS):
            ghost.step()
        assert np.array_equal(env.position, ghost.flight.env.position)
        assert np.array_equal(env.velocity, ghost.flight.env.velocity)


def test_both_begin_at_one_place_and_at_one_time(duel):
    driver = duel(ScriptedPilot())
    driver.frames(30)
    mine, theirs = scene(driver).flight, ghost(driver).flight
    assert np.array_equal(mine.env.position, theirs.env.position)
    assert mine.env.steps[0] == theirs.env.steps[0] == 0
    press(driver, MAIN)
    driver.frames(20)
    assert mine.env.steps[0] == theirs.env.steps[0] > 10
    assert not np.array_equal(mine.env.position, theirs.env.position)


def test_your_flight_is_the_same_with_a_ghost_and_without(duel, open_game: Open):
    with_ghost = duel(ScriptedPilot())
    press(with_ghost, MAIN)
    with_ghost.frames(90)
    recording = scene(with_ghost).flight.recording
    alone = Flight(12)
    for action in recording.actions:
        alone.step(action)
    assert np.array_equal(alone.env.position, scene(with_ghost).flight.env.position)


def test_escape_leaves_before_the_start_and_after_the_end(duel):
    driver = duel(Idle())
    driver.key(pygame.K_ESCAPE)
    assert driver.top_name == "MenuScene"
    driver = duel(Idle())
    end(driver, 8, 3, 0, -3, 0, 0)
    driver.key(pygame.K_ESCAPE)
    assert driver.top_name == "MenuScene"


@pytest.mark.parametrize(("key", "same"), [(pygame.K_r, True), (pygame.K_n, False)])
def test_retry_and_a_new_start_are_for_both(duel, key: int, same: bool):
    driver = duel(Idle())
    first = scene(driver).flight.env.position.copy()
    end(driver, 8, 3, 0, -3, 0, 0)
    driver.key(key)
    mine, theirs = scene(driver).flight, ghost(driver).flight
    assert scene(driver).waiting
    assert np.array_equal(mine.env.position, theirs.env.position)
    assert np.array_equal(mine.env.position, first) is same


def test_a_ghost_that_still_flies_has_no_figures_and_flies_on(duel):
    driver = duel(ScriptedPilot())
    end(driver, 8, 3, 0, -3, 0, 0)
    yours = scene(driver).flight.env
    row = ghost(driver).row(yours)
    assert (row.result, row.figures) == ("still flying", {})
    driver.skip(1200)
    assert ghost(driver).row(yours).result == "landed"


@pytest.mark.parametrize(
    ("later", "said"), [(2.0, "2.0 s after you"), (-1.5, "1.5 s before you"), (0.0, "at the same time")]
)
def test_of_two_who_land_the_card_says_who_was_first(later: float, said: str):
    ghost, yours = Ghost(Flight(1, Idle()), "rival"), LanderEnv(1, 1, frame_skip=1)
    yours.reset()
    for env in (ghost.flight.env, yours):
        env.place(np.ones(1, bool), np.array([[0, PAD, 0, 0, 0, 0]]))
        while env.outcome[0] == Outcome.FLYING:
            env.step(np.zeros(1, int))
    ghost.flight.env.steps[0] += round(60 * later)
    assert said in ghost.row(yours).result


def test_a_ghost_is_seen(duel):
    driver = duel(Idle())
    press(driver, MAIN)
    driver.frames(60)
    canvas, ghostly = driver.app.canvas, ghost(driver)
    canvas.surface.fill((0, 0, 0))
    ghostly.draw(canvas, Camera().view(canvas.scale), 1.0)
    x, y = Camera().view(canvas.scale).pixels(ghostly.flight.env.position[0]).astype(int).tolist()
    around = pygame.surfarray.array3d(canvas.surface)[x - 40 : x + 40, y - 40 : y + 40].astype(int)
    assert (around[..., 2] - around[..., 0]).max() > 100  # the rim is blue
    assert 0.05 < (around.sum(axis=2) > 30).mean() < 0.8


def test_a_ghost_that_the_camera_leaves_out_is_marked_at_the_edge(duel):
    driver = duel(Idle())
    press(driver, MAIN)
    driver.frames(20)
    canvas, ghostly = driver.app.canvas, ghost(driver)
    x, y = ghostly.flight.env.position[0].tolist()
    for aside, marked in ((0.0, False), (60.0, True)):
        canvas.surface.fill((0, 0, 0))
        ghostly.draw(canvas, View(canvas.scale, (x - aside, y)), 1.0)
        rim = pygame.surfarray.array3d(canvas.surface)[-canvas.px(30) :, :, 2]
        assert (rim > 100).any() is np.bool_(marked)
