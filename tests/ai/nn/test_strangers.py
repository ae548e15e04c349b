"""What programs of others do with networks: copies, pickles, empty batches, and what is no input at all."""

import copy
import pickle

import numpy as np
import pytest

from ai.agent import DeepQAgent
from ai.nn import (
    SGD,
    ActivationFunctions,
    ActivationLayer,
    Adam,
    CostFunctions,
    FullyConnectedLayer,
    LayerNormalisation,
    NeuralNetwork,
)
from tests.ai.nn.test_layers import LAYER_ROWS

X, Y = np.random.default_rng(0).normal(size=(5, 3)).astype(np.float32), np.zeros((5, 2), np.float32)


def network():
    return (
        NeuralNetwork(*CostFunctions.use_huber(0.7))
        .add_layer(FullyConnectedLayer(3, 4))
        .add_layer(ActivationLayer(*ActivationFunctions.use_leaky_relu(0.2)))
        .add_layer(LayerNormalisation(4))
        .add_layer(FullyConnectedLayer(4, 2))
    )


COPIES = {"deepcopy": copy.deepcopy, "pickle": lambda what: pickle.loads(pickle.dumps(what))}


@pytest.mark.parametrize("copied", [*COPIES.values(), NeuralNetwork.copy], ids=[*COPIES, "copy"])
def test_a_copied_network_is_equal_and_learns_apart(copied):
    first = network()
    twin = copied(first)
    before = first.predict(X)
    assert np.array_equal(twin.predict(X), before)
    assert (twin.cost.name, dict(twin.cost.options)) == ("huber", {"delta": 0.7})
    twin.train(X, Y, epochs=3)
    assert not np.array_equal(twin.predict(X), before)
    assert np.array_equal(first.predict(X), before)
    first.train(X, Y, epochs=3)
    assert np.array_equal(first.values, twin.values)


@pytest.mark.parametrize("way", COPIES)
def test_a_copied_agent_decides_alike_and_learns_on(way):
    first = DeepQAgent.load("models/lander/modern")
    twin = COPIES[way](first)
    observation = np.random.default_rng(1).normal(size=(4, 9)).astype(np.float32)
    before = first.q_values(observation)
    assert np.array_equal(twin.q_values(observation), before)
    twin.online.train_batch(observation, np.zeros((4, 6)), twin.optimizer)
    assert not np.array_equal(twin.online.predict(observation), first.online.predict(observation))
    assert np.array_equal(first.q_values(observation), before)


REFUSED = {
    "nothing": None,
    "objects": np.array([[1, None, 2]], object),
    "words": "abc",
    "four dimensions": np.ones((2, 2, 2, 3)),
    "three dimensions": np.ones((2, 2, 3)),
    "a number": 1.0,
    "another width": np.ones((2, 4)),
}


@pytest.mark.parametrize("what", REFUSED)
def test_what_is_no_input_is_refused_in_a_sentence(what):
    for ask in (network().predict, network().forward_propagate):
        with pytest.raises(ValueError, match="network takes"):
            ask(REFUSED[what])


def test_wrong_values_rates_and_numbers_are_refused_in_a_sentence():
    for values in (1.0, np.ones(3), np.ones((36, 1)), np.zeros(network().values.size, complex)):
        with pytest.raises(ValueError, match="parameters, in one row"):
            network().values = values
    for make in (SGD, Adam, lambda rate: network().train(X, Y, learning_rate=rate)):
        with pytest.raises(ValueError, match="a learning rate is a number, not 'fast'"):
            make("fast")
    for dtype in (int, complex, np.float16, np.longdouble):
        with pytest.raises(ValueError, match="a network computes with float32 or float64"):
            NeuralNetwork(*CostFunctions.use_mse(), dtype=dtype)


@pytest.mark.parametrize("name", LAYER_ROWS)
def test_an_empty_batch_goes_through_every_layer_and_trains_nothing(name):
    layer = LAYER_ROWS[name]()
    shape = layer.inputs if isinstance(layer.inputs, tuple) else (layer.inputs or 5,)
    alone = NeuralNetwork(*CostFunctions.use_mse()).add_layer(layer)
    empty = np.zeros((0, *shape), np.float32)
    one = alone.predict(np.zeros((1, *shape), np.float32))
    assert alone.predict(empty).shape == alone.forward_propagate(empty).shape == (0, *one.shape[1:])
    before = alone.values.copy()
    assert alone.train_batch(empty, np.zeros((0, *one.shape[1:])), Adam(0.1)) == 0.0
    assert np.array_equal(alone.values, before)


@pytest.mark.parametrize("cost", [CostFunctions.use_mse(), CostFunctions.use_huber()], ids=lambda cost: cost.name)
def test_costs_refuse_targets_of_another_shape(cost):
    for ask in (cost, cost.derivative):
        with pytest.raises(ValueError, match="the targets have shape"):
            ask(np.zeros((5, 1)), np.zeros(5))


def test_a_masked_class_has_no_chance_and_costs_nothing():
    cost = CostFunctions.use_softmax_cross_entropy()
    logits, target = np.array([[1.0, -np.inf, 2.0]]), np.array([[0.0, 0.0, 1.0]])
    assert cost(logits, target) == pytest.approx(np.log(1 + np.exp(-1.0)))
    assert cost.derivative(logits, target)[0] == pytest.approx([1 / (1 + np.e), 0.0, -1 / (1 + np.e)])


def test_one_optimizer_serves_one_network():
    adam, first = Adam(0.01), network()
    first.train_batch(X, Y, adam)
    with pytest.raises(ValueError, match="another network needs its own"):
        network().train_batch(X, Y, adam)
    first.train_batch(X, Y, adam)
