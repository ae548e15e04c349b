"""The commands of sweeps: run a study of many trials, tell what a study found."""

from __future__ import annotations

import argparse
import json
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from ai.cli import command_line as cli

if TYPE_CHECKING:
    from ai.sweep.plan import Plan
    from ai.sweep.study import Study

_RUNS: Final = (1, 1000)  # seeds of a trial, members of a population
_BUDGET: Final = (1, 10**12)
# Options of a plan, which a study keeps: as they are, and what they are made into.
_PLAN: Final = "seeds", "metric", "search", "population", "stop_early", "decisions", "every", "validation", "seed"
_OF_A_NEW_ONE: Final = (*_PLAN, "knobs", "space", "preset", "changes", "digits")


def add_commands(commands: Any) -> None:
    """Add `sweep` and `study` to a parser's sub-commands."""
    sweep = commands.add_parser(
        "sweep", help="train many times with other settings, on all cores or on a cluster, to see which knobs matter"
    )
    add = sweep.add_argument
    add("--study", required=True, metavar="NAME", help="name of the study, or a path of its folder")
    add("--resume", action="store_true", help="go on with a study; --trials may ask for more")
    add("--trials", type=int, metavar="N", help="trials in all (default: 64)")
    add("--seeds", type=int, metavar="N", help="runs of each trial, seeds 0 to N-1 (default: 3)")
    add("--metric", metavar="NAME", help="compare trials by time_to_99 (any share), success, return, mean or accuracy")
    add("--knobs", metavar="NAMES", help="knobs or groups to search, with commas between (default: learning, a group)")
    add("--space", type=Path, metavar="FILE", help="knobs to search, with ranges, as JSON")
    add("--search", choices=("tpe", "random", "population"), help="how settings are proposed (default: tpe, by Optuna)")
    add("--population", type=int, metavar="N", help="members of a generation (default: 8)")
    add("--stop-early", action="store_true", default=None, help="end trials that fall behind (ASHA)")
    add("--decisions", type=int, metavar="N", help="length of each run (default: 250,000)")
    add("--every", type=int, metavar="N", help="decisions or epochs between two measurements")
    add("--validation", type=int, metavar="N", help="episodes of a measurement, as for train")
    add("--env", metavar="NAME", help="an environment of Gymnasium (default: our own lander)")
    add("--digits", action="store_true", default=None, help="train networks that read digits")
    add("--preset", help="settings of all that is not searched, as for train or train-digits")
    add("--set", action="append", metavar="NAME=VALUE", dest="changes", help="change such a setting")
    add("--seed", type=int, help="of the search itself (default: 0)")
    add("--address", metavar="HOST:PORT", help="join the Ray cluster there")
    add("--workers", type=int, metavar="N", help="processes at once (default: all cores)")
    sweep.set_defaults(run=_sweep)

    study = commands.add_parser("study", help="tell what a study found: the best settings, and which knobs matter")
    study.add_argument("study", metavar="NAME", help="name of the study, or a path of its folder")
    study.add_argument("--json", action="store_true", help="print one JSON object")
    study.add_argument("--html", type=Path, metavar="FILE", help="write one page with plots, which needs nothing else")
    study.set_defaults(run=_study)


@cli.refusing
def _sweep(arguments: argparse.Namespace) -> int:
    from ai.sweep.cluster import MISSING, answering, installed
    from ai.sweep.study import Study

    if not installed():
        raise ImportError(MISSING)
    cli.check_ranges(arguments, trials=(1, 100_000), validation=cli.EPISODES, seed=cli.SEEDS, workers=cli.WORKERS)
    cli.check_ranges(arguments, seeds=_RUNS, population=_RUNS, decisions=_BUDGET, every=_BUDGET)
    place = _place(arguments)
    if arguments.address is not None:
        answering(arguments.address)  # before there is a study
    study = _resumed(arguments, place) if arguments.resume else Study.create(place, _plan(arguments))
    with study.claimed(), cli.stoppable() as stop:
        code = 0 if study.complete else _run(arguments, study, stop)
    _print(study)
    if not study.complete:
        named = f" --env {arguments.env}" if ":" in (arguments.env or "") else ""
        kept = f"{len(study.trials)} of {study.plan.trials} trials are kept"
        cli.say(f"{kept}; to go on: sweep --study {arguments.study} --resume{named}")
    return cli.exit_code(stop) or code


