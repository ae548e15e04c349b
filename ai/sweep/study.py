"""Study on disk: its design, and the finished trials, each whole or not there.

    study.json            the design
    trials/0007/          a finished trial: trial.json with its curves, and seed-N/ with the run as `train` keeps it

Only the process that runs a study writes it. It gets results through Ray, so workers need no common disk. A study may
be somebody else's: all that it says is checked, and starts no code.
"""

from __future__ import annotations

import json
import re
import statistics
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Annotated, Any, Final, Self

from ai.files.folder import atomic_folder, recover_all, take_folder
from ai.files.reading import brief, read_json
from ai.files.schema import Count, Duration, Seed, Sized, check_header, read_as
from ai.files.writing import write_bytes, write_text
from ai.sweep.design import Design, Measurement, Metric

STUDIES: Final = "studies"  # folder of all studies, in the user's
STUDY_FILE: Final = "study.json"
TRIAL_FILE: Final = "trial.json"
FORMAT, VERSION = "tranquility study", 5
_MOST: Final = 64_000_000  # bytes of a trial's file
_UNREADABLE: Final = (OSError, ValueError, TypeError, ArithmeticError, RecursionError)
_BEST: Final = 10  # rows of the table

Files = dict[str, bytes]  # content by path
_Words = Annotated[str, Sized(2000)]


class StudyError(ValueError):
    """A folder is no study, or not one that can be used as asked."""


@dataclass(frozen=True)
class SeedResult:
    """Result of one seed of a trial."""

    seed: Seed
    curve: Annotated[tuple[Measurement, ...], Sized(100_000)]  # what was measured on the way
    value: float | None  # of the metric; None if there is none
    problem: _Words = ""  # why the run ended before its time; empty if it did not


@dataclass(frozen=True)
class Trial:
    """Result of a trial, as its file has it."""

    number: Count  # in its study
    params: dict[str, Any]  # values of the knobs that were searched
    value: float | None  # the seeds' median; None if one has none, or the settings made no sense
    seconds: Duration  # that it took, by the clock, with all measuring and saving
    seeds: Annotated[tuple[SeedResult, ...], Sized(1000)]  # none if the settings made no sense
    problem: _Words = ""  # why there is no result; empty if there is one

    @property
    def values(self) -> list[float]:
        """Values of the seeds that have one."""
        return [seed.value for seed in self.seeds if seed.value is not None]


