from dataclasses import replace

import numpy as np
import pytest

from ai.lander.environment import LIMITS, NUM_ACTIONS, PARAMS, Cause, LanderEnv, Outcome
from ai.lander.missions import MISSIONS
from ai.lander.rewards import RewardWeights
from ai.lander.rules import ACTION_SHARES, MIRROR_ACTIONS, MIRROR_FEATURES, MIRROR_SIGNS, nearest_action
from ai.lander.spawns import SPAWNS, Curriculum
from engine import DT

STAND = PARAMS.pad_top + PARAMS.stand


def placed(*starts, frame_skip=1, **options):
    """Landers that begin at rows x, y, vx, vy, angle, spin."""
    env = LanderEnv(len(starts), 0, frame_skip=frame_skip, **options)
    env.place(np.ones(len(starts), dtype=bool), np.array(starts, dtype=float))
    return env


def fly(env, action=0, steps=600):
    for _ in range(steps):
        result = env.step(np.full(env.num_envs, action))
        if result.ended.all():
            break
    return result


def test_free_fall_follows_gravity_and_drag():
    env = placed((0, 20, 0, 0, 0, 0))
    fly(env, steps=30)
    expected = 0.0
    for _ in range(30):
        speed = abs(expected)
        drag = (PARAMS.linear_drag + PARAMS.quadratic_drag * speed) * DT
        expected = (expected - PARAMS.gravity * DT) / (1 + drag)
    assert env.velocity[0, 1] == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize(
    ("action", "x", "y", "spin"),
    [(1, -1, 0, 1), (2, 1, 0, -1), (3, 0, 1, 0), (4, -1, 1, 1), (5, 1, 1, -1)],
)
def test_actions_push_and_turn_as_documented(action, x, y, spin):
    env = placed((0, 15, 0, 0, 0, 0))
    coasting = placed((0, 15, 0, 0, 0, 0))
    env.step(np.array([action]))
    coasting.step(np.array([0]))
    gained = env.velocity[0] - coasting.velocity[0]
    assert np.sign(np.round(gained, 6)).tolist() == [x, y]
    assert np.sign(np.round(env.angular_velocity[0], 6)) == spin
    if y:
        assert gained[1] == pytest.approx(PARAMS.main_thrust / PARAMS.mass * DT, rel=1e-2)


def test_standing_still_on_the_pad_for_half_a_second_is_a_landing():
    env = placed((1.0, STAND, 0, 0, 0, 0))
    result = fly(env)
    assert env.outcome[0] == Outcome.LANDED
    assert result.terminated[0]
    assert not result.truncated[0]
    assert LIMITS.rest_steps <= env.steps[0] <= LIMITS.rest_steps + 10
    assert env.contacts.all()
    assert env.altitude[0] == pytest.approx(0.0, abs=0.01)


def test_each_way_to_crash_is_named_by_the_limit_that_was_broken(subtests):
    for start, cause, limits in [
        ((0, STAND + 0.02, 0, -2.3, 0, 0), Cause.HARD, LIMITS),
        ((0, STAND + 0.02, 0, -1.5, 0, 0), Cause.HARD, replace(LIMITS, touch_speed=1.2)),
        ((0, STAND + 0.02, 2.4, -0.5, 0, 0), Cause.SLIDING, LIMITS),
        ((0, STAND + 0.02, 1.6, -0.5, 0, 0), Cause.SLIDING, replace(LIMITS, slide_speed=1.2)),
        ((0, STAND + 0.3, 0, -0.5, 0.6, 0), Cause.TILTED, LIMITS),
        ((0, STAND, 0, -0.3, np.pi, 0), Cause.HULL, LIMITS),
        ((10, STAND - 0.5, 0, -0.3, 0, 0), Cause.TERRAIN, LIMITS),
    ]:
        with subtests.test(start=start, cause=cause):
            env = placed(start, limits=limits)
            assert fly(env).components["terminal"][0] == -RewardWeights().terminal
            assert env.outcome[0] == Outcome.CRASHED
            assert env.cause[0] == cause
            assert bool(env.intact[0]) is (cause == Cause.TERRAIN)


def test_a_touch_just_within_the_limits_is_no_crash():
    env = placed((0, STAND + 0.01, 0, -1.9, 0, 0))
    fly(env)
    assert env.outcome[0] == Outcome.LANDED
    assert not env.intact[0]
    assert 1.8 < env.impact[0, 0] < LIMITS.touch_speed


