"""Trash of a folder: what was deleted there and can be restored, the latest last."""

from __future__ import annotations

import re
import shutil
import time
from contextlib import suppress
from pathlib import Path
from typing import Final

from game.core import texts
from game.core.names import LibraryError, holder, library_errors

TRASH: Final = ".trash"
_STAMP: Final = re.compile(r"[0-9]{1,30} ")  # prefix of the name of a deleted file or folder


class Trash:
    """Deleted files and folders of `folder`. A method that fails raises LibraryError and changes nothing.

    Args:
        folder: the folder that they are deleted from, and restored to; need not exist.
        most: how many can be restored: the latest ones.

    """

    def __init__(self, folder: Path, most: int) -> None:
        self.folder, self._most = folder, most

    def add(self, path: Path, name: str) -> None:
        """Delete a file or folder so that it can be restored by that name; very old ones are erased for good."""
        trash = self.folder / TRASH
        with library_errors(texts.NOT_DELETED, name):
            trash.mkdir(exist_ok=True)
            latest = max((_stamp(each) for each in self._deleted()), default=0)
            path.rename(trash / f"{max(time.time_ns(), latest + 1)} {name}")  # a clock can be set back
        for old in self._deleted()[: -self._most]:
            with suppress(OSError):
                shutil.rmtree(old) if old.is_dir() and not old.is_symlink() else old.unlink()

    @property
    def names(self) -> list[str]:
        """Names of all that can be restored, the latest last."""
        return [_name(path) for path in self._deleted()]

    def restore(self, name: str) -> Path:
        """Restore what was last deleted under that name, if the name is free; return its path."""
        found = [path for path in self._deleted() if _name(path) == name]
        if not found:
            raise LibraryError(texts.GONE.format(name=name))
        if holder(self.folder, name):
            raise LibraryError(texts.NAME_TAKEN.format(name=name))
        with library_errors(texts.LIBRARY_NOT_RESTORED, name):
            return found[-1].rename(self.folder / name)

    def restore_last(self, name: str) -> Path:
        """Restore what was deleted last, under a free name; return its path."""
        with library_errors(texts.LIBRARY_NOT_RESTORED, name):
            return self._deleted()[-1].rename(self.folder / name)

    def _deleted(self) -> list[Path]:
        """Return the paths of what was deleted, the latest last: each is named by its time of deletion and its name."""
        with suppress(OSError):
            dated = [path for path in (self.folder / TRASH).iterdir() if _STAMP.match(path.name)]
            return sorted(dated, key=_stamp)
        return []


def _stamp(path: Path) -> int:
    """Return the number of a deleted item: its time of deletion in nanoseconds, or slightly later to be unique."""
    return int(path.name.split(" ")[0])


def _name(path: Path) -> str:
    return path.name.partition(" ")[2]
