"""The networks there are to read digits: those that came with the game, and the player's own by the names they gave."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from ai.digits.checkpoints import TRAINING_FILE
from ai.digits.classifier import DIGITS_FILE, NETWORK
from ai.nn.files import read_json
from game.core import texts
from game.core.collection import claims

NAMES: Final = ("modern", "classic")  # of the shipped ones
PATIENCE: Final = 120.0  # seconds for a worker's turn: reading all test images in one takes a busy machine long
FOLDER: Final = "digits"  # in the player's folder: the shipped networks' fixes, and `RUNS`
RUNS: Final = "runs"
FIXES: Final = "fixes"  # in the folder of a network of the player's own
PARTS: Final = (DIGITS_FILE, NETWORK, TRAINING_FILE)  # a folder with any of them is one, whole or not


@dataclass(frozen=True)
class Shelved:
    """Where a network is, and where its fixes are: a numbered folder for each."""

    folder: Path
    fixes: Path

    def fixed(self) -> list[Path]:
        """Return the folders of its fixes, the last one last; each stands upon those before."""
        with suppress(OSError):
            return sorted(
                (path for path in self.fixes.iterdir() if path.name.isdecimal()), key=lambda path: int(path.name)
            )
        return []

    def versions(self) -> list[Path]:
        """Return the folders it can be read from, the one with all fixes first."""
        return [*reversed(self.fixed()), self.folder]

    @property
    def said(self) -> str:
        """What its small file says of how well it reads; empty if that is not known."""
        described: dict[str, Any] = {}
        with suppress(OSError, ValueError, TypeError):
            described |= read_json(self.folder / TRAINING_FILE)
        for key, words in (("test", texts.SHELF_TESTED), ("held_out", texts.SHELF_HELD_OUT)):
            with suppress(KeyError, TypeError, ValueError, ArithmeticError):
                return words.format(part=float(described[key]))
        return ""


def runs_dir(user_dir: Path) -> Path:
    """Return where runs are kept."""
    return user_dir / FOLDER / RUNS


def shelf(models_dir: Path, user_dir: Path) -> dict[str, Shelved]:
    """Return all networks by name, damaged ones too; the player's own come last.

    One that is called as a shipped one is told apart, not left out.
    """
    found = {name: Shelved(models_dir / "digits" / name, user_dir / FOLDER / name) for name in NAMES}
    with suppress(OSError):
        for path in sorted(runs_dir(user_dir).iterdir(), key=lambda path: path.name.casefold()):
            if claims(path, PARTS):
                taken = path.name.casefold() in NAMES
                found[texts.NETWORK_YOURS.format(name=path.name) if taken else path.name] = Shelved(path, path / FIXES)
    return found


def called(name: str) -> str:
    """Return what a network is called on the screen."""
    return texts.DIGITS_NETWORKS.get(name, name)
