"""Rules of a flight: what pushes a lander, what ends its flight and how, and where flights begin."""

from dataclasses import replace

import numpy as np
import pytest

from ai.lander.environment import LIMITS, NUM_ACTIONS, PARAMS, Cause, LanderEnv, Outcome
from ai.lander.rewards import RewardWeights
from ai.lander.rules import ACTION_SHARES, MIRROR_ACTIONS, MIRROR_FEATURES, MIRROR_SIGNS, nearest_action
from ai.lander.spawns import Curriculum, _away
from engine import DT
from tests.support.landers import STAND, fly, placed, put

SOME = np.array([3, 12, 1, -1, 0.2, 0.1])


def test_free_fall_follows_gravity_and_drag():
    env, expected = placed((0, 20)), 0.0
    fly(env, steps=30)
    for _ in range(30):
        drag = (PARAMS.linear_drag + PARAMS.quadratic_drag * abs(expected)) * DT
        expected = (expected - PARAMS.gravity * DT) / (1 + drag)
    assert env.velocity[0, 1] == pytest.approx(expected, rel=1e-12)


def test_actions_push_and_turn_as_documented():
    env = placed(*[(0, 15)] * 6)
    env.step(np.arange(6))
    gained = env.velocity - env.velocity[0]
    assert np.sign(np.round(gained, 6)).tolist() == [[0, 0], [-1, 0], [1, 0], [0, 1], [-1, 1], [1, 1]]
    assert np.sign(np.round(env.angular_velocity, 6)).tolist() == [0, 1, -1, 0, 1, -1]
    assert gained[3:, 1] == pytest.approx(PARAMS.main_thrust / PARAMS.mass * DT, rel=1e-2)


def test_standing_still_on_the_pad_for_half_a_second_is_a_landing():
    env = placed((1.0, STAND))
    result = fly(env)
    assert env.outcome[0] == Outcome.LANDED
    assert (result.terminated[0], result.truncated[0]) == (True, False)
    assert LIMITS.rest_steps <= env.steps[0] <= LIMITS.rest_steps + 10
    assert env.feet_down.all()
    assert env.altitude[0] == pytest.approx(0.0, abs=0.01)


def test_only_what_neither_moves_nor_leans_nor_turns_is_at_rest():
    for limits in (replace(LIMITS, rest_speed=0.0), replace(LIMITS, rest_tilt=0.0), replace(LIMITS, rest_spin=0.0)):
        env = placed((1.0, STAND), limits=limits)
        fly(env, steps=60)
        assert env.outcome[0] == Outcome.FLYING
    env = placed((0, STAND), (1, STAND))
    fly(env, steps=LIMITS.rest_steps - 5)
    assert env.still_steps.all()
    fly(env, 3, steps=20)
    assert not env.feet_down.any()
    assert not env.still_steps.any(), "it is counted anew after a hop"


def test_each_way_to_crash_is_named_by_the_limit_that_was_broken(subtests):
    for start, cause, limits in [
        ((0, STAND + 0.02, 0, -2.3), Cause.HARD, LIMITS),
        ((0, STAND + 0.02, 0, -1.5), Cause.HARD, replace(LIMITS, touch_speed=1.2)),
        ((0, STAND + 0.02, 2.4, -0.5), Cause.SLIDING, LIMITS),
        ((0, STAND + 0.02, -1.6, -0.5), Cause.SLIDING, replace(LIMITS, slide_speed=1.2)),
        ((0, STAND + 0.3, 0, -0.5, 0.6), Cause.TILTED, LIMITS),
        ((0, STAND, 0, -0.3, np.pi), Cause.HULL, LIMITS),
        ((10, STAND - 0.5, 0, -0.3), Cause.TERRAIN, LIMITS),
    ]:
        with subtests.test(start=start, cause=cause):
            env = placed(start, limits=limits)
            assert fly(env).components["terminal"][0] == -RewardWeights().terminal
            assert (env.outcome[0], env.cause[0]) == (Outcome.CRASHED, cause)
            assert bool(env.intact[0]) is (cause == Cause.TERRAIN)
    env = placed((0, STAND + 0.01, 0, -1.9))  # just within the limits
    fly(env)
    assert env.outcome[0] == Outcome.LANDED
    assert not env.intact[0]
    assert 1.8 < env.impact[0, 0] < LIMITS.touch_speed


