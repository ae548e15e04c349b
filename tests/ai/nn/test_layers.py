"""Every layer, activation and cost through one contract: a new one joins by one row."""

import itertools
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from ai.nn import (
    ActivationFunctions,
    ActivationLayer,
    ConvolutionLayer,
    CostFunctions,
    DropoutLayer,
    DuelingLayer,
    FlattenLayer,
    FullyConnectedLayer,
    LayerNormalisation,
    MaxPoolingLayer,
    NeuralNetwork,
    softmax,
)
from ai.nn.activations import ACTIVATIONS
from ai.nn.costs import COSTS
from ai.nn.storage import LAYERS

INPUTS, OUTPUTS, BATCH = 5, 4, 6

ACTIVATION_ROWS: dict[str, Any] = {
    "tanh": ActivationFunctions.use_tanh(),
    "sigmoid": ActivationFunctions.use_sigmoid(),
    "relu": ActivationFunctions.use_relu(),
    "leaky_relu": ActivationFunctions.use_leaky_relu(0.2),
    "plain pair": (np.sin, np.cos),
}
COST_ROWS: dict[str, Any] = {
    "mse": CostFunctions.use_mse(),
    "huber": CostFunctions.use_huber(0.7),
    "softmax_cross_entropy": CostFunctions.use_softmax_cross_entropy(),
    "plain pair": (lambda p, t: np.sum((p - t) ** 4), lambda p, t: 4 * (p - t) ** 3),
}
# Each makes a layer that takes INPUTS values, or images.
LAYER_ROWS = {
    "FullyConnectedLayer": lambda: FullyConnectedLayer(INPUTS, OUTPUTS),
    "DuelingLayer": lambda: DuelingLayer(INPUTS, OUTPUTS),
    "LayerNormalisation": lambda: LayerNormalisation(INPUTS),
    "ActivationLayer": lambda: ActivationLayer(*ActivationFunctions.use_sigmoid()),
    "DropoutLayer without loss": lambda: DropoutLayer(0),
    "ConvolutionLayer": lambda: ConvolutionLayer((5, 4, 2), filters=3, kernel=3),
    "ConvolutionLayer even": lambda: ConvolutionLayer((3, 6, 1), filters=2, kernel=2),
    "ConvolutionLayer of one pixel": lambda: ConvolutionLayer((3, 2, 4), filters=2, kernel=1),
    "MaxPoolingLayer": lambda: MaxPoolingLayer((6, 4, 2)),
    "MaxPoolingLayer of odd size": lambda: MaxPoolingLayer((7, 8, 2), size=3),
    "FlattenLayer": lambda: FlattenLayer((3, 2, 2)),
}
each_layer = pytest.mark.parametrize("name", LAYER_ROWS)


def network_with(layer, activation=None, cost=None, dtype=np.float64):
    """Put the layer between two others, so that its input error matters too."""
    rng = np.random.default_rng(3)
    network = NeuralNetwork(*(cost or CostFunctions.use_mse()), rng=rng, dtype=dtype)
    if isinstance(layer.inputs, tuple):
        height, width, channels = layer.inputs
        network.add_layer(ConvolutionLayer((height, width, 3), filters=channels, kernel=1, scale=3.0))
    else:
        network.add_layer(FullyConnectedLayer(3, INPUTS, scale=3.0))
    network.add_layer(layer)
    network.add_layer(ActivationLayer(*(activation or ActivationFunctions.use_tanh())))
    if isinstance(layer.outputs, tuple):
        network.add_layer(FlattenLayer(layer.outputs))
    network.add_layer(FullyConnectedLayer(network.layers[-1].outputs or layer.outputs or INPUTS, 2))
    network.values += 0.1 * rng.normal(size=network.values.shape)  # biases and gains that are not 0 or 1
    return network


def examples_of(layer, count=BATCH, seed=5):
    shape = layer.inputs if isinstance(layer.inputs, tuple) else (layer.inputs or INPUTS,)
    return np.random.default_rng(seed).normal(size=(count, *shape))


