"""Convolution, pooling, flattening and dropout: what is theirs alone. The contract of all layers is in test_layers."""

from typing import Any

import numpy as np
import pytest

from ai.nn import (
    ActivationFunctions,
    ActivationLayer,
    Adam,
    ConvolutionLayer,
    CostFunctions,
    DropoutLayer,
    FlattenLayer,
    FullyConnectedLayer,
    MaxPoolingLayer,
    NeuralNetwork,
    images,
    network,
)


def convolved(layer, image):
    """Return what the definition says, pixel by pixel."""
    padded = np.pad(image, [(layer.padding, layer.padding)] * 2 + [(0, 0)])
    output = np.empty(layer.outputs)
    for row, column in np.ndindex(layer.outputs[:2]):
        top, left = row * layer.stride, column * layer.stride
        window = padded[top : top + layer.kernel, left : left + layer.kernel]
        output[row, column] = np.einsum("hwc,whcf->f", window, layer.kernels) + layer.bias
    return output


@pytest.mark.parametrize("block", [1, 100, 1000, images.BLOCK])
@pytest.mark.parametrize(
    ("inputs", "kernel", "stride", "padding"),
    [((5, 8, 2), 3, 1, 0), ((7, 4, 1), 5, 1, 2), ((9, 6, 3), 3, 2, 1), ((4, 5, 2), 2, 3, 1), ((3, 3, 1), 3, 1, 0)],
)
def test_a_convolution_is_what_its_definition_says(monkeypatch, block, inputs, kernel, stride, padding):
    monkeypatch.setattr(images, "BLOCK", block)
    rng = np.random.default_rng(1)
    layer = ConvolutionLayer(inputs, 4, kernel, stride=stride, padding=padding, dtype=np.float64, rng=rng)
    layer.bias[...] = rng.normal(size=4)
    x = rng.normal(size=(3, *inputs))
    expected = [convolved(layer, image) for image in x]
    np.testing.assert_allclose(layer.predict(x), expected, atol=1e-12)
    np.testing.assert_allclose(layer.forward_propagate(x), expected, atol=1e-12)


def test_gradients_do_not_depend_on_the_blocks(monkeypatch):
    def gradients():
        layer = ConvolutionLayer((6, 7, 2), 4, 3, padding=1, dtype=np.float64)
        rng = np.random.default_rng(2)
        error = rng.normal(size=layer.forward_propagate(rng.normal(size=(5, 6, 7, 2))).shape)
        input_error = layer.backward_propagate(error)
        return [input_error, *(parameter.gradient for parameter in layer.parameters)]

    expected = gradients()
    monkeypatch.setattr(images, "BLOCK", 200)
    for gradient, one in zip(gradients(), expected, strict=True):
        np.testing.assert_allclose(gradient, one, atol=1e-12)


def test_the_largest_of_each_square_comes_through():
    image = np.arange(30.0).reshape(1, 5, 6, 1)
    pooled = MaxPoolingLayer((5, 6, 1)).predict(image)
    np.testing.assert_array_equal(pooled[0, :, :, 0], [[7, 9, 11], [19, 21, 23]])


def test_of_equal_pixels_the_first_gets_the_error():
    layer = MaxPoolingLayer((2, 6, 1))
    image = np.array([[0.0, 5, 3, 3, 1, 2], [5, 5, 3, 3, 4, 4]]).reshape(1, 2, 6, 1)
    layer.forward_propagate(image)
    error = layer.input_error(np.array([1.0, 2, 3]).reshape(1, 1, 3, 1))
    np.testing.assert_array_equal(error[0, :, :, 0], [[0, 1, 2, 0, 0, 0], [0, 0, 0, 0, 3, 0]])


