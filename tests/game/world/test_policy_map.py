"""The map of a policy shows what a lander would do if it were really put there."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pygame
import pytest

from ai.agent.agent import DeepQAgent
from ai.lander.environment import LanderEnv
from ai.lander.pilots import ScriptedPilot
from game.core import texts
from game.drawing.canvas import Canvas
from game.flight import networks
from game.flight.networks import Policy
from game.scenes.watch.policy_map import COLOURS, PLACES, PolicyMap
from game.scenes.watch.scene import WatchScene
from game.ui.context import Context
from game.world.camera import View
from tests.support.driver import Driver

MODELS = Path(__file__).parents[3] / "models" / "lander"
Open = Callable[..., Driver]


@pytest.fixture
def env() -> LanderEnv:
    env = LanderEnv(2, seed=3, frame_skip=1)
    env.reset()
    for _ in range(40):
        env.fly(np.array([4, 3]))
    return env


def whole(env: LanderEnv, policy: Policy) -> PolicyMap:
    """A map that is computed to its end."""
    policy_map = PolicyMap()
    policy_map.follow(env, 1, policy)
    assert not policy_map._rows, "while it is off"
    policy_map.on = True
    while policy_map.actions is None:
        policy_map.follow(env, 1, policy)
    return policy_map


@pytest.mark.parametrize("name", ["modern", "scripted"])
def test_a_place_has_the_decision_of_a_lander_that_is_really_there(env: LanderEnv, name: str):
    policy = ScriptedPilot() if name == "scripted" else DeepQAgent.load(MODELS / name)
    actions = whole(env, policy).actions
    assert actions is not None
    state = [*env.velocity[1], env.angle[1], env.angular_velocity[1]]
    compared = 0
    for (x, y), action in list(zip(PLACES.reshape(-1, 2), actions.ravel(), strict=True))[::53]:
        if y < env.lowest(x, float(env.angle[1])):
            continue
        env.begin_at(1, np.array([x, y, *state]))
        decided = networks.decide(policy, env.observe()[[1]])
        if decided.points is None or np.diff(np.sort(decided.points[0])[-2:]) > 1e-3:  # else a batch may differ
            assert decided.action[0] == action
            compared += 1
    assert compared > 25


def test_a_place_has_the_colour_of_its_action(env: LanderEnv):
    canvas = Canvas(pygame.Surface((1280, 720)))
    policy_map = whole(env, DeepQAgent.load(MODELS / "modern"))
    policy_map.draw(canvas, View(1.0))
    actions, seen = policy_map.actions, set()
    assert actions is not None
    for row in range(6, 26, 2):
        for column in range(8, 58, 2):
            around = actions[row - 1 : row + 2, column - 1 : column + 2]
            if (around != around[0, 0]).any():
                continue
            x, y = View(1.0).points(PLACES[row, column]).tolist()
            shown = np.array(canvas.surface.get_at((round(x), round(y)))[:3])
            away = [np.abs(shown - 0.5 * np.array(colour)).max() for colour in COLOURS]
            assert int(np.argmin(away)) == around[0, 0]
            seen.add(int(around[0, 0]))
    assert len(seen) >= 4


def scene(driver: Driver) -> WatchScene:
    assert isinstance(driver.top, WatchScene)
    return driver.top


def test_a_button_and_the_mouse_choose_the_map(open_game: Open, context: Context):
    driver = open_game(WatchScene, seed=2)
    assert scene(driver).flyer.network.name == "modern"
    driver.press_on(texts.MORE[0])
    driver.frames(2)
    driver.form.focus(driver.widget(texts.WATCH_MAP))
    driver.button(pygame.CONTROLLER_BUTTON_DPAD_RIGHT)
    assert scene(driver).world.policy_map.on
    driver.wait(lambda: scene(driver).world.policy_map.actions is not None)
    driver.click(driver.widget(texts.WATCH_MAP)._places[0].center)
    assert not scene(driver).world.policy_map.on
