from dataclasses import fields
from typing import Any

import pytest

from ai.agent.schedule import exploration_of_each
from ai.training.config import PRESETS, Config
from ai.training.experiments import SABOTAGES, sabotaged
from ai.training.loop import Training

CASES = [(base, name) for base in PRESETS for name in SABOTAGES]


def changes(before: Config, after: Config) -> dict[str, Any]:
    return {
        item.name: getattr(after, item.name)
        for item in fields(Config)
        if getattr(after, item.name) != getattr(before, item.name)
    }


def test_each_takes_something_away_from_modern(subtests: pytest.Subtests):
    for name in SABOTAGES:
        with subtests.test(name=name):
            assert changes(PRESETS["modern"], sabotaged(PRESETS["modern"], name))


def test_each_is_a_configuration_that_learns(subtests: pytest.Subtests):
    for base, name in CASES:
        with subtests.test(base=base, name=name):
            small = PRESETS[base].changed(
                num_envs=min(8, PRESETS[base].num_envs), batch_size=16, gradient_steps=1, learning_starts=16
            )
            training = Training(sabotaged(small, name), evaluate_every=0)
            for _ in range(120 if training.env.num_envs == 1 else 30):
                training.advance()
            assert training.agent.gradient_steps > 0


def test_taken_away_twice_is_gone_no_more_than_once(subtests: pytest.Subtests):
    for base, name in CASES:
        with subtests.test(base=base, name=name):
            once = sabotaged(PRESETS[base], name)
            twice = sabotaged(once, name)
            if name != "rate_times_100":
                assert once == twice
            assert twice.learning_rate <= 1.0


def test_only_the_end_of_a_flight_pays_without_shaping():
    weights = sabotaged(PRESETS["classic"], "no_shaping").reward_weights
    assert {name: value for name, value in vars(weights).items() if value} == {"terminal": 120.0}


def test_no_replay_keeps_one_batch():
    training = Training(sabotaged(Config(batch_size=256), "no_replay"), evaluate_every=0)
    for _ in range(20):
        training.advance()
    assert len(training.agent.replay) == 256


def test_without_exploration_nothing_is_random():
    training = Training(sabotaged(Config(num_envs=4, epsilon_spread=1.0), "no_exploration"), evaluate_every=0)
    assert training.advance().epsilon == 0.0
    assert not exploration_of_each(training.config, training.epsilon, training.config.num_envs).any()


def test_an_unknown_name_is_a_key_error():
    with pytest.raises(KeyError):
        sabotaged(Config(), "no_gravity")
