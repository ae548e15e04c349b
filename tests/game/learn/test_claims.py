"""What chapters 7 to 9 claim, on the real runs that they show; `benchmarks.small_runs` prints more seeds of them."""

import numpy as np
import pytest

from ai.lander.environment import LIMITS, PARAMS
from ai.lander.rewards import FEET_STEPS_PAID, RewardWeights
from ai.training.small_run import SMALL_RUN, Plan, SmallRun
from game.learn.daring import DARING, PAY
from game.learn.memory import LATEST, YESTERDAY, MemoryChapter
from game.learn.target import BOUND


def test_no_flight_can_score_more_than_the_bound():
    weights, highest = RewardWeights(), LIMITS.ceiling - PARAMS.pad_top - PARAMS.stand
    # Falling from the ceiling without drag is faster than any lander ever is.
    fastest = np.sqrt(2 * PARAMS.gravity * highest)
    coming = 10 * (weights.distance * highest + weights.speed * fastest)
    assert coming + weights.feet * FEET_STEPS_PAID + weights.terminal < BOUND


def test_without_a_target_network_values_run_away_and_with_it_they_do_not():
    usual, without = (SmallRun(SMALL_RUN.changed(target_update_interval=every), 0) for every in (100, 1))
    peaks = [max(run.advance().value for _ in range(160)) for run in (usual, without)]
    assert peaks[0] < 100 < BOUND < 10 * BOUND < peaks[1]


def test_daring_finds_the_landing_that_is_only_paid_at_the_end():
    config = SMALL_RUN.changed(n_step=5, reward_weights=PAY)
    never, sometimes = (
        SmallRun(config.changed(epsilon_start=share, epsilon_end=share), 0, Plan((5.0, 8.0))) for share in DARING[:2]
    )
    for _ in range(420):
        never.advance()
        sometimes.advance()
    assert never.state.landed is not None
    assert never.state.landed < 0.1
    assert sometimes.state.landed is not None
    assert sometimes.state.landed > 0.6


@pytest.mark.slow
def test_learning_from_the_latest_alone_forgets_yesterday():
    latest = SmallRun(SMALL_RUN, 0, MemoryChapter.PLAN._replace(keep=LATEST))
    for _ in range(YESTERDAY):
        latest.advance()
    assert latest.state.passed == 1.0
    least = min(latest.advance().passed or 0.0 for _ in range(260))
    assert least < 0.5
    assert latest.state.landed == 1.0  # today's flights it lands
