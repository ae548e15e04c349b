"""What schedules make of the settings, and which settings they leave without effect."""

from dataclasses import fields
from inspect import getgeneratorlocals

import numpy as np
import pytest

from ai.agent.schedule import target_rate
from ai.digits.config import DIGIT_PRESETS
from ai.training.config import PRESETS, Config, InForce, idle, in_force
from ai.training.lander_session import LanderSession
from ai.training.loop import Training
from ai.training.messages import SwarmState

TINY = Config(
    hidden=(8,), num_envs=16, learning_starts=32, batch_size=16, gradient_steps=1, replay_size=2000, spawn="near",
    schedule_decisions=1000,
    epsilon_decisions=500, epsilon_start=0.5,
)  # fmt: skip
LIVE = [item.name for item in fields(Config) if item.metadata["live"]]


def trained(config: Config, change: dict[str, float], at: int, until: int) -> Training:
    training = Training(config, 3, evaluate_every=0)
    while training.agent.decisions < until:
        if training.agent.decisions == at:
            training.apply_live(config.changed(**change))
        training.advance()
    return training


@pytest.mark.parametrize(
    ("config", "at"),
    [
        (TINY, 0),
        (TINY, 1120),  # ε has come down, and the horizon is over
        (TINY.changed(num_envs=1), 64),
        (TINY.changed(epsilon_start=0.0, epsilon_end=0.0), 64),
        (TINY.changed(success_pass=True, prioritised=True), 64),
    ],
)
def test_what_is_called_idle_changes_nothing_bit_for_bit(config: Config, at: int):
    until = at + 25 * config.num_envs
    quiet = trained(config, {}, at, until)
    found = [name for name in idle(config, at, quiet.episodes) if name in LIVE]
    described = {item.name: item.metadata for item in fields(Config)}
    for end in ("low", "high"):  # all at once: one that acts makes a difference among others too
        turned = trained(config, {name: described[name][end] for name in found}, at, until)
        assert np.array_equal(turned.agent.online.values, quiet.agent.online.values), found
        assert np.array_equal(turned.observation, quiet.observation), found


def test_schedules_leave_their_settings_behind_one_by_one():
    modern, classic = {"success_batch_size", "double"}, {"epsilon_spread"}
    for preset, decisions, episodes, expected in [
        ("modern", 0, 0, modern),
        ("modern", 14_000, 250, modern),
        ("modern", 15_000, 250, modern | {"epsilon_decay"}),
        ("modern", 100_000, 5_000, modern | {"epsilon_decay", "learning_rate"}),
        ("classic", 0, 0, classic),
        ("classic", 299_999, 2_000, classic),
        ("classic", 300_000, 4_000, classic | {"learning_rate", "epsilon_decisions"}),
    ]:
        found = {name for name in idle(PRESETS[preset], decisions, episodes) if name in LIVE}
        assert found == expected, (preset, decisions)


def test_what_is_not_turned_on_changes_nothing():
    assert {"priority_exponent", "importance_exponent"} <= set(idle(PRESETS["modern"]))
    assert "schedule_decisions" in idle(PRESETS["classic"])
    assert "schedule_decisions" not in idle(PRESETS["classic"].changed(final_touchdown_limits=0.5))
    assert DIGIT_PRESETS["classic"].unused() == {"filters": "convolutions", "kernel": "convolutions"}
    assert DIGIT_PRESETS["modern"].changed(augmentation=0.0).unused() == {"unaugmented": "augmentation"}


def test_what_a_run_says_is_in_force_is_what_it_learns_and_flies_with():
    run = LanderSession.live(TINY)
    messages = [next(run)]
    training = getgeneratorlocals(run)["session"].training
    messages += [next(run) for _ in range(80)]
    assert isinstance(messages[0][-2], InForce) or any(isinstance(each, InForce) for each in messages[0])
    (said,) = [each for each in run.send(("change", "discount", 0.9)) if isinstance(each, InForce)]
    assert said.values["learning_rate"] == training.agent.optimizer.learning_rate == TINY.final_learning_rate
    assert said.values["epsilon_start"] == training.epsilon
    assert said.idle["learning_rate"] == "final_learning_rate"
    (said,) = [each for each in run.send(("change", "final_learning_rate", 0.01)) if isinstance(each, InForce)]
    assert said.values["learning_rate"] == 0.01, "at once, also while it rests"
    assert any(isinstance(each, SwarmState) for each in next(run))
    assert training.agent.optimizer.learning_rate == 0.01
    run.close()


def test_half_way_it_is_half_way():
    said = in_force(PRESETS["modern"], 7_500, 0)
    assert said.values["epsilon_start"] == pytest.approx(0.525)
    said = in_force(PRESETS["modern"], 50_000, 0)
    assert said.values["learning_rate"] == pytest.approx((3e-3 + 3e-4) / 2)
    assert said.values["tau"] == pytest.approx((0.005 + 0.00025) / 2)


def test_without_a_last_share_the_target_s_rate_never_changes_by_a_bit():
    for tau in (1.0, 0.1, 0.005, 0.0003):
        assert {target_rate(Config(tau=tau), decisions) for decisions in range(0, 900_000, 12_347)} == {tau}
