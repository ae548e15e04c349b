"""Convolution, pooling, flattening and dropout: what is theirs alone. The contract of all layers is in test_layers."""

import numpy as np
import pytest

from ai.nn import (
    ActivationFunctions,
    ActivationLayer,
    ConvolutionLayer,
    CostFunctions,
    DropoutLayer,
    FlattenLayer,
    FullyConnectedLayer,
    MaxPoolingLayer,
    NeuralNetwork,
    images,
)


@pytest.mark.parametrize("block", [1, 100, images.BLOCK])
@pytest.mark.parametrize(("inputs", "kernel"), [((5, 8, 2), 3), ((9, 6, 3), 1), ((4, 5, 2), 2)])
def test_a_convolution_is_what_its_definition_says_in_blocks_of_any_size(monkeypatch, block, inputs, kernel):
    monkeypatch.setattr(images, "BLOCK", block)
    rng = np.random.default_rng(1)
    layer = ConvolutionLayer(inputs, 4, kernel)
    layer.dtype = np.float64
    layer.bias[...] = rng.normal(size=4)
    x, error = rng.normal(size=(3, *inputs)), rng.normal(size=(3, *layer.outputs))
    expected, gradient, input_error = np.empty(error.shape), np.zeros(layer.kernels.shape), np.zeros(x.shape)
    for example, row, column in np.ndindex(error.shape[:3]):
        square = (example, slice(row, row + kernel), slice(column, column + kernel))
        window = x[square].swapaxes(0, 1)
        sent = error[example, row, column]
        expected[example, row, column] = np.einsum("xyc,xycf->f", window, layer.kernels) + layer.bias
        gradient += window[..., None] * sent
        input_error[square] += (layer.kernels @ sent).swapaxes(0, 1)
    np.testing.assert_allclose(layer.predict(x), expected, atol=1e-12)
    np.testing.assert_allclose(layer.forward_propagate(x), expected, atol=1e-12)
    np.testing.assert_allclose(layer.backward_propagate(error), input_error, atol=1e-12)
    np.testing.assert_allclose(layer.parameters[0].gradient, gradient.reshape(layer.weights.shape), atol=1e-12)


@pytest.mark.parametrize("size", [2, 3])
def test_the_largest_of_each_square_comes_through_and_gets_the_error(size):
    rng = np.random.default_rng(4)
    layer = MaxPoolingLayer((7, 8, 2), size)
    for _ in range(2):  # the last rows and columns fill no square, and keep no error of the last time
        images = rng.integers(0, 3, (4, 7, 8, 2)).astype(float)  # a third of the pixels equal their neighbour
        pooled = layer.forward_propagate(images)
        error = rng.normal(size=pooled.shape)
        expected = np.zeros(images.shape)
        for example, row, column, channel in np.ndindex(error.shape):
            top, left = row * size, column * size
            square = images[example, top : top + size, left : left + size, channel]
            assert pooled[example, row, column, channel] == square.max()
            down, across = np.unravel_index(square.argmax(), square.shape)  # the first of equal ones
            expected[example, top + down, left + across, channel] = error[example, row, column, channel]
        np.testing.assert_array_equal(layer.input_error(error), expected)


def test_dropout_drops_as_often_as_it_says_and_keeps_the_mean():
    layer = DropoutLayer(0.25)
    x = np.ones((200, 100), np.float32)
    output = layer.forward_propagate(x)
    assert set(np.unique(output)) == {0, np.float32(4 / 3)}
    assert np.mean(output == 0) == pytest.approx(0.25, abs=0.01)
    np.testing.assert_array_equal(layer.input_error(2 * x), 2 * output)
    assert not np.array_equal(output.copy(), layer.forward_propagate(x))


def test_nothing_is_dropped_in_predict_and_on_the_way_to_the_input():
    network, plain = digits_network(dropout=0.9), digits_network(dropout=0.0)
    plain.values = network.values
    x, error = np.random.default_rng(1).random((4, 8, 8, 1)), np.eye(3)[[0, 1, 2, 0]]
    np.testing.assert_array_equal(network.predict(x), plain.predict(x))
    assert not np.array_equal(network.forward_propagate(x), plain.forward_propagate(x))
    np.testing.assert_array_equal(network.input_gradient(x, error), plain.input_gradient(x, error))


def test_sizes_that_make_no_sense_are_named(subtests):
    network = NeuralNetwork(*CostFunctions.use_mse()).add_layer(ConvolutionLayer((8, 8, 1), 2, 3))
    for make, message in [
        (lambda: ConvolutionLayer((28, 28), 8, 3), "height, width, channels"),
        (lambda: ConvolutionLayer(28, 8, 3), "height, width, channels"),
        (lambda: ConvolutionLayer((4, 9, 1), 8, 5), "5 does not fit into 4 x 9"),
        (lambda: ConvolutionLayer((2000, 2000, 3), 8, 3), "height · width · channels"),
        (lambda: MaxPoolingLayer((4, 9, 1), 5), "between 2 and that of the image, 4 x 9"),
        (lambda: MaxPoolingLayer((4, 9, 1), 1), "between 2"),
        (lambda: FlattenLayer("784"), "height, width, channels"),
        (lambda: network.add_layer(MaxPoolingLayer((6, 6, 1))),
         "takes images of 6 x 6 x 1, the layer before gives images of 6 x 6 x 2"),
        (lambda: network.add_layer(FullyConnectedLayer(72, 2)),
         "takes 72 values, the layer before gives images of 6 x 6 x 2"),
    ]:  # fmt: skip
        with subtests.test(message=message), pytest.raises(ValueError, match=message):
            make()


def digits_network(seed=0, dropout=0.2):
    """Return a small classifier of 8 x 8 pixels into three kinds."""
    return (
        NeuralNetwork(*CostFunctions.use_softmax_cross_entropy(), rng=np.random.default_rng(seed))
        .add_layer(ConvolutionLayer((8, 8, 1), 4, 3))
        .add_layer(ActivationLayer(*ActivationFunctions.use_relu()))
        .add_layer(MaxPoolingLayer((6, 6, 4)))
        .add_layer(FlattenLayer((3, 3, 4)))
        .add_layer(DropoutLayer(dropout))
        .add_layer(FullyConnectedLayer(36, 3))
    )
