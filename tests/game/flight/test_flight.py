from pathlib import Path

import numpy as np
import pytest

from ai.agent.agent import DeepQAgent
from ai.environment import Floats, Ints
from ai.lander.environment import LIMITS, NUM_ACTIONS, NUM_FEATURES, PARAMS, Cause, LanderEnv, Outcome
from ai.lander.pilots import ScriptedPilot
from ai.lander.push import KEYS
from game.core import texts
from game.core.clock import TimeScale
from game.flight import networks
from game.flight.flight import Flight, StickHolder
from game.flight.foresight import Preview
from game.flight.logbook import describe
from game.flight.networks import DECISION_STEPS
from game.flight.outcomes import outcome_card
from game.flight.swarm import Swarm
from game.scenes.logbook.scene import entry_row
from tests.support.flights import begun
from tests.support.landers import STAND, put


class Counting:
    """A network that counts how often it is asked, and always fires the main engine."""

    def __init__(self) -> None:
        self.asked = 0

    def act(self, observation: np.ndarray, *, held: np.ndarray | None = None) -> np.ndarray:
        self.asked += 1
        return np.full(len(observation), 3)


def test_a_network_decides_every_four_steps_and_at_once_when_it_takes_over():
    network = Counting()
    flight = begun(1, network)
    flight.step()
    assert flight.chooser.hand_over()
    for _ in range(DECISION_STEPS + 2):
        flight.step(KEYS[1])
        assert flight.env.actions[0] == 3
    assert network.asked == 2
    flight.chooser.hand_over()
    flight.step(KEYS[2])
    assert flight.env.actions[0] == 2
    assert flight.share == pytest.approx(2 / 8)
    flight.chooser.hand_over()
    flight.step()
    assert network.asked == 3


def test_without_a_network_nothing_can_be_handed_over():
    flight = begun(1)
    assert not flight.chooser.hand_over()
    assert flight.chooser.hand is StickHolder.HUMAN


def test_the_path_without_thrust_is_the_way_it_then_goes_in_the_wind_too():
    for mission in ("", "wind"):
        flight = begun(2, mission=mission)
        drift = Preview(flight.env)
        while not len(drift.path):
            drift.follow(5)
        assert len(drift.path) > 15
        for place in drift.path[1:-1]:
            for _ in range(6):
                flight.step()
            assert np.array_equal(place, flight.env.position[0]), mission


def test_a_swarm_flies_again_and_again_counts_and_is_drawn_without_a_leap():
    swarm = Swarm(4, 4, ScriptedPilot())
    ended = 0
    for _ in range(1500):
        ended += int(swarm.step().sum())
        assert np.abs(swarm.poses.now - swarm.poses.before)[:, :2].max() < 0.4
    assert ended == swarm.landed + swarm.lost > 4
    assert swarm.landed > 3
    assert len(swarm.poses.at(0.5)) == 4


TIPPED = "Tipped over to {2:.0f}°, and then came down at {0:.1f} m/s."
HARD = "Touched down at {0:.1f} m/s; 2.0 is the limit."
TILTED = "Tilted {2:.0f}° at contact; 29° is the limit."
SLID = "Slid across the ground at {1:.1f} m/s; 2.0 is the limit."


def fallen(*start: float, action: int = 0) -> Flight:
    """A flight from a state to its end."""
    flight = begun(1)
    put(flight.env, start)
    while not flight.over:
        flight.step(KEYS[action])
    return flight