def _run(arguments: argparse.Namespace, study: Study, stop: list[int]) -> int:
    """Run the trials that a study has left; return the exit code: that of a failure if some could not be made."""
    from ai.sweep.cluster import joined
    from ai.sweep.report import settings

    shown = study.best()

    def show() -> None:
        nonlocal shown
        words, best = f"{len(driver.jobs)} running", study.best()
        if best:
            described = f"best {study.shown(best.value)}, trial {best.number}: {settings(best.params)}"
            words += f", {described}"
            if bar.disable and best is not shown:
                cli.fail(f"{len(study.trials)} of {study.plan.trials} trials: {described}")
        shown = best
        bar.set_postfix_str(words)
        bar.update(len(study.trials) - bar.n)

    with joined(arguments.address, arguments.workers) as workers:
        if stop:
            return 0
        from ai.sweep.driver import Driver

        with cli.progress_bar(study.plan.trials, study.folder.name, initial=len(study.trials), unit="trial") as bar:
            driver = Driver(study, workers, lambda line: bar.write(cli.readable(line), file=cli.Unheard()), show)
            driver.run(stop)
    with suppress(OSError):  # it is made from the rest
        study.importance = driver.search.importance()
        study.write()
    if driver.lost and not stop:
        numbers, why = ", ".join(map(str, sorted(driver.lost))), "; ".join(sorted(set(driver.lost.values())))
        return cli.fail(f"trials failed again and again: {numbers}: {why}")
    return 0


def _place(arguments: argparse.Namespace) -> Path:
    """Return the folder of the study, among the user's or where a path leads; raises ValueError for no such name."""
    from ai.files import user_dir
    from ai.sweep.study import STUDIES

    name = arguments.study
    try:
        cli.folder(name)
    except argparse.ArgumentTypeError as error:
        raise ValueError(str(error)) from error
    return Path(name) if "/" in name or "\\" in name else (arguments.user_dir or user_dir()) / STUDIES / name


def _resumed(arguments: argparse.Namespace, place: Path) -> Study:
    """Return a study to go on with; raises ValueError for options that only a new one can have.

    A study may be somebody else's: an environment whose name would import code has to be named by the user as well.
    """
    from ai.sweep.study import Study
    from ai.sweep.trial import check_ready
    from ai.training.config import Config, check_env

    if given := [name for name in _OF_A_NEW_ONE if getattr(arguments, name) is not None]:
        named = ", ".join(f"--{'set' if name == 'changes' else name.replace('_', '-')}" for name in given)
        raise ValueError(f"a study that has begun keeps its plan: {named} can only be given without --resume")
    study = Study.load(place)
    config = study.plan.config
    env = config.env if isinstance(config, Config) else None
    if arguments.env not in (None, env):
        raise ValueError(f"a study that has begun keeps its plan: it is not for --env {arguments.env}")
    if env is not None:
        check_env(env, arguments.env)
    if arguments.trials not in (None, study.plan.trials):
        study.extend(arguments.trials)
    if not study.complete:
        check_ready(config)
    return study


def _plan(arguments: argparse.Namespace) -> Plan:
    """Return the plan of a new study; raises ValueError or OSError for what makes no sense."""
    from ai.cli.train import digit_config, lander_config
    from ai.sweep.plan import Plan, knob_space, read_space
    from ai.sweep.trial import check_ready

    arguments.changes, arguments.epochs = arguments.changes or [], None
    if arguments.digits and (arguments.env or arguments.decisions):
        raise ValueError("--env and --decisions are not for digits: these train for --set epochs=N")
    if arguments.knobs is not None and arguments.space is not None:
        raise ValueError("say what to search with --knobs or with --space, not with both")
    config: Any = (digit_config if arguments.digits else lander_config)(arguments)
    check_ready(config)
    if arguments.space is not None:
        space = read_space(config, arguments.space)
    else:
        space = knob_space(config, (arguments.knobs or "learning").split(","))
    if arguments.digits and arguments.knobs is None:
        space.pop("epochs", None)  # it is the budget
    given = {name: getattr(arguments, name) for name in (*_PLAN, "trials")}
    return Plan.of(config, space, **{name: value for name, value in given.items() if value is not None})


@cli.refusing
def _study(arguments: argparse.Namespace) -> int:
    from ai.files import write_text
    from ai.sweep.report import page, report
    from ai.sweep.study import Study

    study = Study.load(_place(arguments))
    if arguments.html:
        write_text(arguments.html, page(study))
    if arguments.json:
        print(json.dumps(report(study), indent=2))
    else:
        _print(study)
    return 0


def _print(study: Study) -> None:
    """Print the table of a study, whose texts may be somebody else's."""
    from ai.sweep.report import table

    print("\n".join(cli.readable(line, len(line)) for line in table(study).splitlines()), flush=True)
