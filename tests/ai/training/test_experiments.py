"""Experiments on one knob, and what comes of one beside its healthy twin: as recorded of real runs."""

from dataclasses import fields

import pytest

from ai.agent.schedule import exploration_of_each
from ai.training.config import PRESETS, Config
from ai.training.experiments import SABOTAGES, Flown, differences, experiment_of, experiments, sabotaged, verdict
from ai.training.loop import Training
from tests.support.recordings import recorded

MODERN = PRESETS["modern"]
KNOBS = [item.name for item in fields(Config) if item.name not in ("env", "reward_weights")] + [
    f"reward_weights.{part}" for part in vars(MODERN.reward_weights)
]


@pytest.mark.parametrize("base", PRESETS)
def test_only_the_knob_differs_or_what_its_sabotage_takes_away(base: str):
    config, found = PRESETS[base], 0
    for name in KNOBS:
        for experiment in experiments(config, name):
            differing = set(differences(config, experiment.applied(config)))
            assert name in differing
            found += 1
            if experiment.sabotage:
                assert experiment.applied(config) == sabotaged(config, experiment.sabotage)
            else:
                assert differing == {name}
    assert found > 50


def test_a_hundred_times_more_or_less_where_the_scale_is_logarithmic_and_the_ends_elsewhere():
    rate = {each.kind: each for each in experiments(MODERN, "learning_rate")}
    assert rate["times"].sabotage == "rate_times_100"
    assert rate["divided"].changes == {"learning_rate": 3e-5}
    assert [each.amount for each in experiments(MODERN, "discount")] == [0.8, 0.9999]
    assert [each.changes["batch_size"] for each in experiments(MODERN, "batch_size")] == [8, 1024]
    assert [each.sabotage for each in experiments(MODERN, "epsilon_end")] == ["no_exploration", ""]
    assert all(each.amount <= MODERN.num_envs for each in experiments(MODERN, "num_envs")), "no slower machine"


def test_of_a_knob_that_has_no_effect_there_is_nothing_to_try():
    assert "priority_exponent" in MODERN.unused()
    assert experiments(MODERN, "priority_exponent") == []
    assert experiments(MODERN.changed(prioritised=True), "priority_exponent")


def test_a_sabotage_is_an_experiment_too(subtests: pytest.Subtests):
    for name in SABOTAGES:
        with subtests.test(name=name):
            assert experiment_of(MODERN, name).applied(MODERN) == sabotaged(MODERN, name)


HEALTHY = recorded("modern healthy")


@pytest.mark.parametrize(
    ("name", "came"),
    [
        ("modern healthy, another seed", "as_well"),
        ("modern sabotage rate_times_100", "never"),
        ("modern sabotage plain_steps", "never"),
        ("modern sabotage short_sight", "never"),
        ("modern sabotage no_shaping", "later"),
        ("classic rates 1", "runs_away"),
    ],
)
def test_what_came_of_recorded_runs(name: str, came: str):
    run = recorded(name)
    assert verdict(Flown(HEALTHY.history, HEALTHY.config), Flown(run.history, run.config)) == came


def test_before_its_twin_lands_it_is_too_early_to_say():
    young, run = recorded("modern healthy", until=60_000), recorded("modern sabotage rate_times_100", until=60_000)
    flown = Flown(young.history, young.config), Flown(run.history, run.config)
    assert verdict(*flown) is None
    assert verdict(*flown, failed=True) == "runs_away"


CASES = [(base, name) for base in PRESETS for name in SABOTAGES]


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
