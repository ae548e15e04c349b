"""One trial, as a worker trains it: the same settings with several seeds, in turn, on one thread.

A run takes the steps that `train` or `train-digits` takes, and is saved by the same function. So it gives the same
network in a sweep as alone, bit for bit.
"""

from __future__ import annotations

import tempfile
import time
from pathlib import Path
from typing import Any

from ai.digits.config import DigitConfig
from ai.digits.mnist import TRAIN, load_part
from ai.digits.training import DigitTraining
from ai.environment import finished
from ai.files.knobs import Knobs
from ai.files.reading import brief
from ai.sweep.design import DIGITS, Design, Measurement, Metric
from ai.sweep.study import Files, SeedResult, Trial, median, seed_folder
from ai.training.config import Config
from ai.training.loop import Training, task_of
from ai.training.run import Limit, save
from ai.training.tasks import VALIDATION_SEED


def trained(design: Design, number: int, params: dict[str, Any]) -> tuple[Trial, Files]:
    """Train a trial; return its result, and the files of the runs that came to their end.

    Raises ValueError or ImportError where no run of this study can begin: images or environment are missing.
    """
    check_ready(design.config)
    began, results = time.monotonic(), []
    try:
        runs = [seed_run(design, params, seed) for seed in design.seeds]
    except ValueError as error:
        return Trial(number, params, None, 0.0, (), brief(error)), {}
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        for seed, run in zip(design.seeds, runs, strict=True):
            curve, problem = _curve(run, design)
            if not problem:
                save(run, folder / seed_folder(seed), final=True, state=False)
            value = Metric.named(design.metric).of(curve, design.budget, bool(problem))
            results.append(SeedResult(seed, tuple(curve), value, brief(problem)))
        files = {path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*") if path.is_file()}
    value, seconds = median([seed.value for seed in results]), round(time.monotonic() - began, 3)
    return Trial(number, params, value, seconds, tuple(results)), files


def check_ready(config: Knobs) -> None:
    """Raise ValueError or ImportError where no run of these settings can begin: images or environment are missing."""
    if isinstance(config, DigitConfig):
        load_part(TRAIN)
    else:
        assert isinstance(config, Config)
        task_of(config)


def seed_run(design: Design, params: dict[str, Any], seed: int) -> Any:
    """Return the run of one seed; raises ValueError for settings that make no sense."""
    config: Any = type(design.config).from_json(design.settings | params)
    if design.kind == DIGITS:
        return DigitTraining(config, seed)
    run = Training(config, seed)
    run.validation_episodes = design.validation or run.validation_episodes
    return run


def _curve(run: Any, design: Design) -> tuple[list[Measurement], str]:
    """Train a run to its end, measured at every mark; return the curve, and why it ended if it diverged."""
    curve: list[Measurement] = []
    marks = *range(design.every, design.budget, design.every), design.budget
    try:
        curve.extend(_trained_to(run, mark) for mark in marks)
    except FloatingPointError as error:
        return curve, str(error)
    return curve, ""


def _trained_to(run: Any, mark: int) -> Measurement:
    """Train a run up to so many decisions or epochs, and measure it; raises FloatingPointError if it diverges."""
    for _ in Limit(moment=mark * getattr(run, "steps_per_epoch", 1)).run(run):
        pass
    if isinstance(run, DigitTraining):
        return Measurement(mark, run.history[-1]["held_out"], run.history[-1]["held_out"])
    score = run.evaluation or finished(run.task.trial(run.agent, run.validation_episodes, VALIDATION_SEED))
    return Measurement(run.moment, score.success, score.mean_return)
