"""The reason of a crash names what was beyond its limit, and the read-outs mark the same."""

import numpy as np
import pytest

from ai.lander.environment import Cause, Outcome
from game.core import texts
from game.explain.readouts import GAUGES, Readout, at_touch, flight_readouts
from game.flight.flight import Flight
from game.flight.outcomes import cause_of, outcome_card, struck_side

FIGURES = {gauge.cause: name for name, gauge in GAUGES.items() if gauge.cause}


def dropped(start: tuple[float, ...]) -> tuple[Flight, dict[str, Readout]]:
    """Let a craft fall from a start; return its flight, and the read-outs that stay at the end."""
    flight, last = Flight(1), dict[str, Readout]()
    flight.env.place(np.ones(1, bool), np.array([start]))
    while not flight.over:
        last = flight_readouts(flight.env)
        flight.step(0)
    return flight, at_touch(last, flight.env)


def test_every_crash_has_a_marked_figure_that_agrees_with_its_reason():
    rng, seen = np.random.default_rng(0), 0
    for _ in range(60):
        pad = Flight(1).env.ground.pads[0]
        aside = rng.choice([-1, 1]) * (pad.width / 2 + rng.uniform(-0.5, 2.0))
        flight, readouts = dropped((
            pad.x + aside, pad.top + rng.uniform(2, 5), rng.uniform(-3, 3), -rng.uniform(0, 5),
            rng.uniform(-0.6, 0.6), rng.uniform(-1, 1),
        ))  # fmt: skip
        cause = cause_of(flight.env)
        if flight.outcome is not Outcome.CRASHED or flight.intact or cause not in FIGURES:
            continue
        seen += 1
        if struck_side(flight.env):
            assert not all(readouts[name].within for name in ("descent", "drift"))
        else:
            named = readouts[FIGURES[cause]]
            assert named.within is False
            if cause is not Cause.TILTED:
                figure = float(outcome_card(flight.env, 1.0).reason.split("at ")[-1].split()[0])
                assert float(named.figure) == pytest.approx(figure, abs=0.051)
    assert seen > 30


def test_what_a_turning_foot_felt_is_marked_although_the_craft_itself_was_slow_enough():
    pad = Flight(1).env.ground.pads[0]
    flight, readouts = dropped((pad.x, pad.top + 1.56, 0.06, -1.46, 0.01, 1.31))
    assert cause_of(flight.env) is Cause.HARD
    assert readouts["descent"].within is False
    assert float(readouts["descent"].figure) > flight.env.limits.touch_speed


def test_the_side_of_a_pad_is_not_said_to_be_slid_across():
    pad = Flight(1).env.ground.pads[0]
    flight, readouts = dropped((pad.x + pad.width / 2 + 1.0, pad.top + 5.0, 0.0, -4.0, 0.0, 0.0))
    assert struck_side(flight.env)
    reason = outcome_card(flight.env, 1.0).reason
    words = texts.CRASHED_SIDEWAYS.split("{")[0]
    assert reason.startswith(words)
    assert readouts["descent"].within is False


def test_a_landing_and_a_soft_touch_mark_nothing():
    pad = Flight(1).env.ground.pads[0]
    for x in (pad.x, pad.x + pad.width):
        flight, readouts = dropped((x, pad.top + 1.5, 0.0, -0.2, 0.0, 0.0))
        assert not flight.wrecked
        assert all(readouts[name].within for name in FIGURES.values())
