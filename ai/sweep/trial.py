"""Trial of a study: the same settings trained with several seeds, in turn, on one thread.

A run takes the steps that `train` or `train-digits` takes, and is saved by the same function. So it gives the same
network in a sweep as alone, bit for bit.
"""

from __future__ import annotations

import hashlib
import tempfile
import time
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any, Final

import numpy as np

from ai.digits.config import DigitConfig
from ai.digits.mnist import TRAIN, load_part
from ai.digits.training import DigitTraining
from ai.files.knobs import Knobs
from ai.sweep.plan import DIGITS, Metric, Plan, Point
from ai.sweep.study import Asked, Files, FinishedTrial, SeedResult, files_in, median, seed_folder, write_files
from ai.training.config import Config
from ai.training.loop import Training, task_of
from ai.training.run import Limit, resume, save
from ai.training.tasks import VALIDATION_SEED

_ROOT: Final = Path(__file__).parents[2]
_MOST_SENT: Final = 100_000_000  # bytes of a checkpoint; a larger one goes without the memories, and so on with none


def seed_run(plan: Plan, params: dict[str, Any], seed: int, parent: Path | None) -> Any:
    """Return the run of one seed: new, or going on, with other live knobs, from what a run kept in `parent`.

    Raises ValueError for settings that make no sense, ModelFormatError for a parent that cannot be read. The settings
    are the user's: their environment is named.
    """
    config: Any = type(plan.config).from_json(plan.settings | params)
    kind: Any = DigitTraining if plan.kind == DIGITS else Training
    if kind is DigitTraining and not config.held_out:
        raise ValueError("a study of digits needs images held out: held_out was 0")
    run = resume(kind, parent, env=getattr(config, "env", None)) if parent else kind(config, seed)
    if parent:
        run.apply_live(config)
    if kind is Training:
        run.validation_episodes = plan.validation or run.validation_episodes
    return run


def trained_to(run: Any, mark: int) -> Point:
    """Train a run up to so many decisions or epochs, and measure it; raises FloatingPointError if it diverges."""
    last = None
    for progress in Limit(moment=mark * getattr(run, "steps_per_epoch", 1)).run(run):
        last = progress
    if isinstance(run, DigitTraining):
        return Point(mark, run.history[-1]["held_out"], run.history[-1]["held_out"])
    score = last.evaluation if last else None
    score = score or run.task.evaluate(run.agent, run.validation_episodes, VALIDATION_SEED)
    return Point(run.moment, score.success, score.mean_return)


class Trial:
    """Trial that goes from mark to mark.

    `runs` are files of runs to go on with, and `source` is what these have come to: its parent's, or its own, as
    `checkpoint` and `result` gave them. Raises ValueError for settings that make no sense, ModelFormatError for runs
    that cannot be read.
    """

    def __init__(
        self, plan: Plan, asked: Asked, source: FinishedTrial | None = None, runs: Files | None = None
    ) -> None:
        self.plan, self.asked, self.metric = plan, asked, Metric.named(plan.metric)
        self.at, self.end = plan.span(asked.number)
        self._restarts, self._began = 0, time.monotonic()
        if source and source.number == asked.number:
            self.at, self._restarts, self._began = source.at, source.restarts + 1, self._began - source.seconds
        self.curves = [list(seed.curve) for seed in source.seeds] if source else [[] for _ in plan.seeds]
        self.problems = [""] * len(plan.seeds)
        with tempfile.TemporaryDirectory() as folder:
            write_files(runs or {}, Path(folder))
            kept = {seed: Path(folder, seed_folder(seed)) for seed in plan.seeds}
            self.runs = [  # what diverged at once has kept nothing, and begins anew
                seed_run(plan, asked.params, seed, run if run.is_dir() else None) for seed, run in kept.items()
            ]

    @property
    def done(self) -> bool:
        """Whether there is nothing left to train."""
        return self.at >= self.end or all(self.problems)

    def step(self) -> None:
        """Train every seed up to the next mark, and measure it there."""
        mark = min(self.end, (self.at // self.plan.every + 1) * self.plan.every)
        for index, run in enumerate(self.runs):
            if not self.problems[index]:
                try:
                    self.curves[index].append(trained_to(run, mark))
                except FloatingPointError as error:
                    self.problems[index] = str(error)
        self.at = mark

    def result(self, figures: dict[int, dict[str, Any]] | None = None) -> FinishedTrial:
        """Return what the trial has come to; `figures` are those of the networks kept, by seed."""
        seeds = []
        for seed, curve, problem, run in zip(self.plan.seeds, self.curves, self.problems, self.runs, strict=True):
            value, kept = self.metric.of(curve, self.plan.budget, bool(problem)), (figures or {}).get(seed, {})
            seeds.append(SeedResult(seed, tuple(curve), value, problem, round(run.seconds, 3), kept))
        value, seconds = median([seed.value for seed in seeds]), round(time.monotonic() - self._began, 3)
        number, params, parent = self.asked.number, self.asked.params, self.asked.parent
        stopped = self.at < self.end
        return FinishedTrial(
            number, params, value, self.at, stopped, seconds, tuple(seeds), parent, restarts=self._restarts
        )

    def checkpoint(self) -> Files:
        """Return the files of every seed's run as it is now, to go on with; none if one has diverged."""
        if any(self.problems):
            return {}
        with tempfile.TemporaryDirectory() as temporary:
            for seed, run in zip(self.plan.seeds, self.runs, strict=True):
                save(run, Path(temporary, seed_folder(seed)))
            files = files_in(Path(temporary))
        large = sum(map(len, files.values())) > _MOST_SENT
        return {name: content for name, content in files.items() if not (large and name.startswith("."))}

    def finish(self) -> tuple[FinishedTrial, Files]:
        """Save and measure every seed's run as its command would; return the result and the files of the runs."""
        figures: dict[int, dict[str, Any]] = {}
        goes_on = self.plan.generation(self.asked.number) + 1 < self.plan.generations  # its state is needed then
        with tempfile.TemporaryDirectory() as temporary:
            for seed, problem, run in zip(self.plan.seeds, self.problems, self.runs, strict=True):
                folder = Path(temporary, seed_folder(seed))
                if not problem:
                    said = save(run, folder, final=True, state=goes_on)
                    figures[seed] = said.get("best") or {
                        name: said[name] for name in ("held_out", "test") if name in said
                    }
                else:
                    run.restore_best()
                    with suppress(ValueError):  # its numbers were never finite after a step
                        save(run, folder, state=False)
            return self.result(figures), files_in(Path(temporary))


def check_ready(config: Knobs) -> None:
    """Raise ValueError or ImportError where no run of these settings can begin: images or environment are missing."""
    if isinstance(config, DigitConfig):
        load_part(TRAIN)
    else:
        assert isinstance(config, Config)
        task_of(config)


@cache
def fingerprint() -> str:
    """Return a hash of the code that decides a run, and of NumPy's version: with another one, results may differ."""
    code = hashlib.sha256(np.__version__.encode())
    for package in ("ai", "engine"):
        for path in sorted((_ROOT / package).rglob("*.py")):
            code.update(path.relative_to(_ROOT).as_posix().encode() + path.read_bytes())
    return code.hexdigest()[:16]
