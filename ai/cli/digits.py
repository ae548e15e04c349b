"""The commands for digits that need no window: teach a network to read them, measure one.

Nothing heavy is imported until a command runs, as in `ai.cli.lander`.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from contextlib import ExitStack
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ai.cli.command_line import (
    REFUSED,
    SECONDS,
    SEEDS,
    configured,
    exit_code,
    fail,
    fail_diverged,
    folder,
    keep,
    keep_checkpoint,
    out_of_range,
    reason,
    refuse_fixed,
    stoppable,
)

if TYPE_CHECKING:
    from ai.digits.config import DigitConfig
    from ai.digits.training import DigitTraining


def add_commands(commands: Any) -> None:
    """Add `train-digits` and `evaluate-digits` to a parser's sub-commands."""
    train = commands.add_parser("train-digits", help="teach a network to read handwritten digits")
    train.add_argument("--preset", help="modern, classic, or as-described, the recipe of one epoch that the classic"
                       " one grew from (default: modern)")  # fmt: skip
    train.add_argument("--output", type=folder, metavar="DIR", help="where to keep the network")
    train.add_argument("--resume", type=folder, metavar="DIR",
                       help="go on with what an earlier run kept there, by its settings; --set and --preset may"
                            " change those that can change while a run goes on")  # fmt: skip
    train.add_argument("--seed", type=int, help="what all chance follows from (default: 0)")
    train.add_argument("--epochs", type=int, help="how often every image is seen (default: as the preset says)")
    train.add_argument("--seconds", type=float,
                       help="stop when the whole run, resumed or not, has trained for so many seconds, even if there"
                            " are epochs to come")  # fmt: skip
    train.add_argument("--set", action="append", default=[], metavar="NAME=VALUE", dest="changes",
                       help="change a setting of the preset, such as --set dropout=0.5")  # fmt: skip
    train.set_defaults(run=_train)

    evaluate = commands.add_parser("evaluate-digits", help="measure how well a network reads MNIST's test images")
    evaluate.add_argument("--model", type=folder, required=True, metavar="DIR")
    evaluate.add_argument("--json", action="store_true", help="print one JSON object")
    evaluate.set_defaults(run=_evaluate)


def _train(arguments: argparse.Namespace) -> int:
    from ai.digits.classifier import KIND
    from ai.nn.folder import claimed_folder

    output = arguments.output or arguments.resume
    if output is None:
        return fail("say where to keep the network: --output DIR, or --resume DIR")
    if problem := out_of_range(arguments, seed=SEEDS, seconds=SECONDS):
        return fail(problem)
    with ExitStack() as claims:
        try:
            training = _begun(arguments) if arguments.resume is None else _resumed(arguments)
            if arguments.seconds is not None and training.seconds >= arguments.seconds:
                raise ValueError(
                    f"this run has trained for {training.seconds:,.1f} seconds already; --seconds is of the whole run:"
                    " ask for more"
                )
            claims.enter_context(claimed_folder(output, KIND))
        except REFUSED as error:
            return fail(reason(error))
        return _keep_training(training, arguments.seconds, output)


def _begun(arguments: argparse.Namespace) -> DigitTraining:
    """Return a new run; raises ValueError for settings that make no sense, MnistError without images."""
    from ai.digits.training import DigitTraining

    return DigitTraining(_config(arguments), arguments.seed or 0)


def _resumed(arguments: argparse.Namespace) -> DigitTraining:
    """Return the run to go on with, its live settings changed as asked; raises ValueError where they are not live."""
    from ai.digits.checkpoints import resume_digit_run

    training = resume_digit_run(arguments.resume)
    wanted = _config(arguments, training.config)
    refuse_fixed(training.config, wanted, training.seed, arguments.seed)
    training.apply_live(wanted)
    return training


def _keep_training(training: DigitTraining, seconds: float | None, output: Path) -> int:
    """Train, keep what comes of it, and return the exit code."""
    from ai.digits.checkpoints import save_digit_run

    stopped = ""
    try:
        with stoppable() as stop:
            try:
                _advance(training, seconds, output, stop)
            except FloatingPointError as error:
                stopped = f"training stopped: {error}. "
                training.restore_best()
            # Save before measuring, which takes a while: the user may stop the program meanwhile.
            output, described = keep(partial(save_digit_run, training), output)
        if not stopped:
            output, described = keep(partial(save_digit_run, training, final=True), output)
    except OSError as error:
        return fail(f"{stopped}could not write to {output}: {error.strerror or error}")
    except ValueError as error:
        return fail(f"{stopped}{error}")
    if stopped:
        return fail_diverged(stopped, output, measured=training.best is not None)
    print(f"kept in {output}: {described['test']:.2%} of MNIST's test images read right")
    return exit_code(stop)


def _advance(training: DigitTraining, seconds: float | None, output: Path, stop: list[int]) -> None:
    """Train until the last epoch, the clock or the user says stop, and keep the work after each epoch."""
    from tqdm import tqdm

    from ai.digits.checkpoints import save_digit_run

    form = "{desc} {percentage:3.0f}%|{bar}| {elapsed}<{remaining} {postfix}"
    trouble = ""
    with tqdm(total=training.steps, initial=training.step, desc="training", bar_format=form, disable=None) as bar:
        while not training.done and not stop:
            began = time.monotonic()
            progress = training.advance()
            training.seconds += time.monotonic() - began
            bar.update(1)
            best = f", held out {progress.best:.2%}" if progress.best is not None else ""
            bar.set_postfix_str(f"epoch {progress.epoch:.1f}, loss {progress.loss:.3f}{best}", refresh=False)
            if progress.step % training.steps_per_epoch == 0 and not training.done:
                new = keep_checkpoint(partial(save_digit_run, training), output)
                if new and new != trouble:
                    bar.write(new, file=sys.stderr)
                trouble = new
            if seconds is not None and training.seconds >= seconds:
                break


def _evaluate(arguments: argparse.Namespace) -> int:
    from ai.digits.classifier import DigitClassifier
    from ai.digits.mnist import TEST, load_part
    from ai.digits.training import confusion

    try:
        classifier = DigitClassifier.load(arguments.model)
        images, labels = load_part(TEST)
    except REFUSED as error:
        return fail(reason(error))
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


def _config(arguments: argparse.Namespace, begun: DigitConfig | None = None) -> DigitConfig:
    """Return the preset, or the settings a run was begun with, with the changes asked for.

    Raises ValueError for a change that makes no sense.
    """
    from ai.digits.config import DIGIT_PRESETS

    if arguments.preset is not None and arguments.preset not in DIGIT_PRESETS:
        raise ValueError(f"--preset is one of {', '.join(DIGIT_PRESETS)}, not {arguments.preset}")
    preset = begun if begun and arguments.preset is None else DIGIT_PRESETS[arguments.preset or "modern"]
    config = configured(preset, arguments.changes)
    return config if arguments.epochs is None else config.changed(epochs=arguments.epochs)
