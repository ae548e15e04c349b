"""Digit training runs on disk: saved with all that they go on from, and resumed."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Final

from ai.digits.checkpoints import read_last, read_settings, snapshot
from ai.digits.classifier import KIND
from ai.digits.training import DigitTraining
from ai.nn import ModelFormatError
from ai.training.keeping import save
from ai.training.run import RunKind
from ai.training.state import StateWriter, broken, read_state

DIGITS: Final = RunKind(KIND, snapshot)


def save_digit_run(
    training: DigitTraining, folder: str | Path, final: bool = False, *, state: bool = True
) -> dict[str, Any]:
    """Save a run's best network and, with `state`, all that it goes on from, whole or not at all.

    Returns its description. `final` measures it on MNIST's test images. Raises OSError if it cannot be written,
    MnistError if there are no test images.
    """
    return save(training, DIGITS, folder, final=final, state=state)


def resume_digit_run(folder: str | Path, **options: Any) -> DigitTraining:
    """Resume an unfinished run that was kept, the very same; raises ModelFormatError for anything else."""
    folder = Path(folder)
    config, seed, step = read_settings(folder)
    try:
        training = DigitTraining(config, seed, **options)
    except (ValueError, OverflowError) as error:
        raise ModelFormatError(folder, [str(error)]) from error
    kept = read_state(folder, step)
    state = kept or read_last(folder, training)
    if state is None:
        raise ModelFormatError(folder, ["there is nothing to go on with: the run is finished, or its state is gone"])
    try:
        training.load_state(state)
    except (KeyError, TypeError, ValueError, ArithmeticError) as error:
        raise broken(folder, error) from error
    if kept:
        training.around, training.states = kept.get("around", {}), StateWriter(folder, kept)
    return training
