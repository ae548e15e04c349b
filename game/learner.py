"""One training run after another, each in a child process: what there is to ask of any of them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final, Generic, TypeVar

from ai.messages import Change
from game.worker import State, Worker

Kind = TypeVar("Kind")

EARLIER: Final = 3  # runs that may stand beside the one that goes on


@dataclass(frozen=True)
class Beside(Generic[Kind]):
    """A run that is shown beside the one that goes on; it keeps the style of its lines as others come and go."""

    name: str
    run: Kind
    style: int  # of game.ui.series.RUN_STYLES; 0 is that of the run that goes on


def put_beside(runs: list[Beside[Kind]], name: str, run: Kind) -> str:
    """Let a run stand beside, in place of one of its name or of the oldest; return who had to make room, if any."""
    runs[:] = [each for each in runs if each.name != name]
    gone = runs.pop().name if len(runs) >= EARLIER else ""
    style = next(style for style in range(1, EARLIER + 1) if style not in {each.style for each in runs})
    runs.insert(0, Beside(name, run, style))
    return gone


class Learner:
    """Holds the process of a run, and lets it rest, go on and end.

    Attributes:
        grace: seconds that a run has to end by itself when the window leaves it.

    """

    grace = 0.5

    def __init__(self) -> None:
        self._worker: Worker | None = None

    @property
    def state(self) -> State | None:
        """How the run stands; None before the first."""
        return self._worker.state if self._worker else None

    @property
    def alive(self) -> bool:
        """Whether there is a run to pause, to step, to stop and to change."""
        return self.state in (State.STARTING, State.RUNNING, State.PAUSED)

    @property
    def problem(self) -> str:
        """Why the run failed, in words; empty if it did not."""
        return self._worker.problem if self._worker and self.state is State.FAILED else ""

    def pause(self) -> None:
        """Let it rest."""
        if self._worker and self.alive:
            self._worker.pause()

    def resume(self) -> None:
        """Let it learn on."""
        if self._worker and self.alive:
            self._worker.resume()

    def step(self) -> None:
        """Let it learn once, and rest after that."""
        if self._worker and self.alive:
            self._worker.pause()
            self._worker.step()

    def change(self, name: str, value: Any) -> None:
        """Turn a live knob."""
        if self._worker and self.alive:
            self._worker.send(Change(name, value))

    def close(self) -> None:
        """End the run, and its process for certain."""
        if self._worker:
            self._worker.close(self.grace)
