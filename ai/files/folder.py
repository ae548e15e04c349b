"""Atomic folders, replaced whole or not at all, so that an interrupted save loses nothing.

Only what is ours is ever replaced: a folder whose `config.json` says of which kind it is, and that holds nothing but
what belongs into one of that kind.
"""

import os
import shutil
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Final

from ai.files.lock import take_folder
from ai.files.reading import beside, brief, read_json, synchronise

CONFIG = "config.json"  # what every model's folder holds
OLD: Final = ".old"  # the end of the name of a folder that was moved aside for a new one
NEW: Final = ".new"  # and of one that is not finished
STALE: Final = 3600.0  # seconds after which it counts as abandoned
_DESKTOP: Final = (".DS_Store", "Thumbs.db", "desktop.ini")  # what systems leave wherever a folder was looked at
_TRIES: Final = 5


@dataclass(frozen=True)
class FolderKind:
    """Kind of a model's folder: its format, and what it may hold.

    Attributes:
        format: what its `config.json` says it is.
        files: names of files besides that, in which * stands for anything.
        folders: kinds of the folders within, by name.

    """

    format: str
    files: tuple[str, ...] = ()
    folders: Mapping[str, "FolderKind"] = field(default_factory=dict)

    def stranger(self, folder: Path) -> str:
        """Return a few words on what in a folder does not belong into one of this kind; empty if all of it does."""
        try:
            said = read_json(folder / CONFIG)
        except (OSError, ValueError):
            return f"no {CONFIG} that can be read"
        if not isinstance(said, dict) or said.get("format") != self.format:
            return f"{CONFIG} of another kind"
        for path in folder.iterdir():
            known = path.is_file() and any(fnmatchcase(path.name, name) for name in (CONFIG, *_DESKTOP, *self.files))
            if path.is_dir() and not path.is_symlink() and path.name in self.folders:
                if within := self.folders[path.name].stranger(path):
                    return f"{within} in {path.name}"
            elif path.is_symlink() or not known:
                return brief(path.name, 60)
        return ""


NETWORK: Final = FolderKind("tranquility network", ("layer-*-*.npy",))


@contextmanager
def atomic_folder(target: str | Path, kind: FolderKind = NETWORK) -> Iterator[Path]:
    """Yield a new empty folder that takes the place of `target` if the block succeeds.

    Until then, and if the block fails, `target` stays as it is and nothing is left beside it. A folder that is
    replaced has to be empty or of the same `kind`: anything else raises FileExistsError, a sentence, so that no slip
    of a path can delete what somebody keeps there. The old folder is moved aside before the new one stands, and
    deleted only then.
    """
    target, new = _begin(target, kind)
    try:
        yield new
        for path in [*new.rglob("*"), new]:
            synchronise(path)
        _check(target, kind)  # something else may have been put there meanwhile
        _swap(new, target)
        synchronise(target.parent)
    except BaseException:
        recover_folder(target)
        shutil.rmtree(new, ignore_errors=True)
        raise
    for old in moved_aside(target):
        if not any(old.iterdir()) or not kind.stranger(old):
            shutil.rmtree(old, ignore_errors=True)


def check_folder(target: str | Path, kind: FolderKind = NETWORK) -> None:
    """Raise the OSError that `atomic_folder` would begin with, long before there is anything to write."""
    _begin(target, kind)[1].rmdir()


@contextmanager
def claimed_folder(target: str | Path, kind: FolderKind) -> Iterator[None]:
    """Lock a folder against training by other processes, game or command, while the block lasts.

    Raises, before there is anything to write, BlockingIOError if one does, and the OSError that `atomic_folder`
    would begin with.
    """
    with take_folder(target):
        check_folder(target, kind)
        yield


def free_folder(target: Path) -> Path:
    """Return a name near a target, with a number behind it, that nothing has yet."""
    number, path = 2, target.with_name(f"{target.name} 2")
    while os.path.lexists(path):
        number += 1
        path = target.with_name(f"{target.name} {number}")
    return path


def recover_folder(target: str | Path) -> None:
    """Put the old folder back if a save was stopped between its two renames. Call it before reading."""
    with suppress(OSError, ValueError):
        path = Path(os.path.realpath(target))
        if not os.path.lexists(path) and (aside := moved_aside(path)):
            max(aside, key=lambda old: old.stat().st_mtime).rename(path)


def state_folder(folder: str | Path) -> Path:
    """Return the folder of the state that belongs to a run's folder: hidden, and beside it."""
    folder = Path(folder)
    return folder.with_name(f".{folder.name}.state")


def remove_state(folder: str | Path) -> None:
    """Delete the state of a run that has ended for good; the network in its folder stays."""
    shutil.rmtree(state_folder(folder), ignore_errors=True)


def move_state(source: Path, target: Path) -> None:
    """Let the state follow a run's folder to another name."""
    remove_state(target)
    with suppress(OSError):
        state_folder(source).rename(state_folder(target))


def aside_for(path: Path) -> str:
    """Return the name of the folder for which this one was moved aside; empty if it was not."""
    if not path.name.startswith(".") or not path.name.endswith(OLD):
        return ""
    name = path.name[1 : -len(OLD)]
    stem, dot, token = name.rpartition(".")
    return stem if dot and len(token) == 8 and set(token) <= set("0123456789abcdef") else name


def _begin(target: str | Path, kind: FolderKind) -> tuple[Path, Path]:
    """Return the folder meant, with its links followed, and an empty one beside it, if it may be replaced."""
    recover_folder(target)
    path = Path(os.path.realpath(target))
    _check(path, kind)
    for left in path.parent.glob(f".{_literal(path.name)}*{NEW}") if path.parent.is_dir() else ():
        with suppress(OSError):
            if time.time() - left.stat().st_mtime > STALE:
                shutil.rmtree(left)
            elif left.name == f".{path.name}{NEW}":  # as all were called once; an empty one is abandoned
                left.rmdir()
    new = beside(path, NEW)
    new.mkdir(parents=True)
    return path, new


def _check(target: Path, kind: FolderKind) -> None:
    """Raise FileExistsError unless nothing is lost if a target is replaced, OSError if that can't be seen."""
    if not target.name:
        raise FileExistsError(f"{target} is no place for a model")
    if not os.path.lexists(target):
        return
    if not target.is_dir():
        raise FileExistsError(f"{target} is something else than a folder, and is left as it is")
    if any(target.iterdir()) and (stranger := kind.stranger(target)):
        raise FileExistsError(f"{target} holds something else than a {kind.format} ({stranger}), and is left as it is")


def _swap(new: Path, target: Path) -> None:
    """Move the target aside and the new folder into its place."""
    for attempt in range(_TRIES):
        if target.exists():
            target.rename(beside(target, OLD))
        try:
            new.rename(target)
        except OSError:
            if attempt == _TRIES - 1 or not target.exists():
                raise
        else:  # else a reader has put the old one back meanwhile
            return


def moved_aside(target: Path) -> list[Path]:
    """Return the folders that were moved aside for a target and not deleted yet."""
    return [
        path
        for path in target.parent.glob(f".{_literal(target.name)}*{OLD}")
        if aside_for(path) == target.name and path.is_dir() and not path.is_symlink()
    ]


def _literal(name: str) -> str:
    return "".join(f"[{letter}]" if letter in "*?[" else letter for letter in name)
