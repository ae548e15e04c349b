"""A descent's legs: what they follow from, that they can be flown, and the routes that lead networks through them."""

from itertools import product

import numpy as np
import pytest

from ai.agent.agent import DeepQAgent
from ai.lander.descent import TANK, LegStart, can_begin, leg, leg_of, refill
from ai.lander.environment import Cause, Outcome
from ai.lander.pilots import ScriptedPilot
from ai.lander.route import Route, sink_of
from game.core.assets import MODELS_DIR
from tests.support.descent import QUICK, SLOW, descend, stand_on
from tests.support.landers import fly, placed, put

NUMBERS = (1, 2, 3, 4, 5, 7, 9, 13, 40)
CLEAR = 1.6  # metres around a craft's middle, which reaches 1.1 sideways and 1 down


def test_a_leg_follows_from_seed_number_and_start_alone():
    first = leg_of(5, LegStart(7))
    leg.cache_clear()
    assert leg_of(5, LegStart(7)) == first
    assert leg_of(6, LegStart(7)) != first
    assert leg_of(5, LegStart(7, tank=3.0)) == first  # what is in the tank changes no ground
    first_kinds = {leg(1, number).kinds for number in range(1, 6)}
    assert first_kinds == {("open",), ("ridge",), ("canyon",), ("overhang",), ("cave",)}


def test_a_route_keeps_clear_of_all_rock_and_the_start_stands_free(subtests: pytest.Subtests):
    around = np.linspace(0, 2 * np.pi, 12, endpoint=False)
    circle = CLEAR * np.stack([np.cos(around), np.sin(around)], axis=1)
    for number, bare in product(NUMBERS, (False, True)):
        flown = leg(number % 3, number, bare)
        with subtests.test(number=number, bare=bare, kinds=flown.kinds):
            route = Route(flown.route)
            way = route.point(np.arange(0, route.length, 0.25))
            ring = (way[:, None] + circle).reshape(-1, 2)
            assert (ring[:, 1] > flown.ground.height(ring[:, 0])).all()
            assert not flown.ground.roofed(ring).any()
            env = flown.begin(TANK)
            fly(env, steps=40)
            assert env.outcome[0] == Outcome.FLYING  # it stands, and standing where it began ends nothing
            assert env.feet_down.all()


def test_a_landing_on_the_goal_or_a_flat_spot_ends_a_leg_and_one_at_the_start_does_not():
    flown = next(each for seed in range(4) if len((each := leg(seed, 3)).ground.pads) == 3)
    for pad, ends in ((0, True), (1, True), (2, False)):
        env = flown.begin(TANK)
        stand_on(env, pad)
        fly(env, steps=60)
        assert bool(env.outcome[0] == Outcome.LANDED) is ends
        assert env.landed_on[0] == (pad if ends else -1)


def test_rock_that_hangs_is_struck_from_below_and_lies_over_open_ground():
    flown = leg(0, 4)
    (roof,) = flown.ground.roofs
    corners = np.array(roof)
    middle = corners.mean(axis=0)
    assert flown.ground.roofed(middle[None])[0]
    assert flown.ground.height(middle[0]) < corners[:, 1].min() - 4
    env = put(flown.begin(TANK), (middle[0], corners[:, 1].min() - 1.6, 0, 1.5))
    fly(env, 3, steps=90)
    assert env.outcome[0] == Outcome.CRASHED
    assert env.cause[0] in (Cause.HULL, Cause.TERRAIN)


def test_the_tank_goes_from_leg_to_leg_and_a_better_landing_brings_more():
    assert refill(100, bare=False) > refill(50, bare=False) > refill(0, bare=False) > 0 == refill(300, bare=True)
    assert refill(300, bare=False) == refill(100, bare=False)
    after = LegStart(3, 9.0).after(6.5, 60, bare=False)
    assert after == LegStart(4, round(2.5 + refill(60, bare=False), 3))
    assert LegStart(3, TANK).after(0.5, 100, bare=False).tank == TANK  # no more than it holds
    assert LegStart(3, 9.0).after(6.5, 240, bare=True) == LegStart(4, 2.5, bare=True)


def test_a_leg_begins_as_the_one_before_can_have_ended():
    assert can_begin(5, LegStart())
    assert not can_begin(5, LegStart(1, 9.0))
    assert can_begin(5, LegStart(2, 5.0))
    assert not can_begin(5, LegStart(2, 4.9))  # a pad has filled it up
    flat = {number: any(pad.bare for pad in leg(5, number - 1).ground.pads) for number in range(2, 12)}
    assert set(flat.values()) == {True, False}
    for number, there in flat.items():
        assert can_begin(5, LegStart(number, 9.0, bare=True)) is there


def test_a_pilot_is_led_at_the_speed_at_which_it_comes_down_itself():
    class Falls:
        def act(self, observation: np.ndarray, *, held: np.ndarray | None = None) -> np.ndarray:
            return np.where(observation[:, 3] < -1.0, 3, 0)  # brakes below 2 m/s, as scaled

    assert sink_of(Falls()) == pytest.approx(2.0, abs=0.15)


def test_a_route_leads_on_from_its_nearest_point_and_ends_over_the_goal():
    route = Route([(0, 5), (4, 5), (4, 9)])
    assert route.length == 8
    assert route.point([-1.0, 5.0, 99.0]).tolist() == [[0, 5], [4, 6], [4, 9]]
    assert route.nearest(np.array([1.0, 6.0])) == 1
    assert route.nearest(np.array([9.0, 7.0])) == 6
    (across, _), (up, _) = route.lead(np.array([[1.0, 6.0], [4.0, 8.9]]))[0].T
    assert across > 0 > up  # on, and back to the route
    assert route.lead(np.array([[1.0, 6.0], [4.0, 8.9]]))[1].tolist() == [False, True]
    plain = placed((4.0, 8.9))
    assert (route.observe(plain, ScriptedPilot()) == plain.observe()).all()


def test_the_network_lands_the_first_legs_and_so_do_slow_hands():
    agent = DeepQAgent.load(MODELS_DIR / "lander" / "modern")
    assert descend(0, agent, QUICK, most=3).legs == 3
    assert descend(0, ScriptedPilot(), SLOW, most=2).legs == 2


def test_one_that_touches_rock_overhead_softly_is_not_down():
    flown = leg(0, 4)
    corners = np.array(flown.ground.roofs[0])
    env = put(flown.begin(TANK), (corners[:, 0].mean(), corners[:, 1].min() - 1.6, 0, 2.0))
    fly(env, steps=90)
    assert env.outcome[0] == Outcome.CRASHED
    assert (env.impact[0, :2] < env.limits.touch_speed).all()
    assert not env.intact[0]
