"""A file that one process at a time holds; the system lets go of it however that process ends."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import IO

if sys.platform == "win32":
    import msvcrt

    def _hold(file: IO[bytes]) -> None:
        msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)

else:
    import fcntl

    def _hold(file: IO[bytes]) -> None:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)


class Lock:
    """Made by `take`; held until `release`."""

    def __init__(self, file: IO[bytes] | None) -> None:
        self._file = file

    def release(self) -> None:
        """Let others take it."""
        if self._file:
            self._file.close()


def take(path: Path) -> Lock | None:
    """Return the lock of a file, which is made if need be; None if another holds it.

    Where files can't be made or locked at all, such as on some network drives, everybody gets it.
    """
    file = None
    with suppress(OSError):
        path.parent.mkdir(parents=True, exist_ok=True)
        file = path.open("ab")
        try:
            _hold(file)
        except (BlockingIOError, PermissionError):  # what Linux and Windows say of a lock that is held
            file.close()
            return None
    return Lock(file)


@contextmanager
def held(path: Path, seconds: float = 1.0) -> Iterator[None]:
    """Hold the lock of a file for a moment, to read another file and write it anew.

    After so many seconds of waiting it goes on without: then one of two changes may be lost, but the game goes on.
    """
    end = time.monotonic() + seconds
    while not (lock := take(path)) and time.monotonic() < end:
        time.sleep(0.01)
    try:
        yield
    finally:
        if lock:
            lock.release()
