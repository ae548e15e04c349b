"""Flights under other rules, flown again bit for bit: shares of thrust, wider pads, no time limit."""

from types import SimpleNamespace

import numpy as np
import pytest

from ai.flights.recording import UNHURRIED, WIDER, Easing
from ai.lander.environment import Outcome
from ai.lander.missions import MISSIONS
from ai.lander.pilots import ScriptedPilot
from ai.lander.push import KEYS, STEPS, Push
from game.flight import flight_file
from game.flight.choosers import Shared
from game.flight.flight import Flight
from game.flight.flight_file import Record
from game.flight.logbook import describe
from game.input.analogue import pushed
from tests.support.flights import begun
from tests.support.one_switch import one_switch


def record_of(flight: Flight) -> Record:
    x, y, angle = flight.poses.now[0].tolist()
    return Record(flight.recording, describe(flight, 1.0), (x, y, angle))


def test_a_stick_that_is_pushed_to_its_ends_is_a_key():
    for key in KEYS:
        assert pushed(*key.shares, Push()) == key


def test_a_co_pilot_that_steps_in_flies_its_own_action_in_full():
    for flown in (4, 3):
        flight = begun(3)
        decision = SimpleNamespace(pilot=[4], action=[flown], likely=[0.0])
        copilot = SimpleNamespace(agent=ScriptedPilot(), decide=lambda *_, decision=decision: decision)
        flight.chooser = Shared(copilot, 4)  # type: ignore[assignment]
        flight.step(Push(9, -9))
        assert flight.env.shares.tolist() == ([[9 / STEPS, -9 / STEPS]] if flown == 4 else [[1.0, 0.0]])
        assert flight.recording.pushes == [Push(9, -9) if flown == 4 else KEYS[3]]


def test_wider_pads_are_half_as_wide_again_and_nothing_else_moves():
    for pads in (1, 3):
        plain, wide = begun(3, pads=pads), begun(3, pads=pads, easing=Easing(wider_pads=True))
        assert wide.env.ground.widths == pytest.approx(WIDER * plain.env.ground.widths)
        assert np.array_equal(wide.env.ground.middles, plain.env.ground.middles)
        assert np.array_equal(wide.env.position, plain.env.position)
    for name, mission in MISSIONS.items():
        env = begun(0, mission=name, easing=Easing(True, True)).env
        assert env.ground.widths[0] == pytest.approx(WIDER * mission.pad.width), name
        assert (env.limits.time, env.limits.touch_speed) == (UNHURRIED, mission.limits.touch_speed), name


def test_without_a_time_limit_a_flight_outlasts_it_and_can_be_read_back():
    flight = begun(3, easing=Easing(untimed=True))
    pilot = ScriptedPilot()
    for _ in range(60 * 40):  # hovering
        flight.step(KEYS[3 * bool(flight.env.velocity[0, 1] < 0) + int(pilot.act(flight.env.observe())[0]) % 3])
    assert flight.outcome is Outcome.FLYING
    assert flight.env.time[0] > 39
    record = flight_file.from_text(flight_file.to_text(record_of(flight)))
    assert record.recording == flight.recording


def test_a_slow_hand_with_one_switch_lands():
    """A fifth of a second late, five decisions a second, and nothing but the engine: the jets steer by themselves."""
    for seed in range(4):
        assert one_switch(begun(seed, easing=Easing(wider_pads=seed % 2 == 0))).outcome is Outcome.LANDED, seed
