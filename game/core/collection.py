"""Collection of named folders, such as a player's networks: rename, delete, restore, import and export them."""

from __future__ import annotations

import shutil
import time
import unicodedata
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Final, Generic, TypeVar

import platformdirs

from ai.files import (
    NEW,
    STALE,
    Lock,
    aside_for,
    brief,
    lock_of,
    move_state,
    moved_aside,
    recover_folder,
    remove_state,
    take,
)
from game.core import texts
from game.core.copying import copy_folder
from game.core.folders import looks_like_item, there
from game.core.names import (
    LONGEST_NAME,
    LibraryError,
    fitting,
    free_path,
    holder,
    is_valid_name,
    library_errors,
    name_problem,
    reason,
)
from game.core.trash import Trash

Item = TypeVar("Item")

UNSAVED: Final = ".training"  # folder of a run that has no name yet
_MOST_DELETED: Final = 8  # items that can be restored
_GAMES: Final = 16  # games that may train at the same time


def exports_dir() -> Path:
    """Return the folder for exports, within the player's documents."""
    return Path(platformdirs.user_documents_dir()) / texts.GAME


@dataclass(frozen=True)
class ItemKind(Generic[Item]):
    """Kind of the items of a collection.

    Attributes:
        parts: names of files or folders; a folder with any of them is an item, complete or not.
        read: returns an item from its folder and name; never raises.
        rescued: name to suggest for an item that was left behind without one.

    """

    parts: tuple[str, ...]
    read: Callable[[Path, str], Item]
    rescued: str


class Collection(Generic[Item]):
    """Named items in `folder`, each a folder. A method that fails raises LibraryError and changes nothing.

    Args:
        folder: the folder that holds the items; need not exist.
        kind: what an item is.

    Attributes:
        unsaved: folder of the item that has no name yet; a second game's has a number appended.
        problem: why `items` could not read the folder; empty if it could.

    """

    def __init__(self, folder: Path, kind: ItemKind[Item]) -> None:
        self.folder, self.kind = folder, kind
        self.unsaved, self.problem = folder / UNSAVED, ""
        self._trash = Trash(folder, _MOST_DELETED)
        self._lock: Lock | None = None

    def items(self) -> list[Item]:
        """Return every item, damaged ones too, by name; after undoing interrupted replacements."""
        self.problem = ""
        try:
            for path in list(self.folder.iterdir()):
                with suppress(OSError):  # a problem with one item does not affect the others
                    self._recover(path)
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

    def export(self, name: str, folder: Path | None = None) -> Path:
        """Copy an item into a folder, by default `exports_dir`; return the path of the copy.

        Nothing is overwritten: a copy whose name is taken gets a number.
        """
        source = self.existing(name)
        folder = folder or exports_dir()
        with library_errors(texts.LIBRARY_NOT_EXPORTED, name):
            folder.mkdir(parents=True, exist_ok=True)
            target = free_path(folder, name)
            copy_folder(source, target)
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
            self.folder.mkdir(parents=True, exist_ok=True)
            copy_folder(source, target)
        return target

    # Deleted items

    def delete(self, name: str) -> None:
        """Delete an item; `undo_delete` restores it, without the state of a run that could go on."""
        source = self.existing(name)
        self._trash.add(source, name)
        remove_state(source)

    @property
    def last_deleted(self) -> str:
        """Name of the item that `undo_delete` would restore; empty if there is none."""
        return (self._trash.names or [""])[-1]

    def undo_delete(self) -> Path | None:
        """Restore the item deleted last, under another name if its own is taken; None if there is none."""
        name = self.last_deleted
        if not name:
            return None
        taken = not is_valid_name(name) or holder(self.folder, name)
        return self._trash.restore_last(self.free_name(name) if taken else name)

    # Items without a name, and those left behind by a game that ended too early

    def hold(self) -> None:
        """Lock an `unsaved` folder against other games until `release`.

        Of the folders that no other game holds, take the first in which an item was left behind, or else the first.
        """
        self.release()
        places = [self.folder / f"{UNSAVED} {number}".removesuffix(" 1") for number in range(1, _GAMES + 1)]
        for place in [*filter(_was_used, places), *places]:
            self._lock = take(lock_of(place))
            if self._lock:
                self.unsaved = place
                if self.left_behind or not _was_used(place):
                    return
                self._lock.release()

    def release(self) -> None:
        """Unlock `unsaved` for other games."""
        if self._lock:
            self._lock.release()
            self._lock = None

    @property
    def left_behind(self) -> bool:
        """Whether an item lies in `unsaved`. Do not ask while it is being written, because this repairs it."""
        recover_folder(self.unsaved)
        with suppress(OSError):
            return any(there(self.unsaved / part) for part in self.kind.parts)
        return False

    def claim(self) -> Item | None:
        """Lock `unsaved` against other games until `release`; return the item in it, if any."""
        self.hold()
        return self.rescued()

    def rescued(self) -> Item | None:
        """Return the item without a name under a suggested one, if any. Call before a training begins."""
        return self.kind.read(self.unsaved, self.free_name(self.kind.rescued)) if self.left_behind else None

    def keep_rescued(self, name: str) -> Item:
        """Give the item without a name this one; return it."""
        target = self.new_folder(name)
        with library_errors(texts.LIBRARY_NOT_KEPT, name):
            self.unsaved.rename(target)
        move_state(self.unsaved, target)
        return self.kind.read(target, target.name)

    def discard_rescued(self) -> None:
        """Delete the item without a name, if any; `undo_delete` restores it."""
        if self.left_behind:
            self._trash.add(self.unsaved, self.free_name(self.kind.rescued))
            remove_state(self.unsaved)

    def _recover(self, path: Path) -> None:
        if (name := aside_for(path)) and name[0] != ".":
            recover_folder(self.folder / name)
        elif path.name.endswith(NEW) and path.name[0] == "." and time.time() - path.lstat().st_mtime > STALE:
            shutil.rmtree(path, ignore_errors=True)


def _was_used(place: Path) -> bool:
    return place.exists() or bool(moved_aside(place))
