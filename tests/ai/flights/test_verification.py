"""Flights of every kind, sent and flown again: each earns what it earned, and a wrong claim is found out."""

from dataclasses import replace
from datetime import date
from functools import cache
from typing import Any

import numpy as np
import pytest

from ai.flights.code import code_of, flight_of
from ai.flights.recording import Claim, ClaimedFlight, Easing, Recording, StickHolder
from ai.flights.verification import (
    DAILY,
    DESCENT,
    TOLERANCE,
    begun,
    earned,
    fly_again,
    in_its_place,
    is_true,
    landing_score,
    verified,
)
from ai.lander.descent import LegStart, leg
from ai.lander.environment import LIMITS, PARAMS, LanderEnv, Outcome
from ai.lander.ground import Ground, Pad
from ai.lander.missions import MISSIONS, STARTS
from ai.lander.pilots import ScriptedPilot
from ai.lander.push import KEYS, Push
from ai.lander.spawns import RUNGS, SPAWNS
from game.input.analogue import pushed
from tests.support import landers

KINDS: dict[str, dict[str, Any]] = {
    "plain": {},
    "three pads": {"pads": 3},
    "a mission": {"mission": "fall"},
    "a leg of a descent": {"leg": LegStart(2, 11.375)},
    "a leg from a flat spot": {"leg": LegStart(10, 4.005, bare=True)},
    "wider pads": {"easing": Easing(wider_pads=True)},
    "wider pads among hills": {"easing": Easing(wider_pads=True), "pads": 3},
    "without a time limit": {"easing": Easing(untimed=True), "mission": "wind"},
    "a rung of the ladder": {"spawn": "rung_4"},
}
DAY = date(2026, 11, 22).toordinal()
SHORT = [KEYS[3], KEYS[0], KEYS[3], KEYS[3]] * 9


@cache
def flown(kind, analogue=False):
    """A flight by the scripted pilot, at most half a minute, with a true claim."""
    recording = Recording(11, **{"spawn": "random", **KINDS[kind]})
    env, pilot = begun(recording), ScriptedPilot()
    while env.outcome[0] == Outcome.FLYING and (step := len(recording.pushes)) < 1800:
        push = KEYS[int(pilot.act(env.observe())[0])]
        if analogue:  # as a hand on sticks: a little less than all of it
            main, side = push.shares
            push = pushed(main * 0.9, side * (0.6 + 0.4 * (step % 30 < 20)), Push())
        recording.pushes.append(push)
        recording.hands.append(StickHolder.HUMAN)
        env.fly(np.array([push.action]), np.array([push.shares]))
    return claimed(recording, earned(env, recording), recording.mission)


def claimed(recording, real, course=""):
    return ClaimedFlight(recording, Claim(real.outcome, real.points, real.end), course), real


@pytest.mark.slow
def test_a_code_of_every_kind_is_read_to_the_same_flight_and_earns_the_same_alone_and_in_company(subtests):
    keys = [(kind, False) for kind in KINDS] + [(kind, True) for kind in ("plain", "three pads", "a leg of a descent")]
    rows = [flown(*key) for key in keys]
    read = [flight_of(code_of(flight)) for flight, _ in rows]
    together = dict(verified([*read, *read[:3]]))
    assert [together[len(rows) + number] for number in range(3)] == [together[number] for number in range(3)]
    for number, (flight, real) in enumerate(rows):
        kind, analogue = keys[number]
        with subtests.test(kind=kind, analogue=analogue):
            assert set(flight.recording.pushes).issubset(KEYS) != analogue
            assert read[number].recording == flight.recording
            assert together[number] == fly_again([flight.recording])[0] == real
            assert is_true(read[number], real)
    landed = [flown(kind)[1] for kind in ("plain", "three pads", "a mission")]
    assert all(real.outcome is Outcome.LANDED and real.points > 0 for real in landed)
    assert [real.medal > 0 for real in landed] == [False, False, True]


def test_flights_begin_as_they_always_did():
    for pads, mission in ((1, ""), (3, ""), (1, "wind")):
        env = begun(Recording(7, "random", pads, mission=mission))
        before = STARTS[mission].begin() if mission else LanderEnv(1, 7, "random", frame_skip=1, ground=env.ground)
        if not mission:
            before.reset()
        assert np.array_equal(env.observe(), before.observe())


