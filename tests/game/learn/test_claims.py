"""What chapters 7 to 9 claim, on the real runs that they show; `benchmarks.small_runs` prints more seeds of them."""

import numpy as np

from ai.lander.environment import LIMITS, PARAMS
from ai.lander.rewards import FEET_STEPS_PAID, RewardWeights
from ai.training.small_run import SMALL_RUN, Plan, SmallRun
from game.scenes.learn.duels import BOUND, DARING, NORMALISED, PAY, config_of
from game.scenes.learn.memory import LATEST, MemoryChapter


def test_no_flight_can_score_more_than_the_bound():
    weights, highest = RewardWeights(), LIMITS.ceiling - PARAMS.pad_top - PARAMS.stand
    # Falling from the ceiling without drag is faster than any lander ever is.
    fastest = np.sqrt(2 * PARAMS.gravity * highest)
    coming = 10 * (weights.distance * highest + weights.speed * fastest)
    assert coming + weights.feet * FEET_STEPS_PAID + weights.terminal < BOUND


def test_values_can_run_away_without_a_target_network_and_do_not_with_it():
    def peak(every: int, seed: int) -> float:
        run = SmallRun(SMALL_RUN.changed(target_update_interval=every), seed)
        return max(run.advance().value for _ in range(160))

    assert peak(100, 0) < BOUND
    assert any(peak(1, seed) > 10 * BOUND for seed in range(5)), "eight of ten do, and the first on most processors"


def test_normalised_layers_keep_values_in_bounds_without_a_copy():
    for seed in range(2):
        run = SmallRun(config_of(NORMALISED), seed)
        assert max(run.advance().value for _ in range(160)) < BOUND, "none of ten passed it"


def test_daring_can_find_a_landing_that_is_only_paid_at_the_end():
    config = SMALL_RUN.changed(n_step=5, reward_weights=PAY)

    def landed(share: float, seed: int) -> float:
        run = SmallRun(config.changed(epsilon_start=share, epsilon_end=share), seed, Plan((5.0, 8.0)))
        for _ in range(420):
            run.advance()
        return run.state.landed or 0.0

    pairs = ([landed(share, seed) for share in DARING[:2]] for seed in range(8))
    assert any(sometimes > never + 0.5 for never, sometimes in pairs), "the first on most processors"


def test_the_latest_memories_alone_hold_nothing_of_yesterday():
    # What comes of it differs from seed to seed and from processor to processor: `benchmarks.small_runs`.
    yesterday, today = 40, 20
    for keep in (LATEST, None):
        run = SmallRun(SMALL_RUN, 0, MemoryChapter.PLAN._replace(change=yesterday, keep=keep))
        for _ in range(yesterday + today):
            run.advance()
        begun = run.env.num_envs * yesterday
        held = run.state.memory.oldest >= begun
        assert held == (keep is not None), keep
        assert run.state.tested is not None
