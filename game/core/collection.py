"""A folder of named folders, which a player's networks are kept in: named, thrown away, brought back, copied."""

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

UNSAVED: Final = ".training"  # where a run that has no name yet keeps itself
TRASH: Final = ".trash"
LONGEST_NAME: Final = 40
_DEEPEST: Final = 8  # folders within folders of a network, its fixes included
_MOST_FILES: Final = 5_000
_MOST_BYTES: Final = 500_000_000
_GAMES: Final = 16  # that may train at the same time
_STAMP: Final = re.compile(r"[0-9]{1,30} ")  # what begins the name of something that was thrown away
_DEVICES: Final = {"con", "prn", "aux", "nul"} | {f"{port}{n}" for port in ("com", "lpt") for n in "123456789¹²³"}


class LibraryError(Exception):
    """What could not be done, and why, in a sentence for the player."""


def fitting(text: str) -> str:
    """Keep what may stand in a name."""
    return "".join(letter for letter in unicodedata.normalize("NFC", text) if letter.isalnum() or letter in " -_.")


def name_problem(text: str) -> str:
    """Say why a text is no name for a folder on every system, in a sentence; empty if it is one."""
    if not text.strip():
        return texts.NAME_EMPTY
    if len(text) > LONGEST_NAME:
        return texts.NAME_LONG.format(most=LONGEST_NAME)
    if fitting(text) != unicodedata.normalize("NFC", text):
        return texts.NAME_LETTERS
    if text[0] == "." or text[-1] == "." or text != text.strip():
        return texts.NAME_ENDS
    if text.partition(".")[0].strip().casefold() in _DEVICES:
        return texts.NAME_DEVICE.format(name=text)
    return ""


def is_valid_name(text: str) -> bool:
    """Whether a folder can be called so."""
    return not name_problem(text)


def claims(folder: Path, parts: Iterable[str]) -> bool:
    """Whether something looks like one of ours: it has one of these parts, or it cannot be looked into.

    What cannot be looked into, such as a link that leads nowhere, is listed as well, so that it is told of.
    """
    if folder.name.startswith("."):
        return False
    try:
        return any(there(folder / part) for part in parts) or leads_nowhere(folder)
    except OSError:
        return True


def there(path: Path) -> bool:
    """Whether something lies there; OSError where that cannot be told, which `Path.exists` takes for no."""
    try:
        path.stat()
    except (FileNotFoundError, NotADirectoryError, ValueError):
        return False
    return True


def leads_nowhere(path: Path) -> bool:
    """Whether it is a link to what is not there; OSError for a link to itself."""
    return path.is_symlink() and not there(path)


def exports_dir() -> Path:
    """Return where a player finds what is exported: among their documents."""
    return Path(platformdirs.user_documents_dir()) / texts.GAME


def free_path(folder: Path, name: str, suffix: str = "") -> Path:
    """Return where something new of that name goes: with a number behind it, if the name is taken."""
    path, number = folder / f"{name}{suffix}", 1
    while os.path.lexists(path):  # which, unlike Path.exists, raises nothing where it may not look
        number += 1
        path = folder / f"{name} {number}{suffix}"
    return path


