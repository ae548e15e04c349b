"""Collection of named folders, such as a player's networks: list, rename, delete, copy one in, rescue one run."""

from __future__ import annotations

import os
import shutil
import stat
import unicodedata
from collections.abc import Callable, Iterable
from contextlib import ExitStack, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Final, Generic, TypeVar

from ai.files import atomic_folder, brief, move_state, recover_all, recover_folder, remove_state, take_folder
from game.core import texts
from game.core.names import (
    LONGEST_NAME,
    LibraryError,
    fitting,
    holder,
    is_valid_name,
    library_errors,
    name_problem,
    reason,
)

Item = TypeVar("Item")

UNSAVED: Final = ".training"  # folder of a run that has no name yet
_DEEPEST: Final = 8  # depth of folders within a network's folder, its fixes included
MOST_FILES: Final = 5_000  # of a folder that is copied
MOST_BYTES: Final = 500_000_000


@dataclass(frozen=True)
class ItemKind(Generic[Item]):
    """Kind of the items of a collection.

    Attributes:
        parts: names of files or folders; a folder with any of them is an item, complete or not.
        read: returns an item from its folder and name; never raises.
        rescued: returns the name to suggest for an item that was left behind without one.

    """

    parts: tuple[str, ...]
    read: Callable[[Path, str], Item]
    rescued: Callable[[], str]


class Collection(Generic[Item]):
    """Named items in `folder`, each a folder. A method that fails raises LibraryError and changes nothing.

    Args:
        folder: the folder that holds the items; need not exist.
        kind: what an item is.

    Attributes:
        unsaved: folder of the item that has no name yet.
        problem: why `items` could not read the folder; empty if it could.

    """

    def __init__(self, folder: Path, kind: ItemKind[Item]) -> None:
        self.folder, self.kind = folder, kind
        self.unsaved, self.problem = folder / UNSAVED, ""
        self._lock = ExitStack()

    def items(self) -> list[Item]:
        """Return every item, damaged ones too, by name; after undoing interrupted replacements."""
        self.problem = ""
        try:
            recover_all(self.folder)
            found = sorted(self.folder.iterdir(), key=lambda path: path.name.casefold())
            return [self.kind.read(path, path.name) for path in found if looks_like_item(path, self.kind.parts)]
        except FileNotFoundError:
            return []
        except OSError as error:
            self.problem = texts.LIBRARY_UNREADABLE.format(folder=self.folder, reason=reason(error))
            return []

    def free_name(self, suggestion: str) -> str:
        """Return the suggestion as a valid, unused name, with a number appended if needed."""
        base = " ".join(fitting(suggestion).split())[:LONGEST_NAME].strip(" .")
        if name_problem(base):
            base = texts.RUN_UNNAMED
        name, number = base, 1
        while holder(self.folder, name):
            number += 1
            name = f"{base[: LONGEST_NAME - 1 - len(str(number))].rstrip(' .')} {number}"
        return name

    def new_folder(self, name: str) -> Path:
        """Return the path for a new item; raises LibraryError for an invalid or used name."""
        if problem := name_problem(name):
            raise LibraryError(problem)
        if taken := holder(self.folder, name):
            raise LibraryError(texts.NAME_TAKEN.format(name=taken))
        return self.folder / unicodedata.normalize("NFC", name)

    def existing(self, name: str) -> Path:
        """Return the path of an item; raises LibraryError if there is none, or if its name leads out of the folder."""
        folder = self.folder / name
        if name.startswith(".") or Path(name).name != name or not (folder.is_dir() or folder.is_symlink()):
            raise LibraryError(texts.GONE.format(name=name))
        return folder

    def rename(self, old: str, new: str) -> Path:
        """Rename an item to an unused name; return its path."""
        source = self.existing(old)
        target = self.folder / unicodedata.normalize("NFC", new)
        if not (is_valid_name(new) and holder(self.folder, new) == old):  # a change of case alone is no clash
            target = self.new_folder(new)
        with library_errors(texts.LIBRARY_NOT_RENAMED, old):
            source.rename(target)
        move_state(source, target)
        return target

    def import_folder(self, path: Path) -> Path:
        """Copy an item into the collection, numbered if its name is taken; return the path of the copy.

        A file of the item may be given in place of its folder.
        """
        with library_errors(texts.LIBRARY_NOT_IMPORTED, brief(path.name, LONGEST_NAME)):
            source = path if path.is_dir() else path.parent
            if not any(there(source / part) for part in self.kind.parts):
                raise LibraryError(texts.LIBRARY_NO_RUN.format(name=source.name))
            target = self.folder / self.free_name(source.name)
            _copy(source, target)
        return target

    def delete(self, name: str) -> None:
        """Delete an item for good, with the state of a run that could go on."""
        self._erase(self.existing(name), name)

    def _erase(self, folder: Path, name: str) -> None:
        with library_errors(texts.NOT_DELETED, name):
            folder.unlink() if folder.is_symlink() else shutil.rmtree(folder)
        remove_state(folder)

    # The item without a name, which a game that ended too early may have left

    def hold(self) -> bool:
        """Lock `unsaved` against other games until `release`; False if another holds it."""
        self.release()
        try:
            self._lock = take_folder(self.unsaved)
        except BlockingIOError:
            return False
        return True

    def release(self) -> None:
        """Unlock `unsaved` for other games."""
        self._lock.close()

    @property
    def left_behind(self) -> bool:
        """Whether an item lies in `unsaved`. Do not ask while it is being written, because this repairs it."""
        recover_folder(self.unsaved)
        with suppress(OSError):
            return any(there(self.unsaved / part) for part in self.kind.parts)
        return False

    def rescued(self) -> Item | None:
        """Return the item without a name under a suggested one, if any. Call before a training begins."""
        return self.kind.read(self.unsaved, self.free_name(self.kind.rescued())) if self.left_behind else None

    def keep_rescued(self, name: str) -> Item:
        """Give the item without a name this one; return it."""
        target = self.new_folder(name)
        with library_errors(texts.LIBRARY_NOT_KEPT, name):
            self.unsaved.rename(target)
        move_state(self.unsaved, target)
        return self.kind.read(target, target.name)

    def discard_rescued(self) -> None:
        """Delete the item without a name, if any."""
        if self.left_behind:
            self._erase(self.unsaved, self.kind.rescued())


