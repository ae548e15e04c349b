"""What a safety critic learns from, and that it learns it."""

from functools import cache

import numpy as np
import pytest

import main
from ai.agent.agent import DeepQAgent
from ai.cli import copilot as commands
from ai.cli.copilot import MODEL
from ai.copilot import critic_training
from ai.copilot.copilot import CoPilot
from ai.copilot.critic import SafetyCritic
from ai.copilot.critic_training import CriticTraining, _platt
from ai.copilot.hands import FAMILIES, UNSEEN, ClumsyHands, Faults, any_hands
from ai.copilot.moments import flown, moon, present, saved
from ai.copilot.oracle import Oracle
from ai.lander.environment import NUM_FEATURES, LanderEnv, Outcome
from ai.lander.pilots import ScriptedPilot
from ai.lander.sensing import SURROUNDINGS

ANYWHERE = MODEL.parent / "anywhere"


@pytest.fixture(scope="module")
def agent():
    return DeepQAgent.load(MODEL)


def doing(*actions):
    """A pilot that does this for ever."""

    class Always:
        def act(self, observation, *, held=None):
            return np.array(actions, dtype=np.intp)

    return Always()


def test_hands_have_the_faults_they_are_given(subtests):
    for faults, wish, does in [
        (Faults(), 4, {4}),
        (Faults(inverted=True), 4, {5}),
        (Faults(one_key=True), 4, {1, 3}),
        (Faults(thrust=1.0), 1, {4}),
        (Faults(timid=1.0), 4, {1}),
        (Faults(flip=1.0), 1, {4}),
        (Faults(change=1.0), 1, {0, 2}),
        (Faults(sticky=1.0), 4, {0}),
        (Faults(late=99), 4, {4}),  # nothing is later than what was first wished
    ]:
        with subtests.test(faults=faults, wish=wish, does=does):
            hands = ClumsyHands(doing(*[wish] * 40), 40, np.random.default_rng(0), faults)
            assert {int(action) for _ in range(3) for action in hands.act(np.zeros((40, 9)))} == does


def test_late_hands_do_what_was_wished_before():
    wishes = iter(range(6))
    pilot = doing(0)
    pilot.act = lambda observation, *, held=None: np.array([next(wishes)])
    hands = ClumsyHands(pilot, 1, np.random.default_rng(0), Faults(late=2))
    assert [int(hands.act(np.zeros((1, 9)))[0]) for _ in range(6)] == [0, 0, 0, 1, 2, 3]


@pytest.mark.parametrize("name", [*FAMILIES, *UNSEEN])
def test_every_family_flies_and_follows_from_its_seed(agent, name):
    def first(seed):
        env = LanderEnv(16, 0, "random")
        env.reset()
        pilot = (FAMILIES | UNSEEN)[name](16, np.random.default_rng(seed), agent)
        for _ in range(20):
            actions = pilot.act(env.observe(), held=env.actions)
            env.fly(actions)
        return env.position

    np.testing.assert_array_equal(first(4), first(4))
    assert np.isfinite(first(5)).all()


def test_whether_a_moment_could_be_saved_is_what_comes_of_flying_on(agent):
    rng = np.random.default_rng(7)
    env = moon(24, rng)
    moments = flown(env, any_hands(24, rng, agent))
    moments = moments.take(rng.choice(len(moments), 30, replace=False))
    action = rng.integers(0, 6, 30)
    together = saved(agent, moments, action)
    assert 0 < together.sum() < 30
    for k in range(30):
        alone = LanderEnv(1, 0, ground=moments.env.ground)
        alone.place(np.ones(1, bool), moments.start[[k]])
        alone.steps[:], alone.target[:] = moments.steps[k], moments.target[k]
        alone.fly(action[[k]])
        while alone.outcome[0] == Outcome.FLYING:
            alone.fly(agent.act(alone.observe(), held=alone.actions))
        assert together[k] == (alone.outcome[0] == Outcome.LANDED)


def test_the_oracle_leaves_a_good_pilot_alone_and_saves_a_bad_one(agent):
    env = LanderEnv(6, 3, "fixed")  # near the pad: before every decision, it flies as far again as there is to go
    env.reset()
    pilots, oracle, changed = doing(0, 0, 0, 0, 0, 0), Oracle(agent), 0
    while (flying := env.outcome == Outcome.FLYING).any():
        asked = pilots.act(None)
        action = oracle.share(env, asked)
        changed += int((flying & (action != asked)).sum())
        env.fly(action)
    assert (env.outcome == Outcome.LANDED).sum() >= 4
    assert changed > 0
    env.reset()
    asked = agent.act(env.observe(), held=env.actions)
    np.testing.assert_array_equal(oracle.share(env, asked), asked)


def test_the_calibration_finds_slope_and_offset():
    rng = np.random.default_rng(0)
    output = rng.normal(1.0, 3.0, 40_000)
    landed = rng.random(40_000) < 1 / (1 + np.exp(-(0.6 * output - 0.8)))
    assert _platt(output, landed) == pytest.approx((0.6, -0.8), abs=0.05)
    steep, _ = _platt(output, output > 0)  # where nothing is uncertain, the slope stays finite
    assert np.isfinite(steep)


