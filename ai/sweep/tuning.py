"""Trials of a study on Ray Tune: Optuna's search, ASHA, populations, and workers that may die.

Comes with the extra `sweep`. Tune decides what runs where and starts again what was lost. What a study is, lies in its
folder alone: nothing is read back from Tune's own files, which are thrown away. docs/adr/0015 says why.
"""

from __future__ import annotations

import json
import logging
import math
import os
import tempfile
import time
import warnings
from collections.abc import Sequence
from types import SimpleNamespace
from typing import Any, Final

import optuna
import ray
from ray import tune
from ray.tune.schedulers import ASHAScheduler, FIFOScheduler, TrialScheduler
from ray.tune.search import Searcher

from ai.files import brief, read_as
from ai.nn import ModelFormatError
from ai.sweep.metric import Metric
from ai.sweep.plan import POPULATION, Plan
from ai.sweep.results import FinishedTrial
from ai.sweep.runs import check_ready, read_config
from ai.sweep.searches import AT, VALUE, PopulationSearch, StudySearch
from ai.sweep.study import Study
from ai.sweep.table import Table
from ai.sweep.trial import Asked, Trial, fingerprint

CHECKPOINT_SECONDS: Final = 20.0  # between two checkpoints of a trial
TRIES: Final = 4  # of a trial whose worker dies; after that it waits for --resume
REDUCTION: Final = 3  # ASHA: one trial in three goes on at each rung


class OtherCodeError(RuntimeError):
    """A node of the cluster has other code than the process that runs the study."""


class SweepTrial(tune.Trainable):
    """Trial as Tune runs it: a step trains all seeds up to the next mark. A worker takes one trial after another."""

    def setup(self, config: dict[str, Any]) -> None:
        """Begin the trial that `config` asks for."""
        if config["code"] != fingerprint():
            raise OtherCodeError("this node has another version of Tranquility than the one that runs the study")
        asked = json.loads(config["asked"])
        parent = FinishedTrial.from_json(asked["parent"]) if asked["parent"] else None
        self._asked = Asked(asked["number"], asked["params"], parent)
        self._trial: Trial | None = None
        self._problem, self._failed, self._kept = "", False, time.monotonic()
        plan = read_as(Plan, json.loads(config["plan"]))
        try:
            check_ready(read_config(plan.kind, plan.settings))
        except (ValueError, ImportError) as error:  # what is missing on this node is no result of a trial
            self._problem, self._failed = brief(error), True
            return
        so_far = FinishedTrial.from_json(json.loads(config["so_far"])) if config["so_far"] else None
        try:
            self._trial = Trial(plan, self._asked, ray.get(config["runs"]) if config["runs"] else b"", so_far)
        except ValueError as error:  # settings that make no sense together, unless it is the parent
            self._problem, self._failed = brief(error), isinstance(error, ModelFormatError)

    def reset_config(self, new_config: dict[str, Any]) -> bool:
        """Begin another trial in the same process."""
        self.setup(new_config)
        return True

    def step(self) -> dict[str, Any]:
        """Train up to the next mark; at the end, save the runs and give them over."""
        if self._trial is None:
            nothing = FinishedTrial(
                self._asked.number, self._asked.params, None, 0, False, 0.0, (), None, self._problem
            )
            return _report(nothing, finished=True) | {"failed": self._failed}
        if not self._trial.done:
            self._trial.step()
        if not self._trial.done:
            return _report(self._trial.result(), runs=self._checkpoint(self._trial))
        result, runs = self._trial.finish()
        return _report(result, finished=True, runs=runs)

    def _checkpoint(self, trial: Trial) -> bytes:
        """Return the runs as they are now, as often as `train` keeps its own; else nothing."""
        if time.monotonic() - self._kept < CHECKPOINT_SECONDS:
            return b""
        self._kept = time.monotonic()
        return trial.checkpoint()

    def save_checkpoint(self, checkpoint_dir: str) -> None:
        """Save nothing: Tune's checkpoints need a disk that all nodes share. `Recorder` keeps the last one."""

    def load_checkpoint(self, checkpoint: Any) -> None:
        """Load nothing."""


def _report(result: FinishedTrial, finished: bool = False, runs: bytes = b"") -> dict[str, Any]:
    value = math.nan if result.value is None else result.value
    told = json.dumps(result.to_json())
    return {
        VALUE: value, AT: result.at, "told": told, "runs": runs, "finished": finished, "failed": False,
        "done": finished,
    }  # fmt: skip


