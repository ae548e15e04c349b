"""Digit training runs on disk: the best network, how it was made, and the state to resume from."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Final

import numpy as np

from ai.digits.classifier import DigitClassifier
from ai.digits.config import DIGIT_PRESETS, DigitConfig
from ai.digits.mnist import TEST, load_part
from ai.digits.training import DigitTraining, accuracy
from ai.files import Count, Duration, OneOf, Seed, Share, Sized, inside, problem_in, read_arrays, read_as, read_json
from ai.files.knobs import nearest_preset
from ai.nn import ModelFormatError

TRAINING_FILE: Final = "training.json"
LAST_FILE: Final = "last.npz"  # the state of runs that were kept before states were
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


def snapshot(training: DigitTraining, final: bool = False) -> tuple[dict[str, Any], Callable[[Path], None]]:
    """Return what a run's training file says now, and what writes its best network as it is now into a new folder.

    A `final` run is measured on MNIST's test images; raises MnistError if there are none.
    """
    best = training.best_classifier()
    described = {
        **nearest_preset(training.config.to_json(), {name: preset.to_json() for name, preset in DIGIT_PRESETS.items()}),
        "seed": training.seed,
        "step": training.step,
        "epochs": training.step // training.steps_per_epoch,
        "seconds": round(training.seconds, 3),
        "held_out": training.best,
        "kept_epoch": training.best_epoch,
        "history": [*training.history],
    }
    if final:
        described["test"] = accuracy(best, *load_part(TEST))
    return described, best.write


def read_settings(folder: Path) -> tuple[DigitConfig, int, int]:
    """Return the settings and the seed of a run in a folder, and its steps so far; raises ModelFormatError."""
    DigitClassifier.load(folder)
    try:
        described = read_as(_TrainingFile, read_json(inside(folder, TRAINING_FILE)))
        preset = DIGIT_PRESETS[described.preset].to_json()
        config = DigitConfig.from_json(preset | DigitConfig.renamed(described.changes))
    except OSError as error:
        raise ModelFormatError(folder, [f"{TRAINING_FILE}: {error.strerror or error}"]) from error
    except (ValueError, TypeError, ArithmeticError) as error:
        raise ModelFormatError(folder, [f"{TRAINING_FILE}: {problem_in(error)}"]) from error
    return config, described.seed, described.step


def read_last(folder: Path, training: DigitTraining) -> dict[str, Any] | None:
    """Return the state of a run that was kept before states were; None if there is none. Raises ModelFormatError."""
    remembered = [f"{_OPTIMIZERS}{name}" for name in training.optimizer.remembers]
    names = {"values", "average", *remembered}

    def expect(name: str, shape: tuple[int, ...], dtype: np.dtype[Any]) -> None:
        steps = name == f"{_OPTIMIZERS}steps" and shape == () and dtype.kind in "iu"
        if not steps and not (name in names and shape == training.average.shape and dtype == np.float32):
            raise ValueError(f"{name} is no part of such a run")

    try:
        described = read_as(_TrainingFile, read_json(inside(folder, TRAINING_FILE)))
        arrays = read_arrays(inside(folder, LAST_FILE), len(names) * training.average.nbytes + _SLACK, expect)
        best = None if described.held_out is None else DigitClassifier.load(folder).network.values
        optimizer = {name.removeprefix(_OPTIMIZERS): arrays[name] for name in arrays if name.startswith(_OPTIMIZERS)}
        return {
            "step": described.step, "seconds": described.seconds, "best": described.held_out, "best_values": best,
            "history": [*described.history], "loss": 0.0, "accuracy": 0.0, "optimizer": optimizer,
            "values": arrays["values"], "average": arrays["average"],
        }  # fmt: skip
    except FileNotFoundError:
        return None
    except (OSError, ValueError, KeyError) as error:
        raise ModelFormatError(folder, [f"{LAST_FILE}: {problem_in(error)}"]) from error
