"""Flights guarded by futures: what was seen to land is flown, whatever is asked for."""

import time

import pytest

from ai.agent.agent import DeepQAgent
from ai.copilot.futures import Future, Lookahead
from ai.copilot.guardian import decisions_of
from ai.flights.verification import fly_again
from ai.lander.descent import LegStart
from ai.lander.environment import Outcome
from ai.lander.moment import Moment
from ai.lander.push import KEYS, Push
from game.core import texts
from game.core.assets import MODELS_DIR
from game.core.settings import Settings
from game.flight.credit import Credit
from game.flight.flight import StickHolder
from game.flight.futures import FuturesProcess
from game.flight.guard import Guard, Taps, nearest
from game.scenes.play.challenge import Rules
from game.scenes.play.words import why_not_saved
from tests.support.flights import actions, begun
from tests.support.futures import AtOnce

GUARD = 0.04  # of the dial: one decision ahead


@pytest.fixture(scope="module")
def agent():
    return DeepQAgent.load(MODELS_DIR / "lander" / "modern")


def guarded(agent, seed=0, assist=GUARD):
    flight = begun(seed, agent, "rung_1")
    flight.chooser.guard = Guard(flight.chooser, AtOnce())
    flight.chooser.help(assist)
    flight.chooser.guard.hang(flight, Push())
    return flight


def fly(flight, ask, most):
    while not flight.over and flight.at < most:
        flight.step(ask(flight.at))
    return flight


def land(flight):
    """Let the plan fly on to its end: nothing else is flown ahead any more."""
    flight.chooser.guard.ahead.late = None
    flight.chooser.hand_over()
    return fly(flight, lambda _: Push(), most=1800)


@pytest.mark.slow
def test_a_held_key_and_a_weak_stick_land_and_their_recording_flies_again(agent):
    for name, stick in {"held right": KEYS[2], "a weak stick": Push(5, 0)}.items():
        flight = land(fly(guarded(agent), lambda _, stick=stick: stick, most=80))
        assert flight.outcome is Outcome.LANDED, name
        [again] = fly_again([flight.recording])
        assert again.end[:2] == tuple(flight.env.position[0].tolist()), name
        assert again.outcome is Outcome.LANDED


def test_what_is_decided_lasts_for_four_steps_and_a_tap_counts_at_the_next(agent):
    flight = fly(guarded(agent), lambda step: KEYS[2 if step == 1 else 0], most=12)
    assert actions(flight)[:4] == [0] * 4
    assert set(actions(flight)[4:8]) == {2} or flight.chooser.guard.saves
    assert len(set(actions(flight)[8:12])) == 1
    taps = Taps()
    for main, side in ((0, 0), (1, 0), (0, 0), (0, -1)):
        taps.follow(Push.of(main, side))
    assert taps.asked == KEYS[4]  # main was tapped, left is held
    taps.forget()
    for key in (3, 4, 3):
        taps.follow(KEYS[key])
    assert taps.asked == KEYS[4]  # left was tapped while main is held
    taps.forget()
    taps.follow(KEYS[1])
    assert taps.asked == KEYS[1]


def test_what_was_not_flown_ahead_in_time_waits_once_and_then_the_plan_flies_on(agent):
    flight = guarded(agent)
    flight.chooser.guard.ahead.late = {KEYS[1]}
    fly(flight, lambda step: KEYS[1 if step > 3 else 0], most=24)
    guard = flight.chooser.guard
    assert (guard.waited, guard.late) == (1, 4)  # first what was asked for before counts once more
    assert not flight.chooser.guard.saves
    assert flight.chooser.guard.safe
    assert flight.choice.overridden
    assert flight.recording.hands[-1] is StickHolder.NETWORK
    assert land(flight).outcome is Outcome.LANDED


def test_a_hand_over_and_another_network_leave_the_plan(agent):
    flight = fly(guarded(agent), lambda _: KEYS[2], most=10)
    flight.chooser.hand_over()
    flight.chooser.change_network(DeepQAgent.load(MODELS_DIR / "lander" / "modern"))
    assert flight.chooser.guard.safe
    fly(flight, lambda _: Push(), most=30)
    assert flight.chooser.guard.safe
    flight.chooser.hand_over()
    assert fly(flight, lambda _: KEYS[1], most=50).chooser.guard.safe
    assert land(flight).outcome is Outcome.LANDED