def test_rest_is_counted_anew_after_a_hop():
    env = placed((0, STAND, 0, 0, 0, 0), (1, STAND, 0, 0, 0, 0))
    fly(env, steps=LIMITS.rest_steps - 5)
    assert env.still_steps.all()
    fly(env, action=3, steps=20)
    assert not env.contacts.any()
    assert not env.still_steps.any()


def test_leaving_the_area_and_running_out_of_time():
    env = placed((21.9, 15, 6, 0, 0, 0), (0, 25.9, 0, 6, 0, 0))
    result = fly(env)
    assert (env.outcome == Outcome.OUT_OF_BOUNDS).all()
    assert result.terminated.all()
    hover = LanderEnv(1, 0, frame_skip=1)
    hover.reset()
    hover.steps[:] = round(LIMITS.time / DT) - 1
    result = hover.step(np.array([0]))
    assert hover.outcome[0] == Outcome.TIMED_OUT
    assert result.truncated[0]
    assert not result.terminated[0]


def test_a_flight_is_the_same_alone_and_in_a_batch():
    rng = np.random.default_rng(3)
    actions = rng.integers(0, NUM_ACTIONS, (300, 40))
    alone, many = LanderEnv(1, 7, "practice"), LanderEnv(40, 7, "practice")
    assert np.array_equal(alone.reset()[0], many.reset()[0])
    for row in actions:
        one, all_ = alone.step(row[:1]), many.step(row)
        assert np.array_equal(one.observation[0], all_.observation[0])
        assert one.reward[0] == all_.reward[0]
        assert one.outcome[0] == all_.outcome[0]
        if one.ended[0]:
            alone.reset(np.array([True]))
            many.reset(all_.ended)


def test_frame_skip_only_holds_the_action():
    fine, coarse = placed((3, 12, 1, -1, 0.2, 0.1)), placed((3, 12, 1, -1, 0.2, 0.1), frame_skip=4)
    for action in (0, 3, 4, 5, 2):
        rewards = [fine.step(np.array([action])).reward[0] for _ in range(4)]
        result = coarse.step(np.array([action]))
        assert np.array_equal(fine.observe(), result.observation)
        assert result.reward[0] == pytest.approx(sum(rewards), abs=1e-4)


def test_a_flight_without_pay_is_the_same_flight():
    paid, unpaid = (LanderEnv(12, 5, "practice", frame_skip=2) for _ in range(2))
    paid.reset()
    unpaid.reset()
    for actions in np.random.default_rng(2).integers(0, NUM_ACTIONS, (150, 12)):
        result = paid.step(actions)
        unpaid.fly(actions)
        assert np.array_equal(result.observation, unpaid.observe())
        assert np.array_equal(result.outcome, unpaid.outcome)
        assert np.array_equal(paid.fuel, unpaid.fuel)
        if result.ended.any():
            paid.reset(result.ended)
            unpaid.reset(result.ended)
    assert paid.landings == unpaid.landings
    with pytest.raises(ValueError, match="0 to 5"):
        unpaid.fly(np.full(12, 6))


def test_gliding_is_flying_until_something_touches_and_goes_through_it_after():
    flown, glided = (placed((3, 12, 1, -1, 0.2, 0.1), (0, 5, 0, -2, 0, 0), frame_skip=4) for _ in range(2))
    for action in (0, 3, 4, 5, 2):
        actions = np.array([action, 0])
        assert np.array_equal(flown.step(actions).observation[0], glided.glide(actions)[0])
    for _ in range(20):
        flown.step(np.array([0, 0]))
        glided.glide(np.array([0, 0]))
    assert flown.outcome[1] == Outcome.CRASHED
    assert glided.outcome[1] == Outcome.FLYING
    assert glided.position[1, 1] < 0 < flown.position[1, 1]


def test_ended_slots_stay_as_they_ended_until_reset():
    env = placed((0, STAND + 0.02, 0, -3, 0, 0), (0, 15, 0, 0, 0, 0))
    ended = fly(env, steps=10)
    later = env.step(np.array([3, 3]))
    assert np.array_equal(later.observation[0], ended.observation[0])
    assert later.reward[0] == 0
    assert later.terminated[0]
    assert not later.terminated[1]
    assert not np.array_equal(later.observation[1], ended.observation[1])
    env.reset(np.array([True, False]))
    assert env.outcome.tolist() == [Outcome.FLYING, Outcome.FLYING]
    assert env.time[0] == 0
    assert env.time[1] > 0


