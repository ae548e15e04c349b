"""Every kind of flight, sent as a code: it is read again to the same flight, which earns the same, bit for bit."""

from functools import cache

import numpy as np
import pytest

from ai.flights.code import code_of, flight_of
from ai.flights.recording import Claim, Easing, Recording, SharedFlight, StickHolder, thrust
from ai.flights.verification import begun, earned, is_true, verified
from ai.lander.descent import LegStart
from ai.lander.environment import Outcome
from ai.lander.pilots import ScriptedPilot
from ai.lander.rules import ACTION_SHARES
from game.input.analogue import pushed

STARTS = {
    "a leg of a descent": {"leg": LegStart(2, 11.375)},
    "a leg from a flat spot": {"leg": LegStart(10, 4.005, bare=True)},
    "wider pads": {"easing": Easing(wider_pads=True)},
    "wider pads among hills": {"easing": Easing(wider_pads=True), "pads": 3},
    "without a time limit": {"easing": Easing(untimed=True), "mission": "wind"},
    "an earlier area": {"area": 0},
    "a rung of the ladder": {"spawn": "rung_4"},
}


def flown(analogue=False, **start):
    """A flight by the scripted pilot, at most half a minute, with a true claim."""
    start = {"spawn": "random", **start}
    recording = Recording(11, **start)
    env, pilot = begun(recording), ScriptedPilot()
    while env.outcome[0] == Outcome.FLYING and len(recording.actions) < 1800:
        action, shares = int(pilot.act(env.observe())[0]), None
        if analogue:  # as a hand on sticks: a little less than all of it
            main, side = ACTION_SHARES[action].tolist()
            action, shares = pushed(main * 0.95, side * (0.6 + 0.4 * (len(recording.actions) % 30 < 20)))
        if shares:
            recording.shares[len(recording.actions)] = shares
        recording.actions.append(action)
        recording.hands.append(StickHolder.HUMAN)
        env.fly(np.array([action]), thrust(shares))
    real = earned(env, recording)
    return SharedFlight(recording, Claim(real.outcome, real.points, real.end), recording.mission), real


KINDS = [(name, analogue) for name in STARTS for analogue in (False, True)]


@cache
def kind(name, analogue):
    return flown(analogue, **STARTS[name])


@pytest.mark.parametrize("analogue", [False, True], ids=["keys", "sticks"])
@pytest.mark.parametrize("name", STARTS)
def test_a_code_is_read_to_the_same_flight_and_verified(name, analogue):
    flight, real = kind(name, analogue)
    assert bool(flight.recording.shares) == analogue
    read = flight_of(code_of(flight))
    assert read.recording == flight.recording
    ((_, again),) = verified([read])
    assert again == real
    assert is_true(read, again)


def test_flights_of_every_kind_are_verified_together():
    rows = [kind(*each) for each in KINDS]
    found = dict(verified([flight_of(code_of(flight)) for flight, _ in rows]))
    assert [found[index] for index in range(len(rows))] == [real for _, real in rows]
