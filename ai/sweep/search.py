"""What a study tries next: settings that Optuna proposes, or the members of a population.

Comes with the extra `sweep`. Optuna keeps trials and settings in its journal, which its own tools read. Optuna trusts
a journal, so we never read one: when a study goes on, a new one is begun, and Optuna gets the finished trials again, in
their order and through the calls that it got them by at first. Each was checked when it was read: of a study that
somebody else has made, nothing reaches Optuna but settings and values.
"""

from __future__ import annotations

import json
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Final

import numpy as np
import optuna
from optuna.storages import JournalStorage
from optuna.storages.journal import BaseJournalBackend
from optuna.trial import TrialState

from ai.sweep.plan import RANDOM, Dimension, Space
from ai.sweep.study import Asked, FinishedTrial, Study

JOURNAL: Final = "journal.jsonl"
LEAST: Final = 8  # trials below which nothing is said of importance
_REDUCTION: Final = 3  # successive halving: one trial in three goes on at each rung
_SHARE: Final = 4  # one member in four is replaced by a copy of one of the best quarter
_REDRAWN: Final = 0.25  # chance that a copied knob is drawn anew, as in the paper
_FACTORS: Final = (0.8, 1.2)


class Journal(BaseJournalBackend):
    """A new journal in a file that this process alone writes; Optuna's own waits for the disk at each line."""

    def __init__(self, path: Path) -> None:
        self._lines: list[dict[str, Any]] = []
        self._path = path
        path.write_bytes(b"")

    def read_logs(self, log_number_from: int) -> Iterator[dict[str, Any]]:
        """Yield the lines from a number on."""
        yield from self._lines[log_number_from:]

    def append_logs(self, logs: list[dict[str, Any]]) -> None:
        """Append lines; raises OSError."""
        lines = [json.dumps(each) for each in logs]
        with self._path.open("a", encoding="utf-8") as file:
            file.write("\n".join(lines) + "\n")
        self._lines += map(json.loads, lines)


class Search:
    """What the driver asks for trials, and to which it tells how they go."""

    def next(self) -> Asked | None:
        """Return the next trial, one that was interrupted or a new one; None for no more, or for none yet."""
        raise NotImplementedError

    def falls_behind(self, trial: FinishedTrial) -> bool:  # noqa: ARG002
        """Note how good a trial is so far; return whether others are so much better that it should end."""
        return False

    def tell(self, trial: FinishedTrial) -> None:
        """Note the end of a trial."""

    def importance(self) -> dict[str, float]:
        """Return the share that each knob has in setting the best trials apart, the most important first."""
        return {}


