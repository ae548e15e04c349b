"""Folders that are replaced whole or not at all, so that an interrupted save loses nothing."""

import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

CONFIG = "config.json"  # what every model's folder holds


@contextmanager
def atomic_folder(target: str | Path) -> Iterator[Path]:
    """Yield a new empty folder that takes the place of `target` if the block succeeds.

    Until then, and if the block fails, `target` stays as it is and nothing is left beside it. A folder that
    is replaced has to hold a `config.json`: anything else raises FileExistsError, so that no slip of a path
    can delete what somebody keeps there. One writer at a time for each target.
    """
    target = Path(target).resolve()
    new, old = _make_new(target), _beside(target, "old")
    shutil.rmtree(old, ignore_errors=True)
    try:
        yield new
        for path in [*new.rglob("*"), new]:
            _synchronise(path)
        if target.exists():
            target.rename(old)
        new.rename(target)
        _synchronise(target.parent)
    except BaseException:
        recover_folder(target)
        shutil.rmtree(new, ignore_errors=True)
        raise
    shutil.rmtree(old, ignore_errors=True)


def check_folder(target: str | Path) -> None:
    """Raise the OSError that `atomic_folder` would begin with, long before there is anything to write."""
    _make_new(Path(target).resolve()).rmdir()


def recover_folder(target: str | Path) -> None:
    """Put the old folder back if a save was stopped between its two renames. Call it before reading."""
    target = Path(target).resolve()
    old = _beside(target, "old")
    if not target.exists() and old.is_dir():
        with suppress(OSError):
            old.rename(target)


def _make_new(target: Path) -> Path:
    """Return an empty folder beside the target, if that may be replaced."""
    recover_folder(target)
    if target.exists() and not _is_replaceable(target):
        raise FileExistsError(f"{target} holds something else than a model, and is left as it is")
    new = _beside(target, "new")
    shutil.rmtree(new, ignore_errors=True)
    new.mkdir(parents=True)
    return new


def _beside(target: Path, suffix: str) -> Path:
    return target.with_name(f".{target.name}.{suffix}")


def _is_replaceable(target: Path) -> bool:
    return target.is_dir() and ((target / CONFIG).exists() or not any(target.iterdir()))


def _synchronise(path: Path) -> None:
    """Wait until a file or folder has reached the disk; not every system can promise that of a folder."""
    if path.is_dir():
        with suppress(OSError):
            _flush(path, os.O_RDONLY)
    else:
        _flush(path, os.O_RDWR)


def _flush(path: Path, flags: int) -> None:
    descriptor = os.open(path, flags)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
