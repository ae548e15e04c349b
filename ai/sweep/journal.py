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

from ai.files import OneOf, Sized, Within, brief, parse_json, read_as, read_text, write_text
from ai.files.schema import Count
from ai.sweep.plan import RANDOM
from ai.sweep.results import FinishedTrial
from ai.sweep.space import Dimension
from ai.sweep.study import Study, StudyError

JOURNAL: Final = "journal.jsonl"
REDUCTION: Final = 3  # successive halving: one trial in three goes on at each rung
LEAST: Final = 8  # trials below which nothing is said of importance
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
    """Optuna's study beside ours: which trials there are, and what they are asked to try."""

    def __init__(self, study: Study) -> None:
        """Open the journal of a study that is claimed; raises StudyError for one that cannot be read."""
        optuna.logging.set_verbosity(optuna.logging.ERROR)
        warnings.simplefilter("ignore", optuna.exceptions.ExperimentalWarning)
        self._study, self._space = study, study.plan.dimensions()
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
            self._study.check_params(self.params(row.number))
        except (ValueError, TypeError, KeyError):  # as of a trial that was cut off before all knobs were drawn
            if not self._study.plan.population:  # what a member is asked follows from those before it
                self._optuna.tell(row.number, state=TrialState.FAIL)
                return False
        return True

    def _trial(self, number: int) -> Trial:
        return Trial(self._optuna, self._optuna._storage.get_trial_id_from_study_id_trial_number(0, number))

    def params(self, number: int) -> dict[str, Any]:
        """Return the settings of a trial."""
        asked = self._trial(number).params
        return {name: json.loads(value) if self._space[name].choices else value for name, value in asked.items()}

    def ask(self, params: dict[str, Any] | None = None) -> int:
        """Return the number of a new trial, with Optuna's settings or with those given; raises OSError."""
        trial = self._optuna.ask(_distributions(self._study) if params is None else {})
        if params is not None:
            trial.set_user_attr("params", params)
        number: int = trial.number
        return number

    def falls_behind(self, trial: FinishedTrial) -> bool:
        """Note how good a trial is so far; return whether others are so much better that it should end."""
        if not self._study.plan.stop_early or trial.value is None:
            return False
        noted = self._trial(trial.number)
        noted.report(trial.value, trial.at // self._study.plan.every)
        return bool(noted.should_prune())

    def tell(self, trial: FinishedTrial) -> None:
        """Note the end of a trial."""
        state = TrialState.FAIL if trial.value is None else TrialState.COMPLETE
        self._optuna.tell(trial.number, trial.value, state=state)


def importance_of(study: Study) -> dict[str, float]:
    """Return the share that each knob has in setting the best trials apart, the most important first.

    PED-ANOVA (Watanabe, Bansal and Hutter 2023), as Optuna computes it. Empty for a population, whose knobs change on
    the way, for too few trials, and for equal values.
    """
    known = [trial for _, trial in sorted(study.trials.items()) if trial.value is not None]
    if study.plan.population or len(known) < LEAST or len({trial.value for trial in known}) < 2:
        return {}
    optuna.logging.set_verbosity(optuna.logging.ERROR)
    warnings.simplefilter("ignore", optuna.exceptions.ExperimentalWarning)
    beside = optuna.create_study(direction="minimize" if study.metric.mode == "min" else "maximize")
    distributions = _distributions(study)
    for trial in known:
        params = {name: _plain(each, trial.params[name]) for name, each in study.plan.dimensions().items()}
        beside.add_trial(optuna.create_trial(params=params, distributions=distributions, value=trial.value))
    evaluator = optuna.importance.PedAnovaImportanceEvaluator()
    shares: dict[str, float] = optuna.importance.get_param_importances(beside, evaluator=evaluator)
    return shares


def _opened(study: Study) -> optuna.Study:
    plan = study.plan
    storage = JournalStorage(Journal(study.folder / JOURNAL))
    # Another seed each time, or a study that goes on would propose once more what it began with.
    seed = plan.seed * 1_000_003 + len(study.trials) & 0x7FFFFFFF
    tpe = optuna.samplers.TPESampler
    sampler = optuna.samplers.RandomSampler(seed) if plan.search == RANDOM else tpe(seed=seed, constant_liar=True)
    pruner = optuna.pruners.SuccessiveHalvingPruner(min_resource=1, reduction_factor=REDUCTION)
    direction = "minimize" if study.metric.mode == "min" else "maximize"
    return optuna.create_study(
        storage=storage, sampler=sampler, pruner=pruner, study_name="study", direction=direction, load_if_exists=True
    )


def _distributions(study: Study) -> dict[str, Any]:
    return {name: _distribution(dimension) for name, dimension in study.plan.dimensions().items()}


def _distribution(dimension: Dimension) -> Any:
    if dimension.choices:
        return optuna.distributions.CategoricalDistribution([json.dumps(value) for value in dimension.choices])
    if dimension.whole:
        return optuna.distributions.IntDistribution(int(dimension.low), int(dimension.high), log=dimension.log)
    return optuna.distributions.FloatDistribution(dimension.low, dimension.high, log=dimension.log)


def _plain(dimension: Dimension, value: Any) -> Any:
    return json.dumps(value) if dimension.choices else value
