"""The commands of sweeps: run a study of many trials, tell what a study found."""

from __future__ import annotations

import argparse
import json
import sys
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from ai.cli.command_line import (
    EPISODES,
    REFUSED,
    SEEDS,
    WORKERS,
    Unheard,
    add_where,
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
    from ai.common.knobs import Knobs
    from ai.sweep.plan import Plan
    from ai.sweep.results import FinishedTrial
    from ai.sweep.study import Study

TRIALS: Final = (1, 100_000)
RUNS: Final = (1, 1000)  # seeds of a trial, members of a population
BUDGET: Final = (1, 10**12)
_TRIALS, _RUNS, _DECISIONS, _MEASURED = 64, 3, 250_000, 5  # defaults; a run is measured five times
_OF_A_NEW_ONE: Final = (
    "seeds", "metric", "judge", "knobs", "space", "search", "population", "stop_early", "decisions", "epochs", "every",
    "validation", "preset", "changes", "digits", "seed",
)  # fmt: skip


def add_commands(commands: Any) -> None:
    """Add `sweep` and `study` to a parser's sub-commands."""
    sweep = commands.add_parser(
        "sweep", help="train many times with other settings, on all cores or on a cluster, to see which knobs matter"
    )
    sweep.add_argument("--study", required=True, metavar="NAME", help="name of the study, or a path of its folder")
    sweep.add_argument("--resume", action="store_true", help="go on with a study; --trials may ask for more")
    sweep.add_argument("--trials", type=int, metavar="N", help=f"trials in all (default: {_TRIALS})")
    sweep.add_argument("--seeds", type=int, metavar="N", help=f"runs of each trial, seeds 0 to N-1 (default: {_RUNS})")
    sweep.add_argument("--metric", metavar="NAME", help="what trials are compared by: time_to_99 or any percentage,"
                       " in decisions; success, return, mean, accuracy (default: by what is trained)")  # fmt: skip
    sweep.add_argument("--judge", choices=("median", "worst"), help="how a trial's seeds are judged (default: median)")
    sweep.add_argument("--knobs", metavar="NAMES", help="knobs or groups to search by their own ranges, with commas"
                       " between (default: learning, the whole group)")  # fmt: skip
    sweep.add_argument("--space", type=Path, metavar="FILE", help="knobs to search, with ranges, as JSON")
    sweep.add_argument("--search", choices=("tpe", "random", "population"), help="how settings are proposed: by Optuna,"
                       " at random, or in a population that copies its best (default: tpe)")  # fmt: skip
    sweep.add_argument("--population", type=int, metavar="N", help="members of a generation (default: 8)")
    sweep.add_argument("--stop-early", action="store_true", default=None, help="end trials that fall behind (ASHA)")
    sweep.add_argument("--decisions", type=int, metavar="N", help=f"length of each run (default: {_DECISIONS:,})")
    sweep.add_argument("--epochs", type=int, metavar="N", help="length of each run of digits (default: the preset's)")
    sweep.add_argument("--every", type=int, metavar="N", help="decisions or epochs between two measurements")
    sweep.add_argument("--validation", type=int, metavar="N", help="episodes of a measurement, as for train")
    sweep.add_argument("--env", metavar="NAME", help="an environment of Gymnasium (default: our own lander);"
                       " with --resume only to allow a study one whose name is module:Name")  # fmt: skip
    sweep.add_argument("--digits", action="store_true", default=None, help="train networks that read digits")
    sweep.add_argument("--preset", help="settings of all that is not searched, as for train or train-digits")
    sweep.add_argument("--set", action="append", metavar="NAME=VALUE", dest="changes", help="change such a setting")
    sweep.add_argument("--seed", type=int, help="of the search itself (default: 0)")
    add_where(sweep, "processes at once (default: all cores)")
    sweep.set_defaults(run=_sweep)

    study = commands.add_parser("study", help="tell what a study found: the best settings, and which knobs matter")
    study.add_argument("study", metavar="NAME", help="name of the study, or a path of its folder")
    study.add_argument("--json", action="store_true", help="print one JSON object")
    study.add_argument("--html", type=Path, metavar="FILE", help="write one page with plots, which needs nothing else")
    study.set_defaults(run=_study)


def _sweep(arguments: argparse.Namespace) -> int:
    from ai.sweep.cluster import MISSING, answering, installed
    from ai.sweep.study import Study

    if not installed():
        return fail(MISSING)
    ranges = {"trials": TRIALS, "seeds": RUNS, "population": RUNS, "decisions": BUDGET, "epochs": BUDGET,
              "every": BUDGET, "validation": EPISODES, "seed": SEEDS, "workers": WORKERS}  # fmt: skip
    if problem := out_of_range(arguments, **ranges):
        return fail(problem)
    code = 0
    try:
        place = _place(arguments)
        if arguments.address is not None:
            answering(arguments.address)  # before there is a study
        study = _resumed(arguments, place) if arguments.resume else Study.create(place, _plan(arguments))
        with study.claimed(), stoppable() as stop:
            if not _complete(study):
                code = _run(arguments, study, stop)
    except REFUSED as error:
        return fail(reason(error))
    _tell(study)
    if not _complete(study):
        say(_again(arguments, study))
    return exit_code(stop) or code


def _complete(study: Study) -> bool:
    return len(study.trials) >= study.plan.trials


def _run(arguments: argparse.Namespace, study: Study, stop: list[int]) -> int:
    """Run the trials that a study has left; return the exit code: that of a failure if some could not be made."""
    from ai.sweep.cluster import joined

    with joined(arguments.address, arguments.workers) as workers:
        if stop:
            return 0
        from ai.sweep.driver import Driver
        from ai.sweep.journal import importance_of

        with progress_bar(study.plan.trials, study.folder.name, initial=len(study.trials), unit="trial") as bar:
            best = study.best()

            def told() -> None:
                nonlocal best
                done = len(study.trials)
                new = study.best()
                if new and new is not best and bar.disable:
                    fail(f"{done} of {study.plan.trials} trials: best {_described(study, new)}")
                best = new
                bar.set_postfix_str(
                    f"{len(driver.running)} running{f', best {_described(study, best)}' if best else ''}"
                )
                bar.update(done - bar.n)

            driver = Driver(study, workers, lambda line: bar.write(readable(line), file=Unheard()), told)
            driver.run(stop)
    with suppress(OSError):  # it is made from the rest, and only lists need it
        study.importance = importance_of(study)
        study.write_summary()
    if driver.trouble:
        return fail(driver.trouble)
    if driver.lost and not stop:
        numbers, why = ", ".join(map(str, sorted(driver.lost))), "; ".join(sorted(set(driver.lost.values())))
        return fail(f"trials failed again and again: {numbers}: {why}")
    return 0


def _described(study: Study, trial: FinishedTrial) -> str:
    from ai.sweep.report import settings

    return f"{study.shown(trial.value)}, trial {trial.number}: {settings(trial.params)}"


def _again(arguments: argparse.Namespace, study: Study) -> str:
    named = f" --env {arguments.env}" if ":" in (arguments.env or "") else ""
    return (
        f"{len(study.trials)} of {study.plan.trials} trials are kept; to go on:"
        f" sweep --study {arguments.study} --resume{named}"
    )


def _place(arguments: argparse.Namespace) -> Path:
    """Return the folder of the study; raises ValueError for a name that cannot be one."""
    from ai.common.places import user_dir
    from ai.sweep.study import find

    try:
        folder(arguments.study)
    except argparse.ArgumentTypeError as error:
        raise ValueError(str(error)) from error
    return find(arguments.study, arguments.user_dir or user_dir())


def _resumed(arguments: argparse.Namespace, place: Path) -> Study:
    """Return a study to go on with; raises ValueError for options that only a new one can have.

    A study may be a stranger's: an environment whose name would import code has to be named by the user as well.
    """
    from ai.sweep.runs import AGENT, check_ready, read_config
    from ai.sweep.study import Study
    from ai.training.config import check_env

    if given := [name for name in _OF_A_NEW_ONE if getattr(arguments, name) is not None]:
        named = ", ".join(f"--{'set' if name == 'changes' else name.replace('_', '-')}" for name in given)
        raise ValueError(f"a study that has begun keeps its plan: {named} can only be given without --resume")
    study = Study.load(place)
    config = read_config(study.plan.kind, study.plan.settings)
    env = getattr(config, "env", None)
    if arguments.env not in (None, env):
        raise ValueError(f"a study that has begun keeps its plan: it is not for --env {arguments.env}")
    if study.plan.kind == AGENT:
        check_env(env, arguments.env)
    if arguments.trials is not None and arguments.trials != study.plan.trials:
        study.extend(arguments.trials)
    if not _complete(study):
        check_ready(config)
    return study


def _plan(arguments: argparse.Namespace) -> Plan:
    """Return the plan of a new study; raises ValueError or OSError for what makes no sense."""
    from ai.sweep.plan import POPULATION, TPE, Plan
    from ai.sweep.runs import AGENT, DIGITS, check_ready
    from ai.sweep.space import knob_space, read_space
    from ai.training.config import ANYWHERE, LANDER

    config = _config(arguments)
    check_ready(config)
    settings = json.loads(json.dumps(config.to_json()))
    if arguments.digits:
        budget, metric = settings["epochs"], "accuracy"
    else:
        budget = arguments.decisions or _DECISIONS
        metric = "time_to_99" if settings["env"] in (LANDER, ANYWHERE) else "return"
    if arguments.knobs is not None and arguments.space is not None:
        raise ValueError("say what to search with --knobs or with --space, not with both")
    if arguments.space is not None:
        space = read_space(config, arguments.space)
    else:
        space = knob_space(config, (arguments.knobs or "learning").split(","))
    if arguments.digits and "epochs" in space and arguments.knobs is None:
        del space["epochs"]  # it is the budget
    search = arguments.search or TPE
    population = (arguments.population or 8) if search == POPULATION else 0
    trials = arguments.trials or _TRIALS
    every = arguments.every or max(1, budget // (max(1, trials // population) if population else _MEASURED))
    return Plan(
        DIGITS if arguments.digits else AGENT,
        settings,
        {name: dimension.to_json() for name, dimension in space.items()},
        tuple(range(arguments.seeds or _RUNS)),
        budget,
        every,
        arguments.metric or metric,
        arguments.judge or "median",
        search,
        bool(arguments.stop_early),
        trials,
        population,
        arguments.seed or 0,
        arguments.validation,
    )


def _config(arguments: argparse.Namespace) -> Knobs:
    """Return the settings of all that is not searched."""
    arguments.changes = arguments.changes or []
    if arguments.digits:
        from ai.cli.digits import config_of as digits_of

        if arguments.env or arguments.decisions:
            raise ValueError("--env and --decisions are not for digits: these train for --epochs")
        return digits_of(arguments)
    from ai.cli.lander import config_of

    if arguments.epochs:
        raise ValueError("--epochs is for --digits: agents train for --decisions")
    return config_of(arguments)


def _study(arguments: argparse.Namespace) -> int:
    from ai.sweep.report import report
    from ai.sweep.study import Study

    try:
        study = Study.load(_place(arguments))
        if arguments.html:
            from ai.files import write_text
            from ai.sweep.page import page

            write_text(arguments.html, page(study))
    except REFUSED as error:
        return fail(reason(error))
    if arguments.json:
        print(json.dumps(report(study), indent=2))
    else:
        _tell(study)
    return 0


def _tell(study: Study) -> None:
    from ai.sweep.report import told

    print("\n".join(readable(line, len(line)) for line in told(study).splitlines()))  # its texts may be a stranger's
    sys.stdout.flush()
