"""Runs that teach a network to read digits, on disk: the best network, how it was made, what to go on with."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, Final

import numpy as np

from ai.digit_config import DIGIT_PRESETS, DigitConfig
from ai.digit_training import DigitTraining, accuracy
from ai.digits import DigitClassifier
from ai.history import UNREADABLE, count, finite, spent
from ai.knobs import nearest_preset
from ai.mnist import TEST, load_part
from ai.nn import ModelFormatError, atomic_folder

TRAINING_FILE: Final = "training.json"
LAST_FILE: Final = "last.npz"  # as long as there are epochs to come


def save_digit_run(training: DigitTraining, folder: str | Path, final: bool = False) -> dict[str, Any]:
    """Keep the best network of a run and what is needed to go on, whole or not at all; return what is said of it.

    `final` measures it on MNIST's test images. Raises OSError if the disk does not take it, MnistError if there
    are no test images.
    """
    best = training.best_classifier()
    described = {
        **nearest_preset(training.config.to_json(), {name: preset.to_json() for name, preset in DIGIT_PRESETS.items()}),
        "seed": training.seed, "step": training.step, "epochs": training.step // training.steps_per_epoch,
        "seconds": round(training.seconds, 3), "held_out": training.best, "history": training.history,
    }  # fmt: skip
    if final:
        described["test"] = accuracy(best, *load_part(TEST))
    with atomic_folder(folder) as temporary:
        best.write(temporary)
        (temporary / TRAINING_FILE).write_text(json.dumps(described, indent=2) + "\n", encoding="utf-8")
        if not training.done:
            state = {f"optimizer.{name}": array for name, array in training.optimizer.state().items()}
            values = training.classifier.network.values
            np.savez(temporary / LAST_FILE, allow_pickle=False, values=values, average=training.average, **state)
    return described


def resume_digit_run(folder: str | Path, **options: Any) -> DigitTraining:
    """Go on from what `save_digit_run` kept of an unfinished run; raises ModelFormatError for anything else."""
    folder = Path(folder)
    best = DigitClassifier.load(folder).network.values
    try:
        described = json.loads((folder / TRAINING_FILE).read_text(encoding="utf-8"))
        preset = DIGIT_PRESETS[described["preset"]].to_json()
        config = DigitConfig.from_json(preset | described["changes"])
        training = DigitTraining(config, count(described, "seed"), **options)
        training.step, training.seconds = count(described, "step"), spent(described)
        training.best, training.history = described["held_out"], list(described["history"])
        if not (training.best is None or finite(training.best)):
            raise ValueError(f"held_out is a share, not {training.best!r}")
        if not all(finite(value) for epoch in training.history for value in epoch.values()):
            raise ValueError("history has numbers that make no sense")
    except UNREADABLE as error:
        raise ModelFormatError(folder, [f"{TRAINING_FILE}: {error!r}"]) from error
    if not (folder / LAST_FILE).exists():
        raise ModelFormatError(folder, ["the run is finished: there is nothing to go on with"])
    try:
        with np.load(folder / LAST_FILE, allow_pickle=False) as state:
            training.classifier.network.values = state["values"]
            training.average[...] = state["average"]
            known = {name.removeprefix("optimizer."): state[name] for name in state if name.startswith("optimizer.")}
        training.optimizer.load_state(known)
    except UNREADABLE as error:
        raise ModelFormatError(folder, [f"{LAST_FILE}: {error}"]) from error
    if best.shape != training.average.shape:
        raise ModelFormatError(folder, ["the network's sizes are not those of the run's settings"])
    training.best_values = None if training.best is None else best.copy()
    return training
