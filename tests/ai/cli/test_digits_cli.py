import errno
import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import ai.cli.digits
import ai.digits.checkpoints
import ai.digits.training
from ai.digits.checkpoints import resume_digit_run, save_digit_run
from ai.digits.classifier import DigitClassifier
from ai.digits.config import DIGIT_PRESETS, DigitConfig, build_digit_network
from ai.digits.mnist import load_part
from ai.digits.training import LIVE, SPLIT_SEED, DigitTraining, run_digits
from ai.nn import (
    ActivationFunctions,
    ActivationLayer,
    CostFunctions,
    FullyConnectedLayer,
    ModelFormatError,
    NeuralNetwork,
)
from main import main

ROOT = Path(__file__).parents[3]
SMALL = DIGIT_PRESETS["classic"].changed(hidden=(16,), epochs=3, held_out=100, batch_size=50, ema_decay=0.9)


@pytest.fixture(scope="module")
def data():
    """600 images: enough to see a network learn."""
    images, labels = load_part("test")
    return images[:600], labels[:600]


@pytest.fixture
def few(monkeypatch, data):
    """Let the commands learn from few images."""
    monkeypatch.setattr(ai.digits.training, "load_part", lambda part: data)


def test_a_run_learns_and_tells_how_it_stands(data):
    progress = list(run_digits(SMALL, seed=1, data=data))
    assert [one.step for one in progress] == list(range(1, 31))
    assert progress[-1].epoch == 3
    assert progress[-1].steps == 30
    assert [one.step for one in progress if one.held_out is not None] == [10, 20, 30]
    assert np.mean([one.loss for one in progress[-5:]]) < 0.9 * np.mean([one.loss for one in progress[:5]])
    assert progress[-1].best == max(one.held_out for one in progress if one.held_out is not None)
    assert progress[0].learning_rate < progress[8].learning_rate > progress[-1].learning_rate


def test_the_same_seed_gives_the_same_network(data):
    def values(seed):
        training = DigitTraining(SMALL, seed, data)
        for _ in range(5):
            training.advance()
        return training.classifier.network.values

    np.testing.assert_array_equal(values(2), values(2))
    assert not np.array_equal(values(2), values(3))


def test_live_knobs_can_be_sent_and_the_others_stay(data):
    run = run_digits(SMALL, data=data)
    next(run)
    assert run.send(SMALL.changed(learning_rate=1e-5, final_learning_rate=1e-6, hidden=(3,))).learning_rate <= 1e-5
    assert {"learning_rate", "augmentation"} <= set(LIVE)
    assert "hidden" not in LIVE


def test_held_out_images_are_never_learnt_from(data):
    training = DigitTraining(SMALL, data=data)
    assert len(training.images) == 500
    learnt = {image.tobytes() for image in training.images}
    assert not [image for image in training.held_images if image.tobytes() in learnt]
    with pytest.raises(ValueError, match="leaves none"):
        DigitTraining(SMALL.changed(held_out=600), data=data)


def test_a_resumed_run_goes_on_as_if_it_had_never_stopped(data, tmp_path):
    config = SMALL.changed(dropout=0.3)
    whole, first = DigitTraining(config, 5, data), DigitTraining(config, 5, data)
    for _ in range(13):
        first.advance()
    save_digit_run(first, tmp_path / "run")
    second = resume_digit_run(tmp_path / "run", data=data)
    for training in (whole, second):
        while not training.done:
            training.advance()
    np.testing.assert_array_equal(whole.classifier.network.values, second.classifier.network.values)
    np.testing.assert_allclose(whole.average, second.average, atol=1e-7)
    assert whole.best == second.best


def test_a_run_that_cannot_go_on_says_so(data, tmp_path):
    training = DigitTraining(SMALL, data=data)
    training.advance()
    save_digit_run(training, tmp_path / "run")
    (tmp_path / "run" / "last.npz").write_bytes(b"nothing")
    with pytest.raises(ModelFormatError, match=r"last\.npz"):
        resume_digit_run(tmp_path / "run", data=data)
    (tmp_path / "run" / "training.json").write_text("{}")
    with pytest.raises(ModelFormatError, match=r"training\.json"):
        resume_digit_run(tmp_path / "run", data=data)


def test_a_gradient_that_is_not_finite_ends_the_run(data):
    training = DigitTraining(SMALL, data=data)
    training.classifier.network.values[:] = np.nan
    with pytest.raises(
        FloatingPointError, match="the cost was not finite at learning step 1; most likely the learning rate"
    ):
        training.advance()


@pytest.mark.parametrize("preset", DIGIT_PRESETS)
def test_presets_build_networks_of_ten_outputs(preset):
    network = build_digit_network(DIGIT_PRESETS[preset], np.random.default_rng(0))
    assert DigitClassifier(network).predict(np.zeros((2, 28, 28))).shape == (2, 10)


