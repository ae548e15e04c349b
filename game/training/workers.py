"""Runs in worker processes, one after another: how each kind is started, and what every one of them can be asked."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Final

from ai.digits.config import DigitConfig
from ai.files.knobs import Knobs
from ai.training.config import Config
from ai.training.digit_session import live_digits
from ai.training.history import COLUMNS, DIGIT_COLUMNS
from ai.training.lander_session import live
from game.core.worker import PATIENCE, Worker, WorkerState

# Decisions of all landers per second; one takes 1/15 s of simulated time. None is as fast as possible.
PACES: Final[tuple[float | None, ...]] = (15.0, 60.0, None)


@dataclass(frozen=True)
class WorkedRun:
    """Kind of run, as the window starts it.

    Attributes:
        live: the generator that a worker pulls.
        config: settings before the first run.
        columns: what its history measures.
        grace: seconds that a run has to end by itself when the window closes it.
        patience: seconds for a turn of its worker.

    """

    live: Callable[..., Any]
    config: Knobs
    columns: Sequence[str]
    grace: float
    patience: float = PATIENCE


LANDERS: Final = WorkedRun(live, Config(), COLUMNS, grace=3.0)  # which save themselves at the end
# Reading all test images takes long on a busy machine.
DIGITS: Final = WorkedRun(live_digits, DigitConfig(), DIGIT_COLUMNS, grace=1.0, patience=120.0)


class OneAfterAnother:
    """Runs in child processes. They write to the same folder, so the next one waits until the last one has ended.

    Requests to the next run are queued until it starts.

    Attributes:
        twin: runs that go on beside these, and are paused, resumed and stepped with them; None without any.
        pace: number of one of `PACES`.

    """

    def __init__(self) -> None:
        self.twin: Any = None
        self.pace = len(PACES) - 1
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

    def _ask(self, order: Callable[[Worker], None], *, both: bool = False) -> None:
        """Send a request to the current run, if any, or queue it for the waiting one; `both`: and to the twin."""
        if self.waiting:
            self._asked.append(order)
        elif self._worker and self.alive:
            order(self._worker)
        if both and self.twin:
            self.twin._ask(order)

    def _send(self, *command: Any, both: bool = False) -> None:
        self._ask(lambda worker: worker.send(command), both=both)

    def pause(self) -> None:
        """Pause."""
        self._ask(Worker.pause, both=True)

    def resume(self) -> None:
        """Resume."""
        self._ask(Worker.resume, both=True)

    def step(self) -> None:
        """Take one learning step, then pause."""
        self._ask(Worker.pause, both=True)
        self._ask(Worker.step, both=True)

    def set_pace(self, index: int) -> None:
        """Choose one of `PACES` by its index."""
        self.pace = index
        self._ask(lambda worker: worker.set_pace(PACES[index]), both=True)
