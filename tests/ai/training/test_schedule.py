"""What schedules make of the settings."""

import pytest

from ai.agent.schedule import exploration, learning_rate, target_rate
from ai.training.config import PRESETS, Config
from ai.training.lander_session import LanderSession

TINY = Config(
    hidden=(8,), num_envs=16, learning_starts=32, batch_size=16, gradient_steps=1, replay_size=2000, spawn="near",
    schedule_decisions=1000,
    epsilon_decisions=500, epsilon_start=0.5,
)  # fmt: skip


def test_once_its_schedule_is_over_a_run_learns_by_the_last_rate_and_a_turn_of_that_acts_at_once():
    run = LanderSession.live(TINY)
    for _ in range(81):
        next(run)
    optimizer = run.training.agent.optimizer
    assert optimizer.learning_rate == TINY.final_learning_rate
    run.send(("change", "final_learning_rate", 0.01))
    next(run)
    assert optimizer.learning_rate == 0.01
    run.close()


def test_half_way_it_is_half_way():
    modern = PRESETS["modern"]
    assert exploration(modern, 7_500, 0) == pytest.approx(0.525)
    assert learning_rate(modern, 50_000) == pytest.approx((3e-3 + 3e-4) / 2)
    assert target_rate(modern, 50_000) == pytest.approx((0.005 + 0.00025) / 2)


def test_without_a_last_share_the_target_s_rate_never_changes_by_a_bit():
    for tau in (1.0, 0.1, 0.005, 0.0003):
        config = Config(tau=tau, final_tau=1.0)
        assert {target_rate(config, decisions) for decisions in range(0, 900_000, 12_347)} == {tau}