@pytest.mark.parametrize("size", [2, 3])
def test_pooling_goes_back_as_pixel_by_pixel(size):
    rng = np.random.default_rng(4)
    layer = MaxPoolingLayer((7, 8, 2), size)
    images = rng.integers(0, 3, (4, 7, 8, 2)).astype(float)  # a third of the pixels equal their neighbour
    error = rng.normal(size=layer.forward_propagate(images).shape)
    expected = np.zeros(images.shape)
    for example, row, column, channel in np.ndindex(error.shape):
        top, left = row * size, column * size
        square = images[example, top : top + size, left : left + size, channel]
        down, across = np.unravel_index(square.argmax(), square.shape)  # the first of equal ones
        expected[example, top + down, left + across, channel] = error[example, row, column, channel]
    np.testing.assert_array_equal(layer.input_error(error), expected)


def test_what_fills_no_square_gets_no_error():
    layer = MaxPoolingLayer((3, 3, 1))
    for _ in range(2):
        layer.forward_propagate(np.zeros((1, 3, 3, 1)))
        error = layer.input_error(np.ones((1, 1, 1, 1)))
    assert error.sum() == error[0, 0, 0, 0] == 1


def test_flattening_moves_nothing():
    layer, x = FlattenLayer((2, 3, 4)), np.asfortranarray(np.random.default_rng(0).normal(size=(5, 2, 3, 4)))
    flat = layer.forward_propagate(x)
    assert flat.shape == (5, 24)
    assert np.shares_memory(flat, x)
    np.testing.assert_array_equal(layer.predict(x), flat)
    np.testing.assert_array_equal(layer.input_error(np.array(flat)), x)


def test_dropout_drops_as_often_as_it_says_and_keeps_the_mean():
    layer = DropoutLayer(0.25)
    x = np.ones((200, 100), np.float32)
    output = layer.forward_propagate(x)
    assert set(np.unique(output)) == {0, np.float32(4 / 3)}
    assert np.mean(output == 0) == pytest.approx(0.25, abs=0.01)
    np.testing.assert_array_equal(layer.input_error(2 * x), 2 * output)
    assert not np.array_equal(output.copy(), layer.forward_propagate(x))


def test_dropout_does_nothing_in_predict():
    network = digits_network(dropout=0.9)
    x = np.random.default_rng(1).random((4, 8, 8, 1))
    plain = digits_network(dropout=0.0)
    plain.values = network.values
    np.testing.assert_array_equal(network.predict(x), plain.predict(x))
    assert not np.array_equal(network.forward_propagate(x), plain.forward_propagate(x))


def test_nothing_is_dropped_on_the_way_to_the_input():
    network, plain = digits_network(dropout=0.9), digits_network(dropout=0.0)
    plain.values = network.values
    x, error = np.random.default_rng(1).random((4, 8, 8, 1)), np.eye(3)[[0, 1, 2, 0]]
    np.testing.assert_array_equal(network.input_gradient(x, error), plain.input_gradient(x, error))


def test_many_images_are_predicted_in_parts(monkeypatch):
    x = np.random.default_rng(1).random((23, 8, 8, 1))
    expected = digits_network().predict(x)
    monkeypatch.setattr(network, "IMAGES", 10)
    np.testing.assert_allclose(digits_network().predict(x), expected, rtol=1e-5)


def test_dropout_is_reproducible():
    x, y = np.random.default_rng(1).random((20, 8, 8, 1)), np.eye(3)[np.arange(20) % 3]
    histories = [digits_network(seed=seed).train(x, y, epochs=2, batch_size=7) for seed in (1, 1, 2)]
    assert histories[0] == histories[1] != histories[2]


def test_rates_are_checked(subtests):
    for rate in [-0.1, 1, 1.5, float("nan"), "0.5", None, True]:
        with subtests.test(rate=rate), pytest.raises(ValueError, match="rate of dropout"):
            DropoutLayer(rate)


