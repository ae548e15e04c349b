import numpy as np
import pytest

from ai.copilot.copilot import Mode
from ai.lander.environment import Outcome
from game.flight.flight import DECISION_STEPS, Flight, StickHolder
from game.flight.forecast import coast_path, surface_height
from game.flight.handicap import HANDS, OWN, Handicap
from tests.support.reading import Weighs

COAST, LEFT, RIGHT, MAIN = range(4)


class Wants(Weighs):
    """A network that thinks one action is worth 10, another one a bit less, and the others nothing."""

    def __init__(self, best: int = MAIN, good: int = LEFT, worth: float = 6.0) -> None:
        self.values = np.zeros(6, np.float32)
        self.values[[best, good]] = 10.0, worth
        self.asked = 0

    def q_values(self, observation: np.ndarray) -> np.ndarray:
        self.asked += 1
        return np.tile(self.values, (len(observation), 1))


class Falls(Wants):
    """Another one whose opinion depends on how fast it falls."""

    def q_values(self, observation: np.ndarray) -> np.ndarray:
        values = super().q_values(observation)
        values[:, MAIN] = np.where(observation[:, 3] < -1.2, 10.0, -10.0)
        values[:, COAST] = np.where(observation[:, 3] < -1.2, -10.0, 10.0)
        return values


def shared(network: Wants | None = None, assist: float = 0.5, **kinds: object) -> Flight:
    flight = Flight(1, network or Wants(), **kinds)
    flight.help(assist, Mode.TOLERANCE)
    return flight


def keys(seed: int, steps: int) -> list[int]:
    rng = np.random.default_rng(seed)
    return np.repeat(rng.integers(6, size=steps), rng.integers(1, 9, size=steps))[:steps].tolist()


def test_without_assist_every_action_is_the_persons_and_with_it_bad_ones_are_changed():
    flight = shared(assist=0.0)
    for held in keys(1, 60):
        flight.step(held)
        assert flight.env.actions[0] == held
        assert flight.flown_by is StickHolder.HUMAN
        assert not flight.overridden
    flight.help(0.5, Mode.TOLERANCE)
    flight.step(LEFT)  # worth six tenths of the best
    assert (flight.env.actions[0], flight.overridden, flight.flown_by) == (LEFT, False, StickHolder.HUMAN)
    flight.step(RIGHT)
    assert (flight.env.actions[0], flight.overridden, flight.flown_by) == (MAIN, True, StickHolder.NETWORK)


def test_hands_off_is_the_networks_and_no_override():
    flight = shared(assist=0.1)
    flight.step(COAST)
    assert (flight.env.actions[0], flight.overridden, flight.flown_by) == (MAIN, False, StickHolder.NETWORK)
    assert flight.share == 0.0


def test_a_tap_of_one_step_is_heard_at_once_and_let_go_at_once():
    flight = shared()
    for _ in range(2 * DECISION_STEPS + 1):
        flight.step(COAST)
    flight.step(LEFT)
    assert flight.env.actions[0] == LEFT
    flight.step(COAST)
    assert flight.env.actions[0] == MAIN


@pytest.mark.parametrize("pads", [1, 3])
def test_a_hundred_handovers_under_a_shared_stick_lose_no_input_and_stick_no_engine(pads: int):
    flight = shared(assist=0.5, pads=pads)
    for turn in range(100):
        if turn % 10 == 0:
            flight.env.place(np.ones(1, bool), np.array([[0.0, 20.0, 0.0, 0.0, 0.0, 0.0]]))
        assert flight.hand_over()
        held = (LEFT, COAST, RIGHT)[turn % 3]
        flight.step(held)
        if flight.hand is StickHolder.NETWORK:
            assert flight.env.actions[0] == MAIN
        else:
            assert flight.asked == held
            assert flight.env.actions[0] == (LEFT if held == LEFT else MAIN)
    assert flight.hand is StickHolder.HUMAN
    flight.help(0.0, Mode.TOLERANCE)
    flight.step(COAST)
    assert flight.env.actions[0] == COAST
    assert len(flight.recording.actions) == len(flight.recording.hands) == 101


@pytest.mark.parametrize("hands", HANDS)
@pytest.mark.parametrize("pads", [1, 3])
def test_the_same_seed_and_keys_are_the_same_flight_and_the_recording_flies_it_again(hands: str, pads: int):
    flights = []
    for _ in range(2):
        flight = shared(Falls(), 0.6, pads=pads, hands=hands)
        for step, held in enumerate(keys(3, 500)):
            if step in (100, 180):
                flight.hand_over()
            flight.step(held)
        flights.append(flight)
    first, second = flights
    assert first.recording == second.recording
    assert np.array_equal(first.poses.now, second.poses.now)
    again = Flight(first.recording.seed, spawn=first.recording.spawn, pads=first.recording.pads)
    for action in first.recording.actions:
        again.step(action)
    assert np.array_equal(again.poses.now, first.poses.now)
    assert again.outcome is first.outcome


def test_other_hands_bring_keys_late_wrong_or_in_part_and_ones_own_bring_them_as_they_are():
    seen = np.zeros((1, 9), np.float32)
    held = keys(5, 2000)
    got = {name: [Handicap.ask(hands, key, seen) for key in held] for name in HANDS for hands in [Handicap(name, 7, 4)]}
    assert got[OWN] == held
    assert max(got["sensor"]) < MAIN
    for name in ("laggy", "noisy"):
        assert 0.2 < np.mean(np.array(got[name]) != held) < 0.95
    late = Handicap("laggy", 7, 4)
    assert [late.ask(COAST, seen) for _ in range(8)] == [COAST] * 8
    assert MAIN in [late.ask(MAIN, seen) for _ in range(200)]  # late, but it comes
    assert COAST in [late.ask(COAST, seen) for _ in range(200)]  # and no engine burns on for good


def test_a_landing_on_any_of_three_pads_counts_and_read_outs_turn_to_it():
    flight = Flight(4, pads=3)
    assert len(flight.env.ground.pads) == 3
    for number, pad in enumerate(flight.env.ground.pads):
        flight = Flight(4, pads=3)
        flight.env.place(np.ones(1, bool), np.array([[pad.x, pad.top + 0.97, 0.0, 0.0, 0.0, 0.0]]))
        for _ in range(60):
            flight.step(COAST)
        assert flight.outcome is Outcome.LANDED
        assert flight.env.target[0] == number


def test_the_network_flies_to_the_nearest_pad_when_nothing_says_another():
    flight = Flight(4, Wants(), pads=3)
    pads = flight.env.ground.pads
    for number, pad in enumerate(pads):
        flight.env.place(np.ones(1, bool), np.array([[pad.x + 1.0, 12.0, 0.0, 0.0, 0.0, 0.0]]))
        for _ in range(DECISION_STEPS):
            flight.step(COAST)
        assert flight.env.target[0] == number


def test_the_path_ahead_ends_on_the_hills_and_heights_are_the_grounds():
    flight = Flight(4, pads=3)
    path = coast_path(flight.env)
    ground = flight.env.ground
    assert (path[:-1, 1] >= ground.height(path[:-1, 0]) + 0.9).all()
    assert abs(path[-1, 1] - ground.height(path[-1, 0]) - 0.96) < 0.25
    for x in np.linspace(-18.0, 18.0, 200):
        near = ground.height(np.array([x - 0.02, x, x + 0.02]))
        assert near.min() - 0.02 <= surface_height(flight.env, float(x)) <= near.max() + 0.02
