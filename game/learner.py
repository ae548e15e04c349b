"""One training run after another, each in a child process: what there is to ask of any of them."""

from __future__ import annotations

from typing import Any, Final

from ai.messages import Change
from game.worker import State, Worker

EARLIER: Final = 3  # runs of this visit that stay to be compared with


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
