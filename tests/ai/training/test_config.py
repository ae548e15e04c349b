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
        ({"learning_rate": float("nan")}, "learning_rate lies between"),
        ({"learning_rate": np.float32("inf")}, "learning_rate lies between"),
        ({"learning_rate": "fast"}, "learning_rate lies between"),
        ({"replay_size": 500, "replay_prune": 501}, "replay_prune is at most replay_size"),
        ({"n_step": 2.5}, "n_step is a whole number"),
        ({"num_envs": np.True_}, "num_envs is not a yes or no"),
        ({"double": 1}, "double is a yes or no"),
        ({"hidden": ()}, "hidden lies between"),
        ({"hidden": (64.5, 64)}, r"hidden is a list of whole numbers, not \[64.5, 64\]"),
        ({"hidden": (np.True_, 8)}, "hidden is a list of whole numbers"),
        ({"hidden": ("64",)}, "hidden is a list of whole numbers"),
        ({"schedule_decisions": 10**400}, r"schedule_decisions is a whole number, not 1000+…"),
        ({"schedule_decisions": 10**5000}, "schedule_decisions is a whole number, not a number of very many digits"),
        ({"env": None}, "env is a text, not null"),
        ({"spawn": "x" * 100_000}, "spawn is one of .*x{20}…$"),
        ({"reward_weights": RewardWeights(time=True)}, r"reward_weights\.time is a finite number"),
        ({"reward_weights": RewardWeights(time=10**400)}, r"reward_weights\.time is a finite number"),
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


def test_numbers_of_numpy_are_plain_numbers():
    weights = RewardWeights(time=np.float32(-0.5), switch=np.int64(0))
    config = Config().changed(num_envs=np.int64(8), learning_rate=np.float32(0.5), double=np.False_,
                              hidden=(np.int32(16), 8), reward_weights=weights)  # fmt: skip
    assert config == Config().changed(num_envs=8, learning_rate=0.5, double=False, hidden=(16, 8),
                                      reward_weights=RewardWeights(time=-0.5, switch=0))  # fmt: skip
    assert Config.from_json(json.loads(json.dumps(config.to_json()))) == config
