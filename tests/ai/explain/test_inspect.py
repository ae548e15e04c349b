from itertools import product

import numpy as np

from ai.agent.network import build_network
from ai.explain.inspection import links, traces
from ai.nn import (
    ConvolutionLayer,
    CostFunctions,
    FlattenLayer,
    FullyConnectedLayer,
    NeuralNetwork,
)
from ai.training.config import Config

OBSERVATION = np.linspace(-1, 1, 9).astype(np.float32)


def network_of(**options: object) -> NeuralNetwork:
    config = Config(hidden=(5, 7)).changed(**options)
    return build_network(9, 6, config, np.random.default_rng(0))


def test_traces_end_with_what_the_network_answers_and_links_lead_there() -> None:
    for dueling, normalised, activation in product((False, True), (False, True), ("relu", "tanh", "leaky_relu")):
        network = network_of(dueling=dueling, layer_normalisation=normalised, activation=activation)
        stages = traces(network, OBSERVATION)
        assert [len(stage) for stage in stages] == [9, 5, 7, 6]
        np.testing.assert_array_equal(stages[0], OBSERVATION)
        np.testing.assert_allclose(stages[-1], network.predict(OBSERVATION), rtol=1e-5)
        assert (stages[1] >= 0).all() or activation != "relu"
        found = links(network)
        assert [(*link.weights.shape, *link.bias.shape) for link in found] == [(9, 5, 5), (5, 7, 7), (7, 6, 6)]
        np.testing.assert_allclose(stages[-2] @ found[-1].weights + found[-1].bias, stages[-1], atol=1e-6)
        network.gradients[:] = -2 * network.values  # of the last way back
        for link in links(network):
            np.testing.assert_allclose(link.gradient, -2 * link.weights, rtol=1e-5)
        for rows, first in zip(traces(network, np.stack([OBSERVATION, -OBSERVATION])), stages, strict=True):
            np.testing.assert_allclose(rows[0], first, atol=1e-6)


def test_numbers_that_are_none_pass_through() -> None:
    network = network_of()
    network.values[:] = np.nan
    assert np.isnan(traces(network, OBSERVATION)[-1]).all()
    network.values[:] = 1e38
    traces(network, OBSERVATION)


def test_images_are_traced_from_the_first_stage_of_units() -> None:
    network = (
        NeuralNetwork(*CostFunctions.use_mse())
        .add_layer(ConvolutionLayer((6, 6, 1), 2, 3))
        .add_layer(FlattenLayer((4, 4, 2)))
        .add_layer(FullyConnectedLayer(32, 3))
    )
    image = np.random.default_rng(0).random((6, 6, 1), np.float32)
    assert [stage.shape for stage in traces(network, image)] == [(32,), (3,)]
    assert len(links(network)) == 1
