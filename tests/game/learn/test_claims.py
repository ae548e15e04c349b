"""What chapters 6 to 9 claim, on the real runs that they show; `benchmarks.small_runs` prints more seeds of them."""

import numpy as np
import pytest

from ai.agent.agent import DeepQAgent
from ai.lander.environment import LIMITS, PARAMS, LanderEnv, Outcome
from ai.lander.rewards import FEET_STEPS_PAID, RewardWeights
from ai.lander.spawns import CURRICULA
from ai.training.config import PRESETS, Config
from ai.training.small_run import SMALL_RUN, Plan, SmallRun
from game.core import texts
from game.core.assets import MODELS_DIR
from game.scenes.learn import pay
from game.scenes.learn.choice import MOMENTS
from game.scenes.learn.memory import KEPT
from game.scenes.learn.pay import PAYS
from game.scenes.learn.plane import examples
from game.scenes.learn.runs import BOUND, DARING, PAY, RIGHT


def test_the_best_line_gets_three_quarters_of_chapter_2_right():
    points, targets = examples(0)
    # Every order in which a line can pass the points lies between two directions in which two of them are level.
    apart = (points[:, None] - points)[np.triu_indices(len(points), 1)].astype(float)
    level = np.sort(np.arctan2(apart[:, 0], -apart[:, 1]) % np.pi)
    directions = (level + np.append(level[1:], level[0] + np.pi)) / 2
    along = points @ np.stack([np.cos(directions), np.sin(directions)])
    passed = np.cumsum(targets[np.argsort(along, axis=0), 0], axis=0)  # half of all are of either kind
    assert np.abs(passed).max() + len(points) / 2 == 0.75 * len(points)


def test_no_flight_can_score_more_than_the_bound():
    weights, highest = RewardWeights(), LIMITS.ceiling - PARAMS.pad_top - PARAMS.stand
    # Falling from the ceiling without drag is faster than any lander ever is.
    fastest = np.sqrt(2 * PARAMS.gravity * highest)
    coming = 10 * (weights.distance * highest + weights.speed * fastest)
    coming += weights.feet * FEET_STEPS_PAID
    assert coming <= 160, "all but the landing"
    assert weights.terminal == 120
    assert coming + weights.terminal < BOUND


def test_what_the_shipped_network_was_paid_for_is_what_chapter_6_says():
    agent = DeepQAgent.load(MODELS_DIR / "lander" / "modern")
    weights, gamma = Config.of(agent).reward_weights, agent.config.discount
    assert (weights.terminal, -60 * weights.time, round(100 * (1 - gamma), 1)) == (120, 12, 1.5)
    for seed, spawn, decisions in [moment for moment in MOMENTS if not moment[2]]:
        env = LanderEnv(1, seed, spawn, frame_skip=4, weights=weights)
        observation, paid, flown = env.reset(), 0.0, 0
        while env.outcome[0] == Outcome.FLYING:
            result = env.step(agent.decide(observation, held=env.actions).action)
            observation, flown = result.observation, flown + 1
            paid += float(result.reward[0])
        way = paid - 120 + 12 * flown / 15
        assert 80 < way < 120, f"the way of {seed}, {spawn}, {decisions} pays about 100"


def test_modern_is_what_chapters_5_7_and_9_say():
    modern, paid = PRESETS["modern"], pay.config_of(PAYS["landing"])
    assert modern.layer_normalisation
    assert modern.fly_target
    assert not modern.target_judges
    same = ("batch_size", "n_step", "target_judges", "double", "hidden", "layer_normalisation", "discount")
    assert [getattr(paid, name) for name in same] == [getattr(modern, name) for name in same]
    stages = CURRICULA[modern.spawn].stages
    assert f"until {stages[1][0]:,} have landed" in texts.LEARN["daring"]["why"]
    assert f"{DARING[1]:.0%}".replace("%", " %") in texts.LEARN["daring"]["task"]
    assert f"{BOUND:g}" in texts.LEARN_TARGET_WHY
    assert f"latest {KEPT[1]}" in texts.LEARN["memory"]["task"]
    assert f"draws {SMALL_RUN.batch_size} " in texts.LEARN["memory"]["lead"]


def test_values_can_run_away_without_a_target_network_and_do_not_with_it_or_with_normalised_layers():
    def peak(config: Config, seed: int) -> float:
        run = SmallRun(config, seed)
        return max(run.advance().value for _ in range(140))

    alone, normalised = RIGHT
    assert peak(SMALL_RUN, 0) < BOUND
    assert peak(normalised, 0) < BOUND, "none of ten passed it"
    assert any(peak(alone, seed) > 10 * BOUND for seed in (0, 1, 3)), "eight of ten do"


@pytest.mark.slow
def test_daring_can_find_a_landing_that_is_only_paid_at_the_end():
    config = SMALL_RUN.changed(n_step=5, reward_weights=PAY)

    def landed(share: float, seed: int) -> float:
        run = SmallRun(config.changed(epsilon_start=share, epsilon_end=share), seed, Plan((5.0, 8.0)))
        for _ in range(420):
            run.advance()
        return run.state.landed or 0.0

    pairs = ([landed(share, seed) for share in DARING[:2]] for seed in range(8))
    assert any(sometimes > never + 0.5 for never, sometimes in pairs), "the first on most processors"
