"""A run of training, of any kind, as everything around it knows it."""

from __future__ import annotations

import time
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, ClassVar, Final, Self

from ai.files import FolderKind

TRAINING_FILE: Final = "training.json"  # in a run's folder: how it was made, and what it has measured


class Run(ABC):
    """A run of training: landers and environments of Gymnasium (`ai.training.loop`), digits (`ai.digits.training`).

    Each says how it steps, what its folder holds, and what it goes on from. What is around a run is there once, in
    `ai.training`.

    Attributes:
        kind: what its folder may hold.
        config, seed: what all of it follows from.
        clock: counts seconds.
        seconds: spent in training, as the caller counts them.
        best: score of the best network so far; None if none has been measured.
        lost: what could not be restored of a run that goes on, in words; empty for the very same run.
        diverged: whether what it remembers may be broken: then there is no state to go on from.
        around: what whoever led it has kept in the state that it goes on from.
        states: has the blocks of that state; None for a new run.

    """

    kind: ClassVar[FolderKind]
    config: Any

    def __init__(self, config: Any, seed: int) -> None:  # noqa: ARG002 - each kind keeps it where it is used
        self.seed = seed
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
        """Return copies of all that the run goes on from, besides its settings and replay buffers."""

    @abstractmethod
    def load_state(self, state: dict[str, Any] | None, folder: Path) -> bool:
        """Go on from a state that lies beside `folder`; return whether that was done, or else say in `lost` why not.

        Raises ModelFormatError where nothing can go on without one, and OSError, KeyError, TypeError, AttributeError,
        ArithmeticError or ValueError for what no such run can have been.
        """
