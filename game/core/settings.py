"""The player's settings, in one small file that survives crashes, full disks and bad edits."""

from __future__ import annotations

import copy
import json
import logging
import os
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass, field, fields
from pathlib import Path
from queue import SimpleQueue
from typing import Annotated, Any, Final

from ai.files.reading import parse_json, read_text
from ai.files.schema import OneOf, Share, Within, sound_fields
from ai.files.writing import take, write_text
from game.core import texts

FILE_NAME: Final = "settings.json"
DAMAGED_NAME: Final = "settings.damaged.json"
_LARGEST: Final = 1_000_000  # bytes
HELP: Final = ("off", "guard", "guide")  # words for how much a network helps, the least first
PACES: Final = (0.2, 1.0)  # limits of the player's factor for the pace of time
TOP_RUNG: Final = 10  # of the ladder of starts: there, flights begin anywhere
_log = logging.getLogger("tranquility")


@dataclass
class Settings:
    """The player's settings. To add one, add a field with its default."""

    full_screen: bool = False
    reduced_motion: bool = False
    colour_safe: bool = False
    show_hints: bool = True
    language: str = ""  # code of the language that the player chose; empty for the system's
    text_size: str = "normal"  # a name of game.drawing.tokens.TEXT_SIZES
    muted: bool = False  # whether nothing is heard at all
    master_volume: Share = 1.0  # factor on all other volumes
    effects_volume: Share = 0.9
    interface_volume: Share = 0.7
    ambience_volume: Share = 0.7
    model: str = ""  # name of the network last chosen to fly; empty for the shipped default
    help: Annotated[str, OneOf(HELP)] = "off"  # how early the network steps in
    three_pads: bool = False  # three pads among hills, instead of one on a plain
    show_thinking: bool = False  # whether what the network thinks is shown in flight
    pace: Annotated[float, Within(*PACES)] = 1.0  # time scale of a flight
    analogue: bool = True  # whether sticks and triggers give a share of thrust, and not all or none
    toggle_thrust: bool = False  # whether a press switches the main engine on or off, instead of holding it
    one_switch: bool = False  # whether a single key or button flies, and chooses in menus
    wider_pads: bool = False  # whether pads are half as wide again
    untimed: bool = False  # whether a flight may take as long as it likes
    keys: dict[str, Any] = field(default_factory=dict)  # changed keys, as game.input.bindings writes them
    buttons: dict[str, Any] = field(default_factory=dict)  # the same for gamepads
    opened: str = ""  # names of parts of screens that stay open, with spaces between
    tutored: bool = False  # whether the tutorial flight was flown or skipped, so it is not offered again
    first_flown: bool = False  # whether the tutorial flight was flown to its landing
    rung: Annotated[int, Within(-1, TOP_RUNG)] = -1  # place on the ladder of starts, from 0; -1 before it is known
    learnt: dict[str, Any] = field(default_factory=dict)  # progress by chapter, as game.scenes.learn.path writes it
    lesson_offered: bool = False  # whether a first landing in Train has been stopped at, or could have been
    slow_runs: bool = True  # whether landers in Train learn slowly enough to be watched
    unknown: dict[str, Any] = field(default_factory=dict)  # values written by a newer version; kept unchanged
    unread: bool = field(default=False, compare=False)  # whether the file exists but could not be read; not saved

    def is_open(self, part: str) -> bool:
        """Whether a part of a screen stays open."""
        return part in self.opened.split()

    def unfold(self, part: str) -> None:
        """Open a part of a screen from now on, or close it."""
        self.opened = " ".join(sorted({part}.symmetric_difference(self.opened.split())))

    def to_dict(self) -> dict[str, Any]:
        """Return the values as the file holds them."""
        values = asdict(self)
        del values["unread"]
        return {**values.pop("unknown"), **values}

    @classmethod
    def from_dict(cls, values: dict[str, Any]) -> Settings:
        """Make settings from a file's values; values of the wrong type or range are replaced by their defaults."""
        known = {each.name for each in fields(cls)} - {"unknown", "unread"}
        sound, _ = sound_fields(cls, {name: value for name, value in values.items() if name in known})
        return cls(**sound, unknown={name: value for name, value in values.items() if name not in known})


