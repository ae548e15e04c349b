"""Sabotages, and what comes of one beside its healthy twin: as recorded of real runs."""

import pytest

from ai.agent.schedule import exploration_of_each
from ai.training.config import PRESETS, Config
from ai.training.experiments import SABOTAGES, Flown, sabotaged, verdict
from ai.training.loop import Training
from tests.support.recordings import recorded

HEALTHY = recorded("modern healthy")


def test_what_came_of_recorded_runs():
    for name, came in (
        ("modern healthy, another seed", "as_well"),
        ("modern sabotage rate_times_100", "never"),
        ("modern sabotage no_shaping", "later"),
        ("classic rates 1", "runs_away"),
    ):
        run = recorded(name)
        assert verdict(Flown(HEALTHY.history, HEALTHY.config), Flown(run.history, run.config)) == came, name


def test_before_its_twin_lands_it_is_too_early_to_say():
    young, run = recorded("modern healthy", until=60_000), recorded("modern sabotage rate_times_100", until=60_000)
    flown = Flown(young.history, young.config), Flown(run.history, run.config)
    assert verdict(*flown) is None
    assert verdict(*flown, failed=True) == "runs_away"
    slow = recorded("modern healthy, another seed", until=20_000)
    assert verdict(Flown(HEALTHY.history, HEALTHY.config), Flown(slow.history, slow.config)) is None


def test_each_is_a_configuration_that_learns(subtests: pytest.Subtests):
    for base, preset in PRESETS.items():
        for name in SABOTAGES:
            with subtests.test(base=base, name=name):
                small = preset.changed(num_envs=min(8, preset.num_envs), batch_size=16, gradient_steps=1,
                                       learning_starts=16)  # fmt: skip
                training = Training(sabotaged(small, name), evaluate_every=0)
                for _ in range(30 if training.env.num_envs == 1 else 12):
                    training.advance()
                assert training.agent.gradient_steps > 0


def test_sabotages_do_what_they_are_called():
    weights = sabotaged(PRESETS["classic"], "no_shaping").reward_weights
    assert {name: value for name, value in vars(weights).items() if value} == {"terminal": 120.0}
    training = Training(sabotaged(Config(num_envs=64, batch_size=128), "no_replay"), evaluate_every=0)
    for _ in range(20):
        training.advance()
    assert len(training.agent.replay) == 128
    training = Training(sabotaged(Config(num_envs=4, epsilon_spread=1.0), "no_exploration"), evaluate_every=0)
    assert training.advance().epsilon == 0.0
    assert not exploration_of_each(training.config, training.epsilon, training.config.num_envs).any()
