"""What was read of folders is kept while their files stay as they are, so that the next scene need not wait for it."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from pathlib import Path
from threading import RLock
from typing import Generic, TypeVar

T = TypeVar("T")
_Stamp = list[tuple[str, int, int]]


class Kept(Generic[T]):
    """What was read of folders or files: the last `most` of them. Scenes share it, so none may change it.

    Attributes:
        lock: held while something is read, or made ready in a thread: nobody uses it before it is.

    """

    def __init__(self, most: int) -> None:
        self.lock = RLock()
        self._most = most
        self._read: dict[Hashable, tuple[_Stamp, T]] = {}  # the latest last

    def get(
        self, path: Path, read: Callable[[], T], *, more: Hashable = None, sound: Callable[[T], bool] = lambda _: True
    ) -> T:
        """Return what was read of a path, or else `read` it, and keep it if it is `sound`; raises what `read` does.

        `more` tells apart what is read of one path in several ways.
        """
        with self.lock:
            stamp, kept = _stamp(path), self._read.pop((path, more), None)
            value = kept[1] if kept and kept[0] == stamp else read()
            if stamp and sound(value):
                self._read[path, more] = stamp, value
                if len(self._read) > self._most:
                    del self._read[next(iter(self._read))]
        return value

    def clear(self) -> None:
        """Forget all."""
        with self.lock:
            self._read.clear()


def _stamp(path: Path) -> _Stamp:
    """Return what tells whether a file has changed, or any in a folder: names, sizes and times; empty if unknown."""
    try:
        files = path.rglob("*") if path.is_dir() else [path]
        return sorted((str(each), (status := each.stat()).st_size, status.st_mtime_ns) for each in files)
    except OSError:
        return []