class SettingsFile:
    """The settings file in the player's folder.

    Neither `load` nor `save` raises. `save` returns whether the file was written; `problem` says what went wrong.
    """

    def __init__(self, folder: Path) -> None:
        self.path = folder / FILE_NAME
        self.problem = ""

    def load(self) -> Settings:
        """Read the settings. A damaged file is put aside under another name, never overwritten."""
        try:
            values = parse_json(read_text(self.path, _LARGEST))
            if not isinstance(values, dict):
                raise ValueError("not a table of settings")
            return Settings.from_dict(values)
        except FileNotFoundError:
            return Settings.from_dict({})
        except ValueError:
            self._set_aside()
            return Settings.from_dict({})
        except OSError as error:
            self.problem = texts.SETTINGS_UNREADABLE.format(reason=error.strerror, name=DAMAGED_NAME)
            return Settings(unread=True)

    def save(self, settings: Settings) -> bool:
        """Write the settings whole or not at all; a file that could not be read is put aside first."""
        try:
            if settings.unread and os.path.lexists(self.path):
                self.path.replace(self.path.with_name(DAMAGED_NAME))
            settings.unread = False
            write_text(self.path, json.dumps(settings.to_dict(), indent=2) + "\n")
        except OSError as error:
            self.problem = texts.SETTINGS_NOT_SAVED.format(reason=error.strerror)
            return False
        return True

    def _set_aside(self) -> None:
        aside = self.path.with_name(DAMAGED_NAME)
        try:
            self.path.replace(aside)
            self.problem = texts.SETTINGS_DAMAGED.format(name=aside.name)
        except OSError:
            self.problem = texts.SETTINGS_DAMAGED_HERE


class SettingsWriter:
    """Thread that writes each change of the settings at once, as waiting for the disk would drop frames.

    Of the windows on one folder only the first writes, until it is closed: what another had not read would be undone.

    Args:
        file: the file to write.
        settings: the settings as read from that file.

    """

    def __init__(self, file: SettingsFile, settings: Settings) -> None:
        self._file = file
        self._written = settings.to_dict()
        self._unread = settings.unread  # True until an unreadable file has been put aside
        self._lock = take(file.path.with_name(f".{FILE_NAME}.lock"))
        self._problems: SimpleQueue[str] = SimpleQueue()
        self._thread = ThreadPoolExecutor(1, "settings")

    def save(self, settings: Settings) -> None:
        """Queue the present settings for writing. Never waits."""
        self._thread.submit(self._attempt, copy.deepcopy(settings))

    def problem(self) -> str:
        """Return why the last write failed, once only; empty if it succeeded."""
        return "" if self._problems.empty() else self._problems.get_nowait()

    def wait(self) -> None:
        """Wait until every queued change has been written or has failed."""
        self._thread.submit(int).result()

    def close(self, settings: Settings) -> None:
        """Write the settings one last time, wait for the thread to end, and let another window write."""
        self.save(settings)
        self._thread.shutdown()
        self._thread = ThreadPoolExecutor(1, "settings")  # which runs only once something is saved
        if self._lock:
            self._lock.close()

    def _attempt(self, settings: Settings) -> None:
        try:
            self._write(settings)
        except Exception as error:  # which would else be seen by nobody
            _log.exception("writing the settings")
            self._problems.put(texts.SETTINGS_NOT_SAVED.format(reason=error))

    def _write(self, settings: Settings) -> None:
        values = settings.to_dict()
        if values == self._written and not self._unread and os.path.exists(self._file.path):  # noqa: PTH110
            return
        if self._lock is None:
            self._written = values  # so that it is said of each change once
            self._problems.put(texts.SETTINGS_ELSEWHERE)
            return
        settings.unread = self._unread
        saved = self._file.save(settings)
        self._unread = settings.unread
        if saved:
            self._written = values
        else:
            self._problems.put(self._file.problem)
