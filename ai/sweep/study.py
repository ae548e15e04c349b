"""Study on disk: its plan, Optuna's journal, and the finished trials, each whole or not there.

    study.json            the plan
    journal.jsonl         Optuna's: every trial that has begun, with its settings (`ai.sweep.journal`)
    summary.json          the best so far and what matters, for lists; made from the rest
    trials/0007/          a finished trial: trial.json with its curves, and seed-N/ with the run as `train` keeps it

Only the process that runs a study writes it. It gets results through Ray, so workers need no common disk.
"""

from __future__ import annotations

import errno
import json
import re
import secrets
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Annotated, Any, Final, Self

from ai.agent.storage import KIND
from ai.digits.classifier import KIND as DIGITS_KIND
from ai.files import (
    OneOf,
    Sized,
    brief,
    new_folder,
    read_as,
    read_json,
    recover_all,
    remove_state,
    take_folder,
    write_text,
)
from ai.sweep.metric import Metric
from ai.sweep.plan import FORMAT, VERSION, Plan
from ai.sweep.results import STUDIES, STUDY_FILE, SUMMARY_FILE, FinishedTrial, Summary, summary_of
from ai.sweep.runs import DIGITS
from ai.sweep.trial import archive, seed_folder, unpack

TRIAL_FILE: Final = "trial.json"
_NAME: Final = re.compile(r"\d{4,6}")
_MOST: Final = 64_000_000  # bytes of a trial's file
_UNREADABLE: Final = (OSError, ValueError, TypeError, ArithmeticError, RecursionError)


class StudyError(ValueError):
    """A folder is no study, or not one that can be used as asked."""


@dataclass(frozen=True)
class _StudyFile:
    format: Annotated[str, OneOf((FORMAT,))]
    version: Annotated[int, OneOf((VERSION,))]
    id: Annotated[str, Sized(32, 32)]
    plan: Plan


