"""Searches of Ray Tune over a study: Optuna's, which knows the trials there are, and populations.

Comes with the extra `sweep`.
"""

from __future__ import annotations

import json
import math
import warnings
from pathlib import Path
from typing import Any, Final

import optuna
import ray
from ray.tune.search import Searcher
from ray.tune.search.optuna import OptunaSearch

from ai.sweep.plan import RANDOM
from ai.sweep.population import proposed
from ai.sweep.space import Dimension
from ai.sweep.study import Study
from ai.sweep.trial import Asked

VALUE: Final = "value"  # what a trial reports: its value so far,
AT: Final = "at"  # and how far it is


class StudySearch(OptunaSearch):
    """Optuna's search that knows the trials a study has: finished ones as evidence, interrupted ones to do first."""

    def __init__(self, study: Study, shared: dict[str, Any]) -> None:
        self._study, self._shared, self._space_of = study, shared, study.plan.dimensions()
        self._left = sorted(study.begun)
        self._next = study.next_number
        # Another seed each time, or a study that goes on would propose once more what it began with.
        seed = study.plan.seed * 1_000_003 + self._next & 0x7FFFFFFF
        with warnings.catch_warnings(action="ignore", category=optuna.exceptions.ExperimentalWarning):
            sampler = (
                optuna.samplers.RandomSampler(seed=seed)
                if study.plan.search == RANDOM
                else optuna.samplers.TPESampler(seed=seed, constant_liar=True)
            )
        super().__init__(
            space={name: _distribution(dimension) for name, dimension in self._space_of.items()},
            metric=VALUE,
            mode=study.metric.mode,
            points_to_evaluate=[self._encoded(study.begun[number].params) for number in self._left],
            sampler=sampler,
        )
        for trial in study.trials.values():
            self.add_evaluated_point(self._encoded(trial.params), trial.value or 0.0, error=trial.value is None)

    def suggest(self, trial_id: str) -> dict[str, Any] | None:
        """Return what a new trial is asked to do."""
        given: dict[str, Any] | None = super().suggest(trial_id)
        if given is None:
            return None
        params = {name: _decoded(self._space_of[name], value) for name, value in given.items()}
        if self._left:
            number = self._left.pop(0)
        else:
            number, self._next = self._next, self._next + 1
        self._study.begin(number, params)
        return _config(Asked(number, params), self._shared)

    def on_trial_result(self, trial_id: str, result: dict[str, Any]) -> None:
        """Pass over what is measured on the way; only the end counts as evidence."""

    def on_trial_complete(self, trial_id: str, result: dict[str, Any] | None = None, error: bool = False) -> None:
        """Learn from a trial that is over."""
        known = result is not None and not math.isnan(result.get(VALUE, math.nan))
        super().on_trial_complete(trial_id, result if known else None, error=error or not known)

    def save(self, checkpoint_path: str) -> None:
        """Save nothing: the study's folder has it all."""
        Path(checkpoint_path).touch()

    def _encoded(self, params: dict[str, Any]) -> dict[str, Any]:
        return {name: _plain(self._space_of[name], value) for name, value in params.items()}


class PopulationSearch(Searcher):
    """Members of a population, generation by generation."""

    def __init__(self, study: Study, shared: dict[str, Any]) -> None:
        super().__init__(metric=VALUE, mode=study.metric.mode)
        self._study, self._shared = study, shared
        self._left = [number for number in range(study.plan.trials) if number not in study.trials]
        self._lost = False
        self._parents: dict[int, Any] = {}

    def suggest(self, trial_id: str) -> dict[str, Any] | str | None:
        """Return what the next member is asked to do; None while the generation before it is not whole."""
        if not self._left or self._lost:
            return str(Searcher.FINISHED)
        asked = proposed(self._study, self._left[0])
        if asked is None:
            return None
        self._left.pop(0)
        self._study.begin(asked.number, asked.params, asked.parent.number if asked.parent else None)
        runs = self._runs(asked.parent.number) if asked.parent else None
        return _config(asked, self._shared, runs)

    def _runs(self, number: int) -> Any:
        """Return a reference to the runs of a finished trial, which is put into Ray's store once."""
        if number not in self._parents:
            self._parents[number] = ray.put(self._study.runs_of(number))
        return self._parents[number]

    def on_trial_complete(self, trial_id: str, result: dict[str, Any] | None = None, error: bool = False) -> None:
        """Note a member that is lost: the next generation cannot begin without it."""
        self._lost = self._lost or error or bool(result and result.get("failed"))

    def save(self, checkpoint_path: str) -> None:
        """Save nothing: the study's folder has it all."""
        Path(checkpoint_path).touch()

    def restore(self, checkpoint_path: str) -> None:
        """Restore nothing."""


def _config(asked: Asked, shared: dict[str, Any], runs: Any = None) -> dict[str, Any]:
    """Return what Tune hands to a worker; as text, which Tune does not look into."""
    parent = asked.parent.to_json() if asked.parent else None
    told = {"number": asked.number, "params": asked.params, "parent": parent}
    return {**shared, "asked": json.dumps(told), "runs": runs, "so_far": ""}


def _distribution(dimension: Dimension) -> optuna.distributions.BaseDistribution:
    if dimension.choices:
        return optuna.distributions.CategoricalDistribution([json.dumps(value) for value in dimension.choices])
    if dimension.whole:
        return optuna.distributions.IntDistribution(int(dimension.low), int(dimension.high), log=dimension.log)
    return optuna.distributions.FloatDistribution(dimension.low, dimension.high, log=dimension.log)


def _plain(dimension: Dimension, value: Any) -> Any:
    return json.dumps(value) if dimension.choices else value


def _decoded(dimension: Dimension, value: Any) -> Any:
    return json.loads(value) if dimension.choices else value
