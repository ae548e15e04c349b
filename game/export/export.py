"""Export of a flight as GIF in a process of its own, so that the window neither waits nor slows down."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

from game.core.worker import Worker, WorkerState
from game.export.film import Filmed, film, unfinished
from game.flight.flight_file import Record
from game.ui.context import Context


class Export:
    """Running export of a flight; call `poll` once a frame.

    Args:
        scene: makes the scene to film; a class or function at module level, so that another process can import it.
        record: the flight to export.
        path: the file to write.
        colour_safe: whether to use the palette for colour-blind viewers.

    Attributes:
        path: the file, complete once this is `over` without a `problem`.
        share: progress, 0 to 1.

    """

    def __init__(
        self, scene: Callable[[Context, Record], Filmed], record: Record, path: Path, *, colour_safe: bool = False
    ) -> None:
        self.path, self.share = path, 0.0
        self._worker = Worker(film, scene, record, path, colour_safe)

    def poll(self) -> None:
        """Update the progress."""
        for drawn in self._worker.poll():
            self.share = drawn.share

    @property
    def over(self) -> bool:
        """Whether the export has ended, with or without success."""
        return self._worker.state in (WorkerState.ENDED, WorkerState.FAILED)

    @property
    def problem(self) -> str:
        """Reason why there is no file; empty during the export, after a cancellation and after success."""
        return self._worker.problem

    def close(self) -> None:
        """Cancel the export and delete the unfinished file."""
        self._worker.close(0.0)  # the window may go on: it waits for no goodbye
        with suppress(OSError, ValueError):  # usually the process has deleted it already
            unfinished(self.path).unlink()