class Recorder(tune.Callback):
    """Keeps every trial in the study as soon as it is over, and tells the table.

    What cannot be written now, as the disk is full, waits in memory and is tried again.
    """

    def __init__(self, study: Study, table: Table, stop: Sequence[int]) -> None:
        self._study, self._table, self._stop = study, table, stop
        self._waiting: list[tuple[FinishedTrial, bytes]] = []
        self.lost: dict[int, str] = {}  # trials that failed, or whose workers died too often, and the last reason
        self.trouble = ""

    def on_trial_start(self, iteration: int, trials: list[Any], trial: Any, **info: Any) -> None:
        """Show a trial that runs."""
        asked = json.loads(trial.config["asked"])
        self._table.begin(asked["number"], asked["params"])

    def on_trial_result(
        self, iteration: int, trials: list[Any], trial: Any, result: dict[str, Any], **info: Any
    ) -> None:
        """Keep a trial that is over: at its end, or because the scheduler has stopped it."""
        told = FinishedTrial.from_json(json.loads(result.pop("told")))
        runs = result.pop("runs")  # not to be kept in memory by Tune
        if result["failed"]:
            self._lose(told.number, told.problem)
        elif result["finished"] or (result.get("done") and not self._stop):
            self._waiting.append((told, runs if result["finished"] else b""))
            self.write()
            self._table.finish(told)
        else:
            self._table.progress(told)
            if runs:  # what a worker is asked to go on with, if this one dies
                trial.config |= {"runs": ray.put(runs), "so_far": json.dumps(told.to_json())}

    def on_trial_error(self, iteration: int, trials: list[Any], trial: Any, **info: Any) -> None:
        """Note a trial that was tried too often, and say why."""
        said = str(trial.get_error() or "").strip().splitlines()
        self._lose(json.loads(trial.config["asked"])["number"], brief(said[-1]) if said else "its worker died")

    def _lose(self, number: int, why: str) -> None:
        self.lost[number] = why
        self._table.say(f"a trial failed: {why}")
        self._table.drop(number)

    def on_step_end(self, iteration: int, trials: list[Any], **info: Any) -> None:
        """Try again what could not be written, and draw."""
        if self.trouble:
            self.write()
        self._table.draw()

    def write(self) -> None:
        """Write what waits to be kept."""
        while self._waiting:
            try:
                self._study.record(*self._waiting[0])
            except OSError as error:
                self.trouble = f"could not write to {self._study.folder}: {error.strerror or error}"
                self._table.say(f"{self.trouble}; the trial is kept in memory and tried again")
                return
            self._waiting.pop(0)
        self.trouble = ""

    def get_state(self) -> None:
        """Give Tune nothing to keep."""


class _Stopper(tune.Stopper):
    """Ends all trials when the user says stop."""

    def __init__(self, stop: Sequence[int]) -> None:
        self._stop = stop

    def __call__(self, trial_id: str, result: dict[str, Any]) -> bool:
        return False

    def stop_all(self) -> bool:
        return bool(self._stop)

    def __deepcopy__(self, memo: Any) -> _Stopper:
        return self  # a copy would never hear of it


def run_trials(study: Study, table: Table, stop: Sequence[int]) -> Recorder:
    """Run the trials that a study has left, on the Ray that was joined; return what became of them.

    A worker that dies before its trial has begun costs Tune the trial at once, however many tries it is allowed. So
    what was lost is run again, as long as the trials before it have ended.
    """
    optuna.logging.set_verbosity(optuna.logging.ERROR)
    logging.getLogger("ray").setLevel(logging.CRITICAL)
    warnings.filterwarnings("ignore", module=r"ray\..*")
    while True:
        before, recorder = len(study.trials), Recorder(study, table, stop)
        _run_left(study, recorder, stop)
        recorder.write()
        if not recorder.lost or stop or recorder.trouble or len(study.trials) == before:
            return recorder


def _run_left(study: Study, recorder: Recorder, stop: Sequence[int]) -> None:
    """Run each trial that a study has left, once."""
    plan = study.plan
    shared = {"plan": json.dumps(plan.to_json()), "code": fingerprint()}
    search: Searcher = PopulationSearch(study, shared) if plan.search == POPULATION else StudySearch(study, shared)
    with tempfile.TemporaryDirectory(prefix="tranquility-sweep-") as temporary:
        tune.Tuner(
            SweepTrial,
            tune_config=tune.TuneConfig(
                search_alg=search,
                scheduler=_scheduler(study),
                num_samples=plan.trials - len(study.trials),
                reuse_actors=True,
            ),
            run_config=tune.RunConfig(
                storage_path=temporary,
                name="study",
                verbose=0,
                stop=_Stopper(stop),
                callbacks=[recorder],
                failure_config=tune.FailureConfig(max_failures=TRIES - 1),
            ),
        ).fit()


def _scheduler(study: Study) -> TrialScheduler:
    """Return what may end trials early. ASHA is told the curves that the study has already."""
    plan = study.plan
    if not plan.stop_early:
        return FIFOScheduler()
    scheduler = ASHAScheduler(
        time_attr=AT,
        metric=VALUE,
        mode=study.metric.mode,
        max_t=plan.budget,
        grace_period=min(plan.every, plan.budget),
        reduction_factor=REDUCTION,
        stop_last_trials=False,
    )
    for trial in study.trials.values():
        earlier: Any = SimpleNamespace(trial_id=f"earlier-{trial.number}")
        scheduler.on_trial_add(None, earlier)
        for at, value in progress_of(trial, plan):
            scheduler.on_trial_result(None, earlier, {AT: at, VALUE: value})
    return scheduler


def progress_of(trial: FinishedTrial, plan: Plan) -> list[tuple[int, float]]:
    """Return the marks at which a trial was measured, and its value at each."""
    metric, told = Metric.named(plan.metric), []
    for index in range(max((len(seed.curve) for seed in trial.seeds), default=0)):
        values = [metric.of(seed.curve[: index + 1], plan.budget) for seed in trial.seeds]
        if (value := metric.judged(values, plan.judge)) is not None:
            told.append((min(plan.budget, (index + 1) * plan.every), value))
    return told


assert os.environ.get("RAY_USAGE_STATS_ENABLED") == "0", "ai.sweep.cluster comes first: it keeps Ray from reporting"
