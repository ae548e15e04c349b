"""The networks a player has kept: one folder a run, to be listed, named, thrown away, brought back and copied."""

from __future__ import annotations

import json
import shutil
import time
import unicodedata
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import platformdirs

from ai.config import LANDER
from ai.nn.folder import recover_folder
from ai.runs import LAST, TRAINING_FILE
from game import texts
from game.lock import Lock, take
from game.networks import PARTS, PLAYERS

UNSAVED: Final = ".training"  # where a run that has no name yet keeps itself; a second game's has a number behind it
TRASH: Final = ".trash"
LONGEST_NAME: Final = 40
_TRASH_KEPT: Final = 8
_GAMES: Final = 16  # that may train at the same time
_OLD: Final = ".old"  # what `atomic_folder` calls a folder that it is about to replace
_NEW: Final = ".new"  # and one that it has not finished
_STALE: Final = 3600.0  # seconds after which nobody will finish it any more
_DEVICES: Final = {"con", "prn", "aux", "nul"} | {f"{port}{n}" for port in ("com", "lpt") for n in "123456789¹²³"}


class LibraryError(Exception):
    """What could not be done, and why, in a sentence for the player."""


@dataclass(frozen=True)
class SavedRun:
    """What is known of a run without reading its network.

    Attributes:
        saved: when, in seconds since 1970.
        preset, changes: the preset its settings are nearest to, and how many of them differ.
        decisions, seconds: how long it learnt.
        success: share of validation flights that its best network landed, 0 to 1; None where nobody counted.
        flyable: whether it may well fly a lander; only reading it will tell.
        resumable: whether there is something to go on training from.
        problem: what is wrong with it; empty for a whole one.

    """

    name: str
    folder: Path
    saved: float = 0.0
    preset: str = ""
    changes: int = 0
    seed: int = 0
    decisions: int = 0
    seconds: float = 0.0
    success: float | None = None
    flyable: bool = False
    resumable: bool = False
    problem: str = ""


def read_run(folder: Path, name: str = "") -> SavedRun:
    """Describe a run by its small file alone. Never raises: what is wrong is in the answer."""
    name = name or folder.name
    file = folder / TRAINING_FILE
    saved = 0.0
    with suppress(OSError):
        saved = (file if file.exists() else folder).stat().st_mtime
    try:
        missing = [part for part in (*PARTS, TRAINING_FILE) if not (folder / part).exists()]
        if missing:
            flyable = missing == [TRAINING_FILE]
            return SavedRun(name, folder, saved, flyable=flyable, problem=texts.RUN_INCOMPLETE.format(file=missing[0]))
        described = json.loads(file.read_text(encoding="utf-8"))
        if described["env"] != LANDER:
            return SavedRun(name, folder, saved, problem=texts.RUN_ELSEWHERE.format(env=described["env"]))
        last = (folder / LAST).is_dir()
        return SavedRun(name, folder, saved, flyable=True, resumable=last, **_figures(described))
    except OSError as error:
        problem = _reason(error)
    except (ValueError, KeyError, TypeError, ArithmeticError, RecursionError):
        problem = texts.RUN_UNREADABLE.format(file=TRAINING_FILE)
    return SavedRun(name, folder, saved, flyable=True, problem=problem)


def _figures(described: dict[str, Any]) -> dict[str, Any]:
    success = described["best"]["success"] if described["best"] else None  # a young run has not been tried yet
    return {
        "preset": str(described["preset"]), "changes": len(described["changes"]), "seed": int(described["seed"]),
        "decisions": int(described["decisions"]), "seconds": float(described["seconds"]),
        "success": None if success is None else float(success),
    }  # fmt: skip


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
    """Whether a run can be called so."""
    return not name_problem(text)


def exports_dir() -> Path:
    """Return where a player finds what is exported: among their documents."""
    return Path(platformdirs.user_documents_dir()) / texts.GAME


