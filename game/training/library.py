"""Library of the player's saved training runs, one folder each, with a summary that needs no network read."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Final

from ai.agent.storage import LAST
from ai.files import Share, Within, brief, inside, read_as, read_json
from ai.run import TRAINING_FILE
from ai.training.config import LANDER
from game.core import texts
from game.core.collection import Collection, ItemKind, leads_nowhere, there
from game.core.names import LONGEST_NAME, reason
from game.flight.networks import PARTS, PLAYERS

_CLAIMS: Final = (*PARTS, TRAINING_FILE)  # a folder with any of these is a run, complete or not
_YEAR_3000: Final = 32_503_680_000.0  # in seconds since 1970; the latest date that every system supports
_MOST: Final = 10**15  # limit of any count
_MOST_SEED: Final = 10**LONGEST_NAME


@dataclass(frozen=True)
class SavedRun:
    """Summary of a run, known without reading its network."""

    name: str
    folder: Path
    saved: float = 0.0  # seconds since 1970
    preset: str = ""  # that its settings began as
    changes: int = 0  # settings that differ from that
    seed: int = 0
    decisions: int = 0
    seconds: float = 0.0  # of training
    success: float | None = None  # share of validation flights that its best network landed; None if not measured
    flyable: bool = False  # probably; certain only after reading it
    resumable: bool = False
    problem: str = ""  # what is wrong with it


@dataclass(frozen=True)
class _Best:
    success: Share | None


@dataclass(frozen=True)
class _TrainingFile:
    """Training file of a run, as far as the list of runs shows it."""

    env: str
    preset: str
    changes: dict[str, Any]
    seed: Annotated[int, Within(0, _MOST_SEED)]
    decisions: Annotated[int, Within(0, _MOST)]
    seconds: Annotated[float, Within(0, _MOST)]
    best: _Best | None  # None for a young run, which has not been validated yet


def read_run(folder: Path, name: str = "") -> SavedRun:
    """Return the summary of a run from its small file. Never raises: `problem` says what is wrong."""
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
        training = read_as(_TrainingFile, read_json(inside(folder, TRAINING_FILE)))
        if training.env != LANDER:
            problem = texts.RUN_ELSEWHERE.format(env=brief(training.env, LONGEST_NAME))
            return SavedRun(name, folder, saved, problem=problem)
        return SavedRun(
            name, folder, saved, brief(training.preset, LONGEST_NAME), len(training.changes), training.seed,
            training.decisions, training.seconds, training.best.success if training.best else None,
            flyable=True, resumable=(folder / LAST).is_dir(),
        )  # fmt: skip
    except OSError as error:
        problem = brief(reason(error))
    except ValueError:
        problem = texts.RUN_UNREADABLE.format(file=TRAINING_FILE)
    return SavedRun(name, folder, saved, flyable=True, problem=problem)


RUNS: Final = ItemKind(_CLAIMS, read_run, lambda: texts.RUN_RESCUED)


class Library(Collection[SavedRun]):
    """Library of runs in a player's folder."""

    def __init__(self, user_dir: Path) -> None:
        super().__init__(user_dir / PLAYERS, RUNS)

    def runs(self) -> list[SavedRun]:
        """Return the summary of every run, the latest first, damaged ones too."""
        return sorted(self.items(), key=lambda run: (-run.saved, run.name))