class Study:
    """Study in a folder. Reading it changes nothing on disk.

    Attributes:
        trials: finished ones by number.
        damaged: numbers of trials whose files cannot be read; they are left as they are.

    """

    def __init__(self, folder: Path, design: Design) -> None:
        self.folder, self.design, self.metric = folder, design, Metric.named(design.metric)
        self.trials: dict[int, Trial] = {}
        self.damaged: list[int] = []

    @classmethod
    def create(cls, folder: Path, design: Design) -> Self:
        """Make a new study; raises StudyError if the folder holds anything, OSError if it cannot be written."""
        design.check()
        if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
            raise StudyError(f"{folder} exists already: --resume goes on with it, or choose another name")
        study = cls(folder, design)
        study._write()
        return study

    @classmethod
    def load(cls, folder: Path) -> Self:
        """Read a study; raises StudyError for a folder that is none."""
        try:
            design = read_as(Design, check_header(read_json(folder / STUDY_FILE), FORMAT, VERSION).get("design"))
            design.check()
        except OSError as error:
            raise StudyError(f"{folder} is no study: {STUDY_FILE}: {error.strerror or error}") from error
        except (ValueError, TypeError, RecursionError) as error:
            raise StudyError(f"{folder} is no study that can be read: {brief(error)}") from error
        study = cls(folder, design)
        with suppress(OSError):
            names = [path.name for path in (folder / "trials").iterdir() if re.fullmatch(r"[0-9]{4,6}", path.name)]
            for number in sorted(map(int, names)):
                try:
                    study.trials[number] = study._read(number)
                except _UNREADABLE:
                    study.damaged.append(number)
        return study

    def _read(self, number: int) -> Trial:
        """Read a finished trial; raises one of `_UNREADABLE` for a file that cannot be one of this study."""
        trial = read_as(Trial, read_json(self.trial_folder(number) / TRIAL_FILE, _MOST))
        self.design.check_params(trial.params)
        senseless = not trial.seeds and trial.value is None
        if trial.number != number or not (senseless or tuple(seed.seed for seed in trial.seeds) == self.design.seeds):
            raise ValueError("of another trial, or of other seeds")
        if trial.value is not None and len(trial.values) < len(trial.seeds):
            raise ValueError("a value without that of a seed")
        return trial

    @contextmanager
    def claimed(self) -> Iterator[None]:
        """Keep other processes from running this study meanwhile; raises BlockingIOError if one does."""
        with take_folder(self.folder):
            with suppress(OSError):
                recover_all(self.folder / "trials")
            yield

    def extend(self, trials: int) -> None:
        """Ask for so many trials in all; raises OSError."""
        self.design = replace(self.design, trials=trials)
        self._write()

    def _write(self) -> None:
        saved = {"format": FORMAT, "version": VERSION, "design": asdict(self.design)}
        write_text(self.folder / STUDY_FILE, json.dumps(saved, indent=2, allow_nan=False) + "\n")

    def record(self, trial: Trial, runs: Files) -> None:
        """Keep a finished trial and the files of its runs, whole or not at all; raises OSError."""
        with atomic_folder(self.trial_folder(trial.number), None) as new:
            for name, content in runs.items():
                write_bytes(new / name, content, flush=False)
            write_text(new / TRIAL_FILE, json.dumps(asdict(trial), allow_nan=False) + "\n", flush=False)
        self.trials[trial.number] = trial

    def trial_folder(self, number: int) -> Path:
        """Return the folder of a finished trial."""
        return self.folder / "trials" / f"{number:04}"

    def best_run(self, trial: Trial) -> Path | None:
        """Return the folder of a trial's best run; None if none was kept."""
        sign = self.metric.sign
        kept = [seed for seed in trial.seeds if seed.value is not None and not seed.problem]
        best = min(kept, key=lambda seed: sign * (seed.value or 0.0), default=None)
        folder = best and self.trial_folder(trial.number) / seed_folder(best.seed)
        return folder if folder and folder.is_dir() else None

    def ranked(self) -> list[Trial]:
        """Return the trials that have a value, the best first."""
        known = [trial for trial in self.trials.values() if trial.value is not None]
        return sorted(known, key=lambda trial: (self.metric.sign * (trial.value or 0.0), trial.number))

    @property
    def complete(self) -> bool:
        """Whether all trials are finished."""
        return len(self.trials) >= self.design.trials

    def shown(self, value: float | None) -> str:
        """Return a value of the metric as the table shows it."""
        return self.metric.shown(value, self.design.budget)

    def table(self) -> str:
        """Return what the study found, the best trials first."""
        design, ranked = self.design, self.ranked()
        trials = f"{self.folder.name}: {len(self.trials)} of {design.trials} trials, {len(design.seeds)} seeds each"
        better = f"({'less' if self.metric.sign == 1 else 'more'} is better)"
        lines = [f"{trials}, compared by {design.metric}, median of the seeds {better}"]
        if self.damaged:
            lines.append(f"of {len(self.damaged)} more, the files cannot be read: {', '.join(map(str, self.damaged))}")
        if senseless := [trial for trial in self.trials.values() if trial.problem]:
            numbers = ", ".join(map(str, sorted(trial.number for trial in senseless)))
            lines.append(f"of {len(senseless)}, the settings make no sense: {numbers}: {brief(senseless[0].problem)}")
        if not ranked:
            return "\n".join([*lines, "no trial has a result yet"])
        lines.append(f"\n{'trial':>5} {design.metric:>12} {'of the seeds':>24}  settings")
        for trial in ranked[:_BEST]:
            spread = f"{self.shown(min(trial.values))} to {self.shown(max(trial.values))}"
            lines.append(f"{trial.number:>5} {self.shown(trial.value):>12} {spread:>24}  {settings(trial.params)}")
        if folder := self.best_run(ranked[0]):
            lines.append(f"\nbest network: {folder}")
        return "\n".join(lines)


def settings(params: dict[str, Any]) -> str:
    """Return the settings of a trial in one line."""
    shown = {name: f"{each:.3g}" if isinstance(each, float) else json.dumps(each) for name, each in params.items()}
    return " ".join(f"{name}={value}" for name, value in shown.items()).replace('"', "")


def median(values: Sequence[float | None]) -> float | None:
    """Return the value of a trial from those of its seeds; None if one has none."""
    known = [value for value in values if value is not None]
    return statistics.median(known) if known and len(known) == len(values) else None


def seed_folder(seed: int) -> str:
    """Return the name of the folder of a seed's run within its trial's."""
    return f"seed-{seed}"
