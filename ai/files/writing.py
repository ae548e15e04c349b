"""Writing of files: whole or not at all, of lines at the end of one, and by one writer at a time."""

import json
import os
import secrets
from contextlib import ExitStack, nullcontext, suppress
from pathlib import Path
from typing import Any


def beside(path: Path, suffix: str) -> Path:
    """Return a name beside a path that nothing else has: hidden, and with a suffix that says what it is."""
    return path.with_name(f".{path.name}.{secrets.token_hex(4)}{suffix}")


def free_path(folder: Path, name: str, suffix: str = "") -> Path:
    """Return a path in a folder that nothing has yet: of a name, with a number behind it if that is taken."""
    path, number = folder / f"{name}{suffix}", 1
    while os.path.lexists(path):  # unlike Path.exists, raises nothing without permission to look
        number += 1
        path = folder / f"{name} {number}{suffix}"
    return path


def write_text(path: Path, text: str, *, flush: bool = True) -> None:
    """Write a text as UTF-8; see `write_bytes`."""
    write_bytes(path, text.encode(), flush=flush)


def write_bytes(path: Path, content: bytes, *, flush: bool = True) -> None:
    """Write a file whole or not at all, by way of another beside it; with `flush`, wait until it is on the disk.

    Folders are made if need be. Raises OSError if it cannot be written; an older file is then still whole.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = beside(path, ".part")
    try:
        with temporary.open("xb") as file:
            file.write(content)
        if flush:
            synchronise(temporary)
        temporary.replace(path)
        if flush:
            synchronise(path.parent)  # which holds the name
    except BaseException:
        _remove(temporary)
        raise


def append_line(path: Path, values: Any) -> None:
    """Write values as a line of JSON at the end of a file, which is made if need be; raises OSError."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("ab") as file:
        file.write(b"\n" + json.dumps(values).encode() + b"\n")  # the last one may have been cut short


def synchronise(path: Path) -> None:
    """Wait until a file or folder has reached the disk; not every system can promise that of a folder."""
    folder = path.is_dir()
    with suppress(OSError) if folder else nullcontext():
        descriptor = os.open(path, os.O_RDONLY if folder else os.O_RDWR)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)


def take(path: Path, seconds: float = 0.0) -> ExitStack | None:
    """Return the lock of a file, to be closed; None if another holds it for more than so many seconds.

    The system releases it however the holder's process ends. Where files can't be made or locked at all, such as on
    some network drives, every caller gets it. A lock that was closed leaves no file behind, but for Windows.
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


def _remove(path: Path) -> None:
    with suppress(OSError):
        path.unlink()
