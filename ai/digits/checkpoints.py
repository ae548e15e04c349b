"""Digit training runs on disk: the best network, how it was made, and the state to resume from."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Final

import numpy as np

from ai.common.knobs import nearest_preset
from ai.digits.classifier import KIND, DigitClassifier
from ai.digits.config import DIGIT_PRESETS, DigitConfig
from ai.digits.mnist import TEST, load_part
from ai.digits.training import DigitTraining, accuracy
from ai.files import Count, Duration, OneOf, Seed, Share, Sized, inside, problem_in, read_arrays, read_as, read_json
from ai.nn import ModelFormatError, atomic_folder

TRAINING_FILE: Final = "training.json"
LAST_FILE: Final = "last.npz"  # as long as there are epochs to come
_OPTIMIZERS: Final = "optimizer."  # what the names of its arrays begin with
_SLACK: Final = 1 << 16  # bytes of an archive beside its numbers


@dataclass(frozen=True)
class DigitRunSummary:
    """Figures in a run's training file that can be shown even where the rest of it is damaged.

    `test` and `held_out` are accuracies on the test and the validation images, 0 to 1; None if not measured.
    """

    preset: Annotated[str, Sized(1000)] = ""
    seconds: Duration = 0.0
    held_out: Share | None = None
    test: Share | None = None


@dataclass(frozen=True)
class _TrainingFile:
    """Training file of a run, as far as it is needed to resume the run."""

    preset: Annotated[str, OneOf(DIGIT_PRESETS)]
    changes: dict[str, Any]
    seed: Seed
    step: Count
    seconds: Duration
    held_out: float | None
    history: tuple[dict[str, int | float | None], ...]


def read_summary(folder: Path, file: str = TRAINING_FILE) -> DigitRunSummary:
    """Return the figures of a run, or of a fix in its own `file`; raises OSError or ValueError."""
    return read_as(DigitRunSummary, read_json(folder / file))


def save_digit_run(training: DigitTraining, folder: str | Path, final: bool = False) -> dict[str, Any]:
    """Save a run's best network and the state to resume from, whole or not at all; return its description.

    `final` measures it on MNIST's test images. Raises OSError if it cannot be written, MnistError if there
    are no test images.
    """
    best = training.best_classifier()
    described = {
        **nearest_preset(training.config.to_json(), {name: preset.to_json() for name, preset in DIGIT_PRESETS.items()}),
        "seed": training.seed,
        "step": training.step,
        "epochs": training.step // training.steps_per_epoch,
        "seconds": round(training.seconds, 3),
        "held_out": training.best,
        "history": training.history,
    }
    if final:
        described["test"] = accuracy(best, *load_part(TEST))
    with atomic_folder(folder, KIND) as temporary:
        best.write(temporary)
        (temporary / TRAINING_FILE).write_text(json.dumps(described, indent=2) + "\n", encoding="utf-8")
        if not training.done:
            state = {f"{_OPTIMIZERS}{name}": array for name, array in training.optimizer.state().items()}
            values = training.classifier.network.values
            np.savez(temporary / LAST_FILE, allow_pickle=False, values=values, average=training.average, **state)
    return described


def resume_digit_run(folder: str | Path, **options: Any) -> DigitTraining:
    """Resume an unfinished run that `save_digit_run` saved; raises ModelFormatError for anything else."""
    folder = Path(folder)
    best = DigitClassifier.load(folder).network.values
    try:
        described = read_as(_TrainingFile, read_json(inside(folder, TRAINING_FILE)))
        preset = DIGIT_PRESETS[described.preset].to_json()
        config = DigitConfig.from_json(preset | DigitConfig.renamed(described.changes))
        training = DigitTraining(config, described.seed, **options)
        training.step, training.seconds, training.best = described.step, described.seconds, described.held_out
        training.history = list(described.history)
    except OSError as error:
        raise ModelFormatError(folder, [f"{TRAINING_FILE}: {error.strerror or error}"]) from error
    except (ValueError, TypeError, ArithmeticError) as error:
        raise ModelFormatError(folder, [f"{TRAINING_FILE}: {problem_in(error)}"]) from error
    if not (folder / LAST_FILE).exists():
        raise ModelFormatError(folder, ["the run is finished: there is nothing to go on with"])
    if best.shape != training.average.shape:
        raise ModelFormatError(folder, ["the network's sizes are not those of the run's settings"])
    try:
        state = _read_last(inside(folder, LAST_FILE), training)
        training.classifier.network.values, training.average[...] = state.pop("values"), state.pop("average")
        known = {name.removeprefix(_OPTIMIZERS): array for name, array in state.items()}
        training.optimizer.load_state(known, training.classifier.network.values)
    except OSError as error:
        raise ModelFormatError(folder, [f"{LAST_FILE}: {error.strerror or error}"]) from error
    except (ValueError, KeyError) as error:
        raise ModelFormatError(folder, [f"{LAST_FILE}: {problem_in(error)}"]) from error
    training.best_values = None if training.best is None else best.copy()
    return training


def _read_last(path: Path, training: DigitTraining) -> dict[str, Any]:
    """Read the arrays to resume from; raises OSError, or ValueError for others than such a run has."""
    remembered = [f"{_OPTIMIZERS}{name}" for name in training.optimizer.remembers]
    names = {"values", "average", *remembered}

    def expect(name: str, shape: tuple[int, ...], dtype: np.dtype[Any]) -> None:
        steps = name == f"{_OPTIMIZERS}steps" and shape == () and dtype.kind in "iu"
        if not steps and not (name in names and shape == training.average.shape and dtype == np.float32):
            raise ValueError(f"{name} is no part of such a run")

    state = read_arrays(path, len(names) * training.average.nbytes + _SLACK, expect)
    if not all(np.isfinite(array).all() for array in state.values()):
        raise ValueError("holds numbers that are not finite")
    return state
