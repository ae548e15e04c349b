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
from game.scenes.watch.policy_map import COLOURS, PolicyMap
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


def whole(policy_map: PolicyMap, env: LanderEnv, policy: Policy, most: int = 200) -> int:
    """Compute a whole map; return in how many updates."""
    before = policy_map.cells
    for update in range(1, most):
        policy_map.follow(env, 1, policy)
        if policy_map.cells is not before:
            return update
    raise AssertionError("no whole map")


@pytest.mark.parametrize("name", ["modern", "classic", "scripted"])
def test_a_cell_is_the_decision_of_a_lander_that_is_really_there(env: LanderEnv, name: str):
    policy = ScriptedPilot() if name == "scripted" else DeepQAgent.load(MODELS / name)
    policy_map = PolicyMap()
    policy_map.on = True
    whole(policy_map, env, policy)
    cells = policy_map.cells
    assert cells is not None
    state = [*env.velocity[1], env.angle[1], env.angular_velocity[1]]
    places = cells.places.reshape(-1, 2)
    compared = 0
    for number in range(0, len(places), 53):
        x, y = places[number]
        if y < env.lowest(x, float(env.angle[1])):
            continue
        env.begin_at(1, np.array([x, y, *state]))
        decided = networks.decide(policy, env.observe()[[1]])
        assert np.array_equal(decided.observation[0], cells.decision.observation[number])
        if decided.points is None:
            assert decided.action[0] == cells.decision.action[number]
        else:
            assert cells.decision.points is not None
            values = np.sort(decided.points[0])
            if values[-1] - values[-2] > 1e-3:  # else a batch may round the other way
                assert decided.action[0] == cells.decision.action[number]
            assert cells.decision.points[number].max() == pytest.approx(values[-1], abs=1e-3)
        compared += 1
    assert compared > 25


def test_it_is_computed_in_pieces_and_only_when_something_has_changed(env: LanderEnv):
    policy, policy_map = DeepQAgent.load(MODELS / "modern"), PolicyMap()
    asked: list[int] = []

    class Counted:
        network = policy.network

        def act(self, observation, *, held=None):
            raise NotImplementedError

        def q_values(self, observation):
            raise NotImplementedError

        def decide(self, observation, *, held=None):
            asked.append(len(observation))
            return policy.decide(observation, held=held)

    policy_map.follow(env, 1, Counted())
    assert not asked  # while it is off
    policy_map.on = True
    updates = whole(policy_map, env, Counted())
    assert updates - 1 == len(asked) > 4
    assert max(asked) < 300
    for _ in range(50):
        policy_map.follow(env, 1, Counted())
    assert len(asked) == updates - 1  # a lander that stands still needs no new map
    env.fly(np.array([0, 0]))
    assert whole(policy_map, env, Counted()) <= updates


def test_a_place_has_the_colour_of_its_action(env: LanderEnv):
    canvas = Canvas(pygame.Surface((1280, 720)))
    policy_map = PolicyMap()
    policy_map.on = True
    whole(policy_map, env, DeepQAgent.load(MODELS / "modern"))
    policy_map.draw(canvas, View(1.0))
    cells = policy_map.cells
    assert cells is not None
    actions = cells.decision.action.reshape(cells.places.shape[:2])
    seen = set()
    for row in range(6, 26, 2):
        for column in range(8, 58, 2):
            around = actions[row - 1 : row + 2, column - 1 : column + 2]
            if (around != around[0, 0]).any():
                continue
            x, y = View(1.0).points(cells.places[row, column]).tolist()
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
    driver.frames(20)
    assert scene(driver).world.policy_map.on
    assert scene(driver).world.policy_map.cells is not None
    driver.click(driver.widget(texts.WATCH_MAP)._places[0].center)
    assert not scene(driver).world.policy_map.on
