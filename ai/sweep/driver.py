"""Trials of a study: Optuna asks for settings, Ray's tasks train them, and this process alone writes the study.

Comes with the extra `sweep`. Optuna keeps nothing on disk: when a study goes on, it is told the finished trials, each
checked when it was read. Ray begins a trial whose worker or node dies again elsewhere.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import fields
from itertools import count
from typing import Any, Final

import optuna
import ray
from optuna.distributions import CategoricalDistribution, FloatDistribution, IntDistribution
from optuna.trial import TrialState, create_trial
from ray.exceptions import RayError, RayTaskError

from ai.files.knobs import Knobs
from ai.files.reading import brief
from ai.sweep.design import choices_of
from ai.sweep.study import Study
from ai.sweep.trial import trained

RETRIES: Final = 3  # of a trial whose worker dies; after that it waits for --resume
MOST_LOST: Final = 10  # trials that could not be made, after which no other is begun
_TURN: Final = 0.2  # seconds after which a wait for workers looks around


class Proposals:
    """Optuna's side of a study: settings to try next, and what came of them."""

    def __init__(self, study: Study) -> None:
        optuna.logging.set_verbosity(optuna.logging.ERROR)
        design, config = study.design, study.design.config
        self._distributions = {name: _distribution(config, name) for name in design.knobs}
        # Another seed each time, or a study that goes on would propose once more what it began with.
        seed = design.seed * 1_000_003 + len(study.trials) & 0x7FFFFFFF
        self._optuna = optuna.create_study(
            direction="minimize" if study.metric.sign == 1 else "maximize",
            sampler=optuna.samplers.TPESampler(seed=seed, constant_liar=True),  # so many at once are not the same
        )
        for trial in study.ranked():
            given = {name: json.dumps(value) if self._chosen(name) else value for name, value in trial.params.items()}
            self._optuna.add_trial(create_trial(params=given, distributions=self._distributions, value=trial.value))

    def ask(self) -> tuple[int, dict[str, Any]]:
        """Return settings to try, and the number by which Optuna is told of them."""
        asked = self._optuna.ask(self._distributions)
        return asked.number, {
            name: json.loads(value) if self._chosen(name) else value for name, value in asked.params.items()
        }

    def tell(self, number: int, value: float | None) -> None:
        """Note what came of settings; None for nothing."""
        self._optuna.tell(number, value, state=TrialState.FAIL if value is None else TrialState.COMPLETE)

    def _chosen(self, name: str) -> bool:
        """Whether a knob has choices, which Optuna knows as texts."""
        return isinstance(self._distributions[name], CategoricalDistribution)


def _distribution(config: Knobs, name: str) -> Any:
    if choices := choices_of(config, name):
        return CategoricalDistribution([json.dumps(value) for value in choices])
    item = next(item for item in fields(config) if item.name == name)
    low, high, log = (item.metadata[end] for end in ("low", "high", "log"))
    return (
        IntDistribution(int(low), int(high), log=log) if item.type == "int" else FloatDistribution(low, high, log=log)
    )


def run(study: Study, workers: int, stop: Sequence[int], report: Callable[[int], None]) -> dict[int, str]:
    """Run the trials that a study has left, on the Ray that was joined, until all are done or the user says stop.

    `report` is told now and then how many are under way. Returns why trials could not be made, by number; raises
    OSError where a trial cannot be written.
    """
    proposals, train = Proposals(study), ray.remote(num_cpus=1, max_retries=RETRIES)(trained)
    numbers = (number for number in count() if number not in study.trials and number not in study.damaged)
    jobs: dict[Any, tuple[int, int]] = {}  # number of each trial under way, and Optuna's number, by Ray's task
    lost: dict[int, str] = {}
    while not stop:
        left = study.design.trials - len(study.trials) - len(lost)
        while len(jobs) < min(workers, left) and len(lost) < MOST_LOST:
            number, (asked, params) = next(numbers), proposals.ask()
            jobs[train.remote(study.design, number, params)] = number, asked
        if not jobs:
            break
        for task in ray.wait(list(jobs), timeout=_TURN)[0]:
            number, asked = jobs.pop(task)
            try:
                trial, files = ray.get(task)
            except RayError as error:
                cause = str(error.cause) if isinstance(error, RayTaskError) else str(error)
                lost[number] = brief(cause.strip().rpartition("\n")[2])
                proposals.tell(asked, None)
            else:
                study.record(trial, files)
                proposals.tell(asked, trial.value)
        report(len(jobs))
    return lost
