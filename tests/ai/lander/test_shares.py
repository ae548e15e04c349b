"""Shares of thrust: the six actions are those of full shares, and anything between counts by its share."""

import numpy as np
import pytest

from ai.lander.environment import LanderEnv
from ai.lander.missions import MISSIONS
from ai.lander.rules import ACTION_SHARES, NUM_ACTIONS, nearest_action

ROWS = np.random.default_rng(5).integers(0, NUM_ACTIONS, (200, 6))


@pytest.mark.parametrize("mission", ["wind", "tank", "outage", "ferry", "earth"])
def test_full_shares_are_the_six_actions_bit_for_bit(mission: str):
    plain, shared = (MISSIONS[mission].begin(6) for _ in range(2))
    for actions in ROWS:
        plain.fly(actions)
        shared.fly(actions, ACTION_SHARES[actions])
        for name in ("position", "velocity", "angle", "angular_velocity", "fuel", "outcome"):
            assert getattr(plain, name).tobytes() == getattr(shared, name).tobytes(), name


def test_half_the_thrust_is_half_the_force_and_half_the_fuel():
    envs = [LanderEnv(1, 3, frame_skip=1) for _ in range(3)]
    for env, share in zip(envs, (0.0, 0.5, 1.0), strict=True):
        env.reset()
        env.begin_at(0, np.array([0.0, 15.0, 0.0, 0.0, 0.0, 0.0]))
        for _ in range(6):
            env.fly(np.array([3]), np.array([[share, 0.0]]))
    speeds = [float(env.velocity[0, 1]) for env in envs]
    assert speeds[1] - speeds[0] == pytest.approx(speeds[2] - speeds[1], rel=1e-2)
    assert [float(env.fuel[0]) for env in envs] == [0.0, 0.05, 0.1]


def test_a_side_share_turns_by_its_sign_and_burns_by_its_size():
    env = LanderEnv(2, 3, frame_skip=1)
    env.reset()
    for slot in range(2):
        env.begin_at(slot, np.array([0.0, 15.0, 0.0, 0.0, 0.0, 0.0]))
    for _ in range(30):
        env.fly(np.array([1, 2]), np.array([[0.0, -0.25], [0.0, 0.25]]))
    assert env.angle[0] == -env.angle[1] > 0
    assert env.side_steps.tolist() == [7.5, 7.5]


def test_an_empty_tank_gives_no_share():
    env = MISSIONS["tank"].begin()
    for _ in range(1000):
        env.fly(np.array([3]), np.array([[0.5, 0.0]]))
        if env.fuel[0] >= env.conditions.tank:
            break
    assert env.thrust.tolist() == [[0.0, 0.0]]


@pytest.mark.parametrize(
    "shares", [[[1.5, 0.0]], [[-0.1, 0.0]], [[0.0, -1.1]], [[np.nan, 0.0]], [[0.0]], [[0, 0], [0, 0]]]
)
def test_shares_no_engine_has_are_refused(shares: list):
    env = LanderEnv(1, 3)
    env.reset()
    with pytest.raises(ValueError, match="shares of thrust"):
        env.fly(np.array([0]), np.array(shares))


def test_the_nearest_action_is_its_own_at_full_and_never_nothing_for_something():
    for action, (main, side) in enumerate(ACTION_SHARES.tolist()):
        assert nearest_action(main, side) == action
    assert nearest_action(0.1, 0.0) == 3
    assert nearest_action(0.1, -0.2) == 1
    assert nearest_action(0.2, 0.1) == 3
    assert nearest_action(0.6, 0.4) == 3
    assert nearest_action(0.4, 0.6) == 2
    assert nearest_action(0.0, 0.0) == 0
