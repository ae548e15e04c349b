"""Digit networks: the shipped ones, and the player's own by name."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from ai.digits.classifier import DIGITS_FILE, NETWORK
from ai.run import TRAINING_FILE
from game.core import texts
from game.core.collection import Collection, ItemKind
from game.training.run_kind import DIGITS

PATIENCE: Final = DIGITS.patience  # seconds for a worker's turn
NAMES: Final = ("modern", "classic")  # names of the shipped networks
FOLDER: Final = "digits"  # in the player's folder: fixes of the shipped networks, and `RUNS`
RUNS: Final = "runs"
FIXES: Final = "fixes"  # in the folder of a player's own network
PARTS: Final = (DIGITS_FILE, NETWORK, TRAINING_FILE)  # a folder with any of these is a network, complete or not


@dataclass(frozen=True)
class SavedDigitModel:
    """Folders of a network and of its fixes, the latter numbered."""

    folder: Path
    fixes: Path

    def fixed(self) -> list[Path]:
        """Return the folders of its fixes in order; each builds on those before."""
        with suppress(OSError):
            return sorted(
                (path for path in self.fixes.iterdir() if path.name.isdecimal()), key=lambda path: int(path.name)
            )
        return []

    def versions(self) -> list[Path]:
        """Return the folders of all versions of the network, the one with all fixes first."""
        return [*reversed(self.fixed()), self.folder]


class DigitModels(Collection[SavedDigitModel]):
    """Collection of a player's own digit networks in `folder`."""

    def __init__(self, folder: Path) -> None:
        kind = ItemKind(PARTS, lambda model, _: SavedDigitModel(model, model / FIXES), lambda: texts.RUN_UNNAMED)
        super().__init__(folder, kind)


def runs_dir(user_dir: Path) -> Path:
    """Return the folder of the player's runs."""
    return user_dir / FOLDER / RUNS


def models_by_name(models_dir: Path, user_dir: Path) -> dict[str, SavedDigitModel]:
    """Return all digit networks by name, damaged ones too; the player's own come last.

    A player's network with the name of a shipped one gets a distinct name, and is not left out.
    """
    found = {name: SavedDigitModel(models_dir / "digits" / name, user_dir / FOLDER / name) for name in NAMES}
    for model in DigitModels(runs_dir(user_dir)).items():
        name = model.folder.name
        found[texts.NETWORK_YOURS.format(name=name) if name.casefold() in NAMES else name] = model
    return found


def called(name: str) -> str:
    """Return the label of a network on the screen."""
    return texts.DIGITS_NETWORKS.get(name, name)
