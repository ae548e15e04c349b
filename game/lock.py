"""A file that one process at a time holds; the system lets go of it however that process ends."""

from __future__ import annotations

import sys
from contextlib import suppress
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
