"""The commands for digits that need no window: teach a network to read them, measure one.

Nothing heavy is imported until a command runs, as in `ai.cli.lander`.
"""

from __future__ import annotations

import argparse
import json
from functools import partial
from typing import TYPE_CHECKING, Any

from ai.cli.command_line import REFUSED, SECONDS, SEEDS, configured, fail, folder, out_of_range, reason
from ai.cli.training_run import RunCommand, add_run_options, train

if TYPE_CHECKING:
    from ai.digits.config import DigitConfig
    from ai.digits.training import DigitProgress


def add_commands(commands: Any) -> None:
    """Add `train-digits` and `evaluate-digits` to a parser's sub-commands."""
    teach = commands.add_parser("train-digits", help="teach a network to read handwritten digits")
    teach.add_argument(
        "--preset",
        help="modern, classic, thorough, which made the shipped modern network, or as-described, the recipe of one"
        " epoch that the classic one grew from (default: modern)",
    )
    add_run_options(teach, "dropout=0.5")
    teach.add_argument("--epochs", type=int, help="how often every image is seen (default: as the preset says)")
    teach.add_argument(
        "--seconds",
        type=float,
        help="stop when the whole run, resumed or not, has trained for so many seconds, even if there"
        " are epochs to come",
    )
    teach.set_defaults(run=_train)

    evaluate = commands.add_parser("evaluate-digits", help="measure how well a network reads MNIST's test images")
    evaluate.add_argument("--model", type=folder, required=True, metavar="DIR")
    evaluate.add_argument("--json", action="store_true", help="print one JSON object")
    evaluate.set_defaults(run=_evaluate)


def _train(arguments: argparse.Namespace) -> int:
    from ai.digits.training import DigitTraining
    from ai.training.checkpoints import DIGITS, resume_digit_run
    from ai.training.run import Limit

    if arguments.resume is None and arguments.output is None:
        return fail("say where to keep the network: --output DIR, or --resume DIR")
    if problem := out_of_range(arguments, seed=SEEDS, seconds=SECONDS):
        return fail(problem)

    def used_up(training: DigitTraining) -> str:
        spent = f"this run has trained for {training.seconds:,.1f} seconds already"
        return f"{spent}; --seconds is of the whole run: ask for more"

    def shown(progress: DigitProgress) -> str:
        best = f", held out {progress.best:.2%}" if progress.best is not None else ""
        return f"epoch {progress.epoch:.1f}, loss {progress.loss:.3f}{best}"

    def verdict(_: DigitTraining, described: dict[str, Any]) -> str:
        return f"{described['test']:.2%} of MNIST's test images read right"

    return train(arguments, RunCommand(
        DIGITS, partial(config_of, arguments), DigitTraining, resume_digit_run, Limit(arguments.seconds), used_up,
        shown, verdict,
    ))  # fmt: skip


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
            "accuracy": int(right.sum()) / len(labels),
            "images": len(labels),
            "by_digit": (right / shown).tolist(),
            "confusion": table.tolist(),
        }
        print(json.dumps(measured))
        return 0
    print(f"read right  {right.sum() / len(labels):.2%} of {len(labels):,}")
    print("drawn       read as" + "".join(f"{digit:>5}" for digit in range(len(table))))
    for digit, row in enumerate(table):
        print(f"{digit:>5} {right[digit] / shown[digit]:>11.2%} " + "".join(f"{count:>5}" for count in row))
    return 0


def config_of(arguments: argparse.Namespace, begun: DigitConfig | None = None) -> DigitConfig:
    """Return the preset, or the settings a run was begun with, with the changes asked for.

    Raises ValueError for a change that makes no sense.
    """
    from ai.digits.config import DIGIT_PRESETS

    if arguments.preset is not None and arguments.preset not in DIGIT_PRESETS:
        raise ValueError(f"--preset is one of {', '.join(DIGIT_PRESETS)}, not {arguments.preset}")
    preset = begun if begun and arguments.preset is None else DIGIT_PRESETS[arguments.preset or "modern"]
    config = configured(preset, arguments.changes)
    return config if arguments.epochs is None else config.changed(epochs=arguments.epochs)
