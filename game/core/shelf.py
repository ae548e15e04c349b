"""What a player keeps in named folders, such as networks: list, rename, delete, copy one in.

One folder has no name yet, `.training`: that of a run under way.
"""

from __future__ import annotations

import shutil
import unicodedata
from collections.abc import Callable, Hashable, Iterable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from itertools import islice
from pathlib import Path
from threading import RLock
from typing import Final, Generic, TypeVar

from ai.files.folder import atomic_folder, recover_all, recover_folder, take_folder
from ai.files.reading import brief
from game.core import texts

T = TypeVar("T")

LONGEST_NAME: Final = 40
MOST_FILES: Final = 5_000  # of a folder that is copied
MOST_BYTES: Final = 500_000_000
_DEVICES: Final = {"con", "prn", "aux", "nul"} | {f"{port}{n}" for port in ("com", "lpt") for n in "123456789¹²³"}


class LibraryError(Exception):
    """Failed operation on a collection; its message is a sentence for the player."""


# Names of folders that every system allows


def fitting(text: str) -> str:
    """Remove from a text the characters that no name may contain."""
    return "".join(letter for letter in unicodedata.normalize("NFC", text) if letter.isalnum() or letter in " -_.")


def is_valid_name(text: str) -> bool:
    """Whether a text is a valid folder name on every system."""
    plain = fitting(text) == unicodedata.normalize("NFC", text) and text == text.strip()
    device = text.partition(".")[0].strip().casefold() in _DEVICES
    return plain and 0 < len(text) <= LONGEST_NAME and "." not in (text[0], text[-1]) and not device


def reason(error: OSError) -> str:
    """Return in a few words what went wrong; a copy of many files names the first that failed."""
    if isinstance(error, shutil.Error) and error.args and isinstance(error.args[0], list):
        return str(error.args[0][0][-1])
    return error.strerror or str(error)


@contextmanager
def _errors(sentence: str, name: str) -> Iterator[None]:
    """Turn an OSError into a LibraryError with a sentence for the player."""
    try:
        yield
    except OSError as error:
        raise LibraryError(sentence.format(name=name, reason=reason(error))) from error


