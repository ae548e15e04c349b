"""Optuna's part of a study: it keeps trials and settings in a journal, proposes settings and stops trials early.

Comes with the extra `sweep`. Optuna is handed its journal by us, each line checked: what a stranger's study says is
bounded, and nothing of it starts code.
"""

from __future__ import annotations

import json
import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Final

import optuna
from optuna.storages import JournalStorage
from optuna.storages.journal import BaseJournalBackend
from optuna.trial import Trial, TrialState

from ai.files import Count, OneOf, Sized, Within, brief, parse_json, read_as, read_text, write_text
from ai.sweep.plan import RANDOM
from ai.sweep.space import Dimension
from ai.sweep.study import FinishedTrial, Study, StudyError
from ai.sweep.trial import Asked

JOURNAL: Final = "journal.jsonl"
LEAST: Final = 8  # trials below which nothing is said of importance
_REDUCTION: Final = 3  # successive halving: one trial in three goes on at each rung
_MOST: Final = 64_000_000  # bytes of a journal
_Word = Annotated[str, Sized(100)]


@dataclass(frozen=True)
class _Line:
    """Line of a journal: the operations of Optuna that a study needs, by their numbers, and what they come with."""

    op_code: Annotated[int, OneOf((0, 4, 5, 6, 7, 8, 9))]
    worker_id: _Word
    study_name: Annotated[str, OneOf(("study",))] = "study"
    directions: tuple[Annotated[int, Within(1, 2)], ...] = ()
    study_id: Annotated[int, Within(0, 0)] = 0
    trial_id: Count = 0
    datetime_start: _Word | None = None
    datetime_complete: _Word | None = None
    param_name: _Word = ""
    param_value_internal: float = 0.0
    distribution: Annotated[str, Sized(10_000)] = ""
    state: Annotated[int, Within(0, 4)] = 0
    values: tuple[float, ...] | None = None
    step: Count = 0
    intermediate_value: float = 0.0
    user_attr: dict[str, Any] | None = None
    system_attr: dict[str, Any] | None = None