def looks_like_item(folder: Path, parts: Iterable[str]) -> bool:
    """Whether a folder looks like an item of the collection: it has one of the parts, or it cannot be read.

    A folder that cannot be read, such as a broken link, counts too, so that it is listed with its problem.
    """
    if folder.name.startswith("."):
        return False
    try:
        return any(there(folder / part) for part in parts) or leads_nowhere(folder)
    except OSError:
        return True


def there(path: Path) -> bool:
    """Whether a path exists; raises OSError where that is unknown, for which `Path.exists` returns False."""
    try:
        path.stat()
    except (FileNotFoundError, NotADirectoryError, ValueError):
        return False
    return True


def leads_nowhere(path: Path) -> bool:
    """Whether a path is a broken link; raises OSError for a link to itself."""
    return path.is_symlink() and not there(path)


def _copy(source: Path, target: Path) -> None:
    """Copy a folder whole or not at all; raises LibraryError unless it holds only plain files, as many as a network's.

    A link may lead outside or in a circle, and a pipe never ends; the window waits while files are copied.
    """
    files = size = 0
    for parent, folders, names in os.walk(source):
        deep = len(Path(parent).relative_to(source).parts) >= _DEEPEST
        for name in (*folders, *names):
            said = Path(parent, name).lstat()
            if not (stat.S_ISREG(said.st_mode) or (stat.S_ISDIR(said.st_mode) and not deep)):
                raise LibraryError(texts.LIBRARY_NOT_PLAIN.format(name=source.name, inside=brief(name, 40)))
            files, size = files + 1, size + said.st_size
            if files > MOST_FILES or size > MOST_BYTES:
                raise LibraryError(texts.LIBRARY_TOO_LARGE.format(name=source.name))
    with atomic_folder(target, None) as new:
        shutil.copytree(source, new, symlinks=True, dirs_exist_ok=True)
