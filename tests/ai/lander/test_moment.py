"""A moment of flights: everything they depend on, in plain arrays, to be flown on from elsewhere."""

import pickle
from dataclasses import replace

import numpy as np
import pytest

from ai.lander.anywhere import AnywhereEnv
from ai.lander.conditions import Conditions
from ai.lander.environment import LIMITS, NUM_ACTIONS, PARAMS, LanderEnv, Outcome
from ai.lander.ground import Ground, Pad
from ai.lander.moment import Moment
from engine import DT
from tests.support.landers import STAND, fly, placed

GROUND = Ground((Pad(-5.0, 1.8, 5.0), Pad(5.0, 2.6, 4.0, 3)), (((1.0, 1.0), (2.0, 2.0), (3.0, 1.0)),))
HARD = Conditions(wind=0.2, gust=0.2, tank=8.0, outage=(1.0, 1.5), swing=2.0)
ACTIONS = np.random.default_rng(0).integers(0, NUM_ACTIONS, (120, 6))


def hard(slots=6):
    """Landers near the ground with everything about them unusual."""
    params = replace(PARAMS, main_thrust=6.0, quadratic_drag=0.03)
    limits = replace(LIMITS, touch_speed=2.4, time=7.0)
    env = LanderEnv(slots, 3, "near", 4, params=params, ground=GROUND, limits=limits, conditions=HARD)
    env.reset()
    env.target = np.arange(slots) % 2
    env.world.gravity, env.strictness = (0.0, -2.5), 0.8
    return env


def flown(env, rows):
    return np.stack([np.column_stack([*env.step(row[: env.num_envs])][:2]) for row in rows])


def plain(value):
    if isinstance(value, dict):
        return all(isinstance(name, str) and plain(part) for name, part in value.items())
    return all(map(plain, value)) if isinstance(value, tuple) else isinstance(value, np.ndarray | float | int | str)


def test_a_snapshot_is_plain_and_brings_back_everything_but_the_dice(subtests):
    for name, env in (("lander", hard()), ("anywhere", AnywhereEnv(6, 1, "near", 4))):
        with subtests.test(name=name):
            env.reset()
            flown(env, ACTIONS[:60])
            assert (env.outcome != Outcome.FLYING).any()
            before = env.snapshot()
            assert plain(before)
            first = flown(env, ACTIONS[60:])
            env.landings += 5
            env.reset()
            env.restore(pickle.loads(pickle.dumps(before)))
            assert env.landings == before["landings"]
            assert np.array_equal(flown(env, ACTIONS[60:]), first)


def test_a_moment_flies_on_in_any_environment_over_the_same_ground():
    env, other = hard(), LanderEnv(6, 0, frame_skip=4, ground=GROUND)
    flown(env, ACTIONS[:60])
    Moment.of(env).put(other)
    assert (other.gravity, other.strictness) == (2.5, 0.8)
    assert np.array_equal(flown(env, ACTIONS[60:]), flown(other, ACTIONS[60:]))


def test_landers_of_a_moment_fly_on_alone_and_twice():
    env = AnywhereEnv(6, 2, "near", 4)
    env.reset()
    flown(env, ACTIONS[:30])
    rows = np.array([4, 1, 1])
    part = AnywhereEnv(3, 0, frame_skip=4)
    moment = Moment.of(env)
    moment.take(rows).put(part)
    together = np.stack([flown(env, ACTIONS[[number]])[0] for number in range(30, 60)])
    env_rows = np.stack([np.column_stack([*part.step(row[rows])][:2]) for row in ACTIONS[30:60]])
    assert np.array_equal(together[:, rows], env_rows)


def test_how_long_a_lander_has_stood_still_is_kept():
    env, fresh = placed((0, STAND), (0, STAND)), LanderEnv(2, frame_skip=1)
    fly(env, steps=LIMITS.rest_steps - 5)
    fresh.restore(env.snapshot())
    for each in (env, fresh):
        fly(each)
    assert env.steps.tolist() == fresh.steps.tolist()
    assert env.time[0] < (LIMITS.rest_steps + 10) * DT


def test_a_snapshot_of_others_is_refused():
    heavy = replace(PARAMS, mass=2.0)
    for other in (LanderEnv(5, ground=GROUND), LanderEnv(6), LanderEnv(6, ground=GROUND, params=heavy)):
        with pytest.raises(ValueError, match="same craft"):
            other.restore(hard().snapshot())
