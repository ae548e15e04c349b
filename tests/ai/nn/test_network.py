"""The network as a whole: building, training, copying."""

from itertools import product
from typing import Any

import numpy as np
import pytest

from ai.nn import (
    ActivationFunctions,
    ActivationLayer,
    CostFunctions,
    DivergenceError,
    DuelingLayer,
    FullyConnectedLayer,
    Layer,
    LayerNormalisation,
    NeuralNetwork,
    register_layer,
)
from ai.nn.storage import LAYERS

XOR_X = np.array([[0, 0], [0, 1], [1, 0], [1, 1]])
XOR_Y = np.array([[0], [1], [1], [0]])


def small_network(seed=0, hidden=16, cost=None):
    return (
        NeuralNetwork(*(cost or CostFunctions.use_mse()), rng=np.random.default_rng(seed))
        .add_layer(FullyConnectedLayer(2, hidden))
        .add_layer(ActivationLayer(*ActivationFunctions.use_tanh()))
        .add_layer(FullyConnectedLayer(hidden, 1))
    )


def test_an_epoch_meets_every_example_once_and_weighs_all_alike():
    seen = []
    network = small_network(cost=(lambda _p, t: seen.extend(t[:, 0]) or 0.0, lambda p, _t: np.zeros_like(p)))
    x, y = np.zeros((10, 2)), np.arange(10.0)[:, None]
    network.train(x, y, epochs=1, batch_size=4)
    assert seen == list(range(10))
    seen.clear()
    network.train(x, y, epochs=2, batch_size=4, sampling="random")
    assert sorted(seen[:10]) == sorted(seen[10:]) == list(range(10))
    assert seen[:10] != seen[10:]
    network = small_network()
    expected = network.cost(network.predict(XOR_X), XOR_Y)
    assert network.train(XOR_X, XOR_Y, batch_size=3, learning_rate=0.0) == [pytest.approx(expected)]


def test_wrong_arguments_are_named():
    change: Any
    for change, message in [
        ({"y": XOR_Y[:2]}, "4 inputs"),
        ({"x": XOR_X[:0], "y": XOR_Y[:0]}, "at least one"),
        ({"y": XOR_Y[:, 0]}, "shape"),
        ({"sampling": "shuffled"}, "shuffled"),
        ({"batch_size": 0}, "batch_size"),
        ({"x": np.zeros((4, 3))}, "3"),
    ]:
        with pytest.raises(ValueError, match=message):
            small_network().train(**({"x": XOR_X, "y": XOR_Y} | change))
    network = small_network()
    with pytest.raises(ValueError, match="takes 2 values, the layer before gives 1"):
        network.add_layer(FullyConnectedLayer(2, 2))
    network.add_layer(ActivationLayer(*ActivationFunctions.use_tanh()))
    with pytest.raises(ValueError, match="LayerNormalisation takes 4"):
        network.add_layer(LayerNormalisation(4))


def test_numbers_that_run_away_end_the_training_and_no_infinite_weight_stays():
    """A linear network at rate 5 overshoots more at each step; the very last step is checked as well."""
    for rate, epochs in product((5.0, 1e30), (1, 100)):
        rng = np.random.default_rng(0)
        network = NeuralNetwork(*CostFunctions.use_mse()).add_layer(FullyConnectedLayer(4, 1))
        x = rng.normal(size=(200, 4))
        with pytest.raises(DivergenceError, match=r"learning step .* the learning rate of") as caught:
            network.train(x, x.sum(axis=1, keepdims=True), epochs=epochs, batch_size=4, learning_rate=rate)
        assert caught.value.learning_rate == rate
        assert 1 <= caught.value.step <= 50
        assert f"learning step {caught.value.step};" in str(caught.value)
        assert np.isfinite(network.values).all()


def test_a_layer_belongs_to_one_network():
    layer = FullyConnectedLayer(2, 2)
    network = NeuralNetwork(*CostFunctions.use_mse()).add_layer(layer)
    for other in (network, NeuralNetwork(*CostFunctions.use_mse())):
        with pytest.raises(ValueError, match="FullyConnectedLayer belongs to a network already"):
            other.add_layer(layer)
    network.values = np.arange(6.0)
    assert len(network.layers) == 1
    np.testing.assert_array_equal(layer.weights, [[0, 1], [2, 3]])


class Gain(Layer):
    """A custom layer with no more than the contract asks: each value times a number of its own."""

    settings = ("inputs",)

    def __init__(self, inputs):
        self.inputs = self.outputs = inputs
        self.shapes = {"gain": (inputs,)}

    def initial_value(self, name):
        return self.rng.uniform(0.5, 1.5, self.inputs)

    def forward_propagate(self, input_data):
        self.input = input_data
        return input_data * self.parameters[0].value

    def backward_propagate(self, output_error):
        self.parameters[0].gradient[...] = (self.input * output_error).sum(axis=0)
        return output_error * self.parameters[0].value

    def predict(self, input_data):
        return input_data * self.parameters[0].value


