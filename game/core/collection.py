"""Collection of named folders, such as a player's networks: rename, delete, restore, import and export them."""

from __future__ import annotations

import os
import re
import shutil
import time
import unicodedata
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Final

import platformdirs

from ai.nn.files import beside, brief
from ai.nn.folder import NEW, STALE, aside_for, moved_aside, recover_folder
from ai.nn.lock import Lock, lock_of, take
from game.core import texts

UNSAVED: Final = ".training"  # folder of a run that has no name yet
TRASH: Final = ".trash"
LONGEST_NAME: Final = 40
_DEEPEST: Final = 8  # depth of folders within a network's folder, its fixes included
_MOST_FILES: Final = 5_000
_MOST_BYTES: Final = 500_000_000
_GAMES: Final = 16  # games that may train at the same time
_STAMP: Final = re.compile(r"[0-9]{1,30} ")  # prefix of the name of a deleted folder
_DEVICES: Final = {"con", "prn", "aux", "nul"} | {f"{port}{n}" for port in ("com", "lpt") for n in "123456789¹²³"}


class LibraryError(Exception):
    """Failed operation on a collection; its message is a sentence for the player."""


def fitting(text: str) -> str:
    """Remove from a text the characters that no name may contain."""
    return "".join(letter for letter in unicodedata.normalize("NFC", text) if letter.isalnum() or letter in " -_.")


def name_problem(text: str) -> str:
    """Return a sentence why a text is not a valid folder name on every system; empty if it is valid."""
    if not text.strip():
        return texts.NAME_EMPTY
    if len(text) > LONGEST_NAME:
        return texts.NAME_LONG.format(count=LONGEST_NAME)
    if fitting(text) != unicodedata.normalize("NFC", text):
        return texts.NAME_LETTERS
    if text[0] == "." or text[-1] == "." or text != text.strip():
        return texts.NAME_ENDS
    if text.partition(".")[0].strip().casefold() in _DEVICES:
        return texts.NAME_DEVICE.format(name=text)
    return ""


def is_valid_name(text: str) -> bool:
    """Whether a text is a valid folder name on every system."""
    return not name_problem(text)


def claims(folder: Path, parts: Iterable[str]) -> bool:
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


def exports_dir() -> Path:
    """Return the folder for exports, within the player's documents."""
    return Path(platformdirs.user_documents_dir()) / texts.GAME


def free_path(folder: Path, name: str, suffix: str = "") -> Path:
    """Return a free path in `folder` for a name, with a number appended if the name is taken."""
    path, number = folder / f"{name}{suffix}", 1
    while os.path.lexists(path):  # unlike Path.exists, raises nothing without permission to look
        number += 1
        path = folder / f"{name} {number}{suffix}"
    return path


