"""A training run as a command: begin or resume it, train with a progress bar, keep what comes of it.

`train` and `train-digits` each say in a `RunCommand` what is their own.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, Generic, TypeVar

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
    from ai.training.run import Limit, Run, RunKind

_LINE_SECONDS: Final = 20.0  # between two lines where there is no terminal
_PARTS: Final = 1000  # of the bar
_BAR: Final = "{desc} {percentage:3.0f}%|{bar}| {elapsed}<{remaining} {postfix}"


TrainedRun = TypeVar("TrainedRun", bound="Run")


@dataclass(frozen=True)
class RunCommand(Generic[TrainedRun]):
    """What is a command's own.

    Attributes:
        kind: the kind of run.
        config: returns the settings asked for, given those that a resumed run was begun with, else None; raises
            ValueError.
        begin: makes a new run of the settings and the seed.
        resume: reads a run from its folder; raises ModelFormatError.
        limit: when to stop.
        used_up: says what a run has used up that has no time left to train.
        shown: what is written of the progress behind the bar.
        verdict: says how good the saved run is, given its description.

    """

    kind: RunKind
    config: Callable[[Any], Any]
    begin: Callable[[Any, int], TrainedRun]
    resume: Callable[[Path], TrainedRun]
    limit: Limit
    used_up: Callable[[TrainedRun], str]
    shown: Callable[[Any], str]
    verdict: Callable[[TrainedRun, Any], str]


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


def train(arguments: argparse.Namespace, command: RunCommand[TrainedRun]) -> int:
    """Begin or resume a run, train, keep what comes of it, and return the exit code."""
    from ai.files import claimed_folder

    output = arguments.output or arguments.resume
    with ExitStack() as claims:
        try:
            training = _begun_or_resumed(arguments, command)
            if command.limit.share(training) >= 1.0:
                raise ValueError(command.used_up(training))
            claims.enter_context(claimed_folder(output, command.kind.folder))
            if not arguments.replace and _holds_another(output, arguments.resume):
                raise ValueError(f"{output} holds an earlier run: --resume {output} goes on with it, --replace ends it")
        except REFUSED as error:
            return fail(reason(error))
        return _train_and_keep(training, output, command)


def _holds_another(output: Path, resumed: Path | None) -> bool:
    """Whether a folder holds a run, and not the one that is gone on with."""
    return output.is_dir() and any(output.iterdir()) and not (resumed and output.samefile(resumed))


def _begun_or_resumed(arguments: argparse.Namespace, command: RunCommand[TrainedRun]) -> TrainedRun:
    """Return the run to train; raises ValueError for changes of a resumed one that are not live."""
    if arguments.resume is None:
        return command.begin(command.config(None), arguments.seed or 0)
    training = command.resume(arguments.resume)
    if training.lost:
        fail(f"{arguments.resume}: {training.lost}")
    wanted = command.config(training.config)
    refuse_fixed(training.config, wanted, training.seed, arguments.seed)
    training.apply_live(wanted)
    return training


def _train_and_keep(training: TrainedRun, output: Path, command: RunCommand[TrainedRun]) -> int:
    stopped, saved = "", False
    try:
        with stoppable() as stop:
            try:
                _advance(training, output, command, stop)
            except FloatingPointError as error:
                stopped = f"training stopped: {error}. "
                training.restore_best()
            # Save before measuring, which takes seconds: the user may stop the program meanwhile.
            output, described = keep(partial(command.kind.save, training), output)
            saved = True
        if not stopped:
            output, described = keep(partial(command.kind.save, training, final=True), output)
    except OSError as error:
        return fail(f"{stopped}could not write to {output}: {error.strerror or error}")
    except ValueError as error:
        return fail(f"{stopped}{'' if saved else f'Nothing new is kept in {output}: '}{error}")
    if stopped:
        return fail_diverged(stopped, output, measured=training.best is not None)
    say(f"kept in {output}: {command.verdict(training, described)}")
    return exit_code(stop)


def _advance(training: TrainedRun, output: Path, command: RunCommand[TrainedRun], stop: list[int]) -> None:
    """Train until the limit or the user, who adds to `stop`, says so; keep the run now and then, and show how it goes.

    That is a progress bar on a terminal, and elsewhere a line now and then. That the run could not be kept is told
    once: a disk that is full now may have room by the end.
    """
    from ai.training.run import Keeper

    keeper, line_at = Keeper(training, command.kind, output), time.monotonic() + _LINE_SECONDS
    with progress_bar(_PARTS, "training", bar_format=_BAR) as bar:
        for progress in command.limit.run(training):
            share, words = command.limit.share(training), command.shown(progress)
            bar.update(int(_PARTS * share) - bar.n)
            bar.set_postfix_str(words, refresh=False)
            if bar.disable and time.monotonic() >= line_at:
                line_at = time.monotonic() + _LINE_SECONDS
                print(f"training {share:.0%}: {words}", file=Unheard(), flush=True)
            if stop:
                break
            for told in keeper.go_on(training.clock()):
                said = f"could not write to {output}: {told.problem}; training goes on"
                bar.write(readable(said), file=Unheard())
    keeper.wait()
