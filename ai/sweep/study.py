"""Study on disk: its plan, and the finished trials, each whole or not there.

    study.json            the plan, trials under way with their settings, the best run so far, which knobs matter
    journal.jsonl         Optuna's, written and never read (`ai.sweep.search`)
    trials/0007/          a finished trial: trial.json with its curves, and seed-N/ with the run as `train` keeps it

Only the process that runs a study writes it. It gets results through Ray, so workers need no common disk.
"""

from __future__ import annotations

import errno
import json
import re
import statistics
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Annotated, Any, Final, Self

from ai.files import (
    Count,
    Duration,
    Seed,
    Share,
    Sized,
    Within,
    atomic_folder,
    brief,
    check_header,
    read_as,
    read_bytes,
    read_json,
    recover_all,
    remove_state,
    take_folder,
    write_bytes,
    write_text,
)
from ai.sweep.plan import Metric, Plan, Point

STUDIES: Final = "studies"  # folder of all studies, in the user's
STUDY_FILE: Final = "study.json"
TRIAL_FILE: Final = "trial.json"
FORMAT, VERSION = "tranquility study", 2
_MOST: Final = 64_000_000  # bytes of a trial's file
_MOST_RUNS: Final = 1_000_000_000  # bytes of a trial's runs
_UNREADABLE: Final = (OSError, ValueError, TypeError, ArithmeticError, RecursionError)

Files = dict[str, bytes]  # content by path
_Words = Annotated[str, Sized(2000)]


class StudyError(ValueError):
    """A folder is no study, or not one that can be used as asked."""


@dataclass(frozen=True)
class Asked:
    """What is asked of one trial."""

    number: Annotated[int, Within(0, 999_999)]  # in its study
    params: dict[str, Any]  # values of the knobs that are searched
    parent: Count | None = None  # the trial whose runs it goes on with, in a population


@dataclass(frozen=True)
class SeedResult:
    """Result of one seed of a trial."""

    seed: Seed
    curve: Annotated[tuple[Point, ...], Sized(100_000)]  # what was measured on the way
    value: float | None  # of the metric; None if there is none
    problem: _Words  # why the run ended before its time; empty if it did not
    seconds: Duration  # of training, by the clock
    figures: dict[str, Any]  # of the network kept, as its command prints them; empty for a run that was stopped early

    @property
    def rank(self) -> tuple[float, float]:
        """How good its network is, by the figures of its own validation."""
        numbers = [self.figures.get(name) for name in ("success", "held_out", "mean_return")]
        success, held_out, mean = (float(number) if isinstance(number, int | float) else 0.0 for number in numbers)
        return success + held_out, mean


@dataclass(frozen=True)
class FinishedTrial:
    """Result of a trial, whole or so far."""

    number: Count  # in its study
    params: dict[str, Any]  # values of the knobs that were searched
    value: float | None  # the seeds' median; None if one has none, or the settings made no sense
    at: Count  # decisions or epochs that were trained
    stopped: bool  # early, because others were better
    seconds: Duration  # that it took, by the clock, with all measuring and saving
    seeds: Annotated[tuple[SeedResult, ...], Sized(1000)]  # none if the settings made no sense
    parent: Count | None = None  # as it was `Asked`
    problem: _Words = ""  # why there is no result; empty if there is one
    restarts: Count = 0  # times that it went on from its last checkpoint, as its worker had died

    @property
    def values(self) -> list[float]:
        """Values of the seeds that have one."""
        return [seed.value for seed in self.seeds if seed.value is not None]

    @property
    def best_seed(self) -> SeedResult | None:
        """Seed whose network is the best; None if none was kept."""
        return max((seed for seed in self.seeds if seed.figures), key=lambda seed: seed.rank, default=None)


@dataclass(frozen=True)
class StudyFile:
    """What study.json says."""

    plan: Plan
    format: str = FORMAT
    version: int = VERSION
    run: Annotated[str, Sized(200)] | None = None  # folder of the best run
    importance: dict[str, Share] | None = None  # share of each knob in setting the best trials apart
    under_way: Annotated[tuple[Asked, ...], Sized(10_000)] = ()

    @classmethod
    def read(cls, folder: Path) -> Self:
        """Read it; raises StudyError for a folder that is no study."""
        try:
            file = read_as(cls, check_header(read_json(folder / STUDY_FILE), FORMAT, (VERSION,)))
            file.plan.check()
        except OSError as error:
            raise StudyError(f"{folder} is no study: {STUDY_FILE}: {error.strerror or error}") from error
        except (ValueError, TypeError, RecursionError) as error:
            raise StudyError(f"{folder} is no study that can be read: {brief(error)}") from error
        return file


