"""The networks there are to fly with: the shipped ones, the player's own, and a scripted pilot beside them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Final, Protocol, runtime_checkable

from ai.env import Floats, Ints

DEFAULT: Final = "modern"
SCRIPTED: Final = "scripted"


class Flyer(Protocol):
    """Whatever can choose actions for a batch of landers."""

    def act(self, observation: Floats, *, held: Ints | None = None) -> Ints:
        """Actions (n,) for observations (n, 9); `held` (n,) are the actions until now."""


@runtime_checkable
class Thinker(Protocol):
    """A flyer that can say what it thinks of every action."""

    def act(self, observation: Floats, *, held: Ints | None = None) -> Ints:
        """Actions (n,) for observations (n, 9); `held` (n,) are the actions until now."""

    def q_values(self, observation: Floats) -> Floats:
        """Values (n, 6) for observations (n, 9)."""


@dataclass(frozen=True)
class Network:
    """A network by name. `flyer` is None where it could not be read, and `problem` then says why."""

    name: str
    flyer: Flyer | None = None
    problem: str = ""


def folders(models_dir: Path, user_dir: Path) -> dict[str, Path]:
    """Return every folder that claims to hold a lander's network, by name; the player's own come last."""
    found: dict[str, Path] = {}
    for parent in (models_dir / "lander", user_dir / "models"):
        try:
            inside = sorted(path for path in parent.iterdir() if path.is_dir() and not path.name.startswith("."))
        except OSError:
            continue
        # The default one comes first, whatever its letter.
        for path in sorted(inside, key=lambda path: path.name != DEFAULT):
            found.setdefault(path.name, path)
    return found


def load(name: str, folder: Path) -> Network:
    """Read one network. Never raises: what is wrong is in the answer."""
    from ai.agent import DeepQAgent
    from ai.nn import ModelFormatError

    try:
        return Network(name, DeepQAgent.load(folder))
    except ModelFormatError as error:
        return Network(name, problem=error.problems[0] if error.problems else str(error))
    except OSError as error:
        return Network(name, problem=error.strerror or str(error))


def chosen(models_dir: Path, user_dir: Path, name: str = "") -> Network:
    """Read the network of that name, or the game's own for no name or one that is gone."""
    known = folders(models_dir, user_dir)
    for wanted in (name, DEFAULT):
        if wanted in known:
            return load(wanted, known[wanted])
    return _missing(models_dir)


def available(models_dir: Path, user_dir: Path) -> list[Network]:
    """Read every network there is, damaged ones too, and the scripted pilot."""
    from ai.pilots import ScriptedPilot

    known = folders(models_dir, user_dir)
    found = [load(name, folder) for name, folder in known.items()]
    if DEFAULT not in known:
        found.insert(0, _missing(models_dir))
    return [*found, Network(SCRIPTED, ScriptedPilot())]


def _missing(models_dir: Path) -> Network:
    return Network(DEFAULT, problem=f"{models_dir / 'lander' / DEFAULT} is missing")
