"""The networks a player has kept: one folder a run, and what is known of each without reading it."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from ai.agent.agent import LAST
from ai.agent.config import LANDER
from ai.nn.files import brief, count_of, inside, number_of, read_json
from ai.training.checkpoints import TRAINING_FILE
from game.core import texts
from game.core.collection import LONGEST_NAME, Collection, LibraryError, claims, leads_nowhere, reason, there, told
from game.flight.networks import PARTS, PLAYERS

_CLAIMS: Final = (*PARTS, TRAINING_FILE)  # a folder with any of them is a run, whole or not
_YEAR_3000: Final = 32_503_680_000.0  # in seconds since 1970; up to then every system knows dates
_MOST: Final = 10**15  # of any count
_MOST_SEED: Final = 10**LONGEST_NAME


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
    for dated in (folder, file):
        with suppress(OSError):
            saved = min(max(dated.lstat().st_mtime, 0.0), _YEAR_3000)
    try:
        if leads_nowhere(folder):
            return SavedRun(name, folder, saved, problem=texts.RUN_LINK)
        missing = [part for part in _CLAIMS if not there(folder / part)]
        if missing:
            flyable = missing == [TRAINING_FILE]
            return SavedRun(name, folder, saved, flyable=flyable, problem=texts.RUN_INCOMPLETE.format(file=missing[0]))
        described = read_json(inside(folder, TRAINING_FILE))
        if described["env"] != LANDER:
            problem = texts.RUN_ELSEWHERE.format(env=brief(described["env"], LONGEST_NAME))
            return SavedRun(name, folder, saved, problem=problem)
        last = (folder / LAST).is_dir()
        return SavedRun(name, folder, saved, flyable=True, resumable=last, **_figures(described))
    except OSError as error:
        problem = brief(reason(error))
    except (ValueError, KeyError, TypeError, ArithmeticError, RecursionError):
        problem = texts.RUN_UNREADABLE.format(file=TRAINING_FILE)
    return SavedRun(name, folder, saved, flyable=True, problem=problem)


def _figures(described: dict[str, Any]) -> dict[str, Any]:
    """Return the figures a run is told by; ValueError, and others, for those that no run can have."""
    best = described["best"]  # a young run has not been tried yet
    success = None if not best or best["success"] is None else float(number_of(best["success"]))
    seed, decisions = count_of(described["seed"], most=_MOST_SEED), count_of(described["decisions"], most=_MOST)
    seconds = float(number_of(described["seconds"], 0))
    if not (seconds < _MOST and 0 <= (success or 0) <= 1):
        raise ValueError("a figure that no run comes to")
    return {
        "preset": brief(described["preset"], LONGEST_NAME), "changes": len(described["changes"]), "seed": seed,
        "decisions": decisions, "seconds": seconds, "success": success,
    }  # fmt: skip


class Library(Collection):
    """The runs in a player's folder. Whatever cannot be done raises LibraryError and changes nothing.

    Attributes:
        problem: why `runs` could not look; empty if it could.

    """

    def __init__(self, user_dir: Path) -> None:
        super().__init__(user_dir / PLAYERS, _CLAIMS)
        self.problem = ""

    def runs(self) -> list[SavedRun]:
        """Describe every run, the latest first, damaged ones too."""
        self.problem = ""
        try:
            self.recover()
            found = [read_run(path) for path in self.folder.iterdir() if claims(path, self.parts)]
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
        """Copy a run from anywhere into the library, under its own name or one near it; return where the copy is.

        A file of the run stands for its folder.
        """
        with told(texts.LIBRARY_NOT_IMPORTED, brief(path.name, LONGEST_NAME)):
            folder = path if path.is_dir() else path.parent
            if not any(there(folder / part) for part in self.parts):
                raise LibraryError(texts.LIBRARY_NO_RUN.format(name=folder.name))
        return super().import_folder(folder)

    # What was never given a name

    def claim(self) -> SavedRun | None:
        """Let no other game use `unsaved` until `release`, and describe the run that lies there, if one does."""
        self.hold()
        return self.rescued()

    def rescued(self) -> SavedRun | None:
        """Describe the run that was never given a name, called as it might be. Ask before a training begins."""
        if not self.left_behind:
            return None
        return read_run(self.unsaved, self.free_name(texts.RUN_RESCUED))

    def keep_rescued(self, name: str) -> SavedRun:
        """Give that run a name."""
        return read_run(self.name(self.unsaved, name))

    def discard_rescued(self) -> None:
        """Throw that run away, if there is one; `undo_delete` brings it back."""
        if rescued := self.rescued():
            self.throw_away(self.unsaved, rescued.name)