class Collection:
    """What lies in `folder`. Whatever cannot be done raises LibraryError and changes nothing.

    Args:
        folder: of the folders; need not exist.
        parts: names of files or folders; what has one of them is one of ours, whole or not.
        most_thrown: how many of those that were thrown away can be brought back: the latest.

    Attributes:
        unsaved: where what has no name yet keeps itself; a second game's has a number behind it.

    """

    def __init__(self, folder: Path, parts: Iterable[str] = (), *, most_thrown: int = 8) -> None:
        self.folder, self.parts, self._most_thrown = folder, tuple(parts), most_thrown
        self.unsaved = folder / UNSAVED
        self._lock: Lock | None = None

    def free_name(self, suggestion: str) -> str:
        """Return the suggestion as a valid name that nothing has yet, with a number behind it if need be."""
        base = " ".join(fitting(suggestion).split())[:LONGEST_NAME].strip(" .")
        if name_problem(base):
            base = texts.RUN_UNNAMED
        name, number = base, 1
        while self.holder(name):
            number += 1
            name = f"{base[: LONGEST_NAME - 1 - len(str(number))].rstrip(' .')} {number}"
        return name

    def new_folder(self, name: str) -> Path:
        """Return where something new of that name goes; LibraryError if it cannot be called so."""
        if problem := name_problem(name):
            raise LibraryError(problem)
        if holder := self.holder(name):
            raise LibraryError(texts.NAME_TAKEN.format(name=holder))
        return self.folder / unicodedata.normalize("NFC", name)

    def existing(self, name: str) -> Path:
        """Return where it lies; a name must not lead out of it, whatever it is."""
        folder = self.folder / name
        if name.startswith(".") or Path(name).name != name or not (folder.is_dir() or folder.is_symlink()):
            raise LibraryError(texts.GONE.format(name=name))
        return folder

    def holder(self, name: str) -> str:
        """Return what already lies there under a name that some systems take for the same; empty if nothing does."""
        with suppress(OSError):
            return next((path.name for path in self.folder.iterdir() if _same(path.name) == _same(name)), "")
        return ""

    def rename(self, old: str, new: str) -> Path:
        """Give something another name, which nothing else has; return where it is."""
        source = self.existing(old)
        target = self.folder / unicodedata.normalize("NFC", new)
        if not (is_valid_name(new) and self.holder(new) == old):  # a change of case alone is no clash
            target = self.new_folder(new)
        with told(texts.LIBRARY_NOT_RENAMED, old):
            source.rename(target)
        return target

    def name(self, folder: Path, name: str) -> Path:
        """Give a folder that has none yet a name; return where it is."""
        target = self.new_folder(name)
        with told(texts.LIBRARY_NOT_KEPT, name):
            folder.rename(target)
        return target

    def export(self, name: str, folder: Path | None = None) -> Path:
        """Copy something into a folder, `exports_dir` if none is named, and return where the copy is.

        Nothing that lies there is touched: a copy whose name is taken gets a number.
        """
        source = self.existing(name)
        folder = folder or exports_dir()
        with told(texts.LIBRARY_NOT_EXPORTED, name):
            folder.mkdir(parents=True, exist_ok=True)
            target = free_path(folder, name)
            _copy(source, target)
        return target

    def import_folder(self, path: Path) -> Path:
        """Copy a folder from anywhere, under its own name or one near it; return where the copy is."""
        target = self.folder / self.free_name(path.name)
        with told(texts.LIBRARY_NOT_IMPORTED, path.name):
            self.folder.mkdir(parents=True, exist_ok=True)
            _copy(path, target)
        return target

    # What has no name yet, and what a game that ended too early left behind

    def hold(self) -> None:
        """Let no other game use `unsaved` until `release`.

        Of the places that no other game holds, it is the first where something was left behind, or else the first.
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
        """Leave `unsaved` to whoever comes next."""
        if self._lock:
            self._lock.release()
            self._lock = None

    @property
    def left_behind(self) -> bool:
        """Whether something of ours lies in `unsaved`. Not to be asked while it is written to, for it repairs that."""
        recover_folder(self.unsaved)
        with suppress(OSError):
            return any(there(self.unsaved / part) for part in self.parts)
        return False

    # What was thrown away

    def throw_away(self, folder: Path, name: str) -> None:
        """Put a folder, or a file, aside, from where it can be had back by that name; very old ones are deleted."""
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
        """What `undo_delete` would bring back; empty for nothing."""
        thrown = self._thrown()
        return thrown[-1].name.partition(" ")[2] if thrown else ""

    @property
    def deleted(self) -> set[str]:
        """The names of all that could be brought back."""
        return {path.name.partition(" ")[2] for path in self._thrown()}

    def bring_back(self, name: str) -> Path:
        """Bring back what was thrown away under that name, where nothing else has it."""
        thrown = [path for path in self._thrown() if path.name.partition(" ")[2] == name]
        if not thrown:
            raise LibraryError(texts.GONE.format(name=name))
        if self.holder(name):
            raise LibraryError(texts.NAME_TAKEN.format(name=name))
        with told(texts.LIBRARY_NOT_RESTORED, name):
            return thrown[-1].rename(self.folder / name)

    def undo_delete(self) -> Path | None:
        """Bring back what was thrown away last, under another name if its own is taken; None if nothing was."""
        name = self.last_deleted
        if not name:
            return None
        if not is_valid_name(name) or self.holder(name):
            name = self.free_name(name)
        with told(texts.LIBRARY_NOT_RESTORED, name):
            return self._thrown()[-1].rename(self.folder / name)

    def recover(self) -> None:
        """Put back what was being replaced when that was interrupted, and clear away what was never finished.

        Raises OSError if the folder can't be looked into; what is wrong with one thing in it concerns no other.
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
        """Return what was thrown away, the latest last: a name is when, and what it was called."""
        with suppress(OSError):
            dated = [path for path in (self.folder / TRASH).iterdir() if _STAMP.match(path.name)]
            return sorted(dated, key=_stamp)
        return []


@contextmanager
def told(sentence: str, name: str) -> Iterator[None]:
    """Turn what the system says into a sentence for the player."""
    try:
        yield
    except OSError as error:
        raise LibraryError(sentence.format(name=name, reason=reason(error))) from error


def reason(error: OSError) -> str:
    """Say in a few words what went wrong; a copy of many files names the first that failed."""
    if isinstance(error, shutil.Error) and error.args and isinstance(error.args[0], list):
        return str(error.args[0][0][-1])
    return error.strerror or str(error)


def _stamp(thrown: Path) -> int:
    """Return when something was thrown away, in nanoseconds, or a little later: none has the number of another."""
    return int(thrown.name.split(" ")[0])


def _was_used(place: Path) -> bool:
    return place.exists() or bool(moved_aside(place))


def _check_plain(folder: Path) -> None:
    """Raise LibraryError unless a folder holds plain files alone, and no more of them than a network can have.

    A link may lead out of it, or round in circles; a pipe never ends; and whatever is copied, the window waits for.
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
    """Copy a folder whole or not at all; LibraryError if it holds what no network has."""
    _check_plain(source)
    partial = beside(target, NEW)
    try:
        shutil.copytree(source, partial, symlinks=True)
        partial.rename(target)
    except BaseException:
        shutil.rmtree(partial, ignore_errors=True)
        raise
