"""Trials of a study on Ray: workers take one trial after another, and what was lost goes on elsewhere.

Comes with the extra `sweep`. Optuna proposes (`ai.sweep.journal`), Ray's workers train, and this process alone writes
the study.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Final

import ray

from ai.files import brief
from ai.nn import ModelFormatError
from ai.sweep.journal import Search
from ai.sweep.plan import Plan
from ai.sweep.population import proposed
from ai.sweep.results import FinishedTrial
from ai.sweep.runs import check_ready, read_config
from ai.sweep.study import Study
from ai.sweep.trial import Asked, Trial, fingerprint

CHECKPOINT_SECONDS: Final = 20.0  # between two checkpoints of a trial
TRIES: Final = 4  # of a trial whose worker dies; after that it waits for --resume
_TURN: Final = 0.2  # seconds after which a wait for workers looks around


class NotReadyError(RuntimeError):
    """A node cannot run a trial: it has other code, or not all that is needed."""


class Worker:
    """Process that trains: a step takes all seeds of its trial to the next mark."""

    def __init__(self, plan: Plan) -> None:
        self._plan, self._kept = plan, 0.0
        self._trial: Trial | None = None

    def begin(self, code: str, asked: Asked, runs: bytes, so_far: FinishedTrial | None) -> str:
        """Begin a trial, or go on with one; return why its settings make no sense, if so.

        Raises NotReadyError for what is no result of a trial.
        """
        if code != fingerprint():
            raise NotReadyError("this node has another version of Tranquility than the one that runs the study")
        try:
            check_ready(read_config(self._plan.kind, self._plan.settings))
        except (ValueError, ImportError) as error:
            raise NotReadyError(brief(error)) from error
        try:
            self._trial, self._kept = Trial(self._plan, asked, runs, so_far), time.monotonic()
        except ModelFormatError as error:  # of its parent
            raise NotReadyError(brief(error)) from error
        except ValueError as error:
            return brief(error)
        return ""

    def step(self) -> tuple[FinishedTrial, bytes, bool]:
        """Train up to the next mark; return the result, the runs if there are new ones to keep, and if it is over."""
        trial = self._trial
        assert trial is not None
        if not trial.done:
            trial.step()
        if trial.done:
            return *trial.finish(), True
        if time.monotonic() - self._kept < CHECKPOINT_SECONDS:
            return trial.result(), b"", False
        self._kept = time.monotonic()
        return trial.result(), trial.checkpoint(), False


@dataclass
class _Job:
    """Trial under way: who trains it, and what it would go on from."""

    asked: Asked
    runs: bytes
    so_far: FinishedTrial | None = None
    worker: Any = None
    tries: int = 0
    begun: bool = False  # on this worker; one that a cluster has no core for waits


class Driver:
    """Runs the trials that a study has left, on the Ray that was joined.

    Attributes:
        running: results so far of the trials under way, by number; None before the first.
        lost: why trials could not be made, by number.
        trouble: why results wait in memory; empty if none do. They are written as soon as there is room.

    """

    def __init__(self, study: Study, workers: int, say: Callable[[str], None], told: Callable[[], None]) -> None:
        self._study, self._workers, self._say, self._told = study, workers, say, told
        self._search = Search(study)
        self._jobs: dict[Any, _Job] = {}
        self._idle: list[Any] = []
        self._waiting: list[tuple[FinishedTrial, bytes]] = []
        self.running: dict[int, FinishedTrial | None] = {}
        self.lost: dict[int, str] = {}
        self.trouble = ""

    def run(self, stop: Sequence[int]) -> None:
        """Run until all is done, nothing more can be, or the user says stop."""
        while not stop:
            self._write()
            while len(self._jobs) < self._workers and (job := self._next()):
                self._start(job)
            if not self._jobs:
                break
            for done in ray.wait(list(self._jobs), timeout=_TURN)[0]:
                self._take(done)
            self._told()
        self._write()

    def _next(self) -> _Job | None:
        """Return the next trial to run: one that was interrupted, or a new one; None while there is none."""
        study, search = self._study, self._search
        if search.left:
            number = search.left[0]
            asked = proposed(study, number) if study.plan.population else Asked(number, search.params(number))
            if asked is not None:
                search.left.pop(0)
        else:
            under_way = len(self._jobs) + len(self._waiting) + len(self.lost)
            if self.trouble or len(study.trials) + under_way >= study.plan.trials:
                return None
            asked = self._new()
        if asked is None:
            return None
        self.running[asked.number] = None
        return _Job(asked, study.runs_of(asked.parent.number) if asked.parent else b"")

    def _new(self) -> Asked | None:
        """Return a new trial; None if a population has to wait for one of its members."""
        study, search = self._study, self._search
        try:
            if not study.plan.population:
                number = search.ask()
                return Asked(number, search.params(number))
            number = len(study.trials) + len(self._jobs) + len(self._waiting) + len(self.lost)
            if (asked := proposed(study, number)) is not None:
                search.ask(asked.params)
            return asked
        except OSError as error:
            self._is_full(error)
            return None

    def _start(self, job: _Job) -> None:
        """Begin a trial on a worker, or let another one go on with it."""
        if job.worker is None:
            options = {"num_cpus": 1, "max_restarts": 0}
            job.worker = self._idle.pop() if self._idle else ray.remote(**options)(Worker).remote(self._study.plan)
        job.tries += 1
        job.begun = False
        self._jobs[job.worker.begin.remote(fingerprint(), job.asked, job.runs, job.so_far)] = job

    def _take(self, done: Any) -> None:
        """Take what a worker answers: the trial has begun, has come to a mark, is over, or is lost."""
        job = self._jobs.pop(done)
        try:
            answer = ray.get(done)
        except ray.exceptions.RayTaskError as error:
            self._rest(job.worker)
            self._lose(job, brief(str(error.cause)))
            return
        except ray.exceptions.RayError as error:
            job.worker = None
            self._idle.clear()  # they may have been on the node that is gone
            if job.tries < TRIES:
                self._start(job)
            else:
                self._lose(job, brief(str(error).strip().splitlines()[-1]))
            return
        job.begun = True
        if answer == "":
            self._jobs[job.worker.step.remote()] = job
            return
        if isinstance(answer, str):  # the settings make no sense
            result, runs, over = FinishedTrial.senseless(job.asked.number, job.asked.params, answer), b"", True
        else:
            result, runs, over = answer
        if over or self._falls_behind(result):
            self._rest(job.worker)
            self.running.pop(result.number)
            self._waiting.append((result, runs if over else b""))
            self._write()
            return
        self.running[result.number] = result
        if runs:
            job.runs, job.so_far = runs, result
        self._jobs[job.worker.step.remote()] = job

    def _rest(self, worker: Any) -> None:
        """Keep a worker for the next trial; let it end if another one waits for the core that it would hold."""
        if all(job.begun for job in self._jobs.values()):
            self._idle.append(worker)

    def _falls_behind(self, result: FinishedTrial) -> bool:
        try:
            return self._search.falls_behind(result)
        except OSError as error:
            self._is_full(error)
            return False

    def _lose(self, job: _Job, why: str) -> None:
        self.running.pop(job.asked.number, None)
        self.lost[job.asked.number] = why
        self._say(f"a trial failed: {why}")

    def _write(self) -> None:
        """Keep every trial that is over; what cannot be written now, as the disk is full, waits."""
        while self._waiting:
            try:
                result, runs = self._waiting[0]
                if result.number not in self._study.trials:
                    self._study.record(result, runs)
                self._search.tell(result)
            except OSError as error:
                self._is_full(error)
                return
            self._waiting.pop(0)
        self.trouble = ""

    def _is_full(self, error: OSError) -> None:
        trouble = f"could not write to {self._study.folder}: {error.strerror or error}"
        if trouble != self.trouble:
            self._say(f"{trouble}; it is tried again")
        self.trouble = trouble
