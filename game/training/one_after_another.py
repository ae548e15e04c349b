"""Worker processes of which the next one waits for the end of the one before, while the window waits for none."""

from __future__ import annotations

from collections.abc import Callable

from game.core.worker import Worker, WorkerState


class OneAfterAnother:
    """Runs in child processes. They write to the same folder, so the next one waits until the last one has ended.

    Requests to the next run are queued until it starts.
    """

    def __init__(self) -> None:
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

    def _ask(self, order: Callable[[Worker], None]) -> None:
        """Send a request to the current run, if any, or queue it for the waiting one."""
        if self.waiting:
            self._asked.append(order)
        elif self._worker and self.alive:
            order(self._worker)
