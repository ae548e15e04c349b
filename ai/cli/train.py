"""The commands that train: `train` and `train-digits`. Each begins or resumes a run, and keeps what comes of it.

Nothing heavy is imported until a command runs, because the game reads this table too before it opens.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable, Mapping
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, TypeVar

from ai.cli import command_line as cli

if TYPE_CHECKING:
    from ai.digits.config import DigitConfig
    from ai.run import Run
    from ai.training.config import Config
    from ai.training.run import Limit

_RANGES: Final = {"decisions": (1, 10**12), "validation": cli.EPISODES, "seed": cli.SEEDS, "seconds": cli.SECONDS}
_LINE_SECONDS: Final = 20.0  # between two lines where there is no terminal
_PARTS: Final = 1000  # of the bar
_BAR: Final = "{desc} {percentage:3.0f}%|{bar}| {elapsed}<{remaining} {postfix}"

Preset = TypeVar("Preset")


def add_commands(commands: Any) -> None:
    """Add `train` and `train-digits` to a parser's sub-commands."""
    land = commands.add_parser("train", help="teach a network to land, or to master another environment")
    read = commands.add_parser("train-digits", help="teach a network to read handwritten digits")
    add = land.add_argument
    add("--env", metavar="NAME", help="an environment of Gymnasium, such as CartPole-v1 (default: our own lander)")
    add(
        "--env-set",
        action="append",
        default=[],
        metavar="NAME=VALUE",
        dest="arguments",
        help="an argument of that environment, such as --env-set max_episode_steps=500",
    )
    add("--preset", help="modern, classic or anywhere, which lands on any world (default: modern, or as --env needs)")
    add("--decisions", type=int, help="stop when the whole run, resumed or not, has taken so many decisions")
    add("--validation", type=int, metavar="N", help="episodes that choose the best network")
    add("--pay", type=Path, metavar="FILE", help="pay by the function pay(before, action, after) of a Python file")
    add = read.add_argument
    add("--preset", help="modern, classic, as-described, or thorough, as the shipped modern one (default: modern)")
    add("--epochs", type=int, help="how often every image is seen (default: as the preset says)")
    for command, run, example in ((land, _train, "n_step=5"), (read, _train_digits, "dropout=0.5")):
        add = command.add_argument
        add("--seconds", type=float, help="stop when the whole run, resumed or not, has trained for so many seconds")
        add("--output", type=cli.folder, metavar="DIR", help="where to keep the network")
        add("--resume", type=cli.folder, metavar="DIR", help="go on with the run there; only live settings may change")
        add("--replace", action="store_true", help="put the new run in the place of an earlier one")
        add("--seed", type=int, help="what all chance follows from (default: 0)")
        changed = f"change a setting of the preset, such as --set {example}"
        add("--set", action="append", default=[], metavar="NAME=VALUE", dest="changes", help=changed)
        command.set_defaults(run=run)


@cli.refusing
def _train(arguments: argparse.Namespace) -> int:
    from ai.training.loop import Training

    return _run(arguments, Training, lander_config)


@cli.refusing
def _train_digits(arguments: argparse.Namespace) -> int:
    from ai.digits.training import DigitTraining

    return _run(arguments, DigitTraining, digit_config)


def lander_config(arguments: argparse.Namespace, begun: Config | None = None) -> Config:
    """Return the preset, or the settings a run was begun with, with the changes asked for.

    Raises ValueError for a change that makes no sense.
    """
    from ai.training.config import ANYWHERE, LANDER, LANDS_ANYWHERE, PRESETS, gym_config

    preset = _preset(arguments.preset, {**PRESETS, "anywhere": LANDS_ANYWHERE}, begun)
    env = (begun or preset).env if arguments.env is None else arguments.env
    if not begun and arguments.preset is None and env != LANDER:
        preset = LANDS_ANYWHERE if env == ANYWHERE else gym_config(env)
    config = cli.configured(preset.changed(env=env), arguments.changes)
    return config.changed(env_arguments=cli.env_arguments(config.env_arguments, getattr(arguments, "arguments", [])))


def digit_config(arguments: argparse.Namespace, begun: DigitConfig | None = None) -> DigitConfig:
    """Return the preset, or the settings a run was begun with, with the changes asked for, as `lander_config`."""
    from ai.digits.config import DIGIT_PRESETS

    config = cli.configured(_preset(arguments.preset, DIGIT_PRESETS, begun), arguments.changes)
    return config if arguments.epochs is None else config.changed(epochs=arguments.epochs)


def _preset(named: str | None, presets: Mapping[str, Preset], begun: Preset | None) -> Preset:
    """Return the preset of a name, or without one what a run was begun with; raises ValueError for other names."""
    if named not in (None, *presets):
        raise ValueError(f"--preset is one of {', '.join(presets)}, not {named}")
    return begun if begun and named is None else presets[named or "modern"]


