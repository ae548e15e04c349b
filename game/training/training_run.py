"""One training run after another, each in a child process: what there is to ask of any of them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final, Generic, TypeVar

from ai.training.messages import Change
from game.core import texts
from game.core.worker import State, Worker

Kind = TypeVar("Kind")

EARLIER: Final = 3  # runs that may stand beside the one that goes on


@dataclass(frozen=True)
class Beside(Generic[Kind]):
    """A run that is shown beside the one that goes on; it keeps the style of its lines as others come and go."""

    name: str
    run: Kind
    style: int  # of game.charts.series.RUN_STYLES; 0 is that of the run that goes on


def put_beside(runs: list[Beside[Kind]], name: str, run: Kind) -> str:
    """Let a run stand beside, in place of one of its name or of the oldest; return who had to make room, if any."""
    runs[:] = [each for each in runs if each.name != name]
    gone = runs.pop().name if len(runs) >= EARLIER else ""
    style = next(style for style in range(1, EARLIER + 1) if style not in {each.style for each in runs})
    runs.insert(0, Beside(name, run, style))
    return gone


class Learner:
    """Holds the process of a run, and lets it rest, go on and end.

    Two runs keep themselves in the same folder, so the next one waits until the process before it has gone. The
    window does not: what is asked meanwhile of the run to come is told to it when it starts.

    Attributes:
        grace: seconds that a run has to end by itself when the window leaves it.
        name: what the run is called, among others.
        runs: how many there have been.

    """

    grace = 0.5

    def __init__(self) -> None:
        self.name, self.runs = "", 0
        self._named = False  # whether the run was saved under its name
        self._worker: Worker | None = None
        self._launch: Callable[[], str] | None = None  # starts the run that waits; returns what there is to know
        self._asked: list[Callable[[Worker], None]] = []  # of that run

    @property
    def waiting(self) -> bool:
        """Whether a run waits for the one before to end."""
        return self._launch is not None

    @property
    def state(self) -> State | None:
        """How the run stands; None before the first."""
        if self.waiting:
            return State.STARTING
        return self._worker.state if self._worker else None

    @property
    def alive(self) -> bool:
        """Whether there is a run to pause, to step, to stop and to change."""
        return self.state in (State.STARTING, State.RUNNING, State.PAUSED)

    @property
    def problem(self) -> str:
        """Why the run failed, in words; empty if it did not."""
        return self._worker.problem if self._worker and self.state is State.FAILED else ""

    def call(self, settings: str) -> None:
        """Call the run by what its settings are called, and a number, unless it was saved under a name."""
        if not self._named:
            self.name = texts.TRAIN_RUN.format(name=settings or texts.TRAIN_THIS, number=self.runs)

    def pause(self) -> None:
        """Let it rest."""
        self._ask(Worker.pause)

    def resume(self) -> None:
        """Let it learn on."""
        self._ask(Worker.resume)

    def step(self) -> None:
        """Let it learn once, and rest after that."""
        self._ask(Worker.pause)
        self._ask(Worker.step)

    def change(self, name: str, value: Any) -> None:
        """Turn a live knob."""
        self._send(Change(name, value))

    def close(self) -> None:
        """End the run, and its process for certain."""
        self._launch = None
        if self._worker:
            self._worker.close(self.grace)

    def _send(self, command: Any) -> None:
        self._ask(lambda worker: worker.send(command))

    def _ask(self, order: Callable[[Worker], None]) -> None:
        """Ask something of the run, if there is one, or of the one to come."""
        if self.waiting:
            self._asked.append(order)
        elif self._worker and self.alive:
            order(self._worker)

    def _start(self, launch: Callable[[], str]) -> str:
        """Start a run as soon as nothing is left of the one before; returns what the player should know by now."""
        self._launch = launch
        self._asked.clear()
        if self._worker:
            self._worker.stop()
        return self._start_waiting()

    def _start_waiting(self) -> str:
        """Start the run that waits, if there is one and its turn has come; returns what the player should know."""
        if self._launch is None or (self._worker and not self._worker.gone):
            return ""
        launch, self._launch = self._launch, None
        note = launch()
        for order in self._asked:
            self._ask(order)
        self._asked.clear()
        return note
