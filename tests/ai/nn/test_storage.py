"""Saving whole or not at all, and naming what is wrong on the way back."""

import json
import re
from typing import Any

import numpy as np
import pytest

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
    ModelFormatError,
    NeuralNetwork,
)
from ai.nn.storage import LAYERS

X = np.random.default_rng(0).normal(size=(7, 3))


def every_layer(seed=0, dtype=np.float32):
    network = (
        NeuralNetwork(*CostFunctions.use_huber(2.5), rng=np.random.default_rng(seed), dtype=dtype)
        .add_layer(FullyConnectedLayer(3, 4))
        .add_layer(LayerNormalisation(4, epsilon=1e-3))
        .add_layer(ActivationLayer(*ActivationFunctions.use_leaky_relu(0.3)))
        .add_layer(FullyConnectedLayer(4, 4))
        .add_layer(ActivationLayer(*ActivationFunctions.use_sigmoid()))
        .add_layer(DuelingLayer(4, 2))
    )
    assert {type(layer) for layer in [*network.layers, *image_layers().layers]} == set(LAYERS.values())
    return network


def image_layers():
    return (
        NeuralNetwork(*CostFunctions.use_softmax_cross_entropy())
        .add_layer(ConvolutionLayer((8, 7, 2), filters=3, kernel=3))
        .add_layer(MaxPoolingLayer((6, 5, 3), size=2))
        .add_layer(DropoutLayer(0.25))
        .add_layer(FlattenLayer((3, 2, 3)))
        .add_layer(FullyConnectedLayer(18, 2))
    )


@pytest.fixture
def saved(tmp_path):
    every_layer().save(tmp_path / "model")
    return tmp_path / "model"


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_a_network_comes_back(tmp_path, dtype):
    network = every_layer(dtype=dtype)
    network.values += 0.5
    network.save(tmp_path / "deep" / "model")
    loaded = NeuralNetwork.load(tmp_path / "deep" / "model")
    np.testing.assert_array_equal(loaded.values, network.values)
    np.testing.assert_array_equal(loaded.predict(X), network.predict(X))
    assert loaded.predict(X).dtype == dtype
    assert (loaded.cost.name, dict(loaded.cost.options)) == ("huber", {"delta": 2.5})
    layers: list[Any] = loaded.layers
    assert layers[1].epsilon == 1e-3
    assert layers[2].activation.options == {"slope": 0.3}
    history = [one.train(X, np.ones((7, 2)), epochs=2) for one in (network, loaded)]
    assert history[0] == history[1]


def test_the_folder_can_be_read_by_a_person(saved):
    edit(lambda config: config["cost"].update(note="?"))(saved)  # keys of other programs are left alone
    NeuralNetwork.load(saved)
    config = json.loads((saved / "config.json").read_text())
    assert (config["format"], config["version"]) == ("tranquility network", 1)
    assert config["cost"] == {"name": "huber", "delta": 2.5, "note": "?"}
    assert config["layers"][0] == {
        "type": "FullyConnectedLayer",
        "inputs": 3,
        "outputs": 4,
        "arrays": {
            "weights": {"file": "layer-0-weights.npy", "shape": [3, 4], "dtype": "float32"},
            "bias": {"file": "layer-0-bias.npy", "shape": [4], "dtype": "float32"},
        },
    }
    assert config["layers"][2]["activation"] == {"name": "leaky_relu", "slope": 0.3}
    arrays = {entry["file"] for layer in config["layers"] for entry in layer["arrays"].values()}
    assert {path.name for path in saved.iterdir()} == arrays | {"config.json"}


def test_a_network_for_images_comes_back_and_damage_to_it_is_named(tmp_path, subtests):
    network, model = image_layers(), tmp_path / "model"
    network.save(model)
    loaded, x = NeuralNetwork.load(model), np.random.default_rng(0).normal(size=(4, 8, 7, 2))
    for one in (loaded, network.copy()):
        np.testing.assert_array_equal(one.predict(x), network.predict(x))
        assert [layer.arguments() for layer in one.layers] == [layer.arguments() for layer in network.layers]
    assert loaded.cost.logits
    change: Any
    for index, change, message in [
        (0, {"inputs": [8, 7]}, "height, width, channels"),
        (0, {"stride": 1, "padding": 0}, "a ConvolutionLayer has no padding, stride"),
        (0, {"filters": 4}, "layer-0-weights.npy"),
        (3, {"inputs": [3, 2, 2]}, "3 x 2 x 2"),
    ]:
        network.save(model)
        edit(lambda config, index=index, change=change: config["layers"][index].update(change))(model)
        with subtests.test(message), pytest.raises(ModelFormatError, match=re.escape(message)):
            NeuralNetwork.load(model)


def edit(change):
    """Make a damage of a change to the parsed config.json."""

    def damage(folder):
        path = folder / "config.json"
        config = json.loads(path.read_text())
        change(config)
        path.write_text(json.dumps(config))

    return damage