def test_the_card_names_what_broke_the_craft_beside_the_pad_too(subtests: pytest.Subtests):
    for cause, start, words, advice in (
        (Cause.HARD, (0, 6, 0, -3, 0, 0), HARD, "HARD"),
        (Cause.HARD, (0, 6, 0, -5, 0, 0), HARD, "HARD"),
        (Cause.HARD, (0, 6, 0, -7, 0, 0), HARD, ""),  # no braking in the last metres would have helped
        (Cause.TILTED, (0, 3.2, 0, -0.5, 0.6, 0), TILTED, "TILTED"),
        (Cause.SLIDING, (-2, 2.6, 3.5, -0.3, 0, 0), SLID, "SLIDING"),
        (Cause.HULL, (0, 3.5, 0, -0.5, np.pi, 0), TIPPED, "TILTED"),
        # Beside the pad, nothing but speed and tilt break a craft; networks learn by the place alone.
        (Cause.TERRAIN, (10, 6, 0, -3, 0, 0), HARD, "HARD"),
        (Cause.TERRAIN, (10, 3.2, 0, -0.2, 0.6, 0), TILTED, "TILTED"),
        (Cause.TERRAIN, (10, 2.1, 3.5, -0.3, 0, 0), SLID, "SLIDING"),
    ):
        with subtests.test(start=start):
            flight = fallen(*start)
            card, (speed, slide, tilt) = outcome_card(flight.env), flight.env.impact[0]
            assert (flight.outcome, flight.env.cause[0]) == (Outcome.CRASHED, cause)
            assert flight.wrecked
            assert (card.good, card.intact, card.title) == (False, False, texts.OUTCOMES["CRASHED"][0])
            assert card.reason == words.format(speed, slide, np.degrees(tilt))
            assert card.advice == texts.ADVICE.get(advice, "")


def test_a_soft_touch_beside_the_pad_leaves_the_craft_whole_without_points():
    flight = fallen(10, 2.2, 0.3, -0.5, 0.2, 0)
    card, entry = outcome_card(flight.env), describe(flight, 0.0)
    assert (flight.outcome, flight.intact, flight.wrecked) == (Outcome.CRASHED, True, False)
    assert (card.title, card.good, card.intact) == (texts.BESIDE_TITLE, False, True)
    assert (card.reason, card.advice) == (texts.CAUSES["TERRAIN"], texts.ADVICE["TERRAIN"])
    assert (entry.score, entry.landed, entry.intact) == (0, False, True)
    assert entry_row(entry)[2] == texts.BESIDE_TITLE


def test_the_card_of_a_landing_and_of_the_other_ends():
    card = outcome_card(fallen(0.4, STAND + 0.02, 0, 0, 0, 0).env)
    assert card.good
    assert card.title == "Perfect"
    assert ("OFF CENTRE", "0.4", "m") in card.figures
    for start, reason in (
        ((29.9, 12, 6, 0, 0, 0), "Left the area at the side, 30 m from its middle."),
        ((0, 28.9, 0, 6, 0, 0), "Left the area at the top, 26 m up."),
    ):
        assert outcome_card(fallen(*start).env).reason == reason
    flight = begun(1)
    flight.env.steps[:] = round(LIMITS.time * 60) - 1
    flight.step()
    assert outcome_card(flight.env).reason.startswith("Time ran out")


def test_a_new_flight_of_a_swarm_holds_no_action_of_the_last_one():
    class Pushing:
        def act(self, observation: Floats, *, held: Ints | None = None) -> Ints:
            self.held = held
            return np.full(len(observation), 3)

    swarm = Swarm(1, 3, pilot := Pushing())
    for _ in range(3000):
        swarm.step()
        if swarm.fresh[0] and swarm.landed + swarm.lost:
            break
    assert swarm.fresh[0]
    assert swarm.decision.action[0] == 3
    assert pilot.held == [0]


def test_what_is_just_over_a_limit_does_not_read_as_the_limit():
    env = LanderEnv(1, 0, frame_skip=1)
    env.reset()
    env.outcome[:] = Outcome.CRASHED
    for cause, impact, reason in (
        (Cause.HARD, (2.02, 0, 0), "Touched down at 2.02 m/s; 2.00 is the limit."),
        (Cause.TILTED, (0, 0, np.radians(28.7)), "Tilted 28.7° at contact; 28.6° is the limit."),
    ):
        env.cause[:], env.impact[:] = cause, impact
        assert outcome_card(env).reason == reason