def test_leaving_the_area_and_running_out_of_time():
    env = placed((21.9, 15, 6), (0, 25.9, 0, 6), (0, 15))
    env.steps[2] = round(LIMITS.time / DT) - 1
    result = fly(env)
    assert env.outcome.tolist() == [Outcome.OUT_OF_BOUNDS] * 2 + [Outcome.TIMED_OUT]
    assert (result.terminated.tolist(), result.truncated.tolist()) == ([True, True, False], [False, False, True])
    assert env.steps[2] == round(LIMITS.time / DT), "not a step later"


@pytest.mark.parametrize("count", [1, 3])
def test_time_is_out_when_the_limits_of_the_flight_say_so(count):
    env = placed(*[(0, 15)] * count, limits=replace(LIMITS, time=0.5))
    fly(env)
    assert (env.outcome == Outcome.TIMED_OUT).all()
    assert (env.steps == 30).all()


@pytest.mark.parametrize(("speed", "counts"), [(0.65, False), (0.4, True)])
def test_one_that_slides_on_both_feet_stands_still_only_below_the_limit(speed, counts):
    env = placed((0, STAND, speed))
    fly(env, steps=5)
    assert env.feet_down.all()
    assert bool(env.velocity[0, 0] < LIMITS.rest_speed) is counts
    assert bool(env.still_steps[0]) is counts


def test_a_start_that_leads_away_does_so_by_speed_lean_and_spin():
    rng = np.random.default_rng(2)
    starts = np.array([_away(rng) for _ in range(40)])
    x, _, vx, _, angle, spin = starts.T
    env = put(
        LanderEnv(len(starts), 0, frame_skip=1), *np.column_stack([0 * x, 0 * x + 15, 0 * vx, 0 * vx, angle, 0 * spin])
    )
    env.step(np.full(len(starts), 3))
    assert (np.sign(x) == np.sign(vx)).all()
    assert (np.sign(x) == np.sign(env.velocity[:, 0])).all(), "its main engine pushes it away"
    assert (np.sign(angle) == np.sign(spin)).all(), "it leans more and more"
    assert 10 < (x > 0).sum() < 30


def test_a_flight_is_the_same_alone_and_in_a_batch():
    actions = np.random.default_rng(3).integers(0, NUM_ACTIONS, (300, 40))
    alone, many = LanderEnv(1, 7, "practice"), LanderEnv(40, 7, "practice")
    assert np.array_equal(alone.reset()[0], many.reset()[0])
    for row in actions:
        one, all_ = alone.step(row[:1]), many.step(row)
        assert all(np.array_equal(ours[0], theirs[0]) for ours, theirs in zip(one, all_, strict=True))
        if one.ended[0]:
            alone.reset(np.array([True]))
            many.reset(all_.ended)


def test_frame_skip_only_holds_the_action():
    fine, coarse = placed(SOME), placed(SOME, frame_skip=4)
    for action in (0, 3, 4, 5, 2):
        rewards = [fine.step(np.array([action])).reward[0] for _ in range(4)]
        result = coarse.step(np.array([action]))
        assert np.array_equal(fine.observe(), result.observation)
        assert result.reward[0] == pytest.approx(sum(rewards), abs=1e-4)


def test_gliding_is_flying_until_something_touches_and_goes_through_it_after():
    flown, glided = (placed(SOME, (0, 5, 0, -2), frame_skip=4) for _ in range(2))
    for action in (0, 3, 4, 5, 2, *[0] * 20):
        actions = np.array([action, 0])
        glided.glide(actions)
        seen = flown.step(actions).observation[0], glided.observe()[0]
        assert np.array_equal(*seen) or flown.feet_down[0].any() or flown.outcome[0]
    assert flown.outcome[1] == Outcome.CRASHED
    assert glided.outcome[1] == Outcome.FLYING
    assert glided.position[1, 1] < 0 < flown.position[1, 1]


def test_ended_slots_stay_as_they_ended_until_reset():
    env = placed((0, STAND + 0.02, 0, -3), (0, 15))
    ended = fly(env, steps=10)
    later = env.step(np.array([3, 3]))
    assert np.array_equal(later.observation[0], ended.observation[0])
    assert not np.array_equal(later.observation[1], ended.observation[1])
    assert later.reward[0] == 0
    assert later.terminated.tolist() == [True, False]
    env.reset(np.array([True, False]))
    assert env.outcome.tolist() == [Outcome.FLYING, Outcome.FLYING]
    assert env.time[0] == 0 < env.time[1]


def test_a_mirrored_flight_is_the_mirror_image():
    env, mirror = placed(SOME, frame_skip=4), placed(SOME * [-1, 1, -1, 1, -1, -1], frame_skip=4)
    for action in np.random.default_rng(2).integers(0, NUM_ACTIONS, 60):
        ours, theirs = env.step(np.array([action])), mirror.step(MIRROR_ACTIONS[[action]])
        assert ours.observation == pytest.approx(theirs.observation[:, MIRROR_FEATURES] * MIRROR_SIGNS, abs=1e-5)
        assert ours.reward == pytest.approx(theirs.reward, abs=1e-3)


