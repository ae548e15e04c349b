"""What the player has trained, one folder each: runs of landers, known by a small file, and digit networks."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Final

from ai.agent.storage import LAST
from ai.digits.classifier import NETWORK
from ai.files.folder import CONFIG
from ai.files.reading import brief, inside, read_json
from ai.files.schema import Share, Within, read_as
from ai.run import TRAINING_FILE
from ai.training.config import LANDER
from game.core import texts
from game.core.shelf import LONGEST_NAME, Collection, leads_nowhere, reason, there
from game.flight.networks import PARTS, PLAYERS

FOLDER: Final = "digits"  # in the player's folder: fixes of the shipped digit networks, and `RUNS`
RUNS: Final = "runs"
FIXES: Final = "fixes"  # in the folder of a player's own digit network
NAMES: Final = ("modern", "classic")  # of the shipped digit networks
_MOST: Final = 10**15  # of any count
_YEAR_3000: Final = 32_503_680_000.0  # in seconds since 1970; the latest date that every system supports


@dataclass(frozen=True)
class SavedRun:
    """Summary of a run, known without reading its network."""

    name: str
    folder: Path
    saved: float = 0.0  # seconds since 1970
    preset: str = ""  # that its settings began as
    changes: int = 0  # settings that differ from that
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
    decisions: Annotated[int, Within(0, _MOST)]
    seconds: Annotated[float, Within(0, _MOST)]
    best: _Best | None  # None for a young run, which has not been validated yet


class Library(Collection[SavedRun]):
    """Library of runs in a player's folder."""

    parts = (*PARTS, TRAINING_FILE)

    def __init__(self, user_dir: Path) -> None:
        super().__init__(user_dir / PLAYERS)

    @property
    def rescued_name(self) -> str:
        """The name to suggest for a run that was left behind without one."""
        return texts.RUN_RESCUED

    def read(self, folder: Path, name: str) -> SavedRun:
        """Return the summary of a run from its small file. Never raises: `problem` says what is wrong."""
        return read_run(folder, name)

    def runs(self) -> list[SavedRun]:
        """Return the summary of every run, the latest first, damaged ones too."""
        return sorted(self.items(), key=lambda run: (-run.saved, run.name))


def read_run(folder: Path, name: str = "") -> SavedRun:
    """Return the summary of a run from its small file. Never raises: `problem` says what is wrong."""
    name = name or folder.name
    saved = 0.0
    for dated in (folder, folder / TRAINING_FILE):
        with suppress(OSError):
            saved = min(max(dated.lstat().st_mtime, 0.0), _YEAR_3000)
    flyable = True
    try:
        if leads_nowhere(folder):
            return SavedRun(name, folder, saved, problem=texts.RUN_LINK)
        missing = [part for part in Library.parts if not there(folder / part)]
        if missing:
            flyable = missing == [TRAINING_FILE]
            return SavedRun(name, folder, saved, flyable=flyable, problem=texts.RUN_INCOMPLETE.format(file=missing[0]))
        training = read_as(_TrainingFile, read_json(inside(folder, TRAINING_FILE)))
        if training.env != LANDER:
            problem = texts.RUN_ELSEWHERE.format(env=brief(training.env, LONGEST_NAME))
            return SavedRun(name, folder, saved, problem=problem)
        return SavedRun(
            name, folder, saved, brief(training.preset, LONGEST_NAME), len(training.changes),
            training.decisions, training.seconds, training.best.success if training.best else None,
            flyable=True, resumable=(folder / LAST).is_dir(),
        )  # fmt: skip
    except OSError as error:
        problem = brief(reason(error))
    except ValueError:
        problem = texts.RUN_UNREADABLE.format(file=TRAINING_FILE)
    return SavedRun(name, folder, saved, flyable=True, problem=problem)


# Networks that read digits


@dataclass(frozen=True)
class SavedDigitModel:
    """Folders of a network and of its fixes, the latter numbered."""

    folder: Path
    fixes: Path

    def fixed(self) -> list[Path]:
        """Return the folders of its fixes in order; each builds on those before."""
        with suppress(OSError):
            numbered = [path for path in self.fixes.iterdir() if path.name.isdecimal()]
            return sorted(numbered, key=lambda path: int(path.name))
        return []

    def versions(self) -> list[Path]:
        """Return the folders of all versions of the network, the one with all fixes first."""
        return [*reversed(self.fixed()), self.folder]


class DigitModels(Collection[SavedDigitModel]):
    """A player's own digit networks."""

    parts = (CONFIG, NETWORK, TRAINING_FILE)

    def __init__(self, user_dir: Path) -> None:
        super().__init__(user_dir / FOLDER / RUNS)

    def read(self, folder: Path, name: str) -> SavedDigitModel:  # noqa: ARG002
        """Return the folders of a network."""
        return SavedDigitModel(folder, folder / FIXES)


def models_by_name(models_dir: Path, user_dir: Path) -> dict[str, SavedDigitModel]:
    """Return all digit networks by name, damaged ones too; the player's own come last.

    A player's network with the name of a shipped one gets a distinct name, and is not left out.
    """
    found = {name: SavedDigitModel(models_dir / "digits" / name, user_dir / FOLDER / name) for name in NAMES}
    for model in DigitModels(user_dir).items():
        name = model.folder.name
        found[texts.NETWORK_YOURS.format(name=name) if name.casefold() in NAMES else name] = model
    return found


def called(name: str) -> str:
    """Return the label of a digit network on the screen."""
    return texts.DIGITS_NETWORKS.get(name, name)
