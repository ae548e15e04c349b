"""A lock that is held for a moment, to change a file that another game may be changing."""

import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from ai.nn.lock import take


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