def test_true_claims_are_true_and_wrong_ones_are_not():
    flight, real = flown("plain")
    claim, pushes, (x, y, angle) = flight.claim, flight.recording.pushes, flight.claim.end
    assert is_true(replace(flight, claim=replace(claim, end=(x + TOLERANCE / 2, y, angle))), real)
    for wrong in (
        replace(claim, points=claim.points + 1),
        replace(claim, outcome=Outcome.CRASHED),
        replace(claim, end=(x + 2 * TOLERANCE, y, angle)),
        replace(claim, medal=1),
    ):
        assert not is_true(replace(flight, claim=wrong), real)
    longer = replace(flight.recording, pushes=[*pushes, *KEYS])  # what is recorded after the end is not flown
    assert fly_again([longer])[0] == real
    assert not is_true(replace(flight, recording=longer), real)
    for steps in (60, 0):  # a record that stops before the end has earned nothing
        short = fly_again([replace(flight.recording, pushes=pushes[:steps])])[0]
        assert (short.outcome, short.points, short.steps) == (Outcome.FLYING, 0, steps)


def test_points_are_fewer_for_a_hard_touch_and_off_the_middle():
    env = landers.placed((1.2, landers.STAND + 0.1, 0, -0.5), ground=Ground((Pad(0.0, PARAMS.pad_top, 6.0, 3),)))
    landers.fly(env)
    hard = env.impact[0, 0] / LIMITS.touch_speed
    assert hard > 0.2
    assert landing_score(env) == 3 * round(100 - 40 * hard - 30 * abs(env.position[0, 0]) / 3)


def test_a_medal_is_for_the_mission_as_it_is():
    flight, real = flown("a mission")
    assert real.medal == MISSIONS["fall"].medal(real.fuel, real.seconds) > 0
    assert is_true(replace(flight, claim=replace(flight.claim, medal=real.medal)), real)
    assert not is_true(replace(flight, claim=replace(flight.claim, medal=real.medal + 1)), real)
    assert fly_again([replace(flight.recording, easing=Easing(wider_pads=True))])[0].medal == 0


def placed(course="", seed=DAY, spawn="random", pads=1, **rest):
    """A short flight with a true claim but, maybe, for its course."""
    recording = Recording(seed, spawn, pads, pushes=SHORT, **rest)
    return claimed(recording, fly_again([recording])[0], course)


def test_a_flight_is_true_from_its_place_and_from_elsewhere_not_whatever_it_earned(subtests):
    spots = {number: any(pad.bare for pad in leg(DAY, number).ground.pads) for number in range(1, 9)}
    no_spot, spot = (next(number + 1 for number, has in spots.items() if has is wanted) for wanted in (False, True))
    here = (
        placed(),
        placed(pads=3),
        placed(easing=Easing(wider_pads=True)),
        placed(spawn="rung_3"),
        placed(DAILY, pads=3),
        placed(DAILY, pads=3, easing=Easing(untimed=True)),
        placed("wind", seed=0, mission="wind"),
        placed("tank", seed=5, mission="tank", easing=Easing(wider_pads=True)),
        placed(DESCENT, leg=LegStart()),
        placed("", leg=LegStart(2, 9.5)),
        placed(DESCENT, leg=LegStart(spot, 3.25, bare=True)),
    )
    elsewhere = (
        placed(DAILY),  # one pad
        placed(DAILY, pads=3, seed=0),  # before the first day
        placed(DAILY, pads=3, seed=10**9),  # after the last
        placed(DAILY, pads=3, spawn="rung_1"),
        placed(DAILY, mission="fall"),
        placed(DAILY, leg=LegStart()),
        placed("wind"),
        placed("wind", mission="fall"),
        placed(mission="wind"),
        placed(DESCENT),
        placed(DESCENT, mission="fall"),
        placed(DESCENT, leg=LegStart(1, 12.0)),  # the first tank is full
        placed(DESCENT, leg=LegStart(1, bare=True)),
        placed(DESCENT, leg=LegStart(2, 4.9)),  # a landing brings more
        placed(DESCENT, leg=LegStart(no_spot, 6.0, bare=True)),
        placed(DESCENT, leg=LegStart(), easing=Easing(wider_pads=True)),
        placed("tank", leg=LegStart()),
        placed(spawn="rung_3", pads=3),
        *(placed(spawn=spawn) for spawn in set(SPAWNS) - {"random", *RUNGS}),
        placed("elsewhere"),
    )
    for flight, real in (*here, *elsewhere):
        with subtests.test(flight=flight):
            assert is_true(flight, real) == in_its_place(flight) == ((flight, real) in here)