class Proposals(Search):
    """Optuna's study beside ours; raises OSError, as for a full disk."""

    def __init__(self, study: Study) -> None:
        optuna.logging.set_verbosity(optuna.logging.ERROR)
        warnings.simplefilter("ignore", optuna.exceptions.ExperimentalWarning)
        plan = study.plan
        # Another seed each time, or a study that goes on would propose once more what it began with.
        seed = plan.seed * 1_000_003 + len(study.trials) & 0x7FFFFFFF
        tpe = optuna.samplers.TPESampler
        random = plan.search == RANDOM
        self._study = study
        self._optuna = optuna.create_study(
            storage=JournalStorage(Journal(study.folder / JOURNAL)),
            study_name=study.folder.name,
            sampler=optuna.samplers.RandomSampler(seed) if random else tpe(seed=seed, constant_liar=True),
            pruner=optuna.pruners.SuccessiveHalvingPruner(min_resource=1, reduction_factor=_REDUCTION),
            direction="minimize" if study.metric.sign == 1 else "maximize",
        )
        self._distributions = {name: _distribution(dimension) for name, dimension in plan.space.items()}
        self._trials: dict[int, optuna.Trial] = {}  # under way, by our number
        for number, trial in sorted(study.trials.items()):
            self._ask(number, trial.params)
            at = plan.every
            while at <= trial.at:  # where a rung of the pruner is; elsewhere it looks at nothing
                self.falls_behind(study.so_far(trial, at))
                at *= _REDUCTION
            self.tell(trial)

    def _ask(self, number: int, params: dict[str, Any] | None = None) -> Asked:
        """Begin a trial, with these settings or such as Optuna proposes."""
        space = self._study.plan.space
        if params is not None:
            given = {name: json.dumps(each) if space[name].choices else each for name, each in params.items()}
            self._optuna.enqueue_trial(given)
        trial = self._trials[number] = self._optuna.ask(self._distributions)
        drawn = {name: json.loads(each) if space[name].choices else each for name, each in trial.params.items()}
        return Asked(number, drawn)

    def next(self) -> Asked | None:
        study = self._study
        if len(study.trials) + len(self._trials) >= study.plan.trials:
            return None
        for number, asked in sorted(study.under_way.items()):
            if number not in self._trials:
                return self._ask(number, asked.params)
        known = (*study.trials, *study.damaged, *study.under_way, *self._trials)
        return self._ask(1 + max(known, default=-1))

    def falls_behind(self, trial: FinishedTrial) -> bool:
        if not self._study.plan.stop_early or trial.value is None:
            return False
        noted = self._trials[trial.number]
        noted.report(trial.value, trial.at // self._study.plan.every)
        return bool(noted.should_prune())

    def tell(self, trial: FinishedTrial) -> None:
        state = TrialState.FAIL if trial.value is None else TrialState.COMPLETE
        self._optuna.tell(self._trials.pop(trial.number), trial.value, state=state)

    def importance(self) -> dict[str, float]:
        """Return the shares of PED-ANOVA (Watanabe, Bansal and Hutter 2023); none for few trials, or equal values."""
        known = [trial.value for trial in self._study.trials.values() if trial.value is not None]
        if len(known) < LEAST or len(set(known)) < 2:
            return {}
        evaluator = optuna.importance.PedAnovaImportanceEvaluator()
        shares: dict[str, float] = optuna.importance.get_param_importances(self._optuna, evaluator=evaluator)
        return shares


class Population(Search):
    """Population-based training (Jaderberg et al. 2017), in generations.

    Every member of a generation trains for the same number of decisions. Then the worst quarter goes on with copies of
    runs of the best quarter, and with their knobs, changed a little; the others go on with their own.

    The paper lets members copy whenever they are ready. Here a generation waits for its last member. So what a member
    is asked to do follows from the finished trials and the study's seed alone: not from the number of workers, nor
    from who was first, nor from whether the study was interrupted.
    """

    def __init__(self, study: Study) -> None:
        self._study = study
        known = {*study.trials, *study.damaged}
        self._left = [number for number in range(study.plan.trials) if number not in known]

    def next(self) -> Asked | None:
        asked = proposed(self._study, self._left[0]) if self._left else None
        if asked is not None:
            self._left.pop(0)
        return asked


def proposed(study: Study, number: int) -> Asked | None:
    """Return what trial `number` of a population is asked; None as long as the generation before it is not whole."""
    plan = study.plan
    rng, generation = np.random.default_rng([plan.seed, number]), plan.generation(number)
    if generation == 0:
        return Asked(number, {name: dimension.draw(rng) for name, dimension in plan.space.items()})
    before = study.generation(generation - 1)
    if len(before) < plan.population:
        return None
    own, few, sign = before[number % plan.population], max(1, plan.population // _SHARE), study.metric.sign
    ranked = sorted(before, key=lambda trial: (trial.value is None, sign * (trial.value or 0.0), trial.number))
    if all(own is not each for each in ranked[-few:]):
        return Asked(number, own.params, own.number)
    source = ranked[int(rng.integers(few))]
    return Asked(number, explored(source.params, plan.space, rng), source.number)


def explored(params: dict[str, Any], space: Space, rng: np.random.Generator) -> dict[str, Any]:
    """Return knobs near those given: each times 0.8 or 1.2, or the next choice, or now and then drawn anew."""
    changed = {}
    for name, dimension in space.items():
        if rng.random() < _REDRAWN:
            changed[name] = dimension.draw(rng)
        elif dimension.choices:
            step = 1 / max(1, len(dimension.choices) - 1)
            changed[name] = dimension.at(dimension.place(params[name]) + step * rng.choice((-1, 1)))
        else:
            value = min(dimension.high, max(dimension.low, params[name] * rng.choice(_FACTORS)))
            changed[name] = round(value) if dimension.whole else float(value)
    return changed


def _distribution(dimension: Dimension) -> Any:
    if dimension.choices:
        return optuna.distributions.CategoricalDistribution([json.dumps(value) for value in dimension.choices])
    if dimension.whole:
        return optuna.distributions.IntDistribution(int(dimension.low), int(dimension.high), log=dimension.log)
    return optuna.distributions.FloatDistribution(dimension.low, dimension.high, log=dimension.log)
