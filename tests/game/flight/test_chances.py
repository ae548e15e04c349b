"""The chance to be saved over a flight: where it fell, by what key, and how often a guardian saved the person."""

from functools import cache
from pathlib import Path

import numpy as np
import pytest

from ai.agent.agent import DeepQAgent
from ai.copilot.copilot import CoPilot, Mode
from ai.lander.environment import Outcome
from game.flight.chances import Fall, FlightChances, Rescues, critic_of, find_falls, known_for
from game.flight.flight import DECISION_STEPS, Flight, StickHolder
from game.flight.flight_file import Entry, Record
from game.flight.replay import FlightReplay

MODERN = Path(__file__).parents[3] / "models" / "lander" / "modern"
COAST, LEFT, RIGHT, MAIN = range(4)
YOU, IT = StickHolder.HUMAN, StickHolder.NETWORK


@cache
def agent() -> DeepQAgent:
    return DeepQAgent.load(MODERN)


def sloppy(flight: Flight, held: int) -> int:
    """Someone who looks five times a second, brakes late, and gives up on it after four seconds."""
    steps = len(flight.recording.actions)
    if steps % 12:
        return held
    leans = float(flight.env.angle[0] + 0.5 * flight.env.angular_velocity[0])
    steer = LEFT if leans < -0.15 else RIGHT if leans > 0.15 else COAST
    return steer + MAIN * bool(flight.env.velocity[0, 1] < -1.5 and steps < 260)


def flown(flight: Flight) -> Flight:
    held = COAST
    while not flight.over:
        held = sloppy(flight, held)
        flight.step(held)
    return flight


def recorded(flight: Flight) -> Record:
    x, y, angle = flight.poses.now[0].tolist()
    return Record(flight.recording, Entry(1.0, flight.outcome.name, 1.0, 1.0, 1.0, 1.0), (x, y, angle))


def judged(record: Record) -> FlightChances:
    replay = FlightReplay(record)
    critic, problem = critic_of(agent())
    assert critic is not None, problem
    chances = FlightChances(replay, critic)
    while not chances.complete:
        replay.scout(40)
        chances.follow()
    return chances


# Where it fell


def steps(*decisions: int) -> list[int]:
    return [action for action in decisions for _ in range(DECISION_STEPS)]


def falls(chances: list[float], actions: list[int]) -> list[Fall]:
    return find_falls(chances, actions, [YOU] * len(actions))


def test_one_press_that_took_the_chance_is_named_with_when_it_began_and_what_it_took():
    actions = steps(COAST, COAST, LEFT, LEFT, LEFT, LEFT, COAST, COAST)
    actions[7] = LEFT  # it was pressed a step before the decision
    (fall,) = falls([0.99, 0.99, 0.95, 0.7, 0.4, 0.31, 0.31, 0.3], actions)
    assert (fall.action, fall.held, fall.since) == (LEFT, True, 7)
    assert (fall.high, fall.before, fall.after) == (0.99, 0.99, 0.31)
    assert (fall.begins, fall.by) == (DECISION_STEPS, YOU)


def test_of_many_short_presses_the_action_that_took_the_most_is_named():
    actions = steps(COAST, LEFT, COAST, LEFT, COAST, LEFT, COAST, LEFT, COAST)
    (fall,) = falls([0.99, 0.84, 0.83, 0.66, 0.65, 0.48, 0.47, 0.3, 0.29], actions)
    assert (fall.action, fall.held) == (LEFT, False)
    assert (fall.high, fall.low) == (0.99, 0.3)
    assert (fall.before, fall.after) == (fall.high, fall.low)


def test_a_chance_that_comes_back_can_fall_again_and_small_losses_are_no_fall():
    one = [0.99, 0.5, 0.2, 0.6, 0.95, 0.96, 0.4, 0.1]
    assert [(fall.begins, fall.ends) for fall in falls(one, steps(*[MAIN] * 8))] == [(0, 8), (20, 28)]
    assert falls([0.99, 0.9, 0.8, 0.7, 0.9, 0.99], steps(*[MAIN] * 6)) == []
    assert falls([], []) == falls([0.2], steps(MAIN)) == []


def test_a_long_slow_loss_is_one_fall_from_its_height():
    chances = np.linspace(0.99, 0.05, 120).tolist()
    (fall,) = falls(chances, steps(*[COAST] * 120))
    assert fall.high > 0.95
    assert fall.low < 0.1
    assert fall.action == COAST


def test_what_the_network_did_is_not_called_the_persons():
    actions = steps(MAIN, MAIN, MAIN)
    (fall,) = find_falls([0.99, 0.6, 0.2], actions, [IT] * len(actions))
    assert fall.by is IT


