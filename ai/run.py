"""A run of training, of any kind, as everything around it knows it."""

from __future__ import annotations

import time
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from typing import Any


class Run(ABC):
    """A run of training: landers and environments of Gymnasium (`ai.training.loop`), digits (`ai.digits.training`).

    Each says how it steps and what it goes on from. What is around a run is there once, in `ai.training`.

    Attributes:
        config, seed: what all of it follows from.
        clock: counts seconds.
        seconds: spent in training, as the caller counts them.
        best: score of the best network so far; None if none has been measured.
        lost: what could not be restored of a run that goes on, in words; empty for the very same run.
        diverged: whether what it remembers may be broken: then there is no state to go on from.
        around: what whoever led it has kept in the state that it goes on from.
        states: has the blocks of that state; None for a new run.

    """

    def __init__(self, config: Any, seed: int) -> None:
        self.config, self.seed = config, seed
        self.clock: Callable[[], float] = time.monotonic
        self.seconds = 0.0
        self.best: Any = None
        self.lost, self.diverged = "", False
        self.around: dict[str, Any] = {}
        self.states: Any = None

    @property
    @abstractmethod
    def moment(self) -> int:
        """Steps so far: decisions of single landers, or batches of images."""

    @property
    def steps(self) -> int | None:
        """How many there will be in all; None for a run without end."""
        return None

    @property
    def done(self) -> bool:
        """Whether there is nothing left to train."""
        return self.steps is not None and self.moment >= self.steps

    @property
    def buffers(self) -> Mapping[str, Any]:
        """Replay buffers that belong to its state."""
        return {}

    @abstractmethod
    def advance(self) -> Any:
        """Take one step; return the progress. Raises FloatingPointError when a number is no longer finite."""

    @abstractmethod
    def apply_live(self, config: Any) -> None:
        """Take over the live knobs of another configuration; the others stay as they are."""

    @abstractmethod
    def restore_best(self) -> None:
        """Restore the best networks so far, if there are any: training cannot go on from diverged ones."""

    @abstractmethod
    def state(self) -> dict[str, Any]:
        """Return copies of all that the run goes on from, besides its settings and replay buffers."""
