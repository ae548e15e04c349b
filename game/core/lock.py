"""File lock, held for a moment while a file is changed that another running game may change too."""

import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from ai.files import take


@contextmanager
def held(path: Path, seconds: float = 1.0) -> Iterator[None]:
    """Hold the lock of a file while it is read and rewritten; a context manager.

    Waits at most `seconds`, then goes on without the lock: one of two changes may be lost, but the game is not blocked.
    """
    end = time.monotonic() + seconds
    while not (lock := take(path)) and time.monotonic() < end:
        time.sleep(0.01)
    try:
        yield
    finally:
        if lock:
            lock.release()
