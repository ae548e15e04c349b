"""Trials of a study on Ray: each is a task that yields a result at every mark, and what was lost goes on elsewhere.

Comes with the extra `sweep`. What is to be tried comes from `ai.sweep.search`, and this process alone writes the study.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Final

import ray
from ray.exceptions import RayError, RayTaskError

from ai.files import brief
from ai.nn import ModelFormatError
from ai.sweep.plan import POPULATION, Plan
from ai.sweep.search import Population, Proposals, Search
from ai.sweep.study import Asked, Files, FinishedTrial, Study
from ai.sweep.trial import Trial, check_ready, fingerprint

TRIES: Final = 4  # of a trial whose worker dies; after that it waits for --resume
MOST_LOST: Final = 100  # trials that could not be made, after which no other is begun
_TURN: Final = 0.2  # seconds after which a wait for workers looks around


def trained(
    code: str, plan: Plan, asked: Asked, source: FinishedTrial | None, runs: Files, checkpoint: float
) -> Iterator[tuple[FinishedTrial, Files, bool]]:
    """Train a trial; yield at every mark the result, the runs if there are new ones to keep, and whether it is over.

    `source` and `runs` are those of a `Trial`; `checkpoint` are the seconds between two times that runs are kept.
    Raises RuntimeError, ImportError, ValueError or ModelFormatError for what is no result of a trial: a node that has
    other code, or not all that is needed.
    """
    if code != fingerprint():
        raise RuntimeError("this node has another version of Tranquility than the one that runs the study")
    check_ready(plan.config)
    try:
        trial = Trial(plan, asked, source, runs)
    except ModelFormatError:  # of its parent
        raise
    except ValueError as error:
        yield FinishedTrial(asked.number, asked.params, None, 0, False, 0.0, (), problem=brief(error)), {}, True
        return
    kept = time.monotonic()
    while not trial.done:
        trial.step()
        if not trial.done:
            due = time.monotonic() - kept >= checkpoint
            kept = time.monotonic() if due else kept
            yield trial.result(), trial.checkpoint() if due else {}, False
    yield *trial.finish(), True


@dataclass
class _Job:
    """Trial under way: what it would go on from, and how often it was begun."""

    asked: Asked
    source: FinishedTrial | None
    runs: Files
    tries: int = 0


class Driver:
    """Runs the trials that a study has left, on the Ray that was joined.

    Ray gives a core to a trial as long as it lasts. So none is held by a worker that waits, and a trial whose node is
    lost goes on where a core becomes free.

    Attributes:
        search: what is to be tried.
        jobs: trials under way, by Ray's generator of their results.
        lost: why trials could not be made, by number.
        checkpoint: seconds between two checkpoints of a trial.

    """

    def __init__(self, study: Study, workers: int, say: Callable[[str], None], report: Callable[[], None]) -> None:
        self._study, self._workers, self._say, self._report = study, workers, say, report
        self.search: Search = Population(study) if study.plan.search == POPULATION else Proposals(study)
        self.jobs: dict[Any, _Job] = {}
        self.lost: dict[int, str] = {}
        self.checkpoint = 20.0

    def run(self, stop: Sequence[int]) -> None:
        """Run until all is done, nothing more can be, or the user says stop; raises OSError for a full disk."""
        study = self._study
        while not stop:
            room = self._workers if len(self.lost) < MOST_LOST else 0
            while len(self.jobs) < room and (asked := self.search.next()):
                study.begin(asked)
                parent = None if asked.parent is None else study.trials[asked.parent]
                self._start(_Job(asked, parent, study.runs_of(parent) if parent else {}))
            if not self.jobs:
                break
            for results in ray.wait(list(self.jobs), timeout=_TURN)[0]:
                self._take(results)
            self._report()

    def _start(self, job: _Job) -> None:
        """Begin a trial, or go on with it from its last checkpoint. A worker waits until its results are taken."""
        job.tries += 1
        train = ray.remote(num_cpus=1, max_retries=0, _generator_backpressure_num_objects=1)(trained)
        given = (self._study.plan, job.asked, job.source, job.runs, self.checkpoint)
        self.jobs[train.remote(fingerprint(), *given)] = job

    def _take(self, results: Any) -> None:
        """Take what a worker yields: the trial has come to a mark, is over, or is lost."""
        job = self.jobs.pop(results)
        try:
            result, runs, over = ray.get(next(results))
        except RayTaskError as error:
            self._lose(job, str(error.cause))
        except (RayError, StopIteration) as error:
            if job.tries < TRIES:
                self._start(job)
            else:
                self._lose(job, str(error).strip().rpartition("\n")[2])
        else:
            if over or self.search.falls_behind(result):
                if not over:
                    ray.cancel(results)
                self._study.record(result, runs if over else {})
                self.search.tell(result)
                return
            if runs:
                job.source, job.runs = result, runs
            self.jobs[results] = job

    def _lose(self, job: _Job, why: str) -> None:
        self.lost[job.asked.number] = brief(why)
        self._say(f"a trial failed: {brief(why)}")
