"""Saving a flight as a moving picture, in a process of its own: the window neither waits for it nor feels it.

A GIF can always be made; an MP4 needs what the extra `export` brings.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from typing import Final

from game.core.worker import State, Worker
from game.flight.flight_file import Record


@dataclass(frozen=True)
class Kind:
    """One kind of moving picture.

    Attributes:
        needs: the module without which it can't be made.
        size: width and height in pixels.
        every: physics steps from frame to frame.
        still: whether the camera rests, which a picture needs that stores only what changes.

    """

    needs: str
    size: tuple[int, int]
    every: int
    still: bool

    @property
    def missing(self) -> bool:
        """Whether what it needs is not installed."""
        return find_spec(self.needs) is None


KINDS: Final = {".gif": Kind("PIL", (640, 360), 3, True), ".mp4": Kind("av", (1280, 720), 1, False)}


class Export:
    """A flight on its way into a file; `poll` once a frame.

    Attributes:
        path: of the file, which is there once this is `over` without a `problem`.
        share: how much of it is drawn, 0 to 1.

    """

    def __init__(self, record: Record, path: Path, *, colour_safe: bool = False) -> None:
        from game.export.film import film

        self.path, self.share = path, 0.0
        self._worker = Worker(film, record, path, colour_safe)

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


def unfinished(path: Path) -> Path:
    """Return where a file is written until it is complete."""
    return path.with_name(f".{path.name}.part")
