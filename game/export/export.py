"""Saving a flight as a moving picture, in a process of its own: the window neither waits for it nor feels it.

A GIF can always be made; an MP4 needs what the extra `export` brings.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

from game.core.worker import State, Worker
from game.export.film import Filmed, film
from game.export.kinds import unfinished
from game.flight.flight_file import Record


class Export:
    """A flight on its way into a file; `poll` once a frame.

    Args:
        scene: makes the scene that is filmed; a class or function, since another process is to find it.
        record: the flight.
        path: of the file to write.
        colour_safe: whether in the colours for the colour-blind.

    Attributes:
        path: of the file, which is there once this is `over` without a `problem`.
        share: how much of it is drawn, 0 to 1.

    """

    def __init__(
        self, scene: Callable[[Record], Filmed], record: Record, path: Path, *, colour_safe: bool = False
    ) -> None:
        self.path, self.share = path, 0.0
        self._worker = Worker(film, scene, record, path, colour_safe)

    def poll(self) -> None:
        """Hear how far it has come."""
        for drawn in self._worker.poll():
            self.share = drawn.share

    @property
    def over(self) -> bool:
        """Whether it has come to an end, well or not."""
        return self._worker.state in (State.ENDED, State.FAILED)

    @property
    def problem(self) -> str:
        """Why there is no file; empty while it goes on, after it was stopped, and if all went well."""
        return self._worker.problem

    def close(self) -> None:
        """Let it be; what was drawn so far is thrown away."""
        self._worker.close(0.0)  # the window may go on: it waits for no goodbye
        with suppress(OSError, ValueError):  # the process has most often done so itself
            unfinished(self.path).unlink()
