"""What the shaping of the reward pays: nothing for a loop in points, and little where the agent discounts."""

import numpy as np
import pytest

from ai.lander.environment import NUM_ACTIONS, LanderEnv, Outcome
from ai.lander.rewards import REWARDS, RewardWeights, Situation

SHAPING = ("distance", "speed", "alignment")


def situation(distance, speed, offset, tilt):
    parts = (np.atleast_1d(np.asarray(part, float)) for part in (distance, offset, speed, tilt))
    return Situation(*parts, *(np.zeros(1, dtype=np.intp) for _ in range(5)))


MIDDLE = situation(0, 0, 0, 0)


def shaped(before, after, weights):
    return sum(REWARDS[name](weights, before, after) for name in SHAPING)


def test_in_points_a_flight_is_paid_for_its_two_ends_alone():
    env, rng = LanderEnv(20, 3, "practice"), np.random.default_rng(0)
    env.reset()
    start, paid = Situation.of(env), np.zeros(20)
    while (flying := env.outcome == Outcome.FLYING).any():
        result = env.step(rng.integers(0, NUM_ACTIONS, 20))
        paid += flying * sum(result.components[name] for name in SHAPING)
        assert result.reward == pytest.approx(sum(result.components.values()), abs=1e-4)
    assert paid == pytest.approx(shaped(start, Situation.of(env), env.weights), abs=1e-2)


def test_each_part_pays_what_it_says(subtests):
    still = {"outcome": 0, "actions": 0, "steps": 10, "tilted_steps": 0, "feet_steps": 0}
    for name, before, after, paid in [
        ("tilt", {}, {"tilted_steps": 3}, -0.15),
        ("feet", {"feet_steps": 27}, {"feet_steps": 31}, 3.0),  # thirty steps are paid
        ("feet", {"feet_steps": 33}, {"feet_steps": 36}, 0.0),
        ("engine", {"actions": 0}, {"steps": 14, "actions": 4}, -0.08),
        ("engine", {"actions": 4}, {"steps": 14, "actions": 0}, 0.0),
        ("switch", {"actions": 3}, {"actions": 4}, -0.5),
        ("switch", {"actions": 3}, {"actions": 1}, -1.0),
        ("switch", {"actions": 3, "outcome": 2}, {"actions": 1, "outcome": 2}, 0.0),
        ("time", {}, {"steps": 14}, -0.8),
        *[("terminal", {}, {"outcome": k}, paid) for k, paid in enumerate((0.0, 120.0, -120.0, -120.0, 0.0))],
        ("terminal", {"outcome": 1}, {"outcome": 1}, 0.0),
    ]:
        with subtests.test(name=name, before=before, after=after):
            one, other = (
                Situation(*[np.zeros(1)] * 4, **{key: np.array([value]) for key, value in (still | changed).items()})
                for changed in (before, after)
            )
            assert REWARDS[name](RewardWeights(switch=-0.5), one, other) == pytest.approx(paid)
