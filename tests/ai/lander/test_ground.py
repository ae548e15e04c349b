"""Ground: several pads, hills and where they leave room."""

import numpy as np
import pytest

from ai.lander.environment import PARAMS, Cause, Outcome
from ai.lander.ground import PADS, Ground, Pad, clearance, hilly
from tests.support.landers import fly, placed

THREE = Ground(
    (Pad(-9.0, 2.0, 6.0), Pad(0.0, 1.6, 4.4, 3), Pad(9.0, 2.5, 3.6, 5)), (((3.0, 1.0), (4.5, 2.2), (6.0, 1.0)),)
)


def standing(*places):
    """Landers at rest on each of these x, y of the surface."""
    return placed(*[(x, y + PARAMS.stand) for x, y in places], ground=THREE)


def test_any_pad_will_do_and_the_result_says_which_but_hills_and_flanks_are_no_place_to_land():
    env = standing((-9, 2.0), (0, 1.6), (9, 2.5), (4.5, 2.3), (14, 1.1))
    assert env.landed_on.tolist() == [-1] * 5
    fly(env, steps=90)
    assert env.outcome.tolist() == [Outcome.LANDED] * 3 + [Outcome.CRASHED] * 2
    assert env.cause[3:].tolist() == [Cause.TERRAIN] * 2
    assert env.landed_on.tolist() == [0, 1, 2, -1, -1]
    env.reset()
    assert env.landed_on.tolist() == [-1] * 5


def test_observations_and_rewards_are_about_the_pad_in_question():
    env = standing((9, 2.5), (0, 9.0))
    fly(env, steps=5)
    each = env.observe_pads()
    assert each.shape == (2, 3, 9)
    for pad in range(3):
        assert np.array_equal(each[:, pad], env.observe(pad))
    assert np.array_equal(env.observe([2, 0]), each[[0, 1], [2, 0]])
    np.testing.assert_allclose(each[0, 2, :2], 0.0, atol=0.01)
    assert each[0, :, 7:].tolist() == [[0, 0], [0, 0], [1, 1]]  # feet on another pad are of no use
    assert each[0, 0, 0] == pytest.approx(16.0 * 0.3)  # 18 m away, and no network has been so far
    env.target[:] = 2
    assert np.array_equal(env.observe(), each[:, 2])
    assert env.pad.tolist() == [[9.0, 2.5]] * 2
    env = standing((4, 9.0), (4, 9.0))
    env.target[:] = (0, 2)
    paid = fly(env, 2, steps=20).components["distance"]
    assert paid[0] < paid[1]


def test_hills_leave_room_for_every_approach():
    x = np.linspace(-20, 20, 2001)
    for seed in range(20):
        ground = hilly(np.random.default_rng(seed))
        assert ground == hilly(np.random.default_rng(seed)) != hilly(np.random.default_rng(seed + 1)), seed
        assert sorted((pad.width, pad.factor) for pad in ground.pads) == sorted(PADS), seed
        for pad in ground.pads:
            away = np.abs(x - pad.x)
            beside = away > pad.width / 2 + 1.0
            free = ground.height(x) <= pad.top + np.maximum(clearance(away), 0.0) + 1e-6
            assert free[beside].all(), seed
            assert ground.height(pad.x) == pad.top, seed
        assert ground.height(x).max() < 6.0, seed
        assert len(ground.hills) > len(PADS), seed


def test_ground_that_makes_no_sense_is_refused():
    for pads in ((), (Pad(0, 0.5, 6),), (Pad(0, 1.6, 0),), (Pad(0, 1.6, 6), Pad(4, 1.6, 6))):
        with pytest.raises(ValueError, match="pad"):
            Ground(pads)
