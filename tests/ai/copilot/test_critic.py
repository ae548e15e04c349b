"""The safety critic: its chances, its files, and how it is found beside an agent."""

import json

import numpy as np
import pytest

from ai.agent.agent import DeepQAgent
from ai.agent.config import Config
from ai.copilot.critic import CriticFacts, Reliability, SafetyCritic, critic_beside, fingerprint, logistic
from ai.lander.environment import MIRROR_ACTIONS, MIRROR_FEATURES, MIRROR_SIGNS, LanderEnv
from ai.lander.sensing import SURROUNDINGS, SURROUNDINGS_MIRROR
from ai.nn import (
    ActivationFunctions,
    ActivationLayer,
    CostFunctions,
    FullyConnectedLayer,
    ModelFormatError,
    NeuralNetwork,
)


def made(inputs=("time left", "pad width"), agent="", **facts):
    network = NeuralNetwork(*CostFunctions.use_mse(), rng=np.random.default_rng(3))
    network.add_layer(FullyConnectedLayer(9 + len(inputs), 8))
    network.add_layer(ActivationLayer(*ActivationFunctions.use_relu()))
    network.add_layer(FullyConnectedLayer(8, 6))
    return SafetyCritic(network, CriticFacts(agent, inputs, **facts))


@pytest.fixture
def moments():
    env = LanderEnv(20, 0, "random")
    env.reset()
    return env.observe(), env.surroundings()


def test_chances_lie_between_nothing_and_certainty_and_follow_the_output():
    output = np.array([-1e30, -2.0, 0.0, 2.0, 1e30])
    np.testing.assert_allclose(logistic(output), [0.0, 1 / (1 + np.e**2), 0.5, 1 / (1 + np.e**-2), 1.0])


def test_a_batch_has_the_chances_of_its_moments_one_by_one(moments):
    critic, (observation, surroundings) = made(slope=0.7, offset=0.4), moments
    together = critic.chances(observation, surroundings)
    assert together.shape == (20, 6)
    alone = [critic.chances(observation[[k]], surroundings[[k]])[0] for k in range(20)]
    np.testing.assert_allclose(together, alone, rtol=1e-6)


@pytest.mark.parametrize("inputs", [(), ("wind", "time left", "pad velocity")])
def test_left_and_right_have_the_same_chances(moments, inputs):
    critic, (observation, surroundings) = made(inputs), moments
    surroundings[:, SURROUNDINGS.index("wind")] = np.linspace(-1.0, 1.0, 20)
    mirrored = critic.chances(observation[:, MIRROR_FEATURES] * MIRROR_SIGNS, surroundings * SURROUNDINGS_MIRROR)
    np.testing.assert_allclose(critic.chances(observation, surroundings), mirrored[:, MIRROR_ACTIONS], rtol=1e-6)


def test_unknown_surroundings_are_those_of_a_flight_that_begins_on_the_moon(moments):
    critic, (observation, surroundings) = made(), moments
    np.testing.assert_array_equal(critic.chances(observation), critic.chances(observation, surroundings))
    late = surroundings.copy()
    late[:, SURROUNDINGS.index("time left")] = 0.0
    assert (critic.chances(observation, late) != critic.chances(observation, surroundings)).any()


def test_slope_and_offset_turn_outputs_into_chances(moments):
    observation, surroundings = moments
    outputs = made().outputs(np.concatenate([observation, surroundings[:, :2]], axis=1))
    steeper = made(slope=2.0, offset=-1.0).chances(observation, surroundings)
    np.testing.assert_allclose(steeper, logistic(2.0 * outputs - 1.0), rtol=1e-5)


def test_what_is_saved_is_read_again(moments, tmp_path):
    rows = (Reliability(0.25, 0.5, 8), Reliability(0.9, 0.75, 4))
    critic = made(agent="abc", slope=1.5, offset=-0.25, moments=12, reliability=rows)
    critic.save(tmp_path / "guardian")
    again = SafetyCritic.load(tmp_path / "guardian")
    assert again.facts == critic.facts
    np.testing.assert_array_equal(again.chances(*moments), critic.chances(*moments))


@pytest.mark.parametrize(
    ("name", "value", "says"),
    [
        ("inputs", ["phase of the moon"], "phase of the moon"),
        ("inputs", [], "11"),
        ("slope", "steep", "slope"),
        ("format", "tranquility agent", "safety critic"),
        ("version", 99, "version"),
        ("reliability", [[1]], "reliability"),
    ],
)
def test_damaged_files_are_refused_in_a_sentence(tmp_path, name, value, says):
    folder = tmp_path / "guardian"
    made().save(folder)
    described = json.loads((folder / "config.json").read_text())
    (folder / "config.json").write_text(json.dumps(described | {name: value}))
    with pytest.raises(ModelFormatError, match=says):
        SafetyCritic.load(folder)


def agent_in(folder):
    agent = DeepQAgent(config=Config(hidden=(4,)), rng=np.random.default_rng(1))
    agent.save(folder)
    return DeepQAgent.load(folder)


def test_a_critic_is_found_beside_its_agent_and_survives_nothing_that_changes_the_agent(tmp_path):
    agent = agent_in(tmp_path / "mine")
    made(agent=fingerprint(agent)).save(tmp_path / "mine" / "guardian")
    critic, problem = critic_beside(agent)
    assert critic is not None
    assert problem == ""
    assert critic_beside(agent)[0] is critic  # read once
    changed = DeepQAgent.load(tmp_path / "mine")
    changed.online.values = changed.target.values = changed.online.values + 1
    assert critic_beside(changed) == (None, "it was made for another network")


def test_why_there_is_none_is_said(tmp_path):
    assert critic_beside(DeepQAgent())[0] is None
    assert critic_beside(agent_in(tmp_path / "a")) == (None, "none was made")
    agent = agent_in(tmp_path / "b")
    made(agent=fingerprint(agent)).save(tmp_path / "b" / "guardian")
    (tmp_path / "b" / "guardian" / "network" / "config.json").write_text("{")
    critic, problem = critic_beside(agent)
    assert critic is None
    assert problem


def test_an_agent_can_be_saved_over_one_that_has_a_critic(tmp_path):
    agent = agent_in(tmp_path / "mine")
    made(agent=fingerprint(agent)).save(tmp_path / "mine" / "guardian")
    agent.save(tmp_path / "mine")
    assert DeepQAgent.load(tmp_path / "mine").folder == tmp_path / "mine"
