"""The commands that train: `train` and `train-digits`. Each begins or resumes a run, and keeps what comes of it.

Nothing heavy is imported until a command runs, because the game reads this table too before it opens.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from ai.cli.command_line import (
    EPISODES,
    REFUSED,
    SECONDS,
    SEEDS,
    Unheard,
    configured,
    exit_code,
    fail,
    folder,
    out_of_range,
    progress_bar,
    readable,
    reason,
    say,
    stoppable,
)

if TYPE_CHECKING:
    from ai.digits.config import DigitConfig
    from ai.digits.training import DigitProgress
    from ai.run import Run
    from ai.training.config import Config
    from ai.training.loop import Progress, Training
    from ai.training.run import Limit, RunKind

DECISIONS: Final = (1, 10**12)
_LINE_SECONDS: Final = 20.0  # between two lines where there is no terminal
_PARTS: Final = 1000  # of the bar
_BAR: Final = "{desc} {percentage:3.0f}%|{bar}| {elapsed}<{remaining} {postfix}"


def add_commands(commands: Any) -> None:
    """Add `train` and `train-digits` to a parser's sub-commands."""
    land = commands.add_parser("train", help="teach a network to land, or to master another environment")
    read = commands.add_parser("train-digits", help="teach a network to read handwritten digits")
    land.add_argument("--env", metavar="NAME",
                      help="an environment of Gymnasium, such as CartPole-v1 (default: our own lander)")  # fmt: skip
    land.add_argument("--preset", help="modern, classic or anywhere, which lands on any world (default: modern; for"
                      " --env, settings of its own)")  # fmt: skip
    land.add_argument("--decisions", type=int, help="stop when the whole run, resumed or not, has taken so many"
                      " decisions; begun anew with the same seed, it gives the same network")  # fmt: skip
    land.add_argument("--validation", type=int, metavar="N", help="episodes that choose the best network")
    read.add_argument("--preset", help="modern, classic, thorough, which made the shipped modern network, or"
                      " as-described, the recipe of one epoch that classic grew from (default: modern)")  # fmt: skip
    read.add_argument("--epochs", type=int, help="how often every image is seen (default: as the preset says)")
    for command, run, example in ((land, _train, "n_step=5"), (read, _train_digits, "dropout=0.5")):
        add = command.add_argument
        add("--seconds", type=float, help="stop when the whole run, resumed or not, has trained for so many seconds")
        add("--output", type=folder, metavar="DIR", help="where to keep the network")
        add("--resume", type=folder, metavar="DIR", help="go on with what an earlier run kept there, by its settings;"
            " --set and --preset may change those that can change while a run goes on")  # fmt: skip
        add("--replace", action="store_true", help="put the new run in the place of an earlier one")
        add("--seed", type=int, help="what all chance follows from (default: 0)")
        add("--set", action="append", default=[], metavar="NAME=VALUE", dest="changes",
            help=f"change a setting of the preset, such as --set {example}")  # fmt: skip
        command.set_defaults(run=run)


def _train(arguments: argparse.Namespace) -> int:
    from ai.training.checkpoints import AGENTS, resume_run
    from ai.training.config import ANYWHERE, LANDER
    from ai.training.loop import Training
    from ai.training.run import Limit

    if problem := out_of_range(arguments, decisions=DECISIONS, validation=EPISODES):
        return fail(problem)

    def begun() -> Training:
        if arguments.resume is None:
            return Training(lander_config(arguments), arguments.seed or 0, validation_episodes=arguments.validation)
        training = resume_run(arguments.resume, env=arguments.env)
        training.validation_episodes = arguments.validation or training.validation_episodes
        _go_on(training, lander_config(arguments, training.config), arguments)
        return training

    def shown(progress: Progress) -> str:
        best = f" best {progress.best.figure}" if progress.best else ""
        lander = progress.env in (LANDER, ANYWHERE)
        recent = f"landed {progress.success_rate:.0%}" if lander else f"return {progress.mean_return:.1f}, mean"
        return f"{recent} of the last 100, ε {progress.epsilon:.2f}, {progress.decisions:,} decisions{best}"

    limit = Limit(arguments.seconds, arguments.decisions)
    return _run(arguments, AGENTS, begun, limit, shown, lambda training, _: str(training.best))


def _train_digits(arguments: argparse.Namespace) -> int:
    from ai.digits.training import DigitTraining
    from ai.training.checkpoints import DIGITS, resume_digit_run
    from ai.training.run import Limit

    def begun() -> DigitTraining:
        if arguments.resume is None:
            return DigitTraining(digit_config(arguments), arguments.seed or 0)
        training = resume_digit_run(arguments.resume)
        _go_on(training, digit_config(arguments, training.config), arguments)
        return training

    def shown(progress: DigitProgress) -> str:
        best = f", held out {progress.best:.2%}" if progress.best is not None else ""
        return f"epoch {progress.epoch:.1f}, loss {progress.loss:.3f}{best}"

    def verdict(_: Run, described: dict[str, Any]) -> str:
        return f"{described['test']:.2%} of MNIST's test images read right"

    return _run(arguments, DIGITS, begun, Limit(arguments.seconds), shown, verdict)