def test_a_replay_is_judged_in_pieces_by_what_the_critic_says_of_each_moment():
    record = recorded(flown(Flight(2)))
    chances = judged(record)
    critic, _ = critic_of(agent())
    assert critic is not None
    flight = Flight(2)
    for number, action in enumerate(record.recording.actions):
        if number % DECISION_STEPS == 0 and number // DECISION_STEPS < len(chances.chances):
            said = critic.chances(flight.env.observe(), flight.env.around())[0, action]
            assert chances.at(number) == pytest.approx(float(said), abs=1e-5)
        flight.step(action)
    assert len(chances.chances) >= len(record.recording.actions) // DECISION_STEPS - 12  # up to the first touch
    assert chances.at(10**6) is None


def test_before_a_fall_the_network_still_lands_and_after_it_hardly_ever():
    before, after, count = 0, 0, 0
    for seed in range(9):
        record = recorded(flown(Flight(seed)))
        if record.entry.outcome == Outcome.LANDED.name:
            continue
        fall = judged(record).worst
        assert fall is not None, f"flight {seed} ended in {record.entry.outcome} without a fall"
        count += 1
        before += lands_from(record, fall.begins)
        after += lands_from(record, fall.ends + DECISION_STEPS)
    assert count > 5
    assert before >= 0.9 * count
    assert after <= 0.2 * count


def lands_from(record: Record, step: int) -> bool:
    """Whether the network lands if it takes the stick at that step."""
    flight = Flight(record.recording.seed, agent())
    for action in record.recording.actions[:step]:
        flight.step(action)
    flight.hand_over()
    while not flight.over:
        flight.step(COAST)
    return flight.outcome is Outcome.LANDED


# Rescues


def guarded(seed: int, assist: float, mode: Mode) -> tuple[Flight, Rescues, list[int]]:
    """A flight with help; also the steps with a change of an action that was too dangerous."""
    flight, rescues, held = Flight(seed, agent()), Rescues(), COAST
    flight.help(assist, mode)
    dangerous, episode = [], -1000
    while not flight.over:
        held = sloppy(flight, held)
        flight.step(held)
        rescues.follow(flight)
        decision = flight.decision
        if decision is None or decision.chance is None or not flight.overridden:
            continue
        step = len(flight.recording.actions)
        if decision.chance[0] < decision.required or step - episode <= 60:
            if step - episode > 60:
                dangerous.append(step)
            episode = step
    return flight, rescues, dangerous


def test_rescues_are_counted_by_stretch_and_only_where_fewer_could_be_saved_than_asked():
    landed = 0
    for seed in range(4):
        flight, rescues, dangerous = guarded(seed, 0.4, Mode.GUARDIAN)
        assert rescues.times == len(dangerous)
        assert rescues.guarded
        landed += flight.outcome is Outcome.LANDED
        assert rescues.saved(flight) == (rescues.times if flight.outcome is Outcome.LANDED else None)
        assert rescues.times < 12
    assert landed >= 3


def test_a_flight_that_nobody_guards_has_no_rescues():
    for mode, assist in ((Mode.TOLERANCE, 0.6), (Mode.GUARDIAN, 0.0)):
        flight, rescues, _ = guarded(1, assist, mode)
        assert (rescues.times, rescues.saved(flight)) == (0, None)


def test_coasting_under_a_guardian_is_the_persons_own_while_it_is_safe():
    flight = Flight(3, agent())
    flight.help(0.2, Mode.GUARDIAN)
    for _ in range(20):
        flight.step(COAST)
    decision = flight.decision
    assert decision is not None
    assert decision.chance is not None
    assert decision.chance[0] >= decision.required
    assert flight.guarded
    assert set(flight.recording.actions) == {COAST}
    assert flight.share == 1.0
    assert not flight.overridden


def test_most_critics_know_the_moon_alone_and_that_for_every_world_all_worlds():
    critic, _ = critic_of(agent())
    everywhere, problem = critic_of(DeepQAgent.load(MODERN.parent / "anywhere"))
    assert everywhere is not None, problem
    assert known_for(Flight(1).env, critic)
    assert known_for(Flight(1, pads=3).env, critic)
    heavy = Flight(1)
    heavy.set_gravity(1.2)
    for env in (Flight(1, mission="mars").env, heavy.env):
        assert not known_for(env, critic)
        assert not known_for(env, None)
        assert known_for(env, everywhere)


def test_a_pilot_without_a_critic_is_told_apart():
    critic, problem = critic_of(None)
    assert critic is None
    assert problem
    assert CoPilot(agent()).critic is critic_of(agent())[0]
