"""Folders that are made, and replaced, whole or not at all, so that an interrupted save loses nothing.

Only what is ours is ever replaced: a folder whose `config.json` says of which kind it is, and that holds nothing but
what belongs into one of that kind.
"""

import errno
import glob
import os
import re
import shutil
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Final

from ai.files.reading import brief, read_json
from ai.files.writing import beside, synchronise, take

CONFIG = "config.json"  # what every model's folder holds
_NEW, _OLD = ".new", ".old"  # ends of the names of folders that are not finished, or were moved aside for a new one
_ASIDE: Final = re.compile(r"\.(.+)\.[0-9a-f]{8}\.(?:new|old)")  # such a name, as `beside` makes it
_STALE: Final = 3600.0  # seconds after which one that is not finished counts as abandoned
_DESKTOP: Final = ("*.DS_Store", "*Thumbs.db", "*desktop.ini")  # what systems leave wherever a folder was looked at


@dataclass(frozen=True)
class FolderKind:
    """Kind of a model's folder: its format, as its `config.json` says, and the files in it.

    `files` are paths relative to the folder, in which * stands for anything.
    """

    format: str
    files: tuple[str, ...] = (CONFIG,)

    def within(self, name: str) -> tuple[str, ...]:
        """Return the files of such a folder that lies within another, for the kind of that one."""
        return tuple(f"{name}/{file}" for file in self.files)

    def foreign(self, folder: Path) -> str:
        """Say what in a folder does not belong into one of this kind; empty if all of it does."""
        try:
            said = read_json(folder / CONFIG)
        except (OSError, ValueError):
            return f"no {CONFIG} that can be read"
        if not isinstance(said, dict) or said.get("format") != self.format:
            return f"{CONFIG} of another kind"
        for path in folder.rglob("*"):
            name = path.relative_to(folder).as_posix()
            known = path.is_dir() or any(fnmatchcase(name, each) for each in (*self.files, *_DESKTOP))
            if path.is_symlink() or not known:
                return brief(name, 60)
        return ""


NETWORK: Final = FolderKind("tranquility network", (CONFIG, "layer-*-*.npy"))
STATE_FILE: Final = "state.npz"  # what a run goes on from besides its networks
OF_A_RUN: Final = "training.json", "history.json", "curves.csv", "checkpoints.npz", STATE_FILE  # in any run's folder


def user_dir() -> Path:
    """Return the user's own folder for settings, scores, networks and studies."""
    import platformdirs

    return Path(platformdirs.user_data_dir("tranquility", appauthor=False))


@contextmanager
def atomic_folder(target: str | Path, kind: FolderKind | None = NETWORK) -> Iterator[Path]:
    """Yield a new empty folder that takes the place of `target` if the block succeeds.

    Until then, and if the block fails, `target` stays as it is and nothing is left beside it. A folder that is
    replaced has to be empty or of the same `kind`, or with None there must be none: anything else raises
    FileExistsError, a sentence, so that no slip of a path can delete what somebody keeps there. The old folder is
    moved aside before the new one stands, and deleted only then.
    """
    path = _checked(target, kind) if kind else Path(target)
    _clear_away(path)
    new = beside(path, _NEW)
    new.mkdir(parents=True)
    try:
        yield new
        for made in [*new.rglob("*"), new]:
            synchronise(made)
        if kind and _checked(path, kind).exists():
            path.rename(beside(path, _OLD))
        new.rename(path)
        synchronise(path.parent)
    except BaseException:
        recover_folder(path)
        shutil.rmtree(new, ignore_errors=True)
        raise
    for old in _aside(path, _OLD):
        shutil.rmtree(old, ignore_errors=True)


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


@contextmanager
def claimed_folder(target: str | Path, kind: FolderKind) -> Iterator[None]:
    """Lock a folder against training by other processes, game or command, while the block lasts.

    Raises, before there is anything to write, BlockingIOError if one does, and the OSError that `atomic_folder`
    would begin with.
    """
    with take_folder(target):
        new = beside(_checked(target, kind), _NEW)
        new.mkdir(parents=True)
        new.rmdir()
        yield


def recover_folder(target: str | Path) -> None:
    """Put the old folder back if a save was stopped between its two renames. Call it before reading."""
    with suppress(OSError, ValueError):
        path = Path(os.path.realpath(target))
        if not os.path.lexists(path) and (aside := _aside(path, _OLD)):
            max(aside, key=lambda old: old.stat().st_mtime).rename(path)


def recover_all(folder: Path) -> None:
    """Put back or delete what saves that were stopped have left in a folder; raises OSError if it can't be seen."""
    for name in {found[1] for path in folder.iterdir() if (found := _ASIDE.fullmatch(path.name))}:
        recover_folder(folder / name)
        _clear_away(folder / name)


def _clear_away(path: Path) -> None:
    """Delete the folders beside a path that were begun for it long ago and never finished."""
    for left in _aside(path, _NEW):
        with suppress(OSError):
            if time.time() - left.stat().st_mtime > _STALE:
                shutil.rmtree(left)


def _aside(path: Path, suffix: str) -> list[Path]:
    """Return the folders beside a path that were begun, or moved aside, for it."""
    found = path.parent.glob(f".{glob.escape(path.name)}.{8 * '[0-9a-f]'}{suffix}")
    return [each for each in found if not each.is_symlink()]


def _checked(target: str | Path, kind: FolderKind) -> Path:
    """Return the folder meant, with its links followed.

    Raises FileExistsError unless nothing is lost if it is replaced, OSError if that can't be seen.
    """
    recover_folder(target)
    path = Path(os.path.realpath(target))
    if not os.path.lexists(path):
        return path
    if not path.is_dir() or not path.name:
        raise FileExistsError(f"{path} is no folder for a model, and is left as it is")
    if any(path.iterdir()) and (foreign := kind.foreign(path)):
        raise FileExistsError(f"{path} holds something else than a {kind.format} ({foreign}), and is left as it is")
    return path
