"""What a worker trains is what the commands train, and settings that fail are a result."""

from dataclasses import replace

import numpy as np
import pytest

from ai.digits.config import DIGIT_PRESETS
from ai.digits.training import DigitTraining
from ai.sweep.design import Design
from ai.sweep.study import Study
from ai.sweep.trial import trained
from ai.training.run import save
from main import main
from tests.support.studies import TINY, networks_in, tiny_design

PARAMS = {"learning_rate": 0.002, "tau": 0.02, "double": True}


def recorded(folder, design, params):
    """Train a trial in this process, and keep it in a study."""
    study = Study.create(folder, design)
    study.record(*trained(design, 0, params))
    assert Study.load(folder).trials == study.trials
    return study


@pytest.mark.slow
def test_a_trials_run_is_that_of_train_bit_for_bit(tmp_path):
    study = recorded(tmp_path / "study", tiny_design(), PARAMS)
    changes = [f"{name}={list(value) if isinstance(value, tuple) else value}" for name, value in TINY.items()]
    changes += ["learning_rate=0.002", "tau=0.02", "double=true"]
    sets = [part for change in changes for part in ("--set", change)]
    command = ["train", "--env", "CartPole-v1", "--decisions", "400", "--validation", "5", "--seed", "1", *sets]
    assert main([*command, "--output", str(tmp_path / "alone")]) == 0
    swept = networks_in(study.trial_folder(0) / "seed-1")
    assert networks_in(tmp_path / "alone") == swept
    assert "online/layer-0-weights.npy" in swept


@pytest.mark.slow
def test_a_trial_of_digits_is_that_of_train_digits(tmp_path):
    config = DIGIT_PRESETS["classic"].changed(hidden=(8,), batch_size=5000, epochs=1, augmentation=0.0)
    design = replace(Design.of(config, ("learning_rate",), every=1, trials=1), seeds=(3,))
    assert design.budget == 1
    study = recorded(tmp_path / "study", design, {"learning_rate": 0.01})
    training = DigitTraining(config.changed(learning_rate=0.01), 3)
    while not training.done:
        training.advance()
    save(training, tmp_path / "alone", final=True)
    assert networks_in(tmp_path / "alone") == networks_in(study.trial_folder(0) / "seed-3")
    assert study.trials[0].value == training.best


def test_a_trial_of_digits_is_measured_each_epoch(tmp_path, monkeypatch):
    drawn = np.random.default_rng(0)
    part = drawn.random((600, 28, 28), np.float32), drawn.integers(10, size=600).astype(np.uint8)
    for module in ("training", "mnist"):
        monkeypatch.setattr(f"ai.digits.{module}.load_part", lambda _: part)
    monkeypatch.setattr("ai.sweep.trial.load_part", lambda _: part)
    config = DIGIT_PRESETS["classic"].changed(hidden=(8,), batch_size=50, epochs=2, augmentation=0.0, held_out=100)
    design = Design.of(config, ("learning_rate",), every=1, trials=1, seeds=1)
    study = recorded(tmp_path / "study", design, {"learning_rate": 0.01})
    (seed,) = study.trials[0].seeds
    assert [point.at for point in seed.curve] == [1, 2]
    assert study.trials[0].value == seed.curve[-1].success


def test_settings_that_make_no_sense_are_a_result():
    trial, files = trained(tiny_design(), 0, PARAMS | {"replay_prune": 10_000})
    assert (trial.value, trial.seeds, files) == (None, (), {})
    assert "replay_prune" in trial.problem


def test_settings_that_diverge_are_a_result_and_not_an_error(tmp_path, monkeypatch):
    def diverge(*_):
        raise FloatingPointError("the loss is not finite")

    monkeypatch.setattr("ai.sweep.trial._trained_to", diverge)
    study = recorded(tmp_path / "study", tiny_design(metric="success"), PARAMS)
    trial = study.trials[0]
    assert (trial.value, trial.seeds[0].problem) == (0.0, "the loss is not finite")
    assert study.best_run(trial) is None, "no run has come to its end"
    study.table()