@pytest.mark.parametrize("place", [0, 1])
def test_a_custom_layer_learns_wherever_it_stands(place):
    network = NeuralNetwork(*CostFunctions.use_mse(), dtype=np.float64)
    network.add_layer(*(Gain(2), FullyConnectedLayer(2, 2))[:: 1 - 2 * place])
    before = network.layers[place].parameters[0].value.copy()
    history = network.train(XOR_X, 3.0 * XOR_X, epochs=200, batch_size=4, learning_rate=0.05)
    assert history[-1] < 0.01 * history[0]
    gain, dense = network.layers[place].parameters[0].value, network.layers[1 - place]
    assert (gain != before).all()
    error = network.input_gradient(XOR_X, np.ones((4, 2)))
    both = dense.weights * (gain if place else gain[:, None])
    np.testing.assert_allclose(error, np.tile(both.sum(axis=1), (4, 1)))


def test_a_custom_layer_is_saved_once_it_is_registered(tmp_path, monkeypatch):
    monkeypatch.setattr("ai.nn.storage.LAYERS", LAYERS.copy())
    network = NeuralNetwork(*CostFunctions.use_mse()).add_layer(Gain(2)).add_layer(FullyConnectedLayer(2, 1))
    with pytest.raises(ValueError, match=r"layer 0, a Gain, could not be loaded again: tell ai\.nn\.register_layer"):
        network.save(tmp_path / "model")
    assert not (tmp_path / "model").exists()
    assert register_layer(Gain) is register_layer(Gain) is Gain
    network.save(tmp_path / "model")
    loaded = NeuralNetwork.load(tmp_path / "model")
    assert type(loaded.layers[0]) is Gain
    np.testing.assert_array_equal(loaded.predict(XOR_X), network.predict(XOR_X))
    np.testing.assert_array_equal(network.copy().predict(XOR_X), network.predict(XOR_X))
    with pytest.raises(ValueError, match="another kind of layer called Gain"):
        register_layer(type("Gain", (Gain,), {}))


def test_the_flat_vector_is_the_layers_and_a_later_layer_joins_it():
    network, other = small_network(5), small_network(5)
    assert network.layers[2].weights.shape == (16, 1)  # looked at before the vector
    np.testing.assert_array_equal(network.values, other.values)
    assert not np.array_equal(network.values, small_network(6).values)
    network.forward_propagate(XOR_X)
    network.backward_propagate(np.ones((4, 1)))
    assert network.gradients[-1] == 4
    network.values[:] = np.arange(2 * 16 + 16 + 16 + 1)
    np.testing.assert_array_equal(network.layers[0].weights.ravel(), np.arange(32))
    network.layers[0].bias[...] = -1
    np.testing.assert_array_equal(network.values[32:48], -1)
    with pytest.raises(ValueError, match="65 real parameters"):
        network.values = np.zeros(3)
    before = network.values.copy()
    network.add_layer(FullyConnectedLayer(1, 2))
    np.testing.assert_array_equal(network.values[: before.size], before)
    assert network.values.size == before.size + 4
    assert np.shares_memory(network.layers[-1].weights, network.values)


def test_a_batch_of_one_is_predicted_as_among_others_whatever_became_of_the_network():
    rng = np.random.default_rng(3)
    x = rng.normal(size=(4, 5))
    network = NeuralNetwork(*CostFunctions.use_mse(), dtype=np.float64).add_layer(FullyConnectedLayer(5, 7))
    network.add_layer(ActivationLayer(*ActivationFunctions.use_tanh()), LayerNormalisation(7), DuelingLayer(7, 3))
    for some in (network, network.copy()):
        answers = [some.predict(row[None]) for row in x]
        np.testing.assert_allclose(np.concatenate(answers), some.predict(x), rtol=1e-12)
        answers[1][...] = 7  # an array of its own
        np.testing.assert_allclose(some.predict(x[1:2]), some.predict(x)[1:2], rtol=1e-12)
        some.values = rng.normal(size=network.values.shape)
        np.testing.assert_allclose(some.predict(x[1:2]), some.predict(x)[1:2], rtol=1e-12)


def test_the_gradient_of_an_input_leaves_those_of_the_parameters():
    network = NeuralNetwork(*CostFunctions.use_mse()).add_layer(Gain(2), FullyConnectedLayer(2, 1), Gain(1))
    network.forward_propagate(XOR_X)
    network.backward_propagate(np.ones((4, 1)))
    before = network.gradients.copy()
    network.input_gradient(XOR_X, 2.0 * np.ones((4, 1)))
    np.testing.assert_array_equal(network.gradients, before)
