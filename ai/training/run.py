"""A run: what learns, of any kind, as everything around it knows it.

Landers and environments of Gymnasium are trained by `ai.training.loop.Training`, digits by
`ai.digits.training.DigitTraining`. Each says how it steps and what it goes on from. What is around a run is there
once: files (`ai.training.keeping`), history, and a session that is watched and steered (`ai.training.session`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

from ai.files import FolderKind

if TYPE_CHECKING:
    from ai.agent.replay import ReplayBuffer
    from ai.training.history import History


class Run(Protocol):
    """A run of training.

    Attributes:
        config, seed: what all of it follows from.
        seconds: spent in training, as the caller counts them.
        lost: what could not be restored of a run that goes on, in words; empty for the very same run.
        diverged: whether what it remembers may be broken: then there is no state to go on from.
        around: what whoever led it has kept in the state that it goes on from.
        states: has the blocks of that state; None for a new run.

    """

    config: Any
    seed: int
    seconds: float
    lost: str
    diverged: bool
    around: dict[str, Any]
    states: Any

    @property
    def clock(self) -> Callable[[], float]:
        """Counts seconds."""

    @property
    def moment(self) -> int:
        """Steps so far: decisions of single landers, or batches of images."""

    @property
    def steps(self) -> int | None:
        """How many there will be in all; None for a run without end."""

    @property
    def done(self) -> bool:
        """Whether there is nothing left to train."""

    @property
    def best(self) -> Any:
        """Score of the best network so far; None if none has been measured."""

    @property
    def buffers(self) -> Mapping[str, ReplayBuffer]:
        """Replay buffers that belong to its state."""

    def advance(self) -> Any:
        """Take one step; return the progress. Raises FloatingPointError when a number is no longer finite."""

    def apply_live(self, config: Any) -> None:
        """Take over the live knobs of another configuration; the others stay as they are."""

    def restore_best(self) -> None:
        """Restore the best networks so far, if there are any: training cannot go on from diverged ones."""

    def state(self) -> dict[str, Any]:
        """Return copies of all that the run goes on from, besides its settings and replay buffers."""


class Snapshot(Protocol):
    """Copy of what a run's folder holds, at one moment: it may be saved while training goes on."""

    @property
    def described(self) -> dict[str, Any]:
        """What the training file says."""

    def save(self, folder: Path) -> None:
        """Write it, whole or not at all; raises OSError if it cannot be written."""


@dataclass(frozen=True)
class RunKind:
    """Kind of run.

    Attributes:
        folder: what its folder may hold.
        snapshot: copies what a run's folder is to hold; a final one is measured on what neither trained nor chose it.

    """

    folder: FolderKind
    snapshot: Callable[[Any, History | None, bool], Snapshot]


class Limit:
    """Ends a run after so many seconds of training or so many steps, or when it is done.

    Both are counted from the run's own beginning, however often it was interrupted in between.
    """

    def __init__(self, seconds: float | None = None, moment: int | None = None) -> None:
        self.seconds, self.moment = seconds, moment

    def share(self, run: Run) -> float:
        """Return the share of its time or steps that a run has used up, from 0 to 1, whichever is more."""
        elapsed = run.seconds / self.seconds if self.seconds else 0.0
        moment = self.moment or run.steps
        return min(1.0, max(elapsed, run.moment / moment if moment else 0.0))

    def run(self, run: Run) -> Iterator[Any]:
        """Advance until the time or the steps are used up."""
        while self.share(run) < 1.0:
            began = run.clock()
            progress = run.advance()
            run.seconds += run.clock() - began
            yield progress
