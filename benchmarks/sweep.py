"""What a sweep costs beside a plain loop over the same trials, and what many queued trials cost.

    python -m benchmarks.sweep [--trials 6] [--decisions 20000] [--empty 500] [--workers 1 2]

First real trials: the lander's modern preset with a searched learning rate, one seed each, by a plain loop in this
process and then by `sweep` with so many workers. Then empty trials, whose settings make no sense, so that they end at
once: what is left is proposing, handing out, handing back and writing. Seconds are by the clock, and processor seconds
of the process that runs the study; Ray's start, which a study pays once, is told apart.
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before NumPy is imported, or it has no effect

import argparse
import platform
import sys
import tempfile
import time
from dataclasses import replace
from importlib.metadata import version
from pathlib import Path

from ai.sweep.cluster import MISSING, installed, joined
from ai.sweep.plan import Plan, knob_space
from ai.sweep.study import Asked, Study
from ai.sweep.trial import Trial
from ai.training.config import PRESETS


def plan_of(trials: int, decisions: int, knob: str) -> Plan:
    config = PRESETS["modern"].changed(replay_size=50_000)
    space = knob_space(config, [knob])
    if knob == "replay_prune":
        space[knob] = replace(space[knob], low=60_000)  # more than the buffer holds
    return Plan.of(
        config, space, seeds=1, decisions=decisions, every=decisions, metric="return", search="random", trials=trials
    )


def looped(plan: Plan, study: Study, swept: Study) -> float:
    """Run a finished study's trials again in a plain loop that keeps the same; return the seconds."""
    began = time.monotonic()
    for number, trial in sorted(swept.trials.items()):
        run = Trial(plan, Asked(number, trial.params))
        while not run.done:
            run.step()
        study.record(*run.finish())
    return time.monotonic() - began


def swept(plan: Plan, folder: Path, workers: int) -> tuple[Study, float, float, float]:
    """Run a study; return it, the seconds of Ray's start, of all trials, and the driver's processor seconds of them."""
    study, began = Study.create(folder, plan), time.monotonic()
    with joined(None, workers):
        from ai.sweep.driver import Driver

        started, spent = time.monotonic(), time.process_time()
        Driver(study, workers, print, lambda: None).run([])
        return study, started - began, time.monotonic() - started, time.process_time() - spent


def inside(study: Study) -> float:
    """Return the seconds that workers spent in trials; the rest went into their start, and into handing out."""
    return sum(trial.seconds for trial in study.trials.values())


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--trials", type=int, default=6)
    parser.add_argument("--decisions", type=int, default=20_000)
    parser.add_argument("--empty", type=int, default=500)
    parser.add_argument("--workers", type=int, nargs="+", default=[1, 2])
    given = parser.parse_args()
    if not installed():
        sys.exit(MISSING)
    print(
        f"Python {platform.python_version()}, Ray {version('ray')}, Optuna {version('optuna')};"
        f" load {os.getloadavg()[0]:.1f}"
    )
    print("| | trials | start of Ray, s | all, s | of it in trials, s | trials an hour | driver's CPU a trial, ms |")
    print("|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as temporary:
        folder, last = Path(temporary), None
        for knob, trials in (("learning_rate", given.trials), ("replay_prune", given.empty)):
            plan = plan_of(trials, given.decisions, knob)
            for workers in given.workers if trials else []:
                last, start, took, spent = swept(plan, folder / f"{knob}-{workers}", workers)
                name = f"{'empty, ' if knob == 'replay_prune' else ''}{workers} at once"
                pace = f"{took:.1f} | {inside(last) / workers:.1f} | {3600 * trials / took:,.0f}"
                print(f"| {name} | {trials} | {start:.1f} | {pace} | {1000 * spent / trials:.0f} |", flush=True)
            if last is not None and knob == "learning_rate":
                took = looped(plan, Study.create(folder / "loop", plan), last)
                print(
                    f"| plain loop | {trials} | | {took:.1f} | {took:.1f} | {3600 * trials / took:,.0f} | |",
                    flush=True,
                )


if __name__ == "__main__":
    main()