class Study:
    """Study in a folder. Reading it changes nothing on disk."""

    def __init__(self, folder: Path, file: StudyFile) -> None:
        self.folder, self.plan, self.metric = folder, file.plan, Metric.named(file.plan.metric)
        self.trials: dict[int, FinishedTrial] = {}  # finished ones by number
        self.damaged: list[int] = []  # numbers of trials whose files cannot be read
        self.under_way = {asked.number: asked for asked in file.under_way}
        self.importance = {name: share for name, share in (file.importance or {}).items() if name in self.plan.space}

    @classmethod
    def create(cls, folder: Path, plan: Plan) -> Self:
        """Make a new study; raises StudyError if the folder holds anything, OSError if it cannot be written."""
        plan.check()
        if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
            raise StudyError(f"{folder} exists already: --resume goes on with it, or choose another name")
        study = cls(folder, StudyFile(plan))
        study.write()
        return study

    @classmethod
    def load(cls, folder: Path) -> Self:
        """Read a study; raises StudyError for a folder that is none. Trials that cannot be read are `damaged`."""
        study = cls(folder, StudyFile.read(folder))
        with suppress(OSError):
            names = [path.name for path in (folder / "trials").iterdir() if re.fullmatch(r"[0-9]{4,6}", path.name)]
            for number in sorted(map(int, names)):
                try:
                    trial = read_as(FinishedTrial, read_json(study.trial_folder(number) / TRIAL_FILE, _MOST))
                    study._check(number, trial)
                    study.trials[number] = trial
                except _UNREADABLE:
                    study.damaged.append(number)
        for number, asked in list(study.under_way.items()):
            with suppress(*_UNREADABLE):
                study.plan.check_params(asked.params)
                if number not in (*study.trials, *study.damaged):
                    continue
            del study.under_way[number]
        return study

    def _check(self, number: int, trial: FinishedTrial) -> None:
        """Raise ValueError or TypeError for what a file says of a trial if it cannot be one of this study."""
        self.plan.check_params(trial.params)
        senseless = not trial.seeds and trial.value is None
        seeds = tuple(seed.seed for seed in trial.seeds)
        if trial.number != number or not (senseless or seeds == self.plan.seeds):
            raise ValueError("of another trial, or of other seeds")
        if trial.value is not None and len(trial.values) < len(trial.seeds):
            raise ValueError("a value without that of a seed")

    # Writing

    @contextmanager
    def claimed(self) -> Iterator[None]:
        """Keep other processes from running this study meanwhile; raises BlockingIOError if one does."""
        with take_folder(self.folder):
            with suppress(OSError):
                recover_all(self.folder / "trials")
            yield

    def extend(self, trials: int) -> None:
        """Ask for so many trials in all; raises OSError, or ValueError for a number that makes no sense."""
        if self.plan.population and trials != self.plan.trials:
            raise StudyError("a population has as many trials as it began with: its generations divide the budget")
        self.plan = replace(self.plan, trials=trials)
        self.write()

    def write(self) -> None:
        """Write study.json; raises OSError."""
        best = self.best()
        run = self.best_run(best) if best else None
        name = run.relative_to(self.folder).as_posix() if run else None
        under_way = tuple(self.under_way.values())
        file = StudyFile(self.plan, run=name, importance=self.importance, under_way=under_way)
        write_text(self.folder / STUDY_FILE, json.dumps(asdict(file), indent=2) + "\n")

    def begin(self, asked: Asked) -> None:
        """Note that a trial is under way, so that it keeps its settings if the study is interrupted; raises OSError."""
        if asked.number not in self.under_way:
            self.under_way[asked.number] = asked
            self.write()

    def record(self, trial: FinishedTrial, runs: Files) -> None:
        """Keep a finished trial and the files of its runs, whole or not at all; raises OSError."""
        with atomic_folder(self.trial_folder(trial.number), None) as new:
            write_files(runs, new)
            write_text(new / TRIAL_FILE, json.dumps(asdict(trial)) + "\n", flush=False)
        self.trials[trial.number] = trial
        self.under_way.pop(trial.number, None)
        generation = self.plan.generation(trial.number)
        if generation and len(self.generation(generation)) == self.plan.population:
            for before in self.generation(generation - 1):  # nobody goes on from there any more
                for seed in self.plan.seeds:
                    remove_state(self.trial_folder(before.number) / seed_folder(seed))
        with suppress(OSError):
            self.write()

    # Reading

    def trial_folder(self, number: int) -> Path:
        """Return the folder of a finished trial."""
        return self.folder / "trials" / f"{number:04}"

    def run_folder(self, trial: FinishedTrial, seed: int) -> Path | None:
        """Return the folder of a run that was kept; None if it was not, as of trials that were stopped early."""
        folder = self.trial_folder(trial.number) / seed_folder(seed)
        return folder if folder.is_dir() else None

    def best_run(self, trial: FinishedTrial) -> Path | None:
        """Return the folder of a trial's best run; None if none was kept."""
        return self.run_folder(trial, trial.best_seed.seed) if trial.best_seed else None

    def runs_of(self, trial: FinishedTrial) -> Files:
        """Return the files of the runs of a finished trial; raises OSError."""
        return files_in(self.trial_folder(trial.number))

    def ranked(self) -> list[FinishedTrial]:
        """Return the trials that have a value, the best first; those that ran to their end before those stopped."""
        known = [trial for trial in self.trials.values() if trial.value is not None]
        sign = self.metric.sign
        return sorted(known, key=lambda trial: (trial.stopped, sign * (trial.value or 0.0), trial.number))

    def best(self) -> FinishedTrial | None:
        """Return the best trial; of a population, of its last generation that is whole. None before there is one."""
        plan, ranked = self.plan, self.ranked()
        if plan.population:
            whole = [each for each in range(plan.generations) if len(self.generation(each)) == plan.population]
            ranked = [trial for trial in ranked if plan.generation(trial.number) == max(whole, default=0)]
        return ranked[0] if ranked else None

    def generation(self, number: int) -> list[FinishedTrial]:
        """Return the finished members of a generation, by number."""
        return [each for _, each in sorted(self.trials.items()) if self.plan.generation(each.number) == number]

    def so_far(self, trial: FinishedTrial, at: int) -> FinishedTrial:
        """Return a trial as it was after so many decisions or epochs."""
        curves = [tuple(point for point in seed.curve if point.at <= at) for seed in trial.seeds]
        values = [
            self.metric.of(curve, self.plan.budget, bool(seed.problem) and curve == seed.curve)
            for curve, seed in zip(curves, trial.seeds, strict=True)
        ]
        return replace(trial, at=at, value=median(values))

    @property
    def complete(self) -> bool:
        """Whether all trials are finished."""
        return len(self.trials) >= self.plan.trials

    def shown(self, value: float | None) -> str:
        """Return a value of the metric as a table shows it."""
        return self.metric.shown(value, self.plan.budget)


def median(values: list[float | None]) -> float | None:
    """Return the value of a trial from those of its seeds; None if one has none."""
    known = [value for value in values if value is not None]
    return statistics.median(known) if known and len(known) == len(values) else None


def files_in(folder: Path) -> Files:
    """Return the content of all files in a folder, by their paths within it.

    Raises OSError for a link, for what is no ordinary file, and for more than a trial may hold: nothing is sent to
    other processes that does not lie in the folder itself.
    """
    files: Files = {}
    for path in sorted(folder.rglob("*")):
        if path.is_symlink():
            raise OSError(errno.ELOOP, "is a link", str(path))
        if not path.is_dir():
            files[path.relative_to(folder).as_posix()] = read_bytes(path, _MOST_RUNS - sum(map(len, files.values())))
    return files


def write_files(files: Files, folder: Path) -> None:
    """Write the files that `files_in` has read into a folder; raises OSError."""
    for name, content in files.items():
        write_bytes(folder / name, content, flush=False)


def seed_folder(seed: int) -> str:
    """Return the name of the folder of a seed's run within its trial's."""
    return f"seed-{seed}"
