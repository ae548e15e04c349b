"""The command of sweeps: run a study of many trials, and print what it found."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from ai.cli import command_line as cli

if TYPE_CHECKING:
    from ai.sweep.design import Design
    from ai.sweep.study import Study

_SEEDS: Final = (1, 1000)  # of a trial
_BUDGET: Final = (1, 10**12)
# Options of a design, which a study keeps: as they are, and what they are made into.
_DESIGN: Final = "seeds", "metric", "decisions", "every", "validation", "seed"
_OF_A_NEW_ONE: Final = (*_DESIGN, "knobs", "preset", "changes", "digits")


def add_commands(commands: Any) -> None:
    """Add `sweep` to a parser's sub-commands."""
    sweep = commands.add_parser(
        "sweep", help="train many times with other settings, on all cores or on a cluster, to see which knobs matter"
    )
    add = sweep.add_argument
    add("--study", required=True, metavar="NAME", help="name of the study, or a path of its folder")
    add("--resume", action="store_true", help="go on with a study; --trials may ask for more")
    add("--trials", type=int, metavar="N", help="trials in all (default: 64)")
    add("--seeds", type=int, metavar="N", help="runs of each trial, seeds 0 to N-1 (default: 3)")
    add("--metric", metavar="NAME", help="compare trials by time_to_99 (any share), success, return or accuracy")
    add("--knobs", metavar="NAMES", help="knobs or groups to search, with commas between (default: learning, a group)")
    add("--decisions", type=int, metavar="N", help="length of each run (default: 250,000)")
    add("--every", type=int, metavar="N", help="decisions or epochs between two measurements")
    add("--validation", type=int, metavar="N", help="episodes of a measurement, as for train")
    add("--env", metavar="NAME", help="an environment of Gymnasium (default: our own lander)")
    add("--digits", action="store_true", default=None, help="train networks that read digits")
    add("--preset", help="settings of all that is not searched, as for train or train-digits")
    add("--set", action="append", metavar="NAME=VALUE", dest="changes", help="change such a setting")
    add("--seed", type=int, help="of the search itself (default: 0)")
    add("--address", metavar="HOST:PORT", help="join the Ray cluster there")
    sweep.set_defaults(run=_sweep)


@cli.refusing
def _sweep(arguments: argparse.Namespace) -> int:
    from ai.sweep.cluster import MISSING, answering, installed
    from ai.sweep.study import Study

    if not installed():
        raise ImportError(MISSING)
    cli.check_ranges(arguments, trials=(1, 100_000), validation=cli.EPISODES, seed=cli.SEEDS, seeds=_SEEDS)
    cli.check_ranges(arguments, decisions=_BUDGET, every=_BUDGET)
    place = _place(arguments)
    if arguments.address is not None:
        answering(arguments.address)  # before there is a study
    study = _resumed(arguments, place) if arguments.resume else Study.create(place, _design(arguments))
    with study.claimed():
        stop, lost = ([], {}) if study.complete else _run(study, arguments.address)
    print("\n".join(cli.readable(line, len(line)) for line in study.table().splitlines()), flush=True)
    if not study.complete:
        named = f" --env {arguments.env}" if ":" in (arguments.env or "") else ""
        kept = f"{len(study.trials)} of {study.design.trials} trials are kept"
        cli.say(f"{kept}; to go on: sweep --study {arguments.study} --resume{named}")
    if lost and not stop:
        numbers, why = ", ".join(map(str, sorted(lost))), "; ".join(sorted(set(lost.values())))
        return cli.fail(f"trials failed again and again: {numbers}: {why}")
    return cli.exit_code(stop)


def _run(study: Study, address: str | None) -> tuple[list[int], dict[int, str]]:
    """Run the trials that a study has left; return signals that came, and why trials failed, by number."""
    from tqdm import tqdm

    from ai.sweep.cluster import joined
    from ai.sweep.study import settings

    with joined(address) as workers, cli.stoppable() as stop:
        from ai.sweep.driver import run

        total, done = study.design.trials, len(study.trials)
        with tqdm(total=total, initial=done, desc=study.folder.name, unit="trial", disable=None) as bar:

            def report(under_way: int) -> None:
                finished, best = len(study.trials) - bar.n, next(iter(study.ranked()), None)
                words = best and f"best {study.shown(best.value)}, trial {best.number}: {settings(best.params)}"
                bar.set_postfix_str(f"{under_way} running" + (f", {words}" if words else ""))
                bar.update(finished)
                if finished and bar.disable:
                    bar.n = len(study.trials)
                    cli.report(f"{bar.n} of {study.design.trials} trials: {words or 'none has a result yet'}")

            return stop, run(study, workers, stop, report)


def _place(arguments: argparse.Namespace) -> Path:
    """Return the folder of the study, among the user's or where a path leads; raises ValueError for no such name."""
    from ai.files.folder import user_dir
    from ai.sweep.study import STUDIES

    name = arguments.study
    try:
        cli.folder(name)
    except argparse.ArgumentTypeError as error:
        raise ValueError(str(error)) from error
    if "/" in name or "\\" in name:
        return Path(name)
    if name in (".", ".."):
        raise ValueError(f"--study takes a name, or the path of a folder, such as {name}/first")
    return Path(arguments.user_dir or user_dir(), STUDIES, name)


def _resumed(arguments: argparse.Namespace, place: Path) -> Study:
    """Return a study to go on with; raises ValueError for options that only a new one can have.

    A study may be somebody else's: an environment whose name would import code has to be named by the user as well.
    """
    from ai.sweep.study import Study
    from ai.sweep.trial import check_ready
    from ai.training.config import Config, check_env

    if given := [name for name in _OF_A_NEW_ONE if getattr(arguments, name) is not None]:
        named = ", ".join(f"--{'set' if name == 'changes' else name}" for name in given)
        raise ValueError(f"a study that has begun keeps its design: {named} can only be given without --resume")
    study = Study.load(place)
    config = study.design.config
    env = config.env if isinstance(config, Config) else None
    if arguments.env not in (None, env):
        raise ValueError(f"a study that has begun keeps its design: it is not for --env {arguments.env}")
    if env is not None:
        check_env(env, arguments.env)
    if arguments.trials not in (None, study.design.trials):
        study.extend(arguments.trials)
    if not study.complete:
        check_ready(config)
    return study


def _design(arguments: argparse.Namespace) -> Design:
    """Return the design of a new study; raises ValueError or OSError for what makes no sense."""
    from ai.cli.train import digit_config, lander_config
    from ai.sweep.design import Design, searched
    from ai.sweep.trial import check_ready

    arguments.changes, arguments.epochs = arguments.changes or [], None
    if arguments.digits and (arguments.env or arguments.decisions):
        raise ValueError("--env and --decisions are not for digits: these train for --set epochs=N")
    names = ("learning" if arguments.knobs is None else arguments.knobs).replace(" ", "").split(",")
    if not all(names):
        raise ValueError(f"--knobs takes names of knobs or groups, with commas between, not {arguments.knobs!r}")
    config: Any = (digit_config if arguments.digits else lander_config)(arguments)
    check_ready(config)
    knobs = searched(config, names)
    if arguments.digits:  # these say how long each trains, and what it is measured with
        knobs = tuple(name for name in knobs if name not in ("epochs", "held_out"))
    given = {name: getattr(arguments, name) for name in (*_DESIGN, "trials")}
    return Design.of(config, knobs, **{name: value for name, value in given.items() if value is not None})
