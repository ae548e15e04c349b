"""A run of training, of any kind, as everything around it knows it."""

from __future__ import annotations

import time
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar, Final, Self

import numpy as np

from ai.files.folder import FolderKind

TRAINING_FILE: Final = "training.json"  # in a run's folder: how it was made, and what it has measured


@dataclass(frozen=True)
class Measured:
    """How a run stands at one moment: what its steps return, and the columns of its curves.

    Fields are numbers, or several of them. What is not known yet is NaN.
    """

    may_thin: ClassVar = True  # of those not fetched yet, every other may be dropped

    seconds: float  # of training so far, pauses left out

    @property
    def values(self) -> tuple[float, ...]:
        """The numbers of its columns."""
        return tuple(np.hstack(list(vars(self).values())).tolist())


class Run(ABC):
    """A run of training: landers and environments of Gymnasium (`ai.training.loop`), digits (`ai.digits.training`).

    Each says how it steps, what its folder holds, and what it goes on from. What is around a run is there once, in
    `ai.training`.

    Attributes:
        kind: what its folder may hold.
        config, seed: what all of it follows from.
        clock: counts seconds.
        seconds: spent in training.
        best: score of the best network so far; None if none has been measured.
        lost: what could not be restored of a run that goes on, in words.
        diverged: whether what it remembers may be broken: then there is no state to go on from.
        needs_state: whether no such run goes on without its state.
        stopping: is asked again and again while a network is measured; where it says so, that ends without a score.

    """

    kind: ClassVar[FolderKind]
    needs_state: ClassVar[bool] = False
    config: Any

    def __init__(self, config: Any, seed: int) -> None:  # noqa: ARG002 - each kind keeps it where it is used
        self.seed = seed
        self.clock: Callable[[], float] = time.monotonic
        self.seconds = 0.0
        self.best: Any = None
        self.lost, self.diverged = "", False
        self.stopping: Callable[[], bool] = lambda: False

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

    def advance(self) -> Any:
        """Take one step, and count its time; return the progress.

        Raises FloatingPointError when a number is no longer finite.
        """
        began = self.clock()
        self.take_step()
        self.seconds += self.clock() - began
        return self.progress

    @abstractmethod
    def take_step(self) -> None:
        """Take one step; `advance` calls it."""

    @property
    @abstractmethod
    def progress(self) -> Measured:
        """How it stands now."""

    @abstractmethod
    def apply_live(self, config: Any) -> None:
        """Take over the live knobs of another configuration; the others stay as they are."""

    @abstractmethod
    def restore_best(self) -> None:
        """Restore the best networks so far, if there are any: training cannot go on from diverged ones."""

    def close(self) -> None:  # noqa: B027 - most hold nothing
        """Let go of what it holds, such as other programs; it does not go on."""

    # On disk

    @abstractmethod
    def snapshot(self, final: bool = False) -> tuple[dict[str, Any], Callable[[Path], None]]:
        """Return what its training file says now, and what writes its networks as they are now into a new folder.

        A `final` one is measured on what neither trained nor chose it.
        """

    @classmethod
    @abstractmethod
    def begun(cls, folder: Path, **options: Any) -> Self:
        """Return the run that a folder describes, without its state; raises ModelFormatError."""

    @abstractmethod
    def state(self) -> dict[str, Any]:
        """Return copies of what the run goes on from and its folder does not hold: arrays, and what JSON can hold."""

    @abstractmethod
    def load_state(self, state: dict[str, Any]) -> None:
        """Go on from what `state` returned.

        Raises KeyError, TypeError, AttributeError, ArithmeticError or ValueError for what no such run can have been.
        """
