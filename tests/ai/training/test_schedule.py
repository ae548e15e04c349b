"""What schedules make of the settings."""

import pytest

from ai.agent.schedule import target_rate
from ai.training.config import PRESETS, Config, in_force
from ai.training.lander_session import LanderSession

TINY = Config(
    hidden=(8,), num_envs=16, learning_starts=32, batch_size=16, gradient_steps=1, replay_size=2000, spawn="near",
    schedule_decisions=1000,
    epsilon_decisions=500, epsilon_start=0.5,
)  # fmt: skip


def test_what_is_in_force_is_what_a_run_learns_and_flies_with():
    run = LanderSession.live(TINY)
    training = run.training
    for _ in range(81):
        next(run)
    said = in_force(training.config, training.agent.decisions, training.episodes)
    assert said["final_learning_rate"] == training.agent.optimizer.learning_rate == TINY.final_learning_rate
    assert said["epsilon_start"] == training.epsilon
    assert "learning_rate" not in said
    run.send(("change", "final_learning_rate", 0.01))
    said = in_force(training.config, training.agent.decisions, training.episodes)
    assert said["final_learning_rate"] == 0.01, "at once, also while it rests"
    next(run)
    assert training.agent.optimizer.learning_rate == 0.01
    run.close()


def test_half_way_it_is_half_way():
    said = in_force(PRESETS["modern"], 7_500, 0)
    assert said["epsilon_start"] == pytest.approx(0.525)
    said = in_force(PRESETS["modern"], 50_000, 0)
    assert said["learning_rate"] == pytest.approx((3e-3 + 3e-4) / 2)
    assert said["tau"] == pytest.approx((0.005 + 0.00025) / 2)


def test_without_a_last_share_the_target_s_rate_never_changes_by_a_bit():
    for tau in (1.0, 0.1, 0.005, 0.0003):
        config = Config(tau=tau, final_tau=1.0)
        assert {target_rate(config, decisions) for decisions in range(0, 900_000, 12_347)} == {tau}
