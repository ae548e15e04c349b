"""What the player chose, kept in one small file that survives crashes, full disks and bad edits."""

from __future__ import annotations

import json
import os
from contextlib import suppress
from dataclasses import asdict, dataclass, field, fields
from pathlib import Path
from typing import Any, Final

from ai.nn.files import parse_json, read_text, write_text
from game.core import texts
from game.core.lock import held

FILE_NAME: Final = "settings.json"
DAMAGED_NAME: Final = "settings.damaged.json"
_LARGEST: Final = 1_000_000  # bytes
# What shares of its gravity, and of time's own pace, a flight can be given.
GRAVITY_SHARES: Final = (0.6, 1.4)
PACES: Final = (0.5, 1.0)


@dataclass
class Settings:
    """The player's choices. A new one is one more line with its default."""

    full_screen: bool = False
    reduced_motion: bool = False
    colour_safe: bool = False
    show_hints: bool = True
    text_size: str = "normal"  # a name of game.drawing.tokens.TEXT_SIZES
    effects_volume: float = 0.9  # every number is a share, 0 to 1 unless limits say otherwise
    interface_volume: float = 0.7
    ambience_volume: float = 0.7
    altitude_volume: float = 0.0  # of the tone that lets one hear height and speed; 0 is off
    model: str = ""  # the network last chosen to fly; empty for the game's own
    assist: float = 0.0  # how much the co-pilot helps a person who flies
    copilot: str = "tolerance"  # and when, a Mode of ai.copilot.copilot
    three_pads: bool = False  # among hills, instead of one on a plain
    hands: str = "own"  # what the keys pass through, of game.flight.handicap
    check_flights: bool = False  # every fifth flight without help
    teach: bool = False  # whether good landings are kept for a network to learn from
    explain: bool = True  # whether a panel says what the co-pilot thinks
    gravity: float = field(default=1.0, metadata={"limits": GRAVITY_SHARES})  # share of it in free flights
    pace: float = field(default=1.0, metadata={"limits": PACES})  # how fast time passes in a flight
    keys: dict[str, Any] = field(default_factory=dict)  # what was changed, as game.input.bindings writes it
    buttons: dict[str, Any] = field(default_factory=dict)  # of the pads
    tutored: bool = False  # whether the first flight is offered no more: it was flown, or left out
    first_flown: bool = False  # whether it was flown to its landing
    unknown: dict[str, Any] = field(default_factory=dict)  # written by a newer version; kept as it is
    unread: bool = field(default=False, compare=False)  # whether there is a file that could not be read; not kept

    def to_dict(self) -> dict[str, Any]:
        """Return what the file holds."""
        values = asdict(self)
        del values["unread"]
        return {**values.pop("unknown"), **values}

    @classmethod
    def from_dict(cls, values: dict[str, Any]) -> Settings:
        """Take every value of the right kind; the others keep their defaults."""
        settings = cls()
        known = {each.name: each.metadata.get("limits", (0.0, 1.0)) for each in fields(cls)}
        del known["unknown"], known["unread"]
        for name in known.keys() & values.keys():
            if _fits(values[name], getattr(settings, name), known[name]):
                setattr(settings, name, values[name])
        settings.unknown = {name: value for name, value in values.items() if name not in known}
        return settings


def changes(values: dict[str, Any], since: dict[str, Any]) -> dict[str, Any]:
    """Return those of some settings that are not what they were."""
    return {name: value for name, value in values.items() if name not in since or since[name] != value}


def _fits(value: object, default: object, limits: tuple[float, float]) -> bool:
    """Whether a value is of its default's type; a number must be within limits as well, which NaN is not."""
    return type(value) is type(default) and (not isinstance(value, float) or limits[0] <= value <= limits[1])


class SettingsFile:
    """The settings file in a folder of the player's.

    Neither `load` nor `save` raises: each returns whether all went well, and `problem` says what did not.
    """

    def __init__(self, folder: Path) -> None:
        self.path = folder / FILE_NAME
        self.problem = ""

    def load(self) -> Settings:
        """Read the settings. A damaged file is kept aside under another name, never overwritten."""
        try:
            return Settings.from_dict(self._read())
        except FileNotFoundError:
            return Settings.from_dict({})
        except ValueError:
            self._set_aside()
            return Settings.from_dict({})
        except OSError as error:
            self.problem = texts.SETTINGS_UNREADABLE.format(reason=error.strerror, name=DAMAGED_NAME)
            return Settings(unread=True)

    def _read(self) -> dict[str, Any]:
        """Return what the file holds; raises OSError or ValueError."""
        values = parse_json(read_text(self.path, _LARGEST))
        if not isinstance(values, dict):
            raise ValueError("not a table of settings")
        return values

    def save(self, settings: Settings, since: dict[str, Any] | None = None) -> bool:
        """Write the settings whole or not at all; a file that could not be read is put aside first.

        Given what they were, as `Settings.to_dict` has it, only what has changed `since` is written over the file:
        another game may have changed the rest meanwhile.
        """
        values = settings.to_dict()
        try:
            if settings.unread and os.path.lexists(self.path):
                self.path.replace(self.path.with_name(DAMAGED_NAME))
            settings.unread = False
            with held(self.path.with_name(f".{FILE_NAME}.lock")):
                if since is not None:
                    values = {**values, **self._there(), **changes(values, since)}
                write_text(self.path, json.dumps(values, indent=2) + "\n")
        except OSError as error:
            self.problem = texts.SETTINGS_NOT_SAVED.format(reason=error.strerror)
            return False
        return True

    def _there(self) -> dict[str, Any]:
        """Return what the file holds; nothing if that makes no sense."""
        with suppress(OSError, ValueError):
            return self._read()
        return {}

    def _set_aside(self) -> None:
        aside = self.path.with_name(DAMAGED_NAME)
        try:
            self.path.replace(aside)
            self.problem = texts.SETTINGS_DAMAGED.format(name=aside.name)
        except OSError:
            self.problem = texts.SETTINGS_DAMAGED_HERE