def truncate(folder):
    path = folder / "layer-3-weights.npy"
    path.write_bytes(path.read_bytes()[:-5])


def put(array):
    return lambda folder: np.save(folder / "layer-0-weights.npy", array, allow_pickle=True)


DAMAGES = {
    "no config": (lambda folder: (folder / "config.json").unlink(), "config.json"),
    "not JSON": (lambda folder: (folder / "config.json").write_text("{"), "config.json"),
    "another format": (edit(lambda c: c.update(format="onnx")), "tranquility network"),
    "a later version": (edit(lambda c: c.update(version=2)), "version 2"),
    "unknown cost": (edit(lambda c: c["cost"].update(name="hinge")), "hinge"),
    "bad delta": (edit(lambda c: c["cost"].update(delta=-1)), "delta"),
    "no layers": (edit(lambda c: c.update(layers=None)), "layers"),
    "unknown layer": (edit(lambda c: c["layers"][3].update(type="Attention")), "Attention"),
    "bad slope": (edit(lambda c: c["layers"][2]["activation"].update(slope="steep")), "layer 2"),
    "huge size": (edit(lambda c: c["layers"][0].update(outputs=10**12)), "1000000000000"),
    "layers that do not fit": (edit(lambda c: c["layers"][3].update(inputs=5)), "takes 5"),
    "shape belied": (edit(lambda c: c["layers"][0]["arrays"]["bias"].update(shape=[5])), "layer-0-bias"),
    "another folder's file": (
        edit(lambda c: c["layers"][0]["arrays"]["bias"].update(file="../layer-0-bias.npy")),
        "not a file of this folder",
    ),
    "missing array": (lambda folder: (folder / "layer-5-bias.npy").unlink(), "layer-5-bias.npy"),
    "truncated array": (truncate, "layer-3-weights.npy"),
    "wrong shape": (put(np.zeros((4, 3), np.float32)), "layer-0-weights.npy"),
    "objects": (put(np.array([[None] * 4] * 3)), "layer-0-weights.npy"),
    "not finite": (put(np.full((3, 4), np.nan, np.float32)), "layer-0-weights.npy"),
}


def test_damage_is_named(tmp_path, subtests):
    for name, (damage, message) in DAMAGES.items():
        saved = tmp_path / name
        every_layer().save(saved)
        damage(saved)
        with subtests.test(name):
            with pytest.raises(ModelFormatError) as caught:
                NeuralNetwork.load(saved)
            assert message in str(caught.value)
            assert str(saved) in str(caught.value)
    with pytest.raises(ModelFormatError, match="no such folder"):
        NeuralNetwork.load(tmp_path / "nowhere")
    (tmp_path / "file").touch()
    with pytest.raises(ModelFormatError, match="a file"):
        NeuralNetwork.load(tmp_path / "file")


def fail_at(monkeypatch, where, name, call, error):
    """Let the given call of a function raise an error."""
    original, calls = getattr(where, name), []

    def failing(*args, **kwargs):
        calls.append(args)
        if len(calls) == call:
            raise error
        return original(*args, **kwargs)

    monkeypatch.setattr(where, name, failing)


def test_a_save_that_is_cut_short_leaves_the_old_network_whole(saved, monkeypatch, subtests):
    expected = NeuralNetwork.load(saved).values
    for where, name, call, error in [
        (np, "save", 3, OSError(28, "No space left on device")),
        (np, "save", 3, KeyboardInterrupt()),
        (json, "dumps", 1, OSError(28, "No space left on device")),
        (type(saved), "rename", 1, PermissionError(13, "Permission denied")),
        (type(saved), "rename", 2, PermissionError(13, "Permission denied")),
    ]:
        with subtests.test(name, call=call, error=error):
            with monkeypatch.context() as patch:
                fail_at(patch, where, name, call, error)
                with pytest.raises(type(error)):
                    every_layer(seed=1).save(saved)
            np.testing.assert_array_equal(NeuralNetwork.load(saved).values, expected)
            assert [path.name for path in saved.parent.iterdir()] == ["model"]
    saved.rename(saved.with_name(".model.00000000.old"))  # as a stop between the two renames leaves it
    np.testing.assert_array_equal(NeuralNetwork.load(saved).values, expected)
    assert [path.name for path in saved.parent.iterdir()] == ["model"]


def test_a_network_that_cannot_come_back_is_not_saved(saved):
    expected = NeuralNetwork.load(saved).values
    unnamed = every_layer().add_layer(ActivationLayer(np.sin, np.cos))
    with pytest.raises(ValueError, match="no name"):
        unnamed.save(saved)
    broken = every_layer()
    broken.values[3] = np.nan
    with pytest.raises(ValueError, match="layer 0 has weights that are not finite"):
        broken.save(saved)
    np.testing.assert_array_equal(NeuralNetwork.load(saved).values, expected)