def test_a_mirrored_flight_is_the_mirror_image():
    start = np.array([3, 12, 1, -1, 0.2, 0.1])
    env, mirror = placed(start, frame_skip=4), placed(start * [-1, 1, -1, 1, -1, -1], frame_skip=4)
    rng = np.random.default_rng(2)
    for action in rng.integers(0, NUM_ACTIONS, 60):
        ours = env.step(np.array([action]))
        theirs = mirror.step(MIRROR_ACTIONS[[action]])
        reflected = theirs.observation[:, MIRROR_FEATURES] * MIRROR_SIGNS
        assert ours.observation == pytest.approx(reflected, abs=1e-5)
        assert ours.reward == pytest.approx(theirs.reward, abs=1e-3)


def test_spawns_lie_where_they_should():
    rng = np.random.default_rng(0)
    for name, draw in SPAWNS.items():
        drawn = np.array([draw(rng) for _ in range(500)])
        beyond = name in ("wide", "thorough", "mixed", "far")
        assert np.abs(drawn[:, 0]).max() <= (17 if beyond else 15)
        assert drawn[:, 1].min() >= STAND
        assert drawn[:, 1].max() <= (21 if beyond else 20)
        limit = 90 if name in ("hard", "far") else 50 if beyond else 35
        assert np.degrees(np.abs(drawn[:, 4])).max() <= limit + 1e-9


def test_once_it_lands_half_of_the_hard_starts_lead_away_from_the_pad():
    rng = np.random.default_rng(0)
    starts = np.array([SPAWNS["far"](rng) for _ in range(4000)])
    x, _, vx, _, angle, spin = starts.T
    tilted = np.abs(angle) > np.radians(50)  # beyond what any but hard starts are
    away = tilted & (x * vx > 0) & (x * angle < 0) & (x * spin < 0)
    assert tilted.mean() == pytest.approx(0.3 * 40 / 90, abs=0.02)
    assert away.sum() / tilted.sum() == pytest.approx(0.5 + 0.5 / 8, abs=0.05)


def test_the_curriculum_follows_landings():
    curriculum = Curriculum()
    assert [curriculum.spawn(n) for n in (0, 99, 100, 200, 299, 300)] == [
        "fixed",
        "fixed",
        "higher",
        "highest",
        "highest",
        "random",
    ]
    env = LanderEnv(1, 0, curriculum)
    env.reset()
    assert env.position[0].tolist() == [0.0, 8.0]
    env.landings = 150
    env.reset()
    assert env.position[0].tolist() == [0.0, 12.0]
    assert env.stage == 1
    for unknown in ("mars", "", None, ["random"]):
        with pytest.raises(ValueError, match="spawn is one of fixed, higher"):
            LanderEnv(2, 0, unknown)
    with pytest.raises(ValueError, match="rising thresholds"):
        Curriculum(((0, "fixed"), (0, "random")))


def test_wrong_actions_are_refused(subtests):
    for actions in [[6, 0], [-1, 0], [0], [0, 0, 0], [[0, 0]], [0.5, 1.0], [np.nan, 0.0], ["a", "b"]]:
        with subtests.test(actions=actions):
            env = LanderEnv(2, 0)
            env.reset()
            with pytest.raises(ValueError, match="actions"):
                env.step(actions)


def test_stepping_before_a_reset_says_so():
    with pytest.raises(RuntimeError, match="reset"):
        LanderEnv(1).step(np.array([0]))


def test_what_is_observed_at_a_place_is_what_a_lander_put_there_observes():
    rng = np.random.default_rng(2)
    env = LanderEnv(3, seed=4)
    env.reset()
    for _ in range(20):
        env.fly(np.array([3, 1, 5]))
    places = np.stack([rng.uniform(-20, 20, 12), rng.uniform(4, 24, 12)], axis=1)
    velocity, angle, spin = env.velocity[1], env.angle[1], env.angular_velocity[1]
    there = env.observe_at(1, places)
    for place, seen in zip(places, there, strict=True):
        env.begin_at(1, np.array([*place, *velocity, angle, spin]))
        assert np.array_equal(env.observe()[1], seen)