class Library:
    """The runs in a player's folder. Whatever cannot be done raises LibraryError and changes nothing.

    Attributes:
        problem: why `runs` could not look; empty if it could.
        unsaved: where a run keeps itself until it is given a name.

    """

    def __init__(self, user_dir: Path) -> None:
        self.folder = user_dir / PLAYERS
        self.problem = ""
        self.unsaved = self.folder / UNSAVED
        self._lock: Lock | None = None

    def runs(self) -> list[SavedRun]:
        """Describe every run, the latest first, damaged ones too."""
        self.problem = ""
        try:
            self._recover()
            found = [read_run(path) for path in self.folder.iterdir() if _claims(path)]
        except FileNotFoundError:
            return []
        except OSError as error:
            self.problem = texts.LIBRARY_UNREADABLE.format(folder=self.folder, reason=_reason(error))
            return []
        return sorted(found, key=lambda run: (-run.saved, run.name))

    def free_name(self, suggestion: str) -> str:
        """Return the suggestion as a valid name that no run has yet, with a number behind it if need be."""
        base = " ".join(fitting(suggestion).split())[:LONGEST_NAME].strip(" .")
        if name_problem(base):
            base = texts.RUN_UNNAMED
        name, number = base, 1
        while self._holder(name):
            number += 1
            name = f"{base[: LONGEST_NAME - 1 - len(str(number))].rstrip(' .')} {number}"
        return name

    def new_folder(self, name: str) -> Path:
        """Return the folder to save a new run of that name in; LibraryError if it cannot be called so."""
        if problem := name_problem(name):
            raise LibraryError(problem)
        if holder := self._holder(name):
            raise LibraryError(texts.NAME_TAKEN.format(name=holder))
        return self.folder / unicodedata.normalize("NFC", name)

    def rename(self, old: str, new: str) -> SavedRun:
        """Give a run another name, which no other has."""
        source = self._existing(old)
        target = self.folder / unicodedata.normalize("NFC", new)
        if not (is_valid_name(new) and self._holder(new) == old):  # a change of case alone is no clash
            target = self.new_folder(new)
        with _told(texts.LIBRARY_NOT_RENAMED, old):
            source.rename(target)
        return read_run(target)

    def delete(self, name: str) -> None:
        """Throw a run away; `undo_delete` brings it back."""
        self._throw_away(self._existing(name), name)

    @property
    def last_deleted(self) -> str:
        """What `undo_delete` would bring back; empty for nothing."""
        thrown = self._thrown()
        return thrown[-1].name.partition(" ")[2] if thrown else ""

    def undo_delete(self) -> SavedRun | None:
        """Bring back what was thrown away last, under another name if its own is taken; None if nothing was."""
        thrown = self._thrown()
        if not thrown:
            return None
        name = thrown[-1].name.partition(" ")[2]
        if not is_valid_name(name) or self._holder(name):
            name = self.free_name(name)
        with _told(texts.LIBRARY_NOT_RESTORED, name):
            thrown[-1].rename(self.folder / name)
        return read_run(self.folder / name)

    def export(self, name: str, folder: Path | None = None) -> Path:
        """Copy a run into a folder, `exports_dir` if none is named, and return where the copy is.

        Nothing that lies there is touched: a copy whose name is taken gets a number.
        """
        source = self._existing(name)
        folder = folder or exports_dir()
        with _told(texts.LIBRARY_NOT_EXPORTED, name):
            folder.mkdir(parents=True, exist_ok=True)
            target, number = folder / name, 1
            while target.exists():
                number += 1
                target = folder / f"{name} {number}"
            _copy(source, target)
        return target

    def import_folder(self, path: Path) -> SavedRun:
        """Copy a run from anywhere into the library, under its own name or one near it."""
        name = path.name
        if not path.is_dir() or not _claims(path, hidden=True):
            raise LibraryError(texts.LIBRARY_NO_RUN.format(name=name))
        target = self.folder / self.free_name(name)
        with _told(texts.LIBRARY_NOT_IMPORTED, name):
            self.folder.mkdir(parents=True, exist_ok=True)
            _copy(path, target)
        return read_run(target)

    # What has no name yet, and what a game that ended too early left behind

    def claim(self) -> SavedRun | None:
        """Let no other game use `unsaved` until `release`, and describe the run that lies there, if one does.

        Of the places that no other game holds, it is the first with a run that was left behind, or else the first.
        """
        self.release()
        places = [self.folder / f"{UNSAVED} {number}".removesuffix(" 1") for number in range(1, _GAMES + 1)]
        for place in [*filter(_was_used, places), *places]:
            self._lock = take(place.with_name(f"{place.name}.lock"))
            if self._lock:
                self.unsaved = place
                if (left := self.rescued()) or not _was_used(place):
                    return left
                self._lock.release()
        return None

    def release(self) -> None:
        """Leave `unsaved` to whoever comes next."""
        if self._lock:
            self._lock.release()
            self._lock = None

    def rescued(self) -> SavedRun | None:
        """Describe the run that was never given a name, called as it might be. Ask before a training begins."""
        recover_folder(self.unsaved)
        if not self.unsaved.is_dir() or not _claims(self.unsaved, hidden=True):
            return None
        return read_run(self.unsaved, self.free_name(texts.RUN_RESCUED))

    def keep_rescued(self, name: str) -> SavedRun:
        """Give that run a name."""
        target = self.new_folder(name)
        with _told(texts.LIBRARY_NOT_KEPT, name):
            self.unsaved.rename(target)
        return read_run(target)

    def discard_rescued(self) -> None:
        """Throw that run away, if there is one; `undo_delete` brings it back."""
        if rescued := self.rescued():
            self._throw_away(self.unsaved, rescued.name)

    # Folders

    def _existing(self, name: str) -> Path:
        """Return a run's folder; a name must not lead out of the library, whatever it is."""
        folder = self.folder / name
        if name.startswith(".") or Path(name).name != name or not folder.is_dir():
            raise LibraryError(texts.LIBRARY_GONE.format(name=name))
        return folder

    def _holder(self, name: str) -> str:
        """Return what already lies there under a name that some systems take for the same; empty if nothing does."""
        with suppress(OSError):
            return next((path.name for path in self.folder.iterdir() if _same(path.name) == _same(name)), "")
        return ""

    def _throw_away(self, folder: Path, name: str) -> None:
        trash = self.folder / TRASH
        with _told(texts.LIBRARY_NOT_DELETED, name):
            trash.mkdir(exist_ok=True)
            folder.rename(trash / f"{time.time_ns()} {name}")
        for old in self._thrown()[:-_TRASH_KEPT]:
            with suppress(OSError):
                old.unlink() if old.is_symlink() else shutil.rmtree(old)

    def _thrown(self) -> list[Path]:
        """Return what was thrown away, the latest last: a name is when, and what it was called."""
        with suppress(OSError):
            dated = [path for path in (self.folder / TRASH).iterdir() if path.name.split(" ")[0].isdecimal()]
            return sorted(dated, key=lambda path: int(path.name.split(" ")[0]))
        return []

    def _recover(self) -> None:
        """Put back runs whose replacement was interrupted, and clear away what was never finished."""
        for path in list(self.folder.iterdir()):
            if path.name.endswith(_OLD) and path.name[0] == "." and path.name[1] != ".":
                recover_folder(self.folder / path.name[1 : -len(_OLD)])
            elif path.name.endswith(_NEW) and path.name[0] == "." and time.time() - path.stat().st_mtime > _STALE:
                shutil.rmtree(path, ignore_errors=True)