def numerical_gradient(function, values, step=1e-6):
    gradient = np.empty_like(values)
    for index in range(values.size):
        kept = values[index]
        values[index] = kept + step
        above = function()
        values[index] = kept - step
        gradient[index] = (above - function()) / (2 * step)
        values[index] = kept
    return gradient


def test_the_tables_are_complete():
    assert {name.split()[0] for name in LAYER_ROWS} == set(LAYERS)
    assert set(ACTIVATION_ROWS) == {*ACTIVATIONS, "plain pair"}
    assert set(COST_ROWS) == {*COSTS, "plain pair"}


@pytest.mark.parametrize(
    ("layer", "activation", "cost"),
    [
        *((layer, "tanh", "mse") for layer in LAYER_ROWS),
        *itertools.product(("FullyConnectedLayer", "MaxPoolingLayer"), ACTIVATION_ROWS, COST_ROWS),
    ],
)
def test_gradients_are_exact(layer, activation, cost):
    network = network_with(LAYER_ROWS[layer](), ACTIVATION_ROWS[activation], COST_ROWS[cost])
    x, y = examples_of(network.layers[0]), np.random.default_rng(6).normal(size=(BATCH, 2))
    prediction = network.forward_propagate(x)
    network.backward_propagate(network.cost.derivative(prediction, y))
    expected = numerical_gradient(lambda: network.cost(network.predict(x), y), network.values)
    np.testing.assert_allclose(network.gradients, expected, rtol=1e-6, atol=1e-8)


@each_layer
def test_a_layer_alone_returns_its_input_error_whatever_the_order_in_memory(name):
    layer = LAYER_ROWS[name]()
    layer.dtype = np.float64
    x = examples_of(layer)
    error = np.random.default_rng(8).normal(size=layer.predict(x).shape)
    expected = numerical_gradient(lambda: np.sum(layer.predict(x) * error), x.reshape(-1)).reshape(x.shape)
    for turn in (np.array, np.asfortranarray):
        given = turn(x), turn(np.array(error))
        np.testing.assert_allclose(layer.forward_propagate(given[0]), layer.predict(x))
        np.testing.assert_allclose(layer.predict(given[0]), layer.predict(x))
        np.testing.assert_allclose(layer.backward_propagate(given[1]), expected, rtol=1e-6, atol=1e-8)
        np.testing.assert_array_equal(given[0], x)  # what is given stays as it is
        np.testing.assert_array_equal(given[1], error)


@each_layer
def test_the_way_back_to_the_input(name):
    network = network_with(LAYER_ROWS[name]())
    x, error = examples_of(network.layers[0]), np.random.default_rng(10).normal(size=(BATCH, 2))
    network.gradients[:] = 7
    gradient = network.input_gradient(x, error)
    expected = numerical_gradient(lambda: np.sum(network.predict(x) * error), x.reshape(-1))
    np.testing.assert_allclose(gradient, expected.reshape(x.shape), rtol=1e-6, atol=1e-8)
    np.testing.assert_array_equal(network.gradients, 7)


@each_layer
def test_a_batch_equals_its_examples(name):
    network = network_with(LAYER_ROWS[name](), dtype=np.float32)
    x = examples_of(network.layers[0]).astype(np.float32)
    batch = network.predict(x)
    assert batch.dtype == np.float32
    given = network.activations(x)
    assert len(given) == len(network.layers)
    np.testing.assert_array_equal(given[-1], batch)
    for one, expected in zip(x, batch, strict=True):
        np.testing.assert_allclose(network.predict(one), expected, rtol=1e-5, atol=1e-6)
        np.testing.assert_allclose(network.predict(one[None])[0], expected, rtol=1e-5, atol=1e-6)
    np.testing.assert_allclose(network.forward_propagate(x), batch, rtol=1e-5, atol=1e-6)