class Study:
    """Study in a folder. Reading it changes nothing on disk.

    Attributes:
        folder: where it lies.
        id: hexadecimal digits that no other study has.
        plan: what was asked for.
        trials: finished ones by number.
        damaged: numbers of trials whose files cannot be read.
        importance: share that each knob has in setting the best trials apart, as it was last known.

    """

    def __init__(self, folder: Path, study_id: str, plan: Plan) -> None:
        self.folder, self.id, self.plan = folder, study_id, plan
        self.metric = Metric.named(plan.metric)
        self.trials: dict[int, FinishedTrial] = {}
        self.damaged: list[int] = []
        self.importance: dict[str, float] = {}

    @classmethod
    def create(cls, folder: Path, plan: Plan) -> Self:
        """Make a new study; raises StudyError if the folder holds anything, OSError if it cannot be written."""
        plan.check()
        if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
            raise StudyError(f"{folder} exists already: --resume goes on with it, or choose another name")
        folder.mkdir(parents=True, exist_ok=True)
        study = cls(folder, secrets.token_hex(16), plan)
        study._write_plan()
        return study

    @classmethod
    def load(cls, folder: Path) -> Self:
        """Read a study; raises StudyError for a folder that is none. Trials that cannot be read are `damaged`."""
        try:
            values = read_json(folder / STUDY_FILE)
            if isinstance(values, dict) and (values.get("format"), values.get("version")) == (FORMAT, 1):
                raise StudyError(f"{folder} is a study of an earlier version, which this one does not read")
            told = read_as(_StudyFile, values)
            told.plan.check()
            if not re.fullmatch(r"[0-9a-f]{32}", told.id):
                raise ValueError("its id is not 32 hexadecimal digits")
        except OSError as error:
            raise StudyError(f"{folder} is no study: {STUDY_FILE}: {error.strerror or error}") from error
        except StudyError:
            raise
        except (ValueError, RecursionError) as error:
            raise StudyError(f"{folder} is no study that can be read: {brief(error)}") from error
        study = cls(folder, told.id, told.plan)
        study._read_trials()
        summary = summary_of(folder)
        known = (summary and summary.importance) or {}
        study.importance = {name: share for name, share in known.items() if name in told.plan.space}
        return study

    def _write_plan(self) -> None:
        told = {"format": FORMAT, "version": VERSION, "id": self.id, "plan": asdict(self.plan)}
        write_text(self.folder / STUDY_FILE, json.dumps(told, indent=2) + "\n")

    def _read_trials(self) -> None:
        for path in _numbered(self.folder / "trials"):
            number = int(path.name)
            try:
                trial = read_as(FinishedTrial, read_json(path / TRIAL_FILE, _MOST))
                self._check(number, trial)
            except _UNREADABLE:
                self.damaged.append(number)
            else:
                self.trials[number] = trial

    def _check(self, number: int, trial: FinishedTrial) -> None:
        """Raise ValueError or TypeError for what a file says of a trial if it cannot be one of this study."""
        if trial.number != number:
            raise ValueError("of another trial")
        self.check_params(trial.params)
        if trial.seeds or trial.value is not None:
            if tuple(seed.seed for seed in trial.seeds) != self.plan.seeds:
                raise ValueError("of other seeds")
            if trial.value is not None and len(trial.values) < len(trial.seeds):
                raise ValueError("a value without that of a seed")

    def check_params(self, params: dict[str, Any]) -> None:
        """Raise ValueError or TypeError for settings that are not of this study's space."""
        if set(params) != set(self.plan.space):
            raise ValueError("of another study")
        for name, dimension in self.plan.dimensions().items():
            dimension.place(params[name])

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
        plan = replace(self.plan, trials=trials)
        if self.plan.population and trials != self.plan.trials:
            raise StudyError("a population has as many trials as it began with: its generations divide the budget")
        plan.check()
        self.plan = plan
        self._write_plan()

    def record(self, trial: FinishedTrial, packed: bytes = b"") -> None:
        """Keep a finished trial and the archive of its runs, whole or not at all; raises OSError."""
        target = self.trial_folder(trial.number)
        with new_folder(target) as new:
            if packed:
                unpack(packed, new)
            write_text(new / TRIAL_FILE, json.dumps(asdict(trial)) + "\n", flush=False)
        self.trials[trial.number] = trial
        self._forget_states(self.plan.generation(trial.number))
        with suppress(OSError):
            self.write_summary()

    def _forget_states(self, generation: int) -> None:
        """Delete what the members before went on from, once all of a generation have."""
        if generation and len(self.generation(generation)) == self.plan.population:
            for trial in self.generation(generation - 1):
                for seed in self.plan.seeds:
                    remove_state(self.trial_folder(trial.number) / seed_folder(seed))

    def write_summary(self) -> None:
        """Write what a list of studies shows; raises OSError."""
        best = self.best()
        seed = best.best_seed if best else None
        summary = Summary(
            len(self.trials), self.plan.trials, self.plan.metric, self.plan.settings.get("env"),
            self.shown(best.value) if best else None,
            f"trials/{best.number:04}/{seed_folder(seed.seed)}" if best and seed else None, self.importance,
        )  # fmt: skip
        write_text(self.folder / SUMMARY_FILE, json.dumps(asdict(summary), indent=2) + "\n", flush=False)

    # Reading

    def trial_folder(self, number: int) -> Path:
        """Return the folder of a finished trial."""
        return self.folder / "trials" / f"{number:04}"

    def run_folder(self, trial: FinishedTrial, seed: int) -> Path | None:
        """Return the folder of a run that was kept; None if it was not, as of trials that were stopped early."""
        folder = self.trial_folder(trial.number) / seed_folder(seed)
        return folder if folder.is_dir() else None

    def runs_of(self, number: int) -> bytes:
        """Return the runs of a finished trial as one archive; raises OSError."""
        folder = self.trial_folder(number)
        for seed in self.plan.seeds:
            run = folder / seed_folder(seed)
            if run.exists() and (stranger := (DIGITS_KIND if self.plan.kind == DIGITS else KIND).stranger(run)):
                raise OSError(errno.EINVAL, f"holds something else than a run ({stranger})", str(run))
        return archive(folder)

    def ranked(self) -> list[FinishedTrial]:
        """Return the trials that have a value, the best first; those that ran to their end before those stopped."""
        sign = 1 if self.metric.mode == "min" else -1
        known = [trial for trial in self.trials.values() if trial.value is not None]
        return sorted(known, key=lambda trial: (trial.stopped, sign * (trial.value or 0.0), trial.number))

    def best(self) -> FinishedTrial | None:
        """Return the best trial; of a population, of its last generation that is whole. None before there is one."""
        ranked = self.ranked()
        if self.plan.population:
            whole = [
                number
                for number in range(self.plan.generations)
                if len(self.generation(number)) == self.plan.population
            ]
            last = whole[-1] if whole else 0
            ranked = [trial for trial in ranked if self.plan.generation(trial.number) == last]
        return ranked[0] if ranked else None

    def generation(self, number: int) -> list[FinishedTrial]:
        """Return the finished members of a generation, by number."""
        return [each for _, each in sorted(self.trials.items()) if self.plan.generation(each.number) == number]

    def shown(self, value: float | None) -> str:
        """Return a value of the metric as a table shows it."""
        return self.metric.shown(value, self.plan.budget)


def _numbered(folder: Path, suffix: str = "") -> list[Path]:
    """Return the paths in a folder that are called by the number of a trial, sorted."""
    try:
        found = [path for path in folder.iterdir() if path.suffix == suffix and _NAME.fullmatch(path.stem)]
    except OSError:
        return []
    return sorted(found, key=lambda path: int(path.stem))


def find(name: str, user_dir: Path) -> Path:
    """Return the folder of a study: among the user's by name, or where a path leads."""
    return Path(name) if "/" in name or "\\" in name else user_dir / STUDIES / name