class Collection:
    """Named items in `folder`, each a folder. A method that fails raises LibraryError and changes nothing.

    Args:
        folder: the folder that holds the items; need not exist.
        parts: names of files or folders; a folder with any of them is an item, complete or not.
        most_thrown: how many deleted items can be restored: the latest ones.

    Attributes:
        unsaved: folder of the item that has no name yet; a second game's has a number appended.

    """

    def __init__(self, folder: Path, parts: Iterable[str] = (), *, most_thrown: int = 8) -> None:
        self.folder, self.parts, self._most_thrown = folder, tuple(parts), most_thrown
        self.unsaved = folder / UNSAVED
        self._lock: Lock | None = None

    def free_name(self, suggestion: str) -> str:
        """Return the suggestion as a valid, unused name, with a number appended if needed."""
        base = " ".join(fitting(suggestion).split())[:LONGEST_NAME].strip(" .")
        if name_problem(base):
            base = texts.RUN_UNNAMED
        name, number = base, 1
        while self.holder(name):
            number += 1
            name = f"{base[: LONGEST_NAME - 1 - len(str(number))].rstrip(' .')} {number}"
        return name

    def new_folder(self, name: str) -> Path:
        """Return the path for a new item; raises LibraryError for an invalid or used name."""
        if problem := name_problem(name):
            raise LibraryError(problem)
        if holder := self.holder(name):
            raise LibraryError(texts.NAME_TAKEN.format(name=holder))
        return self.folder / unicodedata.normalize("NFC", name)

    def existing(self, name: str) -> Path:
        """Return the path of an item; raises LibraryError if there is none, or if its name leads out of the folder."""
        folder = self.folder / name
        if name.startswith(".") or Path(name).name != name or not (folder.is_dir() or folder.is_symlink()):
            raise LibraryError(texts.GONE.format(name=name))
        return folder

    def holder(self, name: str) -> str:
        """Return the existing name that some systems take for the same as this one; empty if there is none."""
        with suppress(OSError):
            return next((path.name for path in self.folder.iterdir() if _same(path.name) == _same(name)), "")
        return ""

    def rename(self, old: str, new: str) -> Path:
        """Rename an item to an unused name; return its path."""
        source = self.existing(old)
        target = self.folder / unicodedata.normalize("NFC", new)
        if not (is_valid_name(new) and self.holder(new) == old):  # a change of case alone is no clash
            target = self.new_folder(new)
        with told(texts.LIBRARY_NOT_RENAMED, old):
            source.rename(target)
        return target

    def name(self, folder: Path, name: str) -> Path:
        """Move a folder without a name into the collection under `name`; return its path."""
        target = self.new_folder(name)
        with told(texts.LIBRARY_NOT_KEPT, name):
            folder.rename(target)
        return target

    def export(self, name: str, folder: Path | None = None) -> Path:
        """Copy an item into a folder, by default `exports_dir`; return the path of the copy.

        Nothing is overwritten: a copy whose name is taken gets a number.
        """
        source = self.existing(name)
        folder = folder or exports_dir()
        with told(texts.LIBRARY_NOT_EXPORTED, name):
            folder.mkdir(parents=True, exist_ok=True)
            target = free_path(folder, name)
            _copy(source, target)
        return target

    def import_folder(self, path: Path) -> Path:
        """Copy a folder into the collection, numbered if its name is taken; return the path of the copy."""
        target = self.folder / self.free_name(path.name)
        with told(texts.LIBRARY_NOT_IMPORTED, path.name):
            self.folder.mkdir(parents=True, exist_ok=True)
            _copy(path, target)
        return target

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
            return any(there(self.unsaved / part) for part in self.parts)
        return False

    # Deleted items

    def throw_away(self, folder: Path, name: str) -> None:
        """Delete a folder or a file so that it can be restored by that name; very old ones are erased for good."""
        trash = self.folder / TRASH
        with told(texts.NOT_DELETED, name):
            trash.mkdir(exist_ok=True)
            latest = max((_stamp(path) for path in self._thrown()), default=0)
            folder.rename(trash / f"{max(time.time_ns(), latest + 1)} {name}")  # a clock can be set back
        for old in self._thrown()[: -self._most_thrown]:
            with suppress(OSError):
                shutil.rmtree(old) if old.is_dir() and not old.is_symlink() else old.unlink()

    @property
    def last_deleted(self) -> str:
        """Name of the item that `undo_delete` would restore; empty if there is none."""
        thrown = self._thrown()
        return thrown[-1].name.partition(" ")[2] if thrown else ""

    @property
    def deleted(self) -> set[str]:
        """Names of all deleted items that can be restored."""
        return {path.name.partition(" ")[2] for path in self._thrown()}

    def bring_back(self, name: str) -> Path:
        """Restore the item deleted under that name, if the name is free; return its path."""
        thrown = [path for path in self._thrown() if path.name.partition(" ")[2] == name]
        if not thrown:
            raise LibraryError(texts.GONE.format(name=name))
        if self.holder(name):
            raise LibraryError(texts.NAME_TAKEN.format(name=name))
        with told(texts.LIBRARY_NOT_RESTORED, name):
            return thrown[-1].rename(self.folder / name)

    def undo_delete(self) -> Path | None:
        """Restore the item deleted last, under another name if its own is taken; None if there is none."""
        name = self.last_deleted
        if not name:
            return None
        if not is_valid_name(name) or self.holder(name):
            name = self.free_name(name)
        with told(texts.LIBRARY_NOT_RESTORED, name):
            return self._thrown()[-1].rename(self.folder / name)

    def recover(self) -> None:
        """Undo interrupted replacements, and remove unfinished copies.

        Raises OSError if the folder can't be read; a problem with one item does not affect the others.
        """
        for path in list(self.folder.iterdir()):
            with suppress(OSError):
                self._recover(path)

    def _recover(self, path: Path) -> None:
        if (name := aside_for(path)) and name[0] != ".":
            recover_folder(self.folder / name)
        elif path.name.endswith(NEW) and path.name[0] == "." and time.time() - path.lstat().st_mtime > STALE:
            shutil.rmtree(path, ignore_errors=True)

    def _thrown(self) -> list[Path]:
        """Return the paths of deleted items, the latest last: each is named by its time of deletion and its name."""
        with suppress(OSError):
            dated = [path for path in (self.folder / TRASH).iterdir() if _STAMP.match(path.name)]
            return sorted(dated, key=_stamp)
        return []


@contextmanager
def told(sentence: str, name: str) -> Iterator[None]:
    """Turn an OSError into a LibraryError with a sentence for the player; a context manager."""
    try:
        yield
    except OSError as error:
        raise LibraryError(sentence.format(name=name, reason=reason(error))) from error


def reason(error: OSError) -> str:
    """Return in a few words what went wrong; a copy of many files names the first that failed."""
    if isinstance(error, shutil.Error) and error.args and isinstance(error.args[0], list):
        return str(error.args[0][0][-1])
    return error.strerror or str(error)


def _stamp(thrown: Path) -> int:
    """Return the number of a deleted item: its time of deletion in nanoseconds, or slightly later to be unique."""
    return int(thrown.name.split(" ")[0])


def _was_used(place: Path) -> bool:
    return place.exists() or bool(moved_aside(place))


def _check_plain(folder: Path) -> None:
    """Raise LibraryError unless a folder holds only plain files, and no more than a network can have.

    A link may lead outside or in a circle, and a pipe never ends; the window waits while files are copied.
    """
    folders, files, size = [(folder, 0)], 0, 0
    while folders:
        parent, depth = folders.pop()
        with os.scandir(parent) as inside:
            for entry in inside:
                files += 1
                if entry.is_dir(follow_symlinks=False) and depth < _DEEPEST:
                    folders.append((Path(entry.path), depth + 1))
                elif entry.is_file(follow_symlinks=False):
                    size += entry.stat(follow_symlinks=False).st_size
                else:
                    raise LibraryError(texts.LIBRARY_NOT_PLAIN.format(name=folder.name, inside=brief(entry.name, 40)))
                if files > _MOST_FILES or size > _MOST_BYTES:
                    raise LibraryError(texts.LIBRARY_TOO_LARGE.format(name=folder.name))


def _same(name: str) -> str:
    return unicodedata.normalize("NFC", name).casefold()


def _copy(source: Path, target: Path) -> None:
    """Copy a folder whole or not at all; raises LibraryError if it holds files that no network has."""
    _check_plain(source)
    partial = beside(target, NEW)
    try:
        shutil.copytree(source, partial, symlinks=True)
        partial.rename(target)
    except BaseException:
        shutil.rmtree(partial, ignore_errors=True)
        raise