@each_layer
def test_batch_sizes_may_alternate_and_predict_leaves_no_trace(name):
    network = network_with(LAYER_ROWS[name]())
    kept = network.predict(examples_of(network.layers[0], seed=4))
    copied = kept.copy()
    for size in (BATCH, 1, 9, BATCH):
        x, error = examples_of(network.layers[0], size), np.random.default_rng(6).normal(size=(size, 2))
        fresh = network_with(LAYER_ROWS[name]())
        network.forward_propagate(x)
        network.predict(2 * x)
        network.predict(examples_of(network.layers[0], 2, seed=4))
        fresh.forward_propagate(x)
        for one in (network, fresh):
            one.backward_propagate(error)
        np.testing.assert_array_equal(network.gradients, fresh.gradients)
        np.testing.assert_array_equal(network.values, fresh.values)
    np.testing.assert_array_equal(kept, copied)


@pytest.mark.parametrize("name", COSTS)
def test_costs_are_summed_over_outputs_and_averaged_over_the_batch(name):
    function, derivative = COST_ROWS[name]
    p, t = np.array([[0.3, -2.0], [1.0, 0.5]]), np.array([[0.0, 0.0], [1.5, 0.1]])
    examples = [function(p[[i]], t[[i]]) for i in (0, 1)]
    assert function(p, t) == pytest.approx(np.mean(examples))
    if name != "softmax_cross_entropy":  # of which the outputs are parts of one
        assert examples[0] == pytest.approx(function(p[[0], :1], t[[0], :1]) + function(p[[0], 1:], t[[0], 1:]))
    np.testing.assert_allclose(derivative(p, t)[0], derivative(p[[0]], t[[0]])[0] / 2)
    np.testing.assert_allclose(derivative(p[0], t[0]), derivative(p[[0]], t[[0]])[0])
    assert function([[1, 2]], [[0, 0]]) == function(np.array([[1.0, 2.0]]), np.zeros((1, 2)))
    assert derivative([[1, 2]], [[0, 0]]).shape == (1, 2)
    assert COST_ROWS[name].logits == (name == "softmax_cross_entropy")


def test_costs_have_the_textbook_values():
    p, t = np.array([[1.0, 3.0]]), np.array([[0.5, 0.0]])
    assert CostFunctions.use_mse()(p, t) == pytest.approx(0.25 + 9.0)
    assert CostFunctions.use_huber(1.0)(p, t) == pytest.approx(0.125 + 2.5)
    cost, logits = CostFunctions.use_softmax_cross_entropy(), np.log([[0.7, 0.2, 0.1]]) + 5
    assert cost(logits, [[0, 1, 0]]) == pytest.approx(-np.log(0.2))
    assert cost(logits, [[0.5, 0.5, 0]]) == pytest.approx(-(np.log(0.7) + np.log(0.2)) / 2)
    np.testing.assert_allclose(softmax(logits), [[0.7, 0.2, 0.1]])
    np.testing.assert_allclose(cost.derivative(logits, [[0, 1, 0]]), [[0.7, -0.8, 0.1]])
    for dtype in (np.float32, np.float64):
        large, target = np.array([[1e4, 0, -1e4], [0, 1e4, 0]], dtype), np.array([[0, 1, 0], [0, 1, 0]], dtype)
        assert cost(large, target) == pytest.approx(1e4 / 2)
        np.testing.assert_array_equal(cost.derivative(large, target), [[0.5, -0.5, 0], [0, 0, 0]])
        assert cost.derivative(large, target).dtype == softmax(large).dtype == dtype


def test_dueling_streams_are_kept_apart():
    layer = DuelingLayer(INPUTS, OUTPUTS)
    x = examples_of(layer).astype(np.float32)
    streams = x @ layer.weights + layer.bias
    value, advantage = streams[:, :1], streams[:, 1:]
    expected = value + advantage - advantage.mean(axis=1, keepdims=True)
    np.testing.assert_allclose(layer.predict(x), expected, rtol=1e-5, atol=1e-6)