def _claims(path: Path, hidden: bool = False) -> bool:
    """Whether a folder looks like a run, whole or not."""
    if path.name.startswith(".") and not hidden:
        return False
    return any((path / part).exists() for part in (*PARTS, TRAINING_FILE))


def _was_used(place: Path) -> bool:
    return place.exists() or place.with_name(f".{place.name}{_OLD}").exists()


def _same(name: str) -> str:
    return unicodedata.normalize("NFC", name).casefold()


def _copy(source: Path, target: Path) -> None:
    """Copy a folder whole or not at all."""
    partial = target.with_name(f".{target.name}.new")
    shutil.rmtree(partial, ignore_errors=True)
    try:
        shutil.copytree(source, partial)
        partial.rename(target)
    except BaseException:
        shutil.rmtree(partial, ignore_errors=True)
        raise


@contextmanager
def _told(sentence: str, name: str) -> Iterator[None]:
    """Turn what the system says into a sentence for the player."""
    try:
        yield
    except OSError as error:
        raise LibraryError(sentence.format(name=name, reason=_reason(error))) from error


def _reason(error: OSError) -> str:
    """Say in a few words what went wrong; a copy of many files names the first that failed."""
    if isinstance(error, shutil.Error) and error.args and isinstance(error.args[0], list):
        return str(error.args[0][0][-1])
    return error.strerror or str(error)
