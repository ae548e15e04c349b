"""What makes flights harder, and what networks that fly anywhere see of it."""

import math
from dataclasses import replace

import numpy as np
import pytest

from ai.lander.conditions import Conditions
from ai.lander.environment import LIMITS, PARAMS, LanderEnv, Outcome
from ai.lander.sensing import SURROUNDINGS, SURROUNDINGS_MIRROR, SURROUNDINGS_SCALE
from tests.support.landers import STAND, fly, placed, put

HARD = Conditions(wind=0.2, gust=0.3, gust_period=4.0, tank=3.0, outage=(2.0, 4.0), swing=4.0, swing_period=16.0)


def seen(env, slot=0, pad=None):
    numbers = env.around(pad)
    assert (numbers.dtype, numbers.shape) == (np.float32, (env.num_envs, len(SURROUNDINGS)))
    return dict(zip(SURROUNDINGS, (numbers[slot] / SURROUNDINGS_SCALE).tolist(), strict=True))


def falling(conditions, seconds=0.0, action=0, **more):
    env = placed((0, 17), (0, 17), conditions=conditions, **more)
    if seconds:
        fly(env, action, steps=round(60 * seconds))
    return env


def test_what_makes_no_sense_is_refused():
    for wrong in ({"wind": math.nan}, {"swing": math.inf}, {"gust_period": 0}, {"swing_period": -1}, {"tank": -1}):
        with pytest.raises(ValueError, match="finite"):
            Conditions(**wrong)


def test_a_steady_wind_pushes_as_a_force_does_and_gusts_come_and_go():
    env = falling(Conditions(wind=0.5), 1.0)
    assert env.velocity[0, 0] == pytest.approx(0.5 / PARAMS.mass, rel=0.02)  # a little is lost to drag
    wind, times = Conditions(wind=0.1, gust=0.4, gust_period=4.0), np.arange(0.0, 7.0, 0.001)
    assert wind.push(np.arange(5.0)) == pytest.approx([0.1, 0.5, 0.1, -0.3, 0.1])
    assert wind.impulse(times[-1:])[0] == pytest.approx(0.001 * wind.push(times).sum(), abs=1e-3)


def test_an_empty_tank_fires_nothing_and_burns_nothing():
    env = falling(Conditions(tank=1.0), 1.5, [3, 4])
    assert env.fuel == pytest.approx([1.0, 1.0], abs=0.02)
    assert env.fired.tolist() == [0, 0]
    before = env.velocity[0, 1]
    env.step(np.array([3, 4]))
    assert env.velocity[0, 1] < before


def test_a_dead_engine_burns_nothing_until_it_is_back():
    env = falling(Conditions(outage=(0.5, 1.0)))
    fired = []
    for _ in range(90):
        env.step(np.array([4, 4]))
        fired.append(env.main_steps[0])
    assert (fired[29], fired[59], fired[89], env.side_steps[0]) == (30, 30, 60, 90)
    env.steps[:] = 45
    assert env.fired.tolist() == [1, 1]
    assert env.thrust.tolist() == [[0.0, -1.0]] * 2


def test_a_pad_moves_and_what_stands_on_it_is_carried_along_and_has_landed():
    env = LanderEnv(3, 0, frame_skip=1, conditions=Conditions(swing=3.0, swing_period=16.0))
    before = put(env, (0.4, STAND + 0.002, env.conditions.shift(0.0)[1])).snapshot()
    fly(env, steps=60)
    assert env.outcome.tolist() == [Outcome.LANDED] * 3  # moving all the time, but not on the pad
    env.restore(before)
    env.limits = replace(env.limits, rest_steps=10**6)  # so that it stays to be seen
    fly(env, steps=300)
    assert env.outcome.tolist() == [Outcome.FLYING] * 3
    assert env.feet_down.all()
    assert env.position[:, 0] - env.pad[:, 0] == pytest.approx(0.4, abs=0.2)
    assert abs(env.pad_shift[0]) > 1.0


def test_on_the_calm_moon_only_the_clock_runs():
    at_first, later = (seen(falling(Conditions(), seconds, limits=replace(LIMITS, time=15.0))) for seconds in (0, 3.0))
    assert at_first.pop("time left") == pytest.approx(15.0)
    assert later.pop("time left") == pytest.approx(12.0, abs=1e-5)
    assert seen(LanderEnv(1, 0))["time left"] == pytest.approx(20.0)  # more is not seen
    assert later == at_first
    expected = {"gravity": PARAMS.gravity, "thrust": PARAMS.main_thrust / PARAMS.mass, "pad width": 6.0,
            "touch speed": LIMITS.touch_speed, "wind": 0.0, "pad velocity": 0.0, "back in": 0.0}  # fmt: skip
    assert {name: later[name] for name in expected} == pytest.approx(expected)


def test_wind_engine_fuel_and_pad_are_seen_and_announced(subtests):
    engine, wind = ("main engine", "dead in", "back in"), ("wind", "wind soon", "mean wind")
    shift, velocity = HARD.shift(np.array([2.99, 3.01]))
    soon = HARD.push(np.arange(1.0, 3.0, 0.001)).mean()
    for seconds, action, names, expected in [
        (1.0, 0, wind, [0.5, soon, 0.2]),
        (0.5, 0, engine, [1.0, 1.5, 0.0]),
        (3.0, 0, engine, [0.0, 0.0, 1.0]),
        (5.0, 0, engine, [1.0, 8.0, 0.0]),
        (1.0, 3, ("fuel left",), [2.0]),
        (1.0, 1, ("fuel left",), [2.9]),
        (3.0, 0, ("pad velocity", "pad acceleration"), [np.diff(shift)[0] / 0.02, np.diff(velocity)[0] / 0.02]),
    ]:
        with subtests.test(seconds=seconds, action=action, names=names):
            now = seen(falling(HARD, seconds, action))
            assert [now[name] for name in names] == pytest.approx(expected, abs=1e-3)
    assert seen(falling(replace(HARD, tank=0.5), 1.0, 3))["fuel left"] == 0.0
    env = falling(Conditions(), 0.5)
    env.world.gravity = (0.0, -3.0)
    assert seen(env)["gravity"] == pytest.approx(3.0)


def test_in_a_mirror_only_what_points_aside_changes_its_sign():
    one, other = falling(HARD, 1.5), falling(replace(HARD, wind=-0.2, gust=-0.3, swing=-4.0), 1.5)
    assert other.around() == pytest.approx(one.around() * SURROUNDINGS_MIRROR, abs=1e-6)
