"""The networks a player has kept: one folder a run, and what is known of each without reading it."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from ai.agent import LAST
from ai.config import LANDER
from ai.nn.files import count_of, inside, number_of, read_json
from ai.nn.folder import moved_aside, recover_folder
from ai.nn.lock import Lock, lock_of, take
from ai.runs import TRAINING_FILE
from game import texts
from game.collection import UNSAVED, Collection, LibraryError, reason
from game.networks import PARTS, PLAYERS

_GAMES: Final = 16  # that may train at the same time


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
        described = read_json(inside(folder, TRAINING_FILE))
        if described["env"] != LANDER:
            return SavedRun(name, folder, saved, problem=texts.RUN_ELSEWHERE.format(env=described["env"]))
        last = (folder / LAST).is_dir()
        return SavedRun(name, folder, saved, flyable=True, resumable=last, **_figures(described))
    except OSError as error:
        problem = reason(error)
    except (ValueError, KeyError, TypeError, ArithmeticError, RecursionError):
        problem = texts.RUN_UNREADABLE.format(file=TRAINING_FILE)
    return SavedRun(name, folder, saved, flyable=True, problem=problem)


def _figures(described: dict[str, Any]) -> dict[str, Any]:
    success = described["best"]["success"] if described["best"] else None  # a young run has not been tried yet
    return {
        "preset": str(described["preset"]), "changes": len(described["changes"]),
        "seed": count_of(described["seed"], most=10**40), "decisions": count_of(described["decisions"]),
        "seconds": float(number_of(described["seconds"])),
        "success": None if success is None else float(number_of(success)),
    }  # fmt: skip


class Library(Collection):
    """The runs in a player's folder. Whatever cannot be done raises LibraryError and changes nothing.

    Attributes:
        problem: why `runs` could not look; empty if it could.
        unsaved: where a run keeps itself until it is given a name; a second game's has a number behind it.

    """

    def __init__(self, user_dir: Path) -> None:
        super().__init__(user_dir / PLAYERS)
        self.problem = ""
        self.unsaved = self.folder / UNSAVED
        self._lock: Lock | None = None

    def runs(self) -> list[SavedRun]:
        """Describe every run, the latest first, damaged ones too."""
        self.problem = ""
        try:
            self.recover()
            found = [read_run(path) for path in self.folder.iterdir() if _claims(path)]
        except FileNotFoundError:
            return []
        except OSError as error:
            self.problem = texts.LIBRARY_UNREADABLE.format(folder=self.folder, reason=reason(error))
            return []
        return sorted(found, key=lambda run: (-run.saved, run.name))

    def delete(self, name: str) -> None:
        """Throw a run away; `undo_delete` brings it back."""
        self.throw_away(self.existing(name), name)

    def import_folder(self, path: Path) -> Path:
        """Copy a run from anywhere into the library, under its own name or one near it; return where the copy is."""
        if not path.is_dir() or not _claims(path, hidden=True):
            raise LibraryError(texts.LIBRARY_NO_RUN.format(name=path.name))
        return super().import_folder(path)

    # What has no name yet, and what a game that ended too early left behind

    def claim(self) -> SavedRun | None:
        """Let no other game use `unsaved` until `release`, and describe the run that lies there, if one does.

        Of the places that no other game holds, it is the first with a run that was left behind, or else the first.
        """
        self.release()
        places = [self.folder / f"{UNSAVED} {number}".removesuffix(" 1") for number in range(1, _GAMES + 1)]
        for place in [*filter(_was_used, places), *places]:
            self._lock = take(lock_of(place))
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
        return read_run(self.name(self.unsaved, name))

    def discard_rescued(self) -> None:
        """Throw that run away, if there is one; `undo_delete` brings it back."""
        if rescued := self.rescued():
            self.throw_away(self.unsaved, rescued.name)


def _claims(path: Path, hidden: bool = False) -> bool:
    """Whether a folder looks like a run, whole or not."""
    if path.name.startswith(".") and not hidden:
        return False
    return any((path / part).exists() for part in (*PARTS, TRAINING_FILE))


def _was_used(place: Path) -> bool:
    return place.exists() or bool(moved_aside(place))