def test_sizes_that_make_no_sense_are_named(subtests):
    for make, message in [
        (lambda: ConvolutionLayer((28, 28), 8, 3), "height, width, channels"),
        (lambda: ConvolutionLayer(28, 8, 3), "height, width, channels"),
        (lambda: ConvolutionLayer((4, 9, 1), 8, 5), "5 does not fit into 4 x 9"),
        (lambda: ConvolutionLayer((4, 9, 1), 8, 3, padding=3), "padding is smaller"),
        (lambda: ConvolutionLayer((4, 9, 1), 8, 3, padding=-1), "padding"),
        (lambda: ConvolutionLayer((4, 9, 1), 8, 3, padding=None), "padding"),
        (lambda: ConvolutionLayer((4, 9, 1), 8, 3, stride=0), "stride"),
        (lambda: ConvolutionLayer((4, 9, 1), 8, 3, initialisation="zeros"), "glorot, he"),
        (lambda: ConvolutionLayer((2000, 2000, 3), 8, 3), "height · width · channels"),
        (lambda: MaxPoolingLayer((4, 9, 1), 5), "between 2 and that of the image, 4 x 9"),
        (lambda: MaxPoolingLayer((4, 9, 1), 1), "between 2"),
        (lambda: FlattenLayer("784"), "height, width, channels"),
    ]:
        with subtests.test(make=make, message=message), pytest.raises(ValueError, match=message):
            make()


@pytest.mark.parametrize(
    "layer", [ConvolutionLayer((8, 8, 1), 2, 3), MaxPoolingLayer((8, 8, 1)), FlattenLayer((8, 8, 1))]
)
@pytest.mark.parametrize("shape", [(5, 64), (5, 8, 8), (5, 8, 8, 2), (64,), (1, 5, 8, 8, 1)])
def test_images_of_another_shape_are_named(layer, shape):
    for propagate in (layer.forward_propagate, layer.predict):
        with pytest.raises(ValueError, match=r"images of shape \(8, 8, 1\)"):
            propagate(np.zeros(shape))
    with pytest.raises(ValueError, match="a batch of images"):
        layer.forward_propagate(np.zeros((8, 8, 1)))


def test_image_layers_have_to_fit():
    network = NeuralNetwork(*CostFunctions.use_mse()).add_layer(ConvolutionLayer((8, 8, 1), 2, 3))
    with pytest.raises(ValueError, match="takes images of 6 x 6 x 1, the layer before gives images of 6 x 6 x 2"):
        network.add_layer(MaxPoolingLayer((6, 6, 1)))
    with pytest.raises(ValueError, match="takes 72 values, the layer before gives images of 6 x 6 x 2"):
        network.add_layer(FullyConnectedLayer(72, 2))


def test_rectified_filters_get_he_weights():
    network = NeuralNetwork(*CostFunctions.use_mse()).add_layer(ConvolutionLayer((9, 9, 16), 64, 5))
    network.add_layer(MaxPoolingLayer((5, 5, 64))).add_layer(ActivationLayer(*ActivationFunctions.use_relu()))
    filters: Any = network.layers[0]
    assert filters.weights.std() == pytest.approx(np.sqrt(2 / 400), rel=0.02)


def digits_network(seed=0, dropout=0.2):
    """Return a small classifier of 8 x 8 pixels into three kinds."""
    return (
        NeuralNetwork(*CostFunctions.use_softmax_cross_entropy(), rng=np.random.default_rng(seed))
        .add_layer(ConvolutionLayer((8, 8, 1), 4, 3, padding=1))
        .add_layer(ActivationLayer(*ActivationFunctions.use_relu()))
        .add_layer(MaxPoolingLayer((8, 8, 4)))
        .add_layer(FlattenLayer((4, 4, 4)))
        .add_layer(DropoutLayer(dropout))
        .add_layer(FullyConnectedLayer(64, 3))
    )


def test_tells_bars_wherever_they_are():
    rng = np.random.default_rng(3)
    kinds, places = rng.integers(0, 3, 300), rng.integers(1, 7, 300)
    x = np.zeros((300, 8, 8, 1))
    for image, kind, place in zip(x, kinds, places, strict=True):
        if kind < 2:
            (image if kind else image.swapaxes(0, 1))[place] = 1
    x += 0.1 * rng.normal(size=x.shape)
    network = digits_network()
    network.train(x[:200], np.eye(3)[kinds[:200]], epochs=15, batch_size=20, optimizer=Adam(0.01))
    guesses = network.predict(x[200:]).argmax(axis=1)
    assert np.mean(guesses == kinds[200:]) > 0.95