def test_a_flight_begun_at_a_state_flies_from_there_and_leaves_the_others_alone():
    env, twin = (LanderEnv(2, seed=4, frame_skip=1) for _ in range(2))
    for each in (env, twin):
        each.reset()
        for _ in range(30):
            each.fly(np.array([3, 0]))
    start = np.array([-3.0, 9.0, 1.5, -2.0, 0.3, -0.2])
    env.begin_at(1, start)
    assert np.array_equal(np.concatenate([env.position[1], env.velocity[1]]), start[:4])
    assert env.outcome[1] == Outcome.FLYING
    assert env.steps.tolist() == [30, 0]
    alone = LanderEnv(1, frame_skip=1)
    alone.place(np.ones(1, bool), start[None])
    for _ in range(40):
        env.fly(np.array([3, 4]))
        twin.fly(np.array([3, 4]))
        alone.fly(np.array([4]))
    assert np.array_equal(env.observe()[0], twin.observe()[0])
    assert np.array_equal(env.observe()[1], alone.observe()[0])


def test_a_flight_does_not_begin_at_just_any_state(subtests):
    for start, how in [
        ((0.0, np.nan, 0, 0, 0, 0), "finite"),
        ((0.0, 9.0, np.inf, 0, 0, 0), "finite"),
        ((0.0, 9.0, 0, 0, 0), "six"),
        ((22.5, 9.0, 0, 0, 0, 0), "inside"),
        ((0.0, 26.5, 0, 0, 0, 0), "inside"),
        ((0.0, 2.5, 0, 0, 0, 0), "above"),  # in the pad
        ((9.0, 2.1, 0, 0, 0.8, 0), "above"),  # a foot in the plain
    ]:
        with subtests.test(start=start, how=how):
            env = LanderEnv(1, seed=1)
            env.reset()
            before = env.observe()
            with pytest.raises(ValueError, match=how):
                env.begin_at(0, np.array(start))
            assert np.array_equal(env.observe(), before)


def test_the_lowest_height_clears_the_ground_and_no_more():
    rng = np.random.default_rng(2)
    for x, angle in rng.uniform((-6.0, -3.0), (6.0, 3.0), (40, 2)):
        for above, touches in ((0.05, False), (-0.1, True)):
            env = LanderEnv(1, frame_skip=1)
            low = env.lowest(x, angle)
            env.gravity = 0.0
            env.place(np.ones(1, bool), np.array([[x, low + above, 0, 0, angle, 0]]))
            env.fly(np.zeros(1, np.intp))
            assert (env.world.contacts is not None) == touches


def test_full_shares_are_the_six_actions_bit_for_bit(subtests):
    for mission in ("wind", "tank", "outage", "ferry", "earth"):
        with subtests.test(mission=mission):
            plain, shared = (MISSIONS[mission].begin(6) for _ in range(2))
            for actions in np.random.default_rng(5).integers(0, NUM_ACTIONS, (200, 6)):
                plain.fly(actions)
                shared.fly(actions, ACTION_SHARES[actions])
            for name in ("position", "velocity", "angle", "angular_velocity", "fuel", "outcome"):
                assert getattr(plain, name).tobytes() == getattr(shared, name).tobytes(), name


def test_a_share_of_thrust_is_that_share_of_force_and_of_fuel():
    env = placed(*[(0, 15, 0, 0, 0, 0)] * 5)
    shares = np.array([[0.0, 0.0], [0.5, 0.0], [1.0, 0.0], [0.0, -0.25], [0.0, 0.25]])
    for _ in range(6):
        env.fly(np.array([3, 3, 3, 1, 2]), shares)
    speed = env.velocity[:3, 1]
    assert speed[1] - speed[0] == pytest.approx(speed[2] - speed[1], rel=1e-2)
    assert env.fuel == pytest.approx([0.0, 0.05, 0.1, 0.0025, 0.0025])
    assert env.angle[3] == -env.angle[4] > 0
    for wrong in ([[1.5, 0.0]], [[-0.1, 0.0]], [[0.0, -1.1]], [[np.nan, 0.0]], [[0.0]], [[0, 0], [0, 0]]):
        with pytest.raises(ValueError, match="shares of thrust"):
            placed((0, 15, 0, 0, 0, 0)).fly(np.array([0]), np.array(wrong))


def test_the_nearest_action_is_its_own_at_full_and_never_nothing_for_something():
    for action, (main, side) in enumerate(ACTION_SHARES.tolist()):
        assert nearest_action(main, side) == action
    for main, side, action in (
        (0.1, 0.0, 3),
        (0.1, -0.2, 1),
        (0.2, 0.1, 3),
        (0.6, 0.4, 3),
        (0.4, 0.6, 2),
        (0.0, 0.0, 0),
    ):
        assert nearest_action(main, side) == action