def test_a_craft_hangs_until_a_plan_is_found_but_not_for_long(agent):
    for known, ready in (
        (None, True),
        ({}, False),
        ({KEYS[1]: Future(None)}, False),
        (dict.fromkeys(KEYS, Future(None)), True),
    ):
        flight = guarded(agent)
        guard = flight.chooser.guard
        if known is not None:
            guard.ahead.known = lambda known=known: known
        assert guard.ready(flight) is ready, known
    flight = guarded(agent)
    guard = flight.chooser.guard
    guard.ahead.late = None
    flight.chooser.help(1.0)
    guard.hang(flight, Push())
    assert guard.ahead.decisions == decisions_of(1.0)  # with another dial, other futures are asked for
    hung = 0
    while not guard.ready(flight):
        guard.hang(flight, KEYS[2])
        hung += 1
    assert hung == 180
    flight = fly(guarded(agent), lambda _: Push(), most=6)
    guard = flight.chooser.guard
    guard.ahead.late = None
    assert guard.ready(flight)  # between two decisions nothing can be found


def test_it_says_since_when_no_plan_is_held(agent):
    flight = fly(guarded(agent), lambda _: Push(), most=4)
    flight.chooser.copilot.forget()
    flight.chooser.guard.ahead.known = lambda: dict.fromkeys(KEYS, Future(None))
    fly(flight, lambda _: Push(), most=20)
    assert why_not_saved(flight) == texts.GUARDIAN_BARE.format(since="0.1")
    flight.chooser.help(0.0)
    fly(flight, lambda _: Push(), most=24)
    assert why_not_saved(flight) == ""


def test_without_its_process_or_at_nought_nothing_is_guarded(agent):
    for assist, problem in ((0.0, ""), (GUARD, "no process")):
        flight = guarded(agent, assist=assist)
        flight.chooser.guard.ahead.problem = problem
        fly(flight, lambda _: KEYS[2], most=8)
        assert not flight.chooser.guard.safe
        assert flight.chooser.guard.decisions == 0
    assert FuturesProcess(cores=1).problem


def test_a_position_of_the_stick_is_replaced_by_the_nearest_that_was_flown_ahead():
    known = dict.fromkeys((Push.of(0.5, 0.0), KEYS[0]))
    assert nearest(Push.of(0.4375, 0.0625), known) == Push.of(0.5, 0.0)
    assert nearest(Push.of(0.5, 1.0), known) == Push.of(0.5, 1.0)  # too far
    assert nearest(KEYS[3], known) == KEYS[3]


@pytest.mark.slow
def test_the_process_flies_what_is_asked_for_first_and_then_every_key(agent):
    ahead = FuturesProcess()
    try:
        flight = begun(0, agent, "rung_1")
        flight.chooser.guard = Guard(flight.chooser, ahead)
        flight.chooser.help(GUARD)
        flight.chooser.guard.hang(flight, KEYS[2])
        until = time.monotonic() + 60
        while len(ahead.known()) < len(KEYS) and time.monotonic() < until:
            time.sleep(0.01)
        assert next(iter(ahead.known())) == KEYS[2]
        assert set(ahead.known()) == set(KEYS)
        (here,) = Lookahead(agent).futures(Moment.of(flight.env), [(0, KEYS[2])])
        assert here.plan is not None
        assert (ahead.known()[KEYS[2]].plan.shares == here.plan.shares).all()
    finally:
        ahead.close()


def test_help_that_changed_nothing_takes_no_record_away_and_help_that_did_is_named(agent):
    for held, changed in ((0, False), (2, True)):
        flight = guarded(agent)
        credit = Credit(flight, Settings(), Rules())
        assert credit.notice == texts.HELP_IS_ON
        for _ in range(24):
            flight.step(KEYS[held])
            credit.follow()
        assert (flight.share < 1) is changed
        assert credit.bar == ("helped" if changed else "")
        assert credit.notice == (texts.NOT_COUNTED["helped"] if changed else texts.HELP_IS_ON)


@pytest.mark.slow
def test_a_leg_of_a_descent_is_guarded_along_its_route(agent):
    flight = begun(0, agent, leg=LegStart())
    flight.chooser.guard = Guard(flight.chooser, AtOnce())
    flight.chooser.help(GUARD)
    flight.chooser.guard.hang(flight, Push())
    assert fly(flight, lambda _: KEYS[2], most=24).chooser.guard.safe
    assert land(flight).outcome is Outcome.LANDED
