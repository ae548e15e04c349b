"""A forward pass written out: the sums of its products are what the layers gave."""

from itertools import pairwise

import numpy as np
import pytest

from ai.digits.classifier import DigitClassifier
from ai.digits.config import DIGIT_PRESETS, build_digit_network
from ai.digits.mnist import load_part
from ai.explain.unit_sums import receptive_field, stages
from ai.nn import (
    ActivationFunctions,
    ActivationLayer,
    ConvolutionLayer,
    CostFunctions,
    FlattenLayer,
    FullyConnectedLayer,
    LayerNormalisation,
    MaxPoolingLayer,
    NeuralNetwork,
)
from game.core.assets import MODELS_DIR

EPSILON = float(np.finfo(np.float32).eps)


def strange_network():
    """A pooling that leaves a column out, and an activation between flattening and the sum."""
    network = NeuralNetwork(*CostFunctions.use_mse(), rng=np.random.default_rng(3))
    first = ConvolutionLayer((11, 9, 2), 5, 4)
    second = ConvolutionLayer(first.outputs, 4, 3)
    pooling = MaxPoolingLayer(second.outputs, 3)
    flatten = FlattenLayer(pooling.outputs)
    tanh, relu = ActivationLayer(*ActivationFunctions.use_tanh()), ActivationLayer(*ActivationFunctions.use_relu())
    connected = FullyConnectedLayer(flatten.outputs, 7), LayerNormalisation(7), FullyConnectedLayer(7, 3)
    for layer in (first, tanh, second, pooling, flatten, relu, *connected):
        network.add_layer(layer)
    network.values = np.random.default_rng(4).normal(size=network.values.size)
    return network, np.random.default_rng(5).random((11, 9, 2), dtype=np.float32)


def shipped(name):
    images, _ = load_part("test")
    return DigitClassifier.load(MODELS_DIR / "digits" / name).network, images[7][:, :, None]


def narrow():
    config = DIGIT_PRESETS["modern"].changed(filters=(8,), kernel=9, hidden=(5,), activation="leaky_relu")
    return build_digit_network(config, np.random.default_rng(2)), load_part("test")[0][1][:, :, None]


CASES = {"strange": strange_network, "modern": lambda: shipped("modern"), "classic": lambda: shipped("classic"),
         "narrow": narrow}  # fmt: skip


@pytest.fixture(params=CASES)
def case(request):
    network, example = CASES[request.param]()
    return network, example, stages(network, example)


def places(stage, rng, most=150):
    found = list(np.ndindex(stage.outputs.shape))
    return found if len(found) <= most else [found[number] for number in rng.choice(len(found), most, replace=False)]


def test_the_sum_of_a_units_products_is_what_its_layer_gave(case):
    *_, found = case
    rng = np.random.default_rng(1)
    for stage in found:
        for place in places(stage, rng):
            if stage.kind == "other":
                with pytest.raises(ValueError, match="LayerNormalisation"):
                    stage.unit(place)
                continue
            unit = stage.unit(place)
            assert unit.output == stage.outputs[place]
            (top, left), (height, width, _) = unit.corner, unit.patch.shape
            channels = [place[2]] if unit.weights is None else slice(None)
            read = stage.inputs[top : top + height, left : left + width, channels]
            np.testing.assert_array_equal(unit.patch, read)
            if stage.kind == "pooling":
                assert unit.output == unit.patch.max()
            elif stage.kind == "activation":
                assert isinstance(stage.layer, ActivationLayer)
                assert unit.output == stage.layer.activation.function(unit.patch)[0, 0, 0]
            else:
                size = float(np.abs(unit.products).sum()) + abs(unit.bias)
                assert abs(unit.total - unit.output) <= (unit.products.size + 1) * EPSILON * size


def test_the_last_stage_is_the_networks_own_answer_and_each_reads_the_one_before(case):
    network, example, found = case
    given = example if isinstance(network.layers[0].inputs, tuple) else example.reshape(-1)
    assert found[-1].outputs.ravel().tobytes() == network.activations(given[None])[-1].tobytes()
    for before, after in pairwise(found):
        assert after.inputs is before.outputs


def test_a_receptive_field_holds_all_pixels_that_matter_and_no_row_that_does_not():
    network, example = strange_network()
    found = stages(network, example)
    rng = np.random.default_rng(6)
    for number, stage in enumerate(found[:4]):
        for place in places(stage, rng, 6):
            top, left, bottom, right = receptive_field(found[: number + 1], place)
            outside = example + rng.random(example.shape, dtype=np.float32)
            outside[top:bottom, left:right] = example[top:bottom, left:right]
            again = stages(network, outside)[number].outputs[place]
            assert again == pytest.approx(stage.outputs[place], abs=1e-5)
    assert receptive_field(found, (0, 0, 1)) == (0, 0, 11, 8)  # the pooling leaves out a column
    first = stages(*shipped("modern"))
    assert receptive_field(first[:1], (3, 4, 0)) == (3, 4, 8, 9)
    assert receptive_field(first[:4], (0, 0, 0)) == (0, 0, 14, 14)


def test_the_strongest_input_has_the_largest_product(case):
    *_, found = case
    rng = np.random.default_rng(3)
    for stage in found:
        for place in places(stage, rng, 20) if stage.kind != "other" else ():
            strongest, unit = stage.strongest_input(place), stage.unit(place)
            if stage.kind == "pooling":
                assert stage.inputs[strongest] == unit.output
            elif stage.kind == "activation":
                assert strongest == place
            else:
                inside = strongest[0] - unit.corner[0], strongest[1] - unit.corner[1], strongest[2]
                assert unit.products[inside] == unit.products.max()
