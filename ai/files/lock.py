"""Lock of a file that one holder at a time has; the system releases it however the holder's process ends."""

import errno
import os
from contextlib import ExitStack, suppress
from pathlib import Path


def take(path: Path, seconds: float = 0.0) -> ExitStack | None:
    """Return the lock of a file, to be closed; None if another holds it for more than so many seconds.

    Where files can't be made or locked at all, such as on some network drives, every caller gets it. A lock that was
    closed leaves no file behind, but for Windows.
    """
    from filelock import FileLock, Timeout  # so that what locks nothing does not wait for it

    lock, held = FileLock(path, seconds, thread_local=False), ExitStack()
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        lock.acquire(poll_interval=0.01)
    except Timeout:
        return None
    except OSError:
        return held
    held.callback(lock.release)
    held.callback(_remove, path)  # first, while it is held, so that nobody else's is removed
    return held


def take_folder(folder: str | Path) -> ExitStack:
    """Return the lock of a folder that is about to be written again and again, as training does.

    It lies beside the folder, which itself is replaced as a whole. Raises BlockingIOError, with a sentence, if another
    holds it: the second of two would undo the first.
    """
    path = Path(os.path.realpath(folder))
    held = take(path.parent / f".{path.name.removeprefix('.')}.lock")
    if held is None:
        raise BlockingIOError(errno.EAGAIN, "another training is keeping its work there", str(folder))
    return held


def _remove(path: Path) -> None:
    with suppress(OSError):
        path.unlink()
