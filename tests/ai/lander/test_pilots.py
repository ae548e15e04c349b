import numpy as np
import pytest

from ai.environment import finished
from ai.lander.environment import OBSERVATION_SCALE
from ai.lander.pilots import LaggyPilot, NoisyPilot, ScriptedPilot, SensorPilot
from ai.training.tasks import flights


class Always:
    def __init__(self, action):
        self.action = action

    def act(self, observation, *, held=None):
        return np.full(len(observation), self.action, dtype=np.intp)


def test_the_scripted_pilot_lands():
    result = finished(flights(ScriptedPilot(), 60, 0))
    assert result.success >= 0.95
    assert result.success + result.crash + result.out_of_bounds + result.time_out == pytest.approx(1.0)
    assert result.mean_time
    assert 5 < result.mean_time < 15


def test_the_laggy_pilot_repeats_its_last_action():
    pilot = Always(3)
    lag = LaggyPilot(pilot, np.random.default_rng(0))
    observation = np.zeros((10_000, 9), dtype=np.float32)
    assert (lag.act(observation) == 3).all()
    pilot.action = 1
    assert (lag.act(observation) == 1).mean() == pytest.approx(0.2, abs=0.02)
    assert (lag.act(observation[:1]) == 1).all()


def test_the_noisy_pilot_errs_as_often_as_said():
    noisy = NoisyPilot(Always(4), np.random.default_rng(0))
    main, steer = np.divmod(noisy.act(np.zeros((20_000, 9), dtype=np.float32)), 3)
    assert (main == 0).mean() == pytest.approx(0.15, abs=0.01)
    assert (steer != 1).mean() == pytest.approx(0.15, abs=0.01)
    assert (steer == 0).mean() == pytest.approx(0.075, abs=0.01)


def test_the_sensor_pilot_only_steers_towards_the_pad():
    observation = np.zeros((3, 9), dtype=np.float32)
    observation[:, 0] = np.array([2.0, -2.0, 0.05]) * OBSERVATION_SCALE[0]
    assert SensorPilot().act(observation).tolist() == [1, 2, 0]