@pytest.fixture
def small(monkeypatch):
    for name, value in (
        ("_FLIGHTS", 24),
        ("_PER_ROUND", 300),
        ("_FIRST", 2),
        ("_FITS", 3),
        ("_PLAIN", 200),
        ("_CALIBRATED", 1),
        ("_TESTED", 1),
        ("_HIDDEN", (32,)),
        ("_STEPS", 500),
    ):
        monkeypatch.setattr(critic_training, name, value)
    monkeypatch.setattr(commands, "ROUNDS_ALLOWED", (2, 5))


@cache
def learnt(agent):
    """The critic that comes of a small training from seed 5."""
    training = CriticTraining(agent, np.random.default_rng(5), rounds=3)
    steps = list(training.run())
    assert [step.round for step in steps] == [2, 3]
    assert steps[-1].moments == 900
    return training.critic


@pytest.mark.slow
def test_a_critic_learns_to_tell_moments_apart(agent, small):
    critic = learnt(agent)
    assert sum(row.moments for row in critic.facts.reliability) == 200
    rng = np.random.default_rng(9)
    env = moon(24, rng)
    moments = flown(env, any_hands(24, rng, agent))
    moments = moments.take(rng.choice(len(moments), 300, replace=False))
    landed = saved(agent, moments, moments.action)
    chance = critic.chances(moments.observation, moments.surroundings)[np.arange(300), moments.action]
    assert ((chance > 0.5) == landed).mean() > 0.8
    assert chance[landed].mean() > chance[~landed].mean() + 0.2


@pytest.mark.slow
def test_the_command_trains_the_one_that_follows_from_its_seed_and_the_co_pilot_finds_it(
    agent, small, tmp_path, capsys
):
    agent.save(tmp_path / "mine")
    assert main.main(["train-guardian", "--model", str(tmp_path / "mine"), "--rounds", "3", "--seed", "5"]) == 0
    assert "900 moments" in capsys.readouterr().out
    critic = SafetyCritic.load(tmp_path / "mine" / "guardian")
    assert CoPilot(DeepQAgent.load(tmp_path / "mine"), 0.4, "guardian").critic is not None
    assert critic.facts.moments == 900
    np.testing.assert_array_equal(critic.network.values, learnt(agent).network.values)
    again = ["train-guardian", "--model", str(tmp_path / "mine"), "--rounds", "3", "--seed", "6"]
    assert main.main(again) == 1
    assert "--replace" in capsys.readouterr().err
    np.testing.assert_array_equal(
        SafetyCritic.load(tmp_path / "mine" / "guardian").network.values, critic.network.values
    )
    assert main.main([*again, "--replace"]) == 0


def test_for_a_network_that_lands_anywhere_it_learns_from_worlds_of_many_kinds(monkeypatch, small):
    monkeypatch.setattr(critic_training, "_FLIGHTS", 12)
    monkeypatch.setattr(critic_training, "_PER_ROUND", 40)
    training = CriticTraining(DeepQAgent.load(ANYWHERE), np.random.default_rng(2))
    lessons = training.gather(None)
    assert lessons.inputs.shape == (40, NUM_FEATURES + len(SURROUNDINGS))
    gravity = lessons.inputs[:, NUM_FEATURES + SURROUNDINGS.index("gravity")]
    assert len(np.unique(gravity)) > 1
    training.lessons.append(lessons)
    critic = training.fit(30)
    assert critic.anywhere
    assert critic.chances(lessons.inputs[:, :NUM_FEATURES], lessons.inputs[:, NUM_FEATURES:]).shape == (40, 6)


def test_the_command_refuses_what_makes_no_sense(tmp_path, capsys, small):
    assert main.main(["train-guardian", "--rounds", "1"]) == 1
    assert main.main(["train-guardian", "--model", str(tmp_path / "none")]) == 1
    DeepQAgent(rng=np.random.default_rng(0)).save(tmp_path / "fresh")
    assert main.main(["train-guardian", "--model", str(tmp_path / "fresh"), "--rounds", "4"]) == 1
    assert "lands too seldom" in capsys.readouterr().err
    assert not (tmp_path / "fresh" / "guardian").exists()


def test_the_shipped_network_has_a_critic_of_its_own_that_is_calibrated(agent):
    copilot = CoPilot(agent, 0.4, "guardian")
    assert copilot.critic is not None, copilot.critic_problem
    for row in copilot.critic.facts.reliability:
        slack = 3 * np.sqrt(max(row.said * (1 - row.said), 1e-3) / row.moments) + 0.01
        assert abs(row.said - row.saved) < slack


def test_a_scripted_pilot_is_seldom_overridden(agent):
    env = LanderEnv(60, 11, "random")
    env.reset()
    copilot, pilot, overridden, decisions = CoPilot(agent, 0.4, "guardian"), ScriptedPilot(), 0, 0
    while (flying := env.outcome == Outcome.FLYING).any():
        asked = pilot.act(env.observe())
        action, changed = copilot.share(env.observe(), asked, env.surroundings())
        overridden, decisions = overridden + (flying & changed).sum(), decisions + flying.sum()
        env.fly(action)
    assert (env.outcome == Outcome.LANDED).mean() > 0.95
    assert overridden / decisions < 0.03


def test_the_present_moment_is_where_the_lander_is(agent):
    env = LanderEnv(3, 0, "random")
    env.reset()
    env.fly(np.array([3, 4, 0]))
    moment = present(env, np.array([1, 2, 3]), np.array([True, False, True]))
    assert len(moment) == 2
    np.testing.assert_array_equal(moment.start[1, :2], env.position[2])
    assert moment.action.tolist() == [1, 3]
