import math

import numpy as np
import pytest

from ai.lander.conditions import Conditions
from ai.lander.environment import PARAMS, LanderEnv, Outcome
from ai.lander.pilots import ScriptedPilot

REST = PARAMS.pad_top + PARAMS.stand


def fly(conditions: Conditions, *, spawn: str = "random", seed: int = 4, count: int = 8, **more) -> LanderEnv:
    env = LanderEnv(count, seed, spawn, conditions=conditions, **more)
    observation, pilot = env.reset(), ScriptedPilot()
    while (env.outcome == Outcome.FLYING).any():
        observation = env.step(pilot.act(observation)).observation
    return env


def place(env: LanderEnv, *start: float) -> None:
    env.reset()
    env.place(np.ones(env.num_envs, bool), np.array([start] * env.num_envs))


@pytest.mark.parametrize(
    "wrong", [{"wind": math.nan}, {"swing": math.inf}, {"gust_period": 0.0}, {"swing_period": -1.0}, {"tank": -1.0}]
)
def test_what_makes_no_sense_is_refused(wrong: dict[str, float]):
    with pytest.raises(ValueError, match="finite"):
        Conditions(**wrong)


def test_a_steady_wind_pushes_as_a_force_does():
    env = LanderEnv(1, 0, frame_skip=1, conditions=Conditions(wind=0.5))
    place(env, 0, 20, 0, 0, 0, 0)
    for _ in range(60):
        env.step(np.zeros(1, int))
    assert env.velocity[0, 0] == pytest.approx(0.5 / PARAMS.mass, rel=0.02)  # a little is lost to drag


def test_gusts_come_and_go_with_their_period():
    wind = Conditions(wind=0.1, gust=0.4, gust_period=4.0)
    assert wind.push(np.array([0.0, 1.0, 2.0, 3.0, 4.0])) == pytest.approx([0.1, 0.5, 0.1, -0.3, 0.1])


def test_what_the_wind_has_given_is_the_sum_of_its_pushes():
    wind, times = Conditions(wind=-0.1, gust=0.4, gust_period=4.0), np.arange(0.0, 7.0, 0.001)
    assert wind.impulse(times[-1:])[0] == pytest.approx(0.001 * wind.push(times).sum(), abs=1e-3)


def test_an_empty_tank_fires_nothing_and_burns_nothing():
    env = LanderEnv(2, 0, "highest", frame_skip=1, conditions=Conditions(tank=1.0))
    env.reset()
    for _ in range(90):
        env.step(np.array([3, 4]))
    assert env.fuel == pytest.approx([1.0, 1.0], abs=0.02)
    assert env.fired.tolist() == [0, 0]
    before = env.velocity[0, 1]
    env.step(np.array([3, 4]))
    assert env.velocity[0, 1] < before


def test_a_dead_engine_burns_nothing_until_it_is_back():
    env = LanderEnv(1, 0, "highest", frame_skip=1, conditions=Conditions(outage=(0.5, 1.0)))
    env.reset()
    fired = [int(env.step(np.array([4])).ended[0]) or int(env.main_steps[0]) for _ in range(90)]
    assert fired[29] == 30
    assert fired[59] == 30
    assert fired[89] == 60
    assert env.side_steps[0] == 90
    env.steps[:] = 45
    assert env.fired.tolist() == [1]
    assert env.thrust.tolist() == [[0.0, -1.0]]


def test_a_pad_moves_and_what_stands_on_it_is_carried_along_and_has_landed():
    env = LanderEnv(3, 0, frame_skip=1, conditions=Conditions(swing=3.0, swing_period=16.0))
    speed = env.conditions.shift(np.zeros(1))[1][0]
    place(env, 0.4, REST + 0.002, speed, 0, 0, 0)
    before = env.snapshot()
    for _ in range(60):
        env.step(np.zeros(3, int))
    assert env.outcome.tolist() == [Outcome.LANDED] * 3  # moving all the time, but not on the pad
    env.restore(before)
    env.limits = env.limits.__class__(rest_steps=10**6)  # so that it stays to be seen
    for _ in range(300):
        env.step(np.zeros(3, int))
    assert env.outcome.tolist() == [Outcome.FLYING] * 3
    assert env.contacts.all()
    assert env.position[:, 0] - env.pad[:, 0] == pytest.approx(0.4, abs=0.2)
    assert abs(env.pad_shift[0]) > 1.0


def test_on_a_moving_pad_rest_is_rest_on_the_pad():
    env = fly(Conditions(swing=2.0, swing_period=18.0), spawn="near")
    landed = env.outcome == Outcome.LANDED
    assert landed.sum() >= 4
    away = np.abs(env.position[:, 0] - env.pad[:, 0])
    assert (away[landed] < env.pad_width[landed] / 2).all()


def test_observations_are_relative_to_the_moving_pad():
    env = LanderEnv(1, 0, frame_skip=1, conditions=Conditions(swing=3.0, swing_period=16.0))
    place(env, 0, 20, 0, 0, 0, 0)
    for _ in range(240):  # a quarter of a period: the pad is farthest to the right, and at rest
        result = env.step(np.zeros(1, int))
    assert result.observation[0, 0] == pytest.approx(-0.3 * 3.0, abs=0.01)
    assert result.observation[0, 2] == pytest.approx(0.0, abs=0.01)
    assert env.observe(0)[0].tolist() == env.observe_pads()[0, 0].tolist()