class Journal(BaseJournalBackend):
    """Journal in a file that one process writes; a line that was cut off by a kill is left out.

    Raises OSError, or ValueError for a line that is none of Optuna's.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        text = read_text(path, _MOST) if path.exists() else ""
        whole = text[: text.rfind("\n") + 1]
        self._lines = [parse_json(line) for line in whole.splitlines()]
        for line in self._lines:
            read_as(_Line, line, strict=True)
        if whole != text:
            write_text(path, whole)

    def read_logs(self, log_number_from: int) -> Iterator[dict[str, Any]]:
        """Yield the lines from a number on."""
        yield from self._lines[log_number_from:]

    def append_logs(self, logs: list[dict[str, Any]]) -> None:
        """Append lines, all or none; raises OSError."""
        with self._path.open("ab") as file:
            end = file.tell()
            try:
                file.write("".join(json.dumps(line) + "\n" for line in logs).encode())
                file.flush()
            except OSError:
                file.truncate(end)
                raise
        self._lines += json.loads(json.dumps(logs))


class Search:
    """Optuna's study beside ours, as the driver asks it for trials; raises StudyError for one that cannot be read.

    Our study's files are right where the two differ, and Optuna is told.
    """

    def __init__(self, study: Study) -> None:
        optuna.logging.set_verbosity(optuna.logging.ERROR)
        warnings.simplefilter("ignore", optuna.exceptions.ExperimentalWarning)
        self._study, self._room = study, study.plan.trials - len(study.trials)
        try:
            self._optuna = _opened(study)
            rows = self._optuna.trials
            if strange := [number for number in (*study.trials, *study.damaged) if number >= len(rows)]:
                raise ValueError(f"it does not know trial {strange[0]}")
            self.left = [row.number for row in rows if self._is_left(row)]  # under way when the study was interrupted
        except OSError:
            raise
        except Exception as error:  # Optuna trusts its journal: any nonsense in one may surface as anything
            raise StudyError(f"{study.folder} has a {JOURNAL} that cannot be read: {brief(error)}") from error

    def _is_left(self, row: Any) -> bool:
        """Whether a trial of the journal is to be run; tell Optuna what the study's files say of any other."""
        if row.state.is_finished() or row.number in self._study.damaged:
            return False
        if (done := self._study.trials.get(row.number)) is not None:
            self.tell(done)
            return False
        try:
            for name, distribution in _distributions(self._study).items():  # it may have been cut off amid these
                self._trial(row.number)._suggest(name, distribution)
            self._study.check_params(self.params(row.number))
        except (ValueError, TypeError, KeyError):
            self._optuna.tell(row.number, state=TrialState.FAIL)
            return False
        return True

    def _trial(self, number: int) -> Trial:
        return Trial(self._optuna, self._optuna._storage.get_trial_id_from_study_id_trial_number(0, number))

    def params(self, number: int) -> dict[str, Any]:
        """Return the settings of a trial."""
        space, asked = self._study.plan.space, self._trial(number).params
        return {name: json.loads(value) if space[name].choices else value for name, value in asked.items()}

    def next(self) -> Asked | None:
        """Return the next trial, one that was interrupted or a new one; None for no more. Raises OSError."""
        if not self._room:
            return None
        number = self.left[0] if self.left else self._optuna.ask(_distributions(self._study)).number
        self.left, self._room = self.left[1:], self._room - 1
        return Asked(number, self.params(number))

    def falls_behind(self, trial: FinishedTrial) -> bool:
        """Note how good a trial is so far; return whether others are so much better that it should end."""
        if not self._study.plan.stop_early or trial.value is None:
            return False
        noted = self._trial(trial.number)
        noted.report(trial.value, trial.at // self._study.plan.every)
        return bool(noted.should_prune())

    def tell(self, trial: FinishedTrial) -> None:
        """Note the end of a trial; raises OSError."""
        state = TrialState.FAIL if trial.value is None else TrialState.COMPLETE
        self._optuna.tell(trial.number, trial.value, state=state)

    def importance(self) -> dict[str, float]:
        """Return the share that each knob has in setting the best trials apart, the most important first.

        PED-ANOVA (Watanabe, Bansal and Hutter 2023). Empty for too few trials, and for equal values.
        """
        known = [trial.value for trial in self._study.trials.values() if trial.value is not None]
        if len(known) < LEAST or len(set(known)) < 2:
            return {}
        evaluator = optuna.importance.PedAnovaImportanceEvaluator()
        shares: dict[str, float] = optuna.importance.get_param_importances(self._optuna, evaluator=evaluator)
        return shares


def _opened(study: Study) -> optuna.Study:
    plan = study.plan
    # Another seed each time, or a study that goes on would propose once more what it began with.
    seed = plan.seed * 1_000_003 + len(study.trials) & 0x7FFFFFFF
    tpe = optuna.samplers.TPESampler
    return optuna.create_study(
        storage=JournalStorage(Journal(study.folder / JOURNAL)),
        sampler=optuna.samplers.RandomSampler(seed) if plan.search == RANDOM else tpe(seed=seed, constant_liar=True),
        pruner=optuna.pruners.SuccessiveHalvingPruner(min_resource=1, reduction_factor=_REDUCTION),
        study_name="study",
        direction="minimize" if study.metric.sign == 1 else "maximize",
        load_if_exists=True,
    )


def _distributions(study: Study) -> dict[str, Any]:
    return {name: _distribution(dimension) for name, dimension in study.plan.space.items()}


def _distribution(dimension: Dimension) -> Any:
    if dimension.choices:
        return optuna.distributions.CategoricalDistribution([json.dumps(value) for value in dimension.choices])
    if dimension.whole:
        return optuna.distributions.IntDistribution(int(dimension.low), int(dimension.high), log=dimension.log)
    return optuna.distributions.FloatDistribution(dimension.low, dimension.high, log=dimension.log)