def lander_config(arguments: argparse.Namespace, begun: Config | None = None) -> Config:
    """Return the preset, or the settings a run was begun with, with the changes asked for.

    Raises ValueError for a change that makes no sense.
    """
    from ai.training.config import ANYWHERE, LANDER, LANDS_ANYWHERE, PRESETS, gym_config

    presets, named = {**PRESETS, "anywhere": LANDS_ANYWHERE}, arguments.preset
    if named is not None and named not in presets:
        raise ValueError(f"--preset is one of {', '.join(presets)}, not {named}")
    preset = begun if begun and named is None else presets[named or "modern"]
    env = (begun or preset).env if arguments.env is None else arguments.env
    if not begun and named is None and env != LANDER:
        preset = LANDS_ANYWHERE if env == ANYWHERE else gym_config(env)
    return configured(preset.changed(env=env), arguments.changes)


def digit_config(arguments: argparse.Namespace, begun: DigitConfig | None = None) -> DigitConfig:
    """Return the preset, or the settings a run was begun with, with the changes asked for.

    Raises ValueError for a change that makes no sense.
    """
    from ai.digits.config import DIGIT_PRESETS

    if arguments.preset is not None and arguments.preset not in DIGIT_PRESETS:
        raise ValueError(f"--preset is one of {', '.join(DIGIT_PRESETS)}, not {arguments.preset}")
    preset = begun if begun and arguments.preset is None else DIGIT_PRESETS[arguments.preset or "modern"]
    config = configured(preset, arguments.changes)
    return config if arguments.epochs is None else config.changed(epochs=arguments.epochs)


def _go_on(training: Run, wanted: Any, arguments: argparse.Namespace) -> None:
    """Take over the live settings wanted for a resumed run; raises ValueError, with their names, for others."""
    if training.lost:
        fail(f"{arguments.resume}: {training.lost}")
    fixed = training.config.fixed_differences(wanted)
    if arguments.seed not in (None, training.seed):
        fixed.append("seed")
    if fixed:
        raise ValueError(f"a run that has begun cannot change {', '.join(fixed)}; without --resume, a new run can")
    training.apply_live(wanted)


def _run(
    arguments: argparse.Namespace, kind: RunKind, begun: Callable[[], Any], limit: Limit,
    shown: Callable[[Any], str], verdict: Callable[[Any, Any], str],
) -> int:  # fmt: skip
    """Train a run that is begun or resumed, keep what comes of it, and return the exit code.

    `shown` is what is written of the progress behind the bar, `verdict` how good the saved run is.
    """
    from ai.files import claimed_folder

    output = arguments.output or arguments.resume
    if output is None:
        return fail("say where to keep the network: --output DIR, or --resume DIR")
    if limit.seconds is None and limit.moment is None and "decisions" in arguments:
        return fail("say when to stop: --seconds S or --decisions N")
    if problem := out_of_range(arguments, seed=SEEDS, seconds=SECONDS):
        return fail(problem)
    with ExitStack() as claims:
        try:
            training = begun()
            if limit.share(training) >= 1.0:
                spent = f"{training.seconds:,.1f} seconds, {training.moment:,} steps"
                raise ValueError(f"this run has taken {spent} already; limits are of the whole run: ask for more")
            claims.enter_context(claimed_folder(output, kind.folder))
            another = output.is_dir() and any(output.iterdir())
            if another and not arguments.replace and not (arguments.resume and output.samefile(arguments.resume)):
                raise ValueError(f"{output} holds an earlier run: --resume {output} goes on with it, --replace ends it")
        except REFUSED as error:
            return fail(reason(error))
        return _train_and_keep(training, output, kind, limit, shown, verdict)


def _train_and_keep(
    training: Run, output: Path, kind: RunKind, limit: Limit, shown: Callable[[Any], str],
    verdict: Callable[[Any, Any], str],
) -> int:  # fmt: skip
    stopped, saved = "", False
    try:
        with stoppable() as stop:
            try:
                _advance(training, output, kind, limit, shown, stop)
            except FloatingPointError as error:
                stopped = f"training stopped: {error}. "
                training.restore_best()
            # Save before measuring, which takes seconds: the user may stop the program meanwhile.
            output, described = _kept(training, output, kind, final=False)
            saved = True
        if not stopped:
            output, described = _kept(training, output, kind, final=True)
    except OSError as error:
        return fail(f"{stopped}could not write to {output}: {error.strerror or error}")
    except ValueError as error:
        return fail(f"{stopped}{'' if saved else f'Nothing new is kept in {output}: '}{error}")
    if stopped:
        what = "What was best until then" if training.best else "The last network, which has not been measured,"
        return fail(f"{stopped}{what} is kept in {output}.")
    say(f"kept in {output}: {verdict(training, described)}")
    return exit_code(stop)


def _advance(
    training: Run, output: Path, kind: RunKind, limit: Limit, shown: Callable[[Any], str], stop: list[int]
) -> None:
    """Train until the limit or the user, who adds to `stop`, says so; keep the run now and then, and show how it goes.

    That is a progress bar on a terminal, and elsewhere a line now and then. That the run could not be kept is told
    once: a disk that is full now may have room by the end.
    """
    from ai.training.run import Keeper

    keeper, line_at = Keeper(training, kind, output), time.monotonic() + _LINE_SECONDS
    with progress_bar(_PARTS, "training", bar_format=_BAR) as bar:
        for progress in limit.run(training):
            share, words = limit.share(training), shown(progress)
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


def _kept(training: Run, output: Path, kind: RunKind, *, final: bool) -> tuple[Path, dict[str, Any]]:
    """Save a run; return its folder and its description. Raises OSError if it cannot be written.

    If something else was put there meanwhile, that stays, and the run is saved beside it.
    """
    from ai.files import free_path

    try:
        return output, kind.save(training, output, final=final)
    except FileExistsError as error:
        fail(str(error))
        beside = free_path(output.parent, output.name)
        return beside, kind.save(training, beside, final=final)
