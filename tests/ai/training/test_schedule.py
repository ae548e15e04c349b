"""What schedules make of the settings."""

import pytest

from ai.agent.schedule import target_rate
from ai.training.config import PRESETS, Config, InForce, in_force
from ai.training.lander_session import LanderSession
from ai.training.messages import SwarmState

TINY = Config(
    hidden=(8,), num_envs=16, learning_starts=32, batch_size=16, gradient_steps=1, replay_size=2000, spawn="near",
    schedule_decisions=1000,
    epsilon_decisions=500, epsilon_start=0.5,
)  # fmt: skip


def test_what_a_run_says_is_in_force_is_what_it_learns_and_flies_with():
    run = LanderSession.live(TINY)
    messages = [next(run)]
    training = run.training
    messages += [next(run) for _ in range(80)]
    assert isinstance(messages[0][-2], InForce) or any(isinstance(each, InForce) for each in messages[0])
    (said,) = [each for each in run.send(("change", "discount", 0.9)) if isinstance(each, InForce)]
    assert said.values["final_learning_rate"] == training.agent.optimizer.learning_rate == TINY.final_learning_rate
    assert said.values["epsilon_start"] == training.epsilon
    assert "learning_rate" not in said.values
    (said,) = [each for each in run.send(("change", "final_learning_rate", 0.01)) if isinstance(each, InForce)]
    assert said.values["final_learning_rate"] == 0.01, "at once, also while it rests"
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
        config = Config(tau=tau, final_tau=1.0)
        assert {target_rate(config, decisions) for decisions in range(0, 900_000, 12_347)} == {tau}
