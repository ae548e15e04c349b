"""Base class of training runs, each in a child process, one after another."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import count
from typing import Any, Generic, TypeVar

from ai.training.messages import ChangeSetting
from game.core import texts
from game.core.worker import Worker, WorkerState

Kind = TypeVar("Kind")


@dataclass(frozen=True)
class EarlierRun(Generic[Kind]):
    """Earlier run shown beside the current one; its line style stays the same as others come and go."""

    name: str
    run: Kind
    style: int  # number for game.charts.series.run_style; 0 is the current run's


def put_beside(runs: list[EarlierRun[Kind]], name: str, run: Kind) -> None:
    """Add an earlier run, in place of one of its name, with the first line style that is free."""
    runs[:] = [each for each in runs if each.name != name]
    taken = {each.style for each in runs}
    runs.insert(0, EarlierRun(name, run, next(style for style in count(1) if style not in taken)))


def rename_beside(runs: list[EarlierRun[Kind]], style: int, name: str) -> str:
    """Rename the earlier run of a line style; return why that cannot be, or ""."""
    if not name or any(each.name == name and each.style != style for each in runs):
        return texts.COMPARE_NAME_TAKEN if name else texts.COMPARE_NAME_EMPTY
    runs[:] = [replace(each, name=name) if each.style == style else each for each in runs]
    return ""


def take_away(runs: list[EarlierRun[Kind]], style: int) -> None:
    """Take away the earlier run of a line style; the others keep theirs."""
    runs[:] = [each for each in runs if each.style != style]


class TrainingRun:
    """Training run with its worker process: start, pause, resume, step and stop it.

    Runs save to the same folder, so the next one waits until the process before it has ended. The window does not
    wait: requests to the next run are queued until it starts.

    Attributes:
        grace: seconds that a run has to end by itself when the window closes it.
        name: name of the run, to tell it from others.
        runs: number of runs so far.

    """

    grace = 0.5

    def __init__(self) -> None:
        self.name, self.runs = "", 0
        self._named = False  # whether the run was saved under its name
        self._worker: Worker | None = None
        self._launch: Callable[[], str] | None = None  # starts the waiting run; returns a note for the player
        self._asked: list[Callable[[Worker], None]] = []  # requests queued for the waiting run

    @property
    def waiting(self) -> bool:
        """Whether a run waits for the previous one to end."""
        return self._launch is not None

    @property
    def state(self) -> WorkerState | None:
        """State of the run; None before the first."""
        if self.waiting:
            return WorkerState.STARTING
        return self._worker.state if self._worker else None

    @property
    def alive(self) -> bool:
        """Whether there is a run that can be paused, stepped, stopped and changed."""
        return self.state in (WorkerState.STARTING, WorkerState.RUNNING, WorkerState.PAUSED)

    @property
    def problem(self) -> str:
        """Reason why the run failed; empty if it did not."""
        return self._worker.problem if self._worker and self.state is WorkerState.FAILED else ""

    def call(self, settings: str) -> None:
        """Name the run after its settings, with a number, unless it was saved under a name."""
        if not self._named:
            self.name = texts.TRAIN_RUN.format(name=settings or texts.TRAIN_THIS, number=self.runs)

    def pause(self) -> None:
        """Pause the run."""
        self._ask(Worker.pause)

    def resume(self) -> None:
        """Resume the run."""
        self._ask(Worker.resume)

    def step(self) -> None:
        """Take one learning step, then pause."""
        self._ask(Worker.pause)
        self._ask(Worker.step)

    def change(self, name: str, value: Any) -> None:
        """Change a live setting of the run."""
        self._send(ChangeSetting(name, value))

    def close(self) -> None:
        """End the run and its process for certain."""
        self._launch = None
        if self._worker:
            self._worker.close(self.grace)

    def _send(self, command: Any) -> None:
        self._ask(lambda worker: worker.send(command))

    def _ask(self, order: Callable[[Worker], None]) -> None:
        """Send a request to the current run, if any, or queue it for the waiting one."""
        if self.waiting:
            self._asked.append(order)
        elif self._worker and self.alive:
            order(self._worker)

    def _start(self, launch: Callable[[], str]) -> str:
        """Start a run as soon as the previous process has ended; return a note for the player, or ""."""
        self._launch = launch
        self._asked.clear()
        if self._worker:
            self._worker.stop()
        return self._start_waiting()

    def _start_waiting(self) -> str:
        """Start the waiting run, if the previous process has ended; return a note for the player, or ""."""
        if self._launch is None or (self._worker and not self._worker.gone):
            return ""
        launch, self._launch = self._launch, None
        note = launch()
        for order in self._asked:
            self._ask(order)
        self._asked.clear()
        return note
