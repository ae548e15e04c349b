"""Sabotages, and what comes of one beside its healthy twin."""

from dataclasses import replace

import pytest

from ai.agent.schedule import exploration_of_each
from ai.training.config import PRESETS, Config
from ai.training.curves import Curves
from ai.training.experiments import SABOTAGES, sabotaged, verdict
from ai.training.loop import Training
from tests.support.points import HEALTHY, Curve, history

MODERN = PRESETS["modern"]


def landing(when: float, **values: float) -> Curve:
    """A run that lands nearly always after a share of it."""
    return lambda share: replace(HEALTHY, success_rate=0.97 if share >= when else 0.1, **values)


def steady(landed: float) -> Curve:
    """A run that lands the same share throughout."""
    return lambda _: replace(HEALTHY, success_rate=landed)


def came(curve: Curve, decisions: float = 400_000, **options: bool) -> str | None:
    healthy, other = history(landing(0.2)), history(curve, decisions=decisions)
    return verdict(Curves(healthy, MODERN), Curves(other, MODERN), **options)


def test_what_came_of_an_experiment_follows_from_both_curves():
    assert came(landing(0.22)) == "most"
    assert came(landing(2.0)) == "few"
    shares = (0.0, 0.19, 0.2, 0.79, 0.8)
    assert [came(steady(share)) for share in shares] == ["few", "few", "some", "some", "most"]
    assert came(landing(0.2, mean_q=30.0, loss=float("inf"))) == "most", "by its landings alone"


def test_before_twice_the_time_its_twin_took_it_is_too_early_to_say():
    assert came(landing(0.2), 150_000) is None
    assert came(landing(0.2), 150_000, failed=True) == "few"
    young = Curves(history(landing(2.0)), MODERN)
    assert verdict(young, young) is None, "its twin does not land either"


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
