"""Run of one seed of a trial: the run that `train` or `train-digits` makes, measured at fixed moments.

Both kinds take the same steps as their command takes, and are saved by the same function. So a run gives the same
network in a sweep as alone, bit for bit.
"""

from __future__ import annotations

import time
from abc import ABC, abstractmethod
from collections.abc import Callable
from pathlib import Path
from typing import Any, Final

from ai.common.knobs import Knobs
from ai.digits.config import DigitConfig
from ai.digits.mnist import TRAIN, load_part
from ai.digits.training import DigitTraining
from ai.sweep.metric import Point
from ai.training.checkpoints import resume_digit_run, resume_run, save_digit_run, save_run
from ai.training.config import Config
from ai.training.loop import Training, task_of
from ai.training.tasks import VALIDATION_SEED

AGENT: Final = "agent"  # kinds of run
DIGITS: Final = "digits"


class SeedRun(ABC):
    """Run of one seed, in a trial; `save_run` is how its command keeps it."""

    def __init__(self, training: Any, save_run: Callable[..., Any]) -> None:
        self.training, self._save_run = training, save_run

    @property
    def seconds(self) -> float:
        """Time spent in training."""
        return float(self.training.seconds)

    @abstractmethod
    def advance(self, mark: int) -> Point:
        """Train up to so many decisions or epochs, and measure; raises FloatingPointError if it diverges."""

    @abstractmethod
    def save(self, folder: Path, state: bool = False) -> dict[str, Any]:
        """Save the run as its command does at its end; return the figures of the network that is kept.

        With `state`, another trial can go on from there.
        """

    def keep(self, folder: Path) -> None:
        """Save the run as it is now, with the state that it goes on from bit for bit."""
        self._save_run(self.training, folder, state=True)

    def salvage(self, folder: Path) -> None:
        """Save what was best of a run that has diverged."""
        self.training.restore_best()
        self.keep(folder)


class AgentRun(SeedRun):
    """Run of an agent: our lander, or an environment of Gymnasium."""

    def advance(self, mark: int) -> Point:  # noqa: D102
        training, began, score = self.training, time.monotonic(), None
        while training.agent.decisions < mark:
            score = training.advance().evaluation
        training.seconds += time.monotonic() - began
        if score is None:
            score = training.task.evaluate(training.agent, training.validation_episodes, VALIDATION_SEED)
        return Point(training.agent.decisions, score.success, score.mean_return)

    def save(self, folder: Path, state: bool = False) -> dict[str, Any]:  # noqa: D102
        self._save_run(self.training, folder, final=True, state=state)
        best = self.training.best
        return {} if best is None else dict(best.to_json())


class DigitRun(SeedRun):
    """Run of a digit network; its moments are epochs, and each measures the images held out."""

    def advance(self, mark: int) -> Point:  # noqa: D102
        training, began, share = self.training, time.monotonic(), None
        while training.step < mark * training.steps_per_epoch and not training.done:
            share = training.advance().held_out
        training.seconds += time.monotonic() - began
        if share is None:
            raise ValueError("a study of digits needs images held out: held_out was 0")
        return Point(training.step // training.steps_per_epoch, share, share)

    def save(self, folder: Path, state: bool = False) -> dict[str, Any]:  # noqa: D102
        described = self._save_run(self.training, folder, final=True, state=state)
        return {"held_out": described["held_out"], "test": described["test"]}


def _save_digits(training: DigitTraining, folder: Path, final: bool = False, *, state: bool = False) -> dict[str, Any]:  # noqa: ARG001
    """Save a run of digits, whose state is part of it until it is over."""
    return save_digit_run(training, folder, final)


def read_config(kind: str, settings: dict[str, Any]) -> Knobs:
    """Return the settings of a run from JSON; raises ValueError for what makes no sense."""
    return (DigitConfig if kind == DIGITS else Config).from_json(settings)


def check_ready(config: Knobs) -> None:
    """Raise ValueError or ImportError where no run of these settings can begin: images or environment are missing."""
    if isinstance(config, DigitConfig):
        load_part(TRAIN)
    else:
        assert isinstance(config, Config)
        task_of(config)


def begin(
    kind: str, settings: dict[str, Any], seed: int, parent: Path | None = None, validation: int | None = None
) -> SeedRun:
    """Begin a run of a kind; or go on, with other live knobs, from what a run kept in `parent`.

    That is what `train` does, with `--resume` in the second case. Raises ValueError for settings that make no sense,
    ModelFormatError for a parent that cannot be read. The settings are the user's: their environment is named.
    """
    config = read_config(kind, settings)
    if isinstance(config, DigitConfig):
        training = DigitTraining(config, seed) if parent is None else resume_digit_run(parent)
        training.apply_live(config)
        return DigitRun(training, _save_digits)
    assert isinstance(config, Config)
    if parent is None:
        return AgentRun(Training(config, seed, validation_episodes=validation), save_run)
    resumed = resume_run(parent, env=config.env)
    if validation is not None:
        resumed.validation_episodes = validation
    resumed.apply_live(config)
    return AgentRun(resumed, save_run)
