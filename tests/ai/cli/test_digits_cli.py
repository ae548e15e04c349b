import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import ai.digits.training
from ai.digits.classifier import DigitClassifier
from ai.digits.mnist import TRAIN, load_part
from ai.digits.training import SPLIT_SEED, DigitTraining
from ai.nn import ActivationFunctions, ActivationLayer, CostFunctions, FullyConnectedLayer, NeuralNetwork
from ai.training.run import resume
from main import main

ROOT = Path(__file__).parents[3]


@pytest.fixture(scope="module")
def data():
    """600 images: enough to see a network learn."""
    images, labels = load_part("test")
    return images[:600], labels[:600]


@pytest.fixture
def few(monkeypatch, data):
    """Let the commands learn from few images."""
    monkeypatch.setattr(ai.digits.training, "load_part", lambda part: data if part == TRAIN else load_part(part))


@pytest.mark.usefixtures("few")
def test_train_resume_evaluate(tmp_path, capsys):
    run = str(tmp_path / "run")
    small = ["--preset", "classic", "--set", "hidden=[16]", "--set", "held_out=100"]
    assert main(["train-digits", *small, "--epochs", "3", "--seconds", "0.001", "--output", run]) == 0
    assert run in capsys.readouterr().out
    for changes, named in (
        (["--epochs", "4"], "epochs"),
        (["--seed", "1"], "seed"),
        (["--set", "hidden=[9]"], "hidden"),
        (["--preset", "modern"], "convolutions"),
        (["--seconds", "0.001"], "whole run"),
    ):
        assert main(["train-digits", "--resume", run, *changes]) == 1
        assert named in capsys.readouterr().err
    assert main(["train-digits", "--resume", run, "--epochs", "3", "--seed", "0", "--set", "label_smoothing=0.1"]) == 0
    described = json.loads((tmp_path / "run" / "training.json").read_text())
    assert described["preset"] == "classic"
    assert described["changes"] == {"hidden": [16], "held_out": 100, "epochs": 3, "label_smoothing": 0.1}
    assert described["epochs"] == 3
    assert len(described["history"]) == 3
    assert main(["train-digits", "--resume", run]) == 1
    assert "finished" in capsys.readouterr().err
    assert main(["evaluate-digits", "--model", run, "--json"]) == 0
    measured = json.loads(capsys.readouterr().out)
    assert measured["accuracy"] == described["test"]
    assert np.array(measured["confusion"]).sum() == measured["images"] == 10_000
    assert len(measured["by_digit"]) == 10
    assert main(["evaluate-digits", "--model", run]) == 0
    assert "read right" in capsys.readouterr().out


@pytest.mark.usefixtures("few")
@pytest.mark.parametrize("trouble", ["", "unmeasured"])
def test_numbers_that_run_away_end_in_a_sentence_and_the_work_is_kept(tmp_path, capsys, monkeypatch, trouble):
    advance = DigitTraining.advance

    def diverging(training):
        if training.step < 8:  # an epoch is five
            return advance(training)
        training.classifier.network.values[:] = 1e30
        raise FloatingPointError("the cost was not finite at learning step 9")

    monkeypatch.setattr(DigitTraining, "advance", diverging)
    held_out = 0 if trouble == "unmeasured" else 100
    small = ["--preset", "classic", "--set", "hidden=[8]", "--set", f"held_out={held_out}", "--set", "ema_decay=0"]
    run = tmp_path / "run"
    assert main(["train-digits", *small, "--output", str(run)]) == 1
    stderr = capsys.readouterr().err
    assert "learning step 9" in stderr
    assert {"": "What was best until then is", "unmeasured": "has not been measured"}[trouble] in stderr
    assert run.exists()
    if not trouble:
        assert resume(DigitTraining, run).classifier.network.values.max() < 1e30, "a wreck is nothing to go on from"


def write_diary(folder):
    """Put something of a person's own where a training is about to be kept."""
    folder.mkdir(exist_ok=True)
    (folder / "diary").write_text("dear")


@pytest.mark.usefixtures("few")
def test_what_is_put_into_a_run_meanwhile_is_kept_and_so_is_the_run(tmp_path, capsys, monkeypatch):
    advance = DigitTraining.advance

    def meddled(training):
        write_diary(tmp_path / "run")
        return advance(training)

    monkeypatch.setattr(DigitTraining, "advance", meddled)
    small = ["--preset", "classic", "--set", "hidden=[8]", "--set", "held_out=100", "--epochs", "1"]
    assert main(["train-digits", *small, "--output", str(tmp_path / "run")]) == 0
    assert (tmp_path / "run" / "diary").read_text() == "dear"
    assert DigitClassifier.load(tmp_path / "run 2")
    assert "run 2" in capsys.readouterr().out


@pytest.mark.slow
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


@pytest.mark.slow
def test_the_network_does_not_depend_on_how_many_threads_are_offered(tmp_path):
    """Two threads share products of 500 images with 784 numbers, and round their sums otherwise than one."""
    for threads in ("1", "2"):
        libraries = {f"{library}_NUM_THREADS": threads for library in ("OPENBLAS", "OMP", "MKL")}
        arguments = ["train-digits", "--preset", "as-described", "--set", "held_out=30000"]
        subprocess.run([sys.executable, "main.py", *arguments, "--output", str(tmp_path / threads)],
                       cwd=ROOT, env=os.environ | libraries, timeout=300, check=True, capture_output=True)  # fmt: skip
    one, two = (DigitClassifier.load(tmp_path / threads).network for threads in ("1", "2"))
    np.testing.assert_array_equal(one.values, two.values)
