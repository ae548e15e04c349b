"""The commands for digits that need no window: teach a network to read them, measure one.

Nothing heavy is imported until a command runs, as in `ai.cli`.
"""

from __future__ import annotations

import argparse
import json
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ai.cli import fail, stoppable

if TYPE_CHECKING:
    from ai.digit_config import DigitConfig
    from ai.digit_training import DigitTraining


def add_commands(commands: Any) -> None:
    """Add `train-digits` and `evaluate-digits` to a parser's sub-commands."""
    train = commands.add_parser("train-digits", help="teach a network to read handwritten digits")
    train.add_argument("--preset", default="modern", help="modern or classic (default: modern)")
    train.add_argument("--output", type=Path, metavar="DIR", help="where to keep the network")
    train.add_argument("--resume", type=Path, metavar="DIR", help="go on with what an earlier run kept there")
    train.add_argument("--seed", type=int, default=0)
    train.add_argument("--epochs", type=int, help="how often every image is seen (default: as the preset says)")
    train.add_argument("--seconds", type=float, help="stop after so many seconds, even if there are epochs to come")
    train.add_argument("--set", action="append", default=[], metavar="NAME=VALUE", dest="changes",
                       help="change a setting of the preset, such as --set dropout=0.5")  # fmt: skip
    train.set_defaults(run=_train)

    evaluate = commands.add_parser("evaluate-digits", help="measure how well a network reads MNIST's test images")
    evaluate.add_argument("--model", type=Path, required=True, metavar="DIR")
    evaluate.add_argument("--json", action="store_true", help="print one JSON object")
    evaluate.set_defaults(run=_evaluate)


def _train(arguments: argparse.Namespace) -> int:
    from ai.digit_runs import resume_digit_run, save_digit_run
    from ai.digit_training import DigitTraining
    from ai.digits import KIND
    from ai.nn.folder import claimed_folder

    output = arguments.output or arguments.resume
    if output is None:
        return fail("say where to keep the network: --output DIR, or --resume DIR")
    try:
        training = (
            resume_digit_run(arguments.resume)
            if arguments.resume
            else DigitTraining(_config(arguments), arguments.seed)
        )
    except ValueError as error:
        return fail(str(error))
    try:
        with claimed_folder(output, KIND):
            _advance(training, arguments.seconds, output)
            described = save_digit_run(training, output, final=True)
    except FloatingPointError as error:
        return fail(f"training stopped: {error}. What was kept at the last epoch is in {output}.")
    except FileExistsError as error:
        return fail(str(error))
    except OSError as error:
        return fail(f"could not write to {output}: {error.strerror or error}")
    except ValueError as error:
        return fail(str(error))
    print(f"kept in {output}: {described['test']:.2%} of MNIST's test images read right")
    return 0


def _advance(training: DigitTraining, seconds: float | None, output: Path) -> None:
    """Train until the last epoch, the clock or the user says stop, and keep the work after each epoch."""
    from tqdm import tqdm

    from ai.digit_runs import save_digit_run

    began = time.monotonic()
    before = training.seconds
    form = "{desc} {percentage:3.0f}%|{bar}| {elapsed}<{remaining} {postfix}"
    bar = tqdm(total=training.steps, initial=training.step, desc="training", bar_format=form, disable=None)
    with bar, stoppable() as stop:
        while not training.done and not stop:
            progress = training.advance()
            training.seconds = before + time.monotonic() - began
            bar.update(1)
            best = f", held out {progress.best:.2%}" if progress.best is not None else ""
            bar.set_postfix_str(f"epoch {progress.epoch:.1f}, loss {progress.loss:.3f}{best}", refresh=False)
            if progress.step % training.steps_per_epoch == 0 and not training.done:
                save_digit_run(training, output)
            if seconds is not None and time.monotonic() - began >= seconds:
                break


def _evaluate(arguments: argparse.Namespace) -> int:
    from ai.digit_training import confusion
    from ai.digits import DigitClassifier
    from ai.mnist import TEST, load_part

    try:
        classifier = DigitClassifier.load(arguments.model)
        images, labels = load_part(TEST)
    except ValueError as error:
        return fail(str(error))
    table = confusion(classifier, images, labels)
    right, shown = table.diagonal(), table.sum(axis=1)
    if arguments.json:
        measured = {
            "accuracy": int(right.sum()) / len(labels), "images": len(labels),
            "by_digit": (right / shown).tolist(), "confusion": table.tolist(),
        }  # fmt: skip
        print(json.dumps(measured))
        return 0
    print(f"read right  {right.sum() / len(labels):.2%} of {len(labels):,}")
    print("drawn       read as" + "".join(f"{digit:>5}" for digit in range(len(table))))
    for digit, row in enumerate(table):
        print(f"{digit:>5} {right[digit] / shown[digit]:>11.2%} " + "".join(f"{count:>5}" for count in row))
    return 0


def _config(arguments: argparse.Namespace) -> DigitConfig:
    """Return the preset with the changes asked for; raises ValueError for one that makes no sense."""
    from ai.cli import configured
    from ai.digit_config import DIGIT_PRESETS

    if arguments.preset not in DIGIT_PRESETS:
        raise ValueError(f"--preset is one of {', '.join(DIGIT_PRESETS)}, not {arguments.preset}")
    config = configured(DIGIT_PRESETS[arguments.preset], arguments.changes)
    return config if arguments.epochs is None else config.changed(epochs=arguments.epochs)