@settings(max_examples=50, deadline=None)
@given(arrays(np.float64, (3, 8), elements=st.floats(-1e3, 1e3)), st.floats(-1e3, 1e3))
def test_layer_normalisation_is_blind_to_shift(x, shift):
    layer = LayerNormalisation(8)
    layer.dtype = np.float64
    normalised = layer.predict(x)
    np.testing.assert_allclose(normalised, layer.predict(x + shift), atol=1e-5)
    np.testing.assert_allclose(normalised.mean(axis=1), 0, atol=1e-6)
    assert np.all(normalised.var(axis=1) <= 1 + 1e-9)


def test_first_weights_are_glorots():
    weights, small = FullyConnectedLayer(784, 100).weights, FullyConnectedLayer(784, 100, scale=0.01).weights
    bound = 1 / np.sqrt(884)
    assert 0.99 * bound < np.abs(weights).max() <= bound
    assert weights.std() == pytest.approx(bound / np.sqrt(3), rel=0.02)
    np.testing.assert_allclose(small, 0.01 * weights, rtol=1e-6)


def test_rectifiers_get_he_weights():
    for activation, normalised in itertools.product(("relu", "leaky_relu"), (False, True)):
        network = NeuralNetwork(*CostFunctions.use_mse()).add_layer(FullyConnectedLayer(300, 200))
        if normalised:
            network.add_layer(LayerNormalisation(200))
        network.add_layer(ActivationLayer(*ACTIVATION_ROWS[activation]))
        network.add_layer(FullyConnectedLayer(200, 100)).add_layer(ActivationLayer(*ACTIVATION_ROWS["tanh"]))
        network.add_layer(ActivationLayer(*ACTIVATION_ROWS["relu"]))
        dense = [layer for layer in network.layers if isinstance(layer, FullyConnectedLayer)]
        assert dense[0].weights.std() == pytest.approx(np.sqrt(2 / 300), rel=0.02)
        assert np.abs(dense[1].weights).max() <= 1 / np.sqrt(300)


def test_looking_at_a_network_while_it_is_built_changes_nothing_of_it():
    networks = [NeuralNetwork(*CostFunctions.use_mse()) for _ in range(2)]
    for make in (
        lambda: FullyConnectedLayer(9, 64), lambda: LayerNormalisation(64),
        lambda: ActivationLayer(*ACTIVATION_ROWS["relu"]), lambda: DuelingLayer(64, 3),
        lambda: ActivationLayer(*ACTIVATION_ROWS["leaky_relu"]),
    ):  # fmt: skip
        for network in networks:
            network.add_layer(make())
        _ = networks[1].values, networks[1].gradients, [layer.parameters for layer in networks[1].layers]
        networks[1].copy()
    np.testing.assert_array_equal(networks[0].values, networks[1].values)
    dense: Any = networks[1].layers[0]
    assert dense.weights.std() == pytest.approx(np.sqrt(2 / 9), rel=0.1)


def test_sizes_and_options_are_checked():
    for size in [0, -1, 2.5, "9", None, True, 1 << 40]:
        for make in (
            lambda size: FullyConnectedLayer(size, 2),
            lambda size: DuelingLayer(2, size),
            LayerNormalisation,
            lambda size: FlattenLayer((3, size, 3)),
            lambda size: ConvolutionLayer((3, 3, 3), size, 3),
            lambda size: ConvolutionLayer((3, 3, 3), 2, size),
            lambda size: MaxPoolingLayer((3, 3, 3), size),
        ):
            with pytest.raises(ValueError, match="whole number"):
                make(size)
    for rate in [-0.1, 1, 1.5, float("nan"), "0.5", None, True]:
        with pytest.raises(ValueError, match="rate of dropout"):
            DropoutLayer(rate)
    with pytest.raises(ValueError, match="slope"):
        ActivationFunctions.use_leaky_relu(1.5)
    with pytest.raises(ValueError, match="delta"):
        CostFunctions.use_huber(0)
    with pytest.raises(TypeError, match="derivative is missing"):
        ActivationLayer(np.sin)
    with pytest.raises(TypeError, match="derivative is missing"):
        NeuralNetwork(lambda p, t: 0.0)
