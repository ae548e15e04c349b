"""Flights flown again: in any company, each earns what it earned alone, and a wrong claim is found out."""

from dataclasses import replace

import numpy as np
import pytest

from ai.flights.recording import Claim, Recording, SharedFlight, StickHolder
from ai.flights.verification import TOLERANCE, begun, earned, fly_again, is_true, verified
from ai.lander.environment import LanderEnv, Outcome
from ai.lander.missions import STARTS
from ai.lander.pilots import ScriptedPilot


def flown(seed, pads=1, mission="", gravity=()):
    """A flight by the scripted pilot, with a true claim."""
    env, pilot, actions = begun(Recording(seed, "random", pads, mission=mission)), ScriptedPilot(), []
    while env.outcome[0] == Outcome.FLYING:
        if len(actions) in dict(gravity):
            env.gravity = dict(gravity)[len(actions)] * env.params.gravity
        actions += pilot.act(env.observe()).tolist()
        env.fly(np.array(actions[-1:]))
    hands = [StickHolder.HUMAN] * len(actions)
    recording = Recording(seed, "random", pads, mission, gravity, actions=actions, hands=hands)
    real = earned(env, recording)
    return SharedFlight(recording, Claim(real.outcome, real.points, real.end), mission), real


ROWS = [flown(3), flown(4), flown(5, pads=3), flown(0, mission="fall"), flown(6, gravity=((0, 0.8), (60, 1.2)))]


def test_each_earns_the_same_in_any_company_bit_for_bit():
    flights = [flight for flight, _ in ROWS * 2]
    found = dict(verified(flights))
    assert [found[index] for index in range(len(flights))] == [real for _, real in ROWS * 2]
    assert [fly_again([flight.recording])[0] for flight, _ in ROWS] == [real for _, real in ROWS]


@pytest.mark.parametrize(("pads", "mission"), [(1, ""), (3, ""), (1, "wind")])
def test_flights_begin_as_they_always_did(pads, mission):
    env = begun(Recording(7, "random", pads, mission=mission))
    before = STARTS[mission].begin() if mission else LanderEnv(1, 7, "random", frame_skip=1, ground=env.ground)
    if not mission:
        before.reset()
    assert np.array_equal(env.observe(), before.observe())


def test_a_landing_earns_points_and_in_a_mission_a_medal():
    assert all(real.outcome is Outcome.LANDED for _, real in ROWS[:4])
    assert all(real.points > 0 for _, real in ROWS[:4])
    assert [real.medal > 0 for _, real in ROWS[:4]] == [False, False, False, True]


def test_true_claims_are_true_and_wrong_ones_are_not():
    flight, real = ROWS[0]
    claim, recording = flight.claim, flight.recording
    x, y, angle = claim.end
    assert is_true(flight, real)
    assert is_true(replace(flight, claim=replace(claim, end=(x + TOLERANCE / 2, y, angle))), real)
    for wrong in (
        replace(claim, points=claim.points + 1),
        replace(claim, outcome=Outcome.CRASHED),
        replace(claim, end=(x + 2 * TOLERANCE, y, angle)),
        replace(claim, medal=1),
    ):
        assert not is_true(replace(flight, claim=wrong), real)
    longer = replace(recording, actions=[*recording.actions, 0])
    assert not is_true(replace(flight, recording=longer), real)


def test_a_record_that_stops_before_the_end_has_earned_nothing():
    recording = ROWS[0][0].recording
    half = replace(recording, actions=recording.actions[:60])
    none = replace(recording, actions=[])
    real = [fly_again([each])[0] for each in (half, none)]
    assert [(each.outcome, each.points, each.steps) for each in real] == [
        (Outcome.FLYING, 0, 60),
        (Outcome.FLYING, 0, 0),
    ]


def test_what_is_recorded_after_the_end_is_not_flown():
    flight, real = ROWS[0]
    longer = replace(flight.recording, actions=[*flight.recording.actions, 3, 3])
    assert fly_again([longer])[0] == real
    assert not is_true(replace(flight, recording=longer), real)
