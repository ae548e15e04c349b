"""Digit training runs on disk: the best network, how it was made, and the state to resume from."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Final

from ai.digits.classifier import DigitClassifier
from ai.digits.config import DIGIT_PRESETS, DigitConfig
from ai.digits.mnist import TEST, load_part
from ai.digits.training import DigitTraining, accuracy
from ai.files import Count, Duration, OneOf, Seed, Share, Sized, inside, problem_in, read_as, read_json
from ai.files.knobs import nearest_preset
from ai.nn import ModelFormatError

TRAINING_FILE: Final = "training.json"


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
    except (OSError, ValueError, TypeError, ArithmeticError) as error:
        raise ModelFormatError(folder, [f"{TRAINING_FILE}: {problem_in(error)}"]) from error
    return config, described.seed, described.step
