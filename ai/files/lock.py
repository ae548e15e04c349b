"""File lock that one process at a time holds; the system releases it however that process ends."""

import errno
import os
import stat
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
    """Lock made by `take`; held until `release`, or until the `with` block that it begins is over."""

    def __init__(self, file: IO[bytes] | None, path: Path | None = None) -> None:
        self._file, self._path = file, path

    def release(self) -> None:
        """Release the lock, and leave no file behind."""
        if self._file is None:
            return
        file, self._file = self._file, None
        if sys.platform != "win32" and self._path:  # while it is held, so that nobody else's is removed
            with suppress(OSError):
                self._path.unlink()
        file.close()

    def __enter__(self) -> "Lock":
        return self

    def __exit__(self, *_: object) -> None:
        self.release()


def take(path: Path) -> Lock | None:
    """Return the lock of a file, which is made if need be; None if another holds it.

    Where files can't be made or locked at all, such as on some network drives, every caller gets it.
    """
    with suppress(OSError):
        path.parent.mkdir(parents=True, exist_ok=True)
        while True:
            file = _open(path)
            try:
                _hold(file)
            except (BlockingIOError, PermissionError):  # what Linux and Windows say of a lock that is held
                file.close()
                return None
            except OSError:
                file.close()
                break
            if _is_there(file, path):
                return Lock(file, path)
            file.close()  # its holder has removed it meanwhile
    return Lock(None)


def take_folder(folder: str | Path) -> Lock:
    """Return the lock of a folder that is about to be written again and again, as training does.

    Raises BlockingIOError, with a sentence, if another holds it: the second of two would undo the first.
    """
    lock = take(lock_of(folder))
    if lock is None:
        raise BlockingIOError(errno.EAGAIN, "another training is keeping its work there", str(folder))
    return lock


def lock_of(folder: str | Path) -> Path:
    """Return the file that stands for a folder: beside it, since the folder itself is replaced as a whole."""
    path = Path(os.path.realpath(folder))
    return path.parent / f".{path.name.removeprefix('.')}.lock"


def _open(path: Path) -> IO[bytes]:
    """Open an ordinary file, which is made if need be; raises OSError for anything else, and never waits."""
    flags = os.O_RDWR | os.O_CREAT | os.O_APPEND | getattr(os, "O_NONBLOCK", 0)
    file = os.fdopen(os.open(path, flags, 0o666), "ab")
    if not stat.S_ISREG(os.fstat(file.fileno()).st_mode):
        file.close()
        raise OSError(errno.EINVAL, "is not an ordinary file", str(path))
    return file


def _is_there(file: IO[bytes], path: Path) -> bool:
    with suppress(OSError):
        return os.path.samestat(os.fstat(file.fileno()), path.stat())
    return False