def _run(arguments: argparse.Namespace, kind: type[Run], config: Callable[..., Any]) -> int:
    """Train a run with the settings of `config`, begun or resumed, keep what comes of it, and return the exit code."""
    from ai.files.folder import claimed_folder
    from ai.training.run import Limit, resume

    output = arguments.output or arguments.resume
    limit = Limit(arguments.seconds, getattr(arguments, "decisions", None))
    cli.check_ranges(arguments, **_RANGES)
    if output is None:
        raise ValueError("say where to keep the network: --output DIR, or --resume DIR")
    if limit.seconds is None and limit.moment is None and "decisions" in arguments:
        raise ValueError("say when to stop: --seconds S or --decisions N")
    if arguments.resume is None:
        training: Any = kind(config(arguments), arguments.seed or 0)
    else:
        training = resume(kind, arguments.resume, env=getattr(arguments, "env", None))
        _go_on(training, config(arguments, training.config), arguments)
    with ExitStack() as claims:
        if getattr(arguments, "pay", None):
            claims.callback(_paid_by(training, arguments.pay))
        if getattr(arguments, "validation", None):
            training.validation_episodes = arguments.validation
        if limit.share(training) >= 1.0:
            spent = f"{training.seconds:,.1f} seconds, {training.moment:,} steps"
            raise ValueError(f"this run has taken {spent} already; limits are of the whole run: ask for more")
        claims.enter_context(claimed_folder(output, kind.kind))
        another = output.is_dir() and any(output.iterdir())
        if another and not arguments.replace and not (arguments.resume and output.samefile(arguments.resume)):
            raise ValueError(f"{output} holds an earlier run: --resume {output} goes on with it, --replace ends it")
        return _train_and_keep(training, output, limit)


def _paid_by(training: Any, path: Path) -> Callable[[], None]:
    """Let a file of the user's own pay a run; return what ends its process. Raises ValueError."""
    from ai.lander.environment import LanderEnv
    from ai.pilots.own import OwnPay

    if not isinstance(training.env, LanderEnv):
        raise ValueError("--pay is for landers")
    training.env.pay = pay = OwnPay(path)
    return pay.close


def _go_on(training: Run, wanted: Any, arguments: argparse.Namespace) -> None:
    """Take over the live settings wanted for a resumed run; raises ValueError, with their names, for others."""
    if training.lost:
        cli.report(f"{arguments.resume}: {training.lost}")
    fixed = training.config.fixed_differences(wanted)
    if arguments.seed not in (None, training.seed):
        fixed.append("seed")
    if fixed:
        raise ValueError(f"a run that has begun cannot change {', '.join(fixed)}; without --resume, a new run can")
    training.apply_live(wanted)


def _train_and_keep(training: Run, output: Path, limit: Limit) -> int:
    from ai.environment import ForeignEnvError

    stopped, saved = "", False
    try:
        with cli.stoppable() as stop:
            training.stopping = lambda: bool(stop)
            try:
                _advance(training, output, limit, stop)
            except FloatingPointError as error:
                stopped = f"training stopped: {error}. "
                training.restore_best()
            except ForeignEnvError as error:
                stopped = f"training stopped: {cli.reason(error)}. "
            # Save before measuring, which takes seconds: the user may stop the program meanwhile.
            output, described = _kept(training, output, final=False)
            saved = True
        if not stopped:
            with cli.stoppable() as again:
                training.stopping = lambda: bool(again)
                output, described = _kept(training, output, final=True)
    except ForeignEnvError as error:
        return cli.fail(f"kept in {output}, and not measured: {cli.reason(error)}")
    except OSError as error:
        return cli.fail(f"{stopped}could not write to {output}: {error.strerror or error}")
    except ValueError as error:
        return cli.fail(f"{stopped}{'' if saved else f'Nothing new is kept in {output}: '}{error}")
    finally:
        training.close()
    if stopped:
        what = "What was best until then" if training.best else "The last network, which has not been measured,"
        return cli.fail(f"{stopped}{what} is kept in {output}.")
    read = described.get("test")  # of digits alone
    verdict = training.best if read is None else f"{read:.2%} of MNIST's test images read right"
    cli.say(f"kept in {output}: {verdict or 'not measured'}")
    return cli.exit_code(stop or again)


def _advance(training: Run, output: Path, limit: Limit, stop: list[int]) -> None:
    """Train until the limit or the user, who adds to `stop`, says so; keep the run now and then, and show how it goes.

    That is a progress bar on a terminal, and elsewhere a line now and then. That the run could not be kept is said
    once: a disk that is full now may have room by the end.
    """
    from tqdm import tqdm

    from ai.training.run import Keeper

    keeper, line_at = Keeper(training, output), time.monotonic() + _LINE_SECONDS
    with tqdm(total=_PARTS, desc="training", bar_format=_BAR, disable=None) as bar:
        for _ in limit.run(training):
            share, words = limit.share(training), str(training)
            bar.update(int(_PARTS * share) - bar.n)
            bar.set_postfix_str(words, refresh=False)
            if bar.disable and time.monotonic() >= line_at:
                line_at = time.monotonic() + _LINE_SECONDS
                cli.report(f"training {share:.0%}: {words}")
            if stop:
                break
            for failure in keeper.go_on(training.clock()):
                bar.clear()
                cli.report(f"could not write to {output}: {failure.problem}; training goes on")
    keeper.wait()


def _kept(training: Run, output: Path, *, final: bool) -> tuple[Path, dict[str, Any]]:
    """Save a run; return its folder and its description. Raises OSError if it cannot be written.

    If something else was put there meanwhile, that stays, and the run is saved beside it.
    """
    from ai.files.writing import free_path
    from ai.training.run import save

    try:
        return output, save(training, output, final=final)
    except FileExistsError as error:
        cli.report(str(error))
        beside = free_path(output.parent, output.name)
        return beside, save(training, beside, final=final)