def test_the_curriculum_follows_landings():
    named = [Curriculum().spawn(landings) for landings in (0, 99, 100, 200, 299, 300)]
    assert named == ["fixed", "fixed", "higher", "highest", "highest", "random"]
    env = LanderEnv(1, 0, Curriculum())
    for landings, height, stage in ((0, 8.0, 0), (150, 12.0, 1)):
        env.landings = landings
        env.reset()
        assert env.position[0].tolist() == [0.0, height]
        assert env.stage == stage
    for unknown in ("mars", "", None, ["random"]):
        with pytest.raises(ValueError, match="spawn is one of fixed, higher"):
            LanderEnv(2, 0, unknown)
    with pytest.raises(ValueError, match="rising thresholds"):
        Curriculum(((0, "fixed"), (0, "random")))


def test_wrong_actions_and_shares_are_refused_and_steps_before_a_reset():
    with pytest.raises(RuntimeError, match="reset"):
        LanderEnv(1).step(np.array([0]))
    env = placed((0, 15), (1, 15))
    for actions in [[6, 0], [-1, 0], [0], [0, 0, 0], [[0, 0]], [0.5, 1.0], [np.nan, 0.0], ["a", "b"]]:
        with pytest.raises(ValueError, match="actions"):
            env.step(actions)
    for shares in ([1.5, 0.0], [-0.1, 0.0], [0.0, -1.1], [np.nan, 0.0], [0.0]):
        with pytest.raises(ValueError, match="shares of thrust"):
            env.fly(np.zeros(2, int), np.array([shares, shares]))


def test_a_flight_does_not_begin_at_just_any_state():
    env = placed((0, 15))
    before = env.observe()
    for start, how in [
        ((0.0, np.nan, 0, 0, 0, 0), "finite"),
        ((0.0, 9.0, 0, 0, 0), "six"),
        ((22.5, 9.0, 0, 0, 0, 0), "inside"),
        ((0.0, 26.5, 0, 0, 0, 0), "inside"),
        ((0.0, 2.5, 0, 0, 0, 0), "above"),  # in the pad
        ((9.0, 2.1, 0, 0, 0.8, 0), "above"),  # a foot in the plain
    ]:
        with pytest.raises(ValueError, match=how):
            env.begin_at(0, np.array(start))
        assert np.array_equal(env.observe(), before), start


def test_the_lowest_height_clears_the_ground_and_no_more():
    for x, angle in np.random.default_rng(2).uniform((-6.0, -3.0), (6.0, 3.0), (40, 2)):
        for above, touches in ((0.05, False), (-0.1, True)):
            env = placed((x, LanderEnv(1).lowest(x, angle) + above, 0, 0, angle))
            env.world.gravity = (0.0, -0.0)
            env.fly(np.zeros(1, np.intp))
            assert (env.world.contacts is not None) == touches


def test_a_share_of_thrust_is_that_share_of_force_and_of_fuel():
    env = placed(*[(0, 15)] * 5)
    shares = np.array([[0.0, 0.0], [0.5, 0.0], [1.0, 0.0], [0.0, -0.25], [0.0, 0.25]])
    for _ in range(6):
        env.fly(np.array([3, 3, 3, 1, 2]), shares)
    speed = env.velocity[:3, 1]
    assert speed[1] - speed[0] == pytest.approx(speed[2] - speed[1], rel=1e-2)
    assert env.fuel == pytest.approx([0.0, 0.05, 0.1, 0.0025, 0.0025])
    assert env.angle[3] == -env.angle[4] > 0


def test_the_nearest_action_is_its_own_at_full_and_never_nothing_for_something():
    some = ((0.1, 0.0, 3), (0.1, -0.2, 1), (0.2, 0.1, 3), (0.6, 0.4, 3), (0.4, 0.6, 2), (0.0, 0.0, 0))
    full = [(main, side, action) for action, (main, side) in enumerate(ACTION_SHARES.tolist())]
    for main, side, action in (*full, *some):
        assert nearest_action(main, side) == action


@pytest.mark.parametrize("given", [{"frame_skip": 1.5}, {"frame_skip": True}, {"num_envs": 2.0}, {"num_envs": 0}])
def test_numbers_of_landers_and_steps_are_whole(given):
    with pytest.raises(ValueError, match=f"{next(iter(given))} is a whole number from 1 on"):
        LanderEnv(**given)
