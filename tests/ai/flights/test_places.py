"""Places of flights: a claim about the start of a day, a mission, a leg or a rung holds only for flights there."""

from dataclasses import replace
from datetime import date

import numpy as np

from ai.flights.recording import Claim, Easing, Recording, SharedFlight
from ai.flights.verification import DAILY, DESCENT, fly_again, in_its_place, is_true
from ai.lander.descent import LegStart, leg
from ai.lander.environment import Outcome
from ai.lander.missions import MISSIONS
from ai.lander.pilots import ScriptedPilot
from ai.lander.spawns import RUNGS, SPAWNS

DAY = date(2026, 11, 22).toordinal()
ACTIONS = [3, 0, 3, 3] * 9


def flown(course="", seed=DAY, spawn="random", pads=1, **rest):
    """A short flight with a true claim but, maybe, for its course."""
    recording = Recording(seed, spawn, pads, actions=ACTIONS, **rest)
    return flown_as(recording, course)


def flown_as(recording, course):
    (real,) = fly_again([recording])
    return SharedFlight(recording, Claim(real.outcome, real.points, real.end), course), real


def bare_after(seed):
    """The first two legs behind one without and one with a flat spot."""
    spots = {number: any(pad.bare for pad in leg(seed, number).ground.pads) for number in range(1, 9)}
    return tuple(next(number + 1 for number, has in spots.items() if has is wanted) for wanted in (False, True))


def test_a_flight_from_its_place_is_true():
    _, behind_a_spot = bare_after(DAY)
    for flight, real in (
        flown(),
        flown(pads=3),
        flown(gravity=((0, 0.5),)),
        flown(easing=Easing(wider_pads=True)),
        flown(spawn="rung_3"),
        flown(DAILY, pads=3),
        flown(DAILY, pads=3, easing=Easing(untimed=True)),
        flown("wind", seed=0, mission="wind"),
        flown("tank", seed=5, mission="tank", easing=Easing(wider_pads=True)),
        flown(DESCENT, leg=LegStart()),
        flown("", leg=LegStart(2, 9.5)),
        flown(DESCENT, leg=LegStart(behind_a_spot, 3.25, bare=True)),
    ):
        assert is_true(flight, real), flight


def test_a_flight_from_elsewhere_is_not_whatever_it_earned():
    no_spot, _ = bare_after(DAY)
    for flight, real in (
        flown(DAILY),  # one pad
        flown(DAILY, pads=3, seed=0),  # before the first day
        flown(DAILY, pads=3, seed=10**9),  # after the last
        flown(DAILY, pads=3, spawn="rung_1"),
        flown(DAILY, pads=3, gravity=((0, 0.7),)),
        flown(DAILY, mission="fall"),
        flown(DAILY, leg=LegStart()),
        flown("wind"),
        flown("wind", mission="fall"),
        flown("wind", mission="wind", gravity=((9, 0.7),)),
        flown(mission="wind"),
        flown(DESCENT),
        flown(DESCENT, mission="fall"),
        flown(DESCENT, leg=LegStart(1, 12.0)),  # the first tank is full
        flown(DESCENT, leg=LegStart(1, bare=True)),
        flown(DESCENT, leg=LegStart(2, 4.9)),  # a landing brings more
        flown(DESCENT, leg=LegStart(no_spot, 6.0, bare=True)),
        flown(DESCENT, leg=LegStart(), gravity=((0, 0.7),)),
        flown("tank", leg=LegStart()),
        flown(spawn="rung_3", pads=3),
        *(flown(spawn=spawn) for spawn in set(SPAWNS) - {"random", *RUNGS}),
        flown("elsewhere"),
    ):
        assert not in_its_place(flight), flight
        assert not is_true(flight, real), flight


def test_a_medal_is_for_the_mission_as_it_is():
    env, pilot, actions = MISSIONS["fall"].begin(), ScriptedPilot(), []
    while env.outcome[0] == Outcome.FLYING:
        actions += pilot.act(env.observe()).tolist()
        env.fly(np.array(actions[-1:]))
    flight, real = flown_as(Recording(0, "random", actions=actions, mission="fall"), "fall")
    assert real.medal == MISSIONS["fall"].medal(real.fuel, real.seconds) > 0
    assert is_true(replace(flight, claim=replace(flight.claim, medal=real.medal)), real)
    assert not is_true(replace(flight, claim=replace(flight.claim, medal=real.medal + 1)), real)
    assert fly_again([replace(flight.recording, easing=Easing(wider_pads=True))])[0].medal == 0