def test_networks_are_listed_with_what_is_wrong_with_them(tmp_path: Path):
    models, user = tmp_path / "models", tmp_path / "user"
    policies = networks.Policies(models, user)
    assert policies.names == ["modern", "scripted"]
    assert "missing" in policies["modern"].problem
    assert policies.first_fit().name == "scripted"
    for folder in (models / "lander" / "broken", user / "models" / "mine"):
        folder.mkdir(parents=True)
        (folder / "config.json").write_text("{}")
    (user / "models" / "pictures").mkdir()
    (user / "models" / "notes.txt").touch()
    policies = networks.Policies(models, user)
    assert policies.names == ["modern", "broken", "mine", "scripted"]
    assert all(policies[name].policy is None and policies[name].problem for name in ("modern", "broken", "mine"))
    assert networks.chosen(models, user, "broken").problem
    assert networks.chosen(models, user, "gone").name == "modern"


def test_whatever_lies_in_the_players_folder_is_named_and_never_raises(tmp_path: Path):
    folder = tmp_path / "models"
    DeepQAgent(4, 2).save(folder / "cartpole")
    DeepQAgent(NUM_FEATURES, NUM_ACTIONS).save(folder / "modern")
    DeepQAgent(NUM_FEATURES, NUM_ACTIONS).save(folder / "cut")
    (folder / "cut" / "optimizer.npz").write_bytes((folder / "cut" / "optimizer.npz").read_bytes()[:200])
    DeepQAgent(NUM_FEATURES, NUM_ACTIONS).save(tmp_path / "shipped" / "lander" / "modern")
    found = networks.Policies(tmp_path / "shipped", tmp_path)
    assert found["cartpole"].policy is None
    assert "4 inputs and 2 actions" in found["cartpole"].problem
    assert found["cut"].policy is None
    assert found["cut"].problem
    assert found["modern"].policy is not None
    assert found["modern (yours)"].policy is not None


def test_a_forecast_ends_at_the_ground_and_disturbs_nothing():
    alone, watched = begun(7, ScriptedPilot()), begun(7, ScriptedPilot())
    forecast = Preview(watched.env, ScriptedPilot())
    for flight in (alone, watched):
        flight.chooser.hand_over()
    while not alone.over:
        alone.step()
        watched.step()
        forecast.follow(2)
        if alone.at == 120:
            assert abs(forecast.path[-1, 0] - watched.env.pad[0, 0]) < watched.env.pad_width[0] / 2
            assert forecast.path[-1, 1] - watched.env.pad[0, 1] - PARAMS.stand < 0.5
    assert watched.recording == alone.recording
    assert np.array_equal(watched.poses.now, alone.poses.now)


class TrainedAtSeven(ScriptedPilot):
    """Pilot of a network that was trained with seven steps to a decision, and counts its decisions."""

    run_settings: dict[str, object] = {"frame_skip": 7}  # noqa: RUF012
    asked = 0

    def act(self, observation, *, held=None):
        self.asked += 1
        return super().act(observation, held=held)


def test_a_network_decides_as_often_as_it_was_trained_to_wherever_it_flies():
    pilot = TrainedAtSeven()
    flight = begun(3, pilot)
    flight.chooser.hand_over()
    for _ in range(70):
        flight.step()
    assert pilot.asked == 10
    swarm = Swarm(1, 3, pilot := TrainedAtSeven())
    for _ in range(70):
        swarm.step()
    assert swarm.decided[0] == pilot.asked == 10
    for damaged in (0, -7, "7", None):
        pilot.run_settings = {"frame_skip": damaged}
        assert networks.decision_steps(pilot) == DECISION_STEPS


def test_a_picture_never_runs_backward():
    """The moment that is drawn, in steps, grows from picture to picture."""
    pace = TimeScale()
    pace.slow_down()
    steps, last = 1, 0.0  # it begins with a step, that of the crash
    for update in range(120):
        steps += pace.steps() if update else 0
        for alpha in (0.0, 0.5, 0.99):
            moment = steps - 1 + pace.between(alpha)
            assert moment >= last - 1e-9
            last = moment
    assert last == pytest.approx(steps - 0.01)


def test_the_players_own_pace_holds_for_as_long_as_it_is_wished():
    pace = TimeScale(0.5)
    assert sum(pace.steps() for _ in range(200)) == 100
    pace.rate = 1.0
    assert all(pace.steps() == 1 for _ in range(10))
    assert pace.between(0.4) == 0.4
