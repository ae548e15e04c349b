import json

import numpy as np
import pytest

from ai.lander.rewards import RewardWeights
from ai.training.config import PRESETS, Config


def test_presets_survive_a_file():
    for preset in PRESETS.values():
        assert Config.from_json(preset.to_json()) == preset
    changed = PRESETS["classic"].changed(reward_weights=RewardWeights(time=0.0), hidden=(8,))
    assert Config.from_json(changed.to_json()) == changed


def test_classic_is_the_agent_first_described():
    classic = PRESETS["classic"]
    assert classic.hidden == (128, 128)
    assert (classic.activation, classic.cost, classic.optimizer) == ("tanh", "mse", "sgd")
    assert (classic.replay_size, classic.replay_prune, classic.target_update_interval) == (1500, 1000, 50)
    assert (classic.epsilon_start, classic.epsilon_decay, classic.epsilon_end) == (1.0, 0.999, 0.05)
    assert classic.success_pass
    assert classic.success_batch_size < classic.batch_size
    assert not any((classic.double, classic.dueling, classic.prioritised, classic.mirror))
    assert classic.spawn == "curriculum"


def test_a_setting_out_of_range_is_named(subtests):
    for changes, message in [
        ({"learning_rate": -1.0}, "learning_rate lies between"),
        ({"learning_rate": float("nan")}, "learning_rate: NaN is no finite number"),
        ({"learning_rate": np.float32("inf")}, "learning_rate: .* is no finite number"),
        ({"learning_rate": "fast"}, "learning_rate: 'fast' is no finite number"),
        ({"replay_size": 500, "replay_prune": 501}, "replay_prune is at most replay_size"),
        ({"n_step": 2.5}, "n_step: 2.5 is no whole number"),
        ({"num_envs": True}, "num_envs: true is no whole number"),
        ({"double": 1}, "double: 1 is neither true nor false"),
        ({"hidden": ()}, "hidden lies between"),
        ({"hidden": (64.5, 64)}, "hidden: 0: 64.5 is no whole number"),
        ({"hidden": (True, 8)}, "hidden: 0: true is no whole number"),
        ({"hidden": ("64",)}, "hidden: 0: '64' is no whole number"),
        ({"schedule_decisions": 10**400}, "schedule_decisions lies between .* not 1000+…"),
        ({"schedule_decisions": 10**5000}, "schedule_decisions lies between .* not something very large"),
        ({"env": None}, "env: null is no text"),
        ({"spawn": "x" * 100_000}, "spawn is one of .*x{20}…$"),
        ({"reward_weights": RewardWeights(time=True)}, "reward_weights: time: true is no finite number"),
        ({"reward_weights": RewardWeights(time=10**400)}, "reward_weights: time: .* is no finite number"),
    ]:
        with subtests.test(changes=changes), pytest.raises(ValueError, match=message):
            Config().changed(**changes)
    for values, message in [
        ({"warp": 9}, "unknown settings: warp"),
        *(({name: value}, name) for name, value in (("hidden", 64), ("hidden", "64"), ("learning_rate", [0.001]))),
        *((wrong, "settings are values by name, not ") for wrong in (None, 3, [], [1], "horizon", [{"horizon": 5}])),
    ]:
        with subtests.test(values=values), pytest.raises(ValueError, match=message):
            Config.from_json(values)


def test_a_float_of_numpy_is_a_float_and_its_other_numbers_are_refused_by_name():
    config = Config().changed(learning_rate=np.float64(0.5))
    assert Config.from_json(json.loads(json.dumps(config.to_json()))) == config
    with pytest.raises(ValueError, match=r"num_envs: .* is no whole number"):
        Config().changed(num_envs=np.int64(8))


def test_settings_of_another_version_are_refused_by_name():
    with pytest.raises(ValueError, match="unknown settings: care, horizon"):
        Config.from_json({"horizon": 5, "care": 0.8, "n_step": 3})
