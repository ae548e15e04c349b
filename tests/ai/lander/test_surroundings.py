"""What is around a lander besides its pad, as networks that fly anywhere see it."""

from dataclasses import replace

import numpy as np
import pytest

from ai.lander.conditions import Conditions
from ai.lander.environment import LIMITS, PARAMS, LanderEnv
from ai.lander.ground import Ground, Pad
from ai.lander.sensing import SURROUNDINGS, SURROUNDINGS_MIRROR, SURROUNDINGS_SCALE

HARD = Conditions(wind=0.2, gust=0.3, gust_period=4.0, tank=3.0, outage=(2.0, 4.0), swing=4.0, swing_period=16.0)


def seen(env: LanderEnv, slot: int = 0, pad: int | None = None) -> dict[str, float]:
    numbers = env.surroundings(pad)
    assert numbers.dtype == np.float32
    assert numbers.shape == (env.num_envs, len(SURROUNDINGS))
    return dict(zip(SURROUNDINGS, (numbers[slot] / SURROUNDINGS_SCALE).tolist(), strict=True))


def falling(conditions: Conditions, seconds: float, action: int = 0, **more) -> LanderEnv:
    env = LanderEnv(2, 0, "highest", frame_skip=1, conditions=conditions, **more)
    env.reset()
    for _ in range(round(60 * seconds)):
        env.step(np.full(2, action))
    return env


def test_on_the_calm_moon_only_the_clock_runs():
    limits = replace(LIMITS, time=15.0)
    at_first, later = (seen(falling(Conditions(), seconds, limits=limits)) for seconds in (0.0, 3.0))
    assert at_first.pop("time left") == pytest.approx(15.0)
    assert later.pop("time left") == pytest.approx(12.0, abs=1e-5)
    assert seen(LanderEnv(1, 0))["time left"] == pytest.approx(20.0)  # more is not seen
    assert later == at_first
    assert later["gravity"] == pytest.approx(PARAMS.gravity)
    assert later["thrust"] == pytest.approx(PARAMS.main_thrust / PARAMS.mass)
    assert later["pad width"] == pytest.approx(6.0)
    assert later["touch speed"] == pytest.approx(LIMITS.touch_speed)
    assert later["wind"] == later["pad velocity"] == later["back in"] == 0.0


def test_wind_now_soon_and_on_average():
    env = falling(HARD, 1.0)
    times = np.arange(1.0, 3.0, 0.001)
    assert seen(env)["wind"] == pytest.approx(0.5, abs=1e-6)
    assert seen(env)["wind soon"] == pytest.approx(HARD.push(times).mean(), abs=1e-3)
    assert seen(env)["mean wind"] == pytest.approx(0.2)


def test_a_failing_engine_is_announced_and_its_return_too():
    before, during, after = (seen(falling(HARD, seconds)) for seconds in (0.5, 3.0, 5.0))
    assert [before[name] for name in ("main engine", "dead in", "back in")] == pytest.approx([1.0, 1.5, 0.0])
    assert [during[name] for name in ("main engine", "dead in", "back in")] == pytest.approx([0.0, 0.0, 1.0])
    assert [after[name] for name in ("main engine", "dead in", "back in")] == pytest.approx([1.0, 8.0, 0.0])


def test_fuel_is_seen_to_run_out():
    assert seen(falling(HARD, 1.0, action=3))["fuel left"] == pytest.approx(2.0, abs=1e-5)
    assert seen(falling(HARD, 1.0, action=1))["fuel left"] == pytest.approx(2.9, abs=1e-5)
    assert seen(falling(replace(HARD, tank=0.5), 1.0, action=3))["fuel left"] == 0.0


def test_a_pad_is_seen_to_move_as_it_does():
    env = falling(HARD, 3.0)
    now, time = seen(env), np.array([2.99, 3.01])
    shift, velocity = HARD.shift(time)
    assert now["pad velocity"] == pytest.approx(np.diff(shift)[0] / 0.02, rel=1e-3)
    assert now["pad acceleration"] == pytest.approx(np.diff(velocity)[0] / 0.02, rel=1e-3)


def test_of_several_pads_each_has_its_width():
    env = LanderEnv(2, 0, ground=Ground((Pad(-6.0, 1.6, 6.0), Pad(6.0, 1.6, 3.6))))
    env.reset()
    env.target[:] = [0, 1]
    assert [seen(env, slot)["pad width"] for slot in (0, 1)] == pytest.approx([6.0, 3.6])
    assert seen(env, 0, pad=1)["pad width"] == pytest.approx(3.6)


def test_gravity_that_is_changed_in_flight_is_seen():
    env = falling(Conditions(), 0.5)
    env.gravity = 3.0
    assert seen(env)["gravity"] == pytest.approx(3.0)


def test_in_a_mirror_only_what_points_aside_changes_its_sign():
    one, other = falling(HARD, 1.5), falling(replace(HARD, wind=-0.2, gust=-0.3, swing=-4.0), 1.5)
    assert other.surroundings() == pytest.approx(one.surroundings() * SURROUNDINGS_MIRROR, abs=1e-6)