class Collection(Generic[T]):
    """Named items in `folder`, each a folder. A method that fails raises LibraryError and changes nothing.

    Args:
        folder: the folder that holds the items; need not exist.

    Attributes:
        parts: names of files or folders; a folder with any of them is an item, complete or not.
        unsaved: folder of the item that has no name yet.
        problem: why `items` could not read the folder; empty if it could.

    """

    parts: tuple[str, ...]

    def __init__(self, folder: Path) -> None:
        self.folder, self.unsaved, self.problem = folder, folder / ".training", ""
        self._lock = ExitStack()

    def read(self, folder: Path, name: str) -> T:
        """Return an item from its folder, under a name; never raises."""
        raise NotImplementedError

    @property
    def rescued_name(self) -> str:
        """The name to suggest for an item that was left behind without one."""
        return texts.RUN_UNNAMED

    def items(self) -> list[T]:
        """Return every item, damaged ones too, by name; after undoing interrupted replacements."""
        self.problem = ""
        try:
            recover_all(self.folder)
            found = sorted(self.folder.iterdir(), key=lambda path: path.name.casefold())
            return [self.read(path, path.name) for path in found if looks_like_item(path, self.parts)]
        except FileNotFoundError:
            return []
        except OSError as error:
            self.problem = texts.LIBRARY_UNREADABLE.format(folder=self.folder, reason=reason(error))
            return []

    def free_name(self, suggestion: str) -> str:
        """Return the suggestion as a valid, unused name, with a number appended if needed."""
        base = " ".join(fitting(suggestion).split())[:LONGEST_NAME].strip(" .")
        if not is_valid_name(base):
            base = texts.RUN_UNNAMED
        name, number = base, 1
        while self._holder(name):
            number += 1
            name = f"{base[: LONGEST_NAME - 1 - len(str(number))].rstrip(' .')} {number}"
        return name

    def new_folder(self, name: str) -> Path:
        """Return the path for a new item; raises LibraryError for an invalid or used name."""
        if not is_valid_name(name):
            raise LibraryError(texts.NAME_RULE.format(count=LONGEST_NAME))
        if taken := self._holder(name):
            raise LibraryError(texts.NAME_TAKEN.format(name=taken))
        return self.folder / unicodedata.normalize("NFC", name)

    def _holder(self, name: str) -> str:
        """Return the name of an item that some systems take for the same as this one; empty if there is none."""
        with suppress(OSError):
            return next((path.name for path in self.folder.iterdir() if _same(path.name) == _same(name)), "")
        return ""

    def existing(self, name: str) -> Path:
        """Return the path of an item; raises LibraryError if there is none, or if its name leads out of the folder."""
        folder = self.folder / name
        if name.startswith(".") or Path(name).name != name or not (folder.is_dir() or folder.is_symlink()):
            raise LibraryError(texts.GONE.format(name=name))
        return folder

    def rename(self, old: str, new: str) -> Path:
        """Rename an item to an unused name; return its path."""
        source = self.existing(old)
        alike = is_valid_name(new) and self._holder(new) == old  # a change of case alone is no clash
        target = self.folder / unicodedata.normalize("NFC", new) if alike else self.new_folder(new)
        self._move(source, target, texts.LIBRARY_NOT_RENAMED, old)
        return target

    def _move(self, source: Path, target: Path, sentence: str, name: str) -> None:
        with _errors(sentence, name):
            source.rename(target)

    def delete(self, name: str) -> None:
        """Delete an item for good."""
        self._erase(self.existing(name), name)

    def _erase(self, folder: Path, name: str) -> None:
        with _errors(texts.NOT_DELETED, name):
            folder.unlink() if folder.is_symlink() else shutil.rmtree(folder)

    def import_folder(self, path: Path) -> Path:
        """Copy an item into the collection, numbered if its name is taken; return the path of the copy.

        A file of the item may be given in place of its folder. Only plain files are copied, as many as a network's: a
        link may lead outside, a pipe never ends, and the window waits meanwhile.
        """
        with _errors(texts.LIBRARY_NOT_IMPORTED, brief(path.name, LONGEST_NAME)):
            source = path if path.is_dir() else path.parent
            if not any(there(source / part) for part in self.parts):
                raise LibraryError(texts.LIBRARY_NO_RUN.format(name=source.name))
            found = list(islice(source.rglob("*"), MOST_FILES + 1))
            for each in found:
                if each.is_symlink() or not (each.is_file() or each.is_dir()):
                    raise LibraryError(texts.LIBRARY_NOT_PLAIN.format(name=source.name, inside=brief(each.name, 40)))
            if len(found) > MOST_FILES or sum(each.stat().st_size for each in found) > MOST_BYTES:
                raise LibraryError(texts.LIBRARY_TOO_LARGE.format(name=source.name))
            target = self.folder / self.free_name(source.name)
            with atomic_folder(target, None) as new:
                shutil.copytree(source, new, symlinks=True, dirs_exist_ok=True)
        return target

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
            return any(there(self.unsaved / part) for part in self.parts)
        return False

    def rescued(self) -> T | None:
        """Return the item without a name under a suggested one, if any. Call before a training begins."""
        return self.read(self.unsaved, self.free_name(self.rescued_name)) if self.left_behind else None

    def keep_rescued(self, name: str) -> T:
        """Give the item without a name this one; return it."""
        target = self.new_folder(name)
        self._move(self.unsaved, target, texts.LIBRARY_NOT_KEPT, name)
        return self.read(target, target.name)

    def discard_rescued(self) -> None:
        """Delete the item without a name, if any."""
        if self.left_behind:
            self._erase(self.unsaved, self.rescued_name)


def looks_like_item(folder: Path, parts: Iterable[str]) -> bool:
    """Whether a folder has one of the parts, or cannot be read, so that it is listed with its problem."""
    if folder.name.startswith("."):
        return False
    try:
        return any(there(folder / part) for part in parts) or leads_nowhere(folder)
    except OSError:
        return True


def _same(name: str) -> str:
    return unicodedata.normalize("NFC", name).casefold()


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


# What was read is kept while its files stay as they are, so that the next scene need not wait for it


class Kept(Generic[T]):
    """What was read of folders or files: the last `most` of them. Scenes share it, so none may change it.

    Attributes:
        lock: held while something is read, or made ready in a thread: nobody uses it before it is.

    """

    def __init__(self, most: int) -> None:
        self.lock = RLock()
        self._most = most
        self._read: dict[Hashable, tuple[list[tuple[str, int, int]], T]] = {}  # the latest last

    def get(
        self, path: Path, read: Callable[[], T], *, more: Hashable = None, sound: Callable[[T], bool] = lambda _: True
    ) -> T:
        """Return what was read of a path, or else `read` it, and keep it if it is `sound`; raises what `read` does.

        `more` tells apart what is read of one path in several ways.
        """
        with self.lock:
            stamp, kept = _stamp(path), self._read.pop((path, more), None)
            value = kept[1] if kept and kept[0] == stamp else read()
            if stamp and sound(value):
                self._read[path, more] = stamp, value
                if len(self._read) > self._most:
                    del self._read[next(iter(self._read))]
        return value

    def clear(self) -> None:
        """Forget all."""
        with self.lock:
            self._read.clear()


def _stamp(path: Path) -> list[tuple[str, int, int]]:
    """Return names, sizes and times of a file, or of those in a folder, which tell of a change; empty if unknown."""
    try:
        files = path.rglob("*") if path.is_dir() else [path]
        return sorted((str(each), (status := each.stat()).st_size, status.st_mtime_ns) for each in files)
    except OSError:
        return []