def test_classic_is_the_network_as_first_described():
    network = build_digit_network(DIGIT_PRESETS["classic"], np.random.default_rng(0))
    assert [layer.outputs for layer in network.layers if layer.outputs] == [100, 50, 10]
    assert [layer.activation.name for layer in network.layers if hasattr(layer, "activation")] == ["tanh"] * 3
    assert network.cost.name == "mse"


def test_settings_are_checked_and_survive_json():
    assert DigitConfig.from_json(json.loads(json.dumps(SMALL.to_json()))) == SMALL
    for wrong in ({"dropout": 1.5}, {"cost": "guess"}, {"epochs": 1.5}, {"hidden": [0]}, {"warp": 9}):
        with pytest.raises(ValueError, match=next(iter(wrong))):
            DigitConfig.from_json(wrong)
    for item in DigitConfig.__dataclass_fields__.values():
        assert item.metadata["help"].endswith(".")
        assert item.metadata["group"] in ("learning", "network", "images")


@pytest.mark.usefixtures("few")
def test_train_resume_evaluate(tmp_path, capsys):
    run = str(tmp_path / "run")
    small = ["--preset", "classic", "--set", "hidden=[16]", "--set", "held_out=100"]
    assert main(["train-digits", *small, "--epochs", "3", "--seconds", "0.001", "--output", run]) == 0
    assert run in capsys.readouterr().out
    for changes, named in (
        (["--epochs", "4"], "epochs"), (["--seed", "1"], "seed"), (["--set", "hidden=[9]"], "hidden"),
        (["--preset", "modern"], "convolutions"), (["--seconds", "0.001"], "whole run"),
    ):  # fmt: skip
        assert main(["train-digits", "--resume", run, *changes]) == 1
        assert named in capsys.readouterr().err
    assert main(["train-digits", "--resume", run, "--epochs", "3", "--seed", "0", "--set", "label_smoothing=0.1"]) == 0
    described = json.loads((tmp_path / "run" / "training.json").read_text())
    assert described["preset"] == "classic"
    assert described["changes"] == {"hidden": [16], "held_out": 100, "epochs": 3, "label_smoothing": 0.1}
    assert described["epochs"] == 3
    assert len(described["history"]) == 3
    assert not (tmp_path / "run" / "last.npz").exists(), "there is nothing to go on with"
    assert main(["train-digits", "--resume", run]) == 1
    assert "finished" in capsys.readouterr().err
    assert main(["evaluate-digits", "--model", run, "--json"]) == 0
    measured = json.loads(capsys.readouterr().out)
    assert measured["accuracy"] == described["test"]
    assert np.array(measured["confusion"]).sum() == measured["images"] == 10_000
    assert len(measured["by_digit"]) == 10
    assert main(["evaluate-digits", "--model", run]) == 0
    assert "read right" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["train-digits"], "--output"),
        (["train-digits", "--output", "x", "--preset", "magic"], "--preset is one of"),
        (["train-digits", "--output", "x", "--set", "warp=9"], "warp=9"),
        (["train-digits", "--output", "x", "--epochs", "0"], "epochs lies between"),
        (["train-digits", "--output", "x", "--seconds", "0"], "--seconds lies between"),
        (["train-digits", "--resume", "nowhere"], "nowhere"),
        (["evaluate-digits", "--model", "nowhere"], "nowhere"),
    ],
)
@pytest.mark.usefixtures("few")
def test_what_cannot_be_done_is_said_in_a_line(arguments, message, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert main(arguments) == 1
    told = capsys.readouterr().err
    assert message in told
    assert "Traceback" not in told
    assert not list(tmp_path.iterdir())


@pytest.mark.usefixtures("few")
@pytest.mark.parametrize("trouble", ["", "full", "unmeasured"])
def test_numbers_that_run_away_end_in_a_sentence_and_the_work_is_kept(tmp_path, capsys, monkeypatch, trouble):
    advance = DigitTraining.advance

    def diverging(training):
        if training.step < 8:  # an epoch is five
            return advance(training)
        training.classifier.network.values[:] = 1e30
        raise FloatingPointError("the cost was not finite at learning step 9")

    def full(*_, **__):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(DigitTraining, "advance", diverging)
    if trouble == "full":
        monkeypatch.setattr(ai.digits.checkpoints, "atomic_folder", full)
    held_out = 0 if trouble == "unmeasured" else 100
    small = ["--preset", "classic", "--set", "hidden=[8]", "--set", f"held_out={held_out}", "--set", "ema_decay=0"]
    run = tmp_path / "run"
    assert main(["train-digits", *small, "--output", str(run)]) == 1
    told = capsys.readouterr().err
    assert "learning step 9" in told
    assert {"": "What was best until then is", "full": "No space", "unmeasured": "has not been measured"}[
        trouble
    ] in told
    assert run.exists() == (trouble != "full")
    if not trouble:
        assert resume_digit_run(run).classifier.network.values.max() < 1e30, "a wreck is nothing to go on from"


@pytest.mark.usefixtures("few")
def test_what_is_put_into_a_run_meanwhile_is_kept_and_so_is_the_run(tmp_path, capsys, monkeypatch):
    def advance(seconds, training, output, stop):
        output.mkdir()
        (output / "diary").write_text("dear")

    monkeypatch.setattr(ai.cli.digits, "_advance", advance)
    small = ["--preset", "classic", "--set", "hidden=[8]", "--set", "held_out=100"]
    assert main(["train-digits", *small, "--output", str(tmp_path / "run")]) == 0
    assert (tmp_path / "run" / "diary").read_text() == "dear"
    assert DigitClassifier.load(tmp_path / "run 2")
    assert "run 2" in capsys.readouterr().out


@pytest.mark.parametrize("few_values", [{"batch_size": 5000}, {"batch_size": 100, "filters": (256,), "kernel": 1}])
def test_a_batch_cannot_ask_for_more_memory_than_there_is(few_values):
    with pytest.raises(ValueError, match="batch_size is at most"):
        DigitConfig(**few_values)
    DIGIT_PRESETS["classic"].changed(batch_size=5000)


def test_windows_that_do_not_fit_are_refused_before_there_is_a_run():
    with pytest.raises(ValueError, match="a kernel of 9 does not fit"):
        DigitConfig(filters=(16, 16, 16), kernel=9)


@pytest.mark.usefixtures("few")
@pytest.mark.parametrize("output", ["letters", "letters/dear.txt/run"])
def test_a_folder_that_cannot_be_written_is_named_before_anything_is_learnt(tmp_path, capsys, monkeypatch, output):
    (tmp_path / "letters").mkdir()
    (tmp_path / "letters" / "dear.txt").write_text("you")
    monkeypatch.delattr(DigitTraining, "advance")
    options = ["--preset", "classic", "--epochs", "1", "--set", "held_out=100"]
    assert main(["train-digits", *options, "--output", str(tmp_path / output)]) == 1
    assert "letters" in capsys.readouterr().err
    assert (tmp_path / "letters" / "dear.txt").read_text() == "you"
    assert [path.name for path in tmp_path.iterdir()] == ["letters"]


def test_the_recipe_as_described_saves_reloads_and_reads(tmp_path, capsys):
    run = str(tmp_path / "run")
    assert main(["train-digits", "--preset", "as-described", "--seed", "3", "--output", run]) == 0
    assert main(["evaluate-digits", "--model", run, "--json"]) == 0
    measured = json.loads(capsys.readouterr().out.splitlines()[-1])
    described = json.loads((tmp_path / "run" / "training.json").read_text())
    assert described["preset"] == "as-described"
    assert (described["changes"], described["step"]) == ({}, 120)
    assert measured["accuracy"] == described["test"] > 0.75

    # The same by the library alone: 784-100-50-10, one epoch over 60,000 images, batches of 500, a rate of 0.2.
    images, labels = load_part("train")
    order = np.random.default_rng(SPLIT_SEED).permutation(60_000)
    order = order[np.random.default_rng((3, 1, 0)).permutation(60_000)]  # as the run draws it
    network = NeuralNetwork(*CostFunctions.use_mse(), rng=np.random.default_rng(3))
    for inputs, outputs in ((784, 100), (100, 50), (50, 10)):
        network.add_layer(FullyConnectedLayer(inputs, outputs))
        network.add_layer(ActivationLayer(*ActivationFunctions.use_tanh()))
    targets = np.eye(10, dtype=np.float32)[labels[order]]
    network.train(images[order].reshape(-1, 784), targets, epochs=1, batch_size=500, learning_rate=0.2)
    np.testing.assert_array_equal(network.values, DigitClassifier.load(run).network.values)


def test_the_network_does_not_depend_on_how_many_threads_are_offered(tmp_path):
    """Two threads share products of 500 images with 784 numbers, and round their sums otherwise than one."""
    for threads in ("1", "2"):
        libraries = {f"{library}_NUM_THREADS": threads for library in ("OPENBLAS", "OMP", "MKL")}
        arguments = ["train-digits", "--preset", "as-described", "--set", "held_out=30000"]
        subprocess.run([sys.executable, "main.py", *arguments, "--output", str(tmp_path / threads)],
                       cwd=ROOT, env=os.environ | libraries, timeout=300, check=True, capture_output=True)  # fmt: skip
    one, two = (DigitClassifier.load(tmp_path / threads).network for threads in ("1", "2"))
    np.testing.assert_array_equal(one.values, two.values)
