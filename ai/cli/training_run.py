"""A training run as a command: begin or resume it, train with a progress bar, keep what comes of it.

`train` and `train-digits` each say in a `RunCommand` what is their own.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable, Iterable
from contextlib import ExitStack
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, Generic, Protocol, TypeVar

from ai.cli.command_line import (
    REFUSED,
    Unheard,
    exit_code,
    fail,
    fail_diverged,
    folder,
    keep,
    progress_bar,
    readable,
    reason,
    refuse_fixed,
    say,
    stoppable,
)

if TYPE_CHECKING:
    from ai.files import FolderKind

_LINE_SECONDS: Final = 20.0  # between two lines where there is no terminal
_BAR: Final = "{desc} {percentage:3.0f}%|{bar}| {elapsed}<{remaining} {postfix}"


class TrainingRun(Protocol):
    """What a command must know of a run: `ai.training.loop.Training` and `ai.digits.training.DigitTraining` have it."""

    config: Any
    seed: int

    @property
    def best(self) -> Any:
        """Score of the best network so far; None if none has been measured."""

    def apply_live(self, config: Any) -> None:
        """Use the live knobs of another configuration."""

    def restore_best(self) -> None:
        """Restore the best networks so far, if there are any."""


Run = TypeVar("Run", bound=TrainingRun)


@dataclass(frozen=True)
class RunCommand(Generic[Run]):
    """What is a command's own.

    Attributes:
        kind: what its folder may hold.
        config: returns the settings asked for, given those that a resumed run was begun with, else None; raises
            ValueError.
        begin: makes a new run of the settings and the seed.
        resume: reads a run from its folder; raises ModelFormatError.
        used_up: says why a run has no time left to train; "" if it has.
        train: trains until the run, its clock or the user, who adds to the list, says stop; keeps checkpoints.
        save: saves a run; `final` measures it as well. Returns a description.
        verdict: says how good the saved run is, given its description.

    """

    kind: FolderKind
    config: Callable[[Any], Any]
    begin: Callable[[Any, int], Run]
    resume: Callable[[Path], Run]
    used_up: Callable[[Run], str]
    train: Callable[[Run, Path, list[int]], None]
    save: Callable[..., Any]
    verdict: Callable[[Run, Any], str]


def add_run_options(train: argparse.ArgumentParser, example: str) -> None:
    """Add the options that every training command has; `example` is a change of a setting."""
    train.add_argument("--output", type=folder, metavar="DIR", help="where to keep the network")
    train.add_argument(
        "--resume",
        type=folder,
        metavar="DIR",
        help="go on with what an earlier run kept there, by its settings; --set and --preset may"
        " change those that can change while a run goes on",
    )
    train.add_argument("--replace", action="store_true", help="put the new run in the place of an earlier one")
    train.add_argument("--seed", type=int, help="what all chance follows from (default: 0)")
    train.add_argument("--set", action="append", default=[], metavar="NAME=VALUE", dest="changes",
                       help=f"change a setting of the preset, such as --set {example}")  # fmt: skip


def train(arguments: argparse.Namespace, command: RunCommand[Run]) -> int:
    """Begin or resume a run, train, keep what comes of it, and return the exit code."""
    from ai.files import claimed_folder

    output = arguments.output or arguments.resume
    with ExitStack() as claims:
        try:
            training = _begun_or_resumed(arguments, command)
            if used_up := command.used_up(training):
                raise ValueError(used_up)
            claims.enter_context(claimed_folder(output, command.kind))
            if not arguments.replace and _holds_another(output, arguments.resume):
                raise ValueError(f"{output} holds an earlier run: --resume {output} goes on with it, --replace ends it")
        except REFUSED as error:
            return fail(reason(error))
        return _train_and_keep(training, output, command)


def _holds_another(output: Path, resumed: Path | None) -> bool:
    """Whether a folder holds a run, and not the one that is gone on with."""
    return output.is_dir() and any(output.iterdir()) and not (resumed and output.samefile(resumed))


def _begun_or_resumed(arguments: argparse.Namespace, command: RunCommand[Run]) -> Run:
    """Return the run to train; raises ValueError for changes of a resumed one that are not live."""
    if arguments.resume is None:
        return command.begin(command.config(None), arguments.seed or 0)
    training = command.resume(arguments.resume)
    wanted = command.config(training.config)
    refuse_fixed(training.config, wanted, training.seed, arguments.seed)
    training.apply_live(wanted)
    return training


def _train_and_keep(training: Run, output: Path, command: RunCommand[Run]) -> int:
    stopped, saved = "", False
    try:
        with stoppable() as stop:
            try:
                command.train(training, output, stop)
            except FloatingPointError as error:
                stopped = f"training stopped: {error}. "
                training.restore_best()
            # Save before measuring, which takes seconds: the user may stop the program meanwhile.
            output, described = keep(partial(command.save, training), output)
            saved = True
        if not stopped:
            output, described = keep(partial(command.save, training, final=True), output)
    except OSError as error:
        return fail(f"{stopped}could not write to {output}: {error.strerror or error}")
    except ValueError as error:
        return fail(f"{stopped}{'' if saved else f'Nothing new is kept in {output}: '}{error}")
    if stopped:
        return fail_diverged(stopped, output, measured=training.best is not None)
    say(f"kept in {output}: {command.verdict(training, described)}")
    return exit_code(stop)


def show_progress(
    steps: Iterable[Any],
    total: int,
    initial: int,
    shown: Callable[[Any], tuple[int, str]],
    checkpoint: Callable[[Any], str],
    output: Path,
    stop: list[int],
) -> None:
    """Take steps of a run until there are no more or `stop` has an entry; show how it goes.

    That is a progress bar on a terminal, and elsewhere a line now and then. `shown` gives, for what a step yields, how
    much of `total` is done and what is written behind the bar; `checkpoint` keeps the run if it is time, and returns
    why an earlier attempt did not succeed, once.
    """
    line_at = time.monotonic() + _LINE_SECONDS
    with progress_bar(total, "training", initial=initial, bar_format=_BAR) as bar:
        for progress in steps:
            done, words = shown(progress)
            bar.update(done - bar.n)
            bar.set_postfix_str(words, refresh=False)
            if bar.disable and time.monotonic() >= line_at:
                line_at = time.monotonic() + _LINE_SECONDS
                print(f"training {done / total:.0%}: {words}", file=Unheard(), flush=True)
            if stop:
                break
            if problem := checkpoint(progress):
                said = f"could not write to {output}: {problem}; training goes on"
                bar.write(readable(said), file=Unheard())
