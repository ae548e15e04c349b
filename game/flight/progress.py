"""Progress of the player: what they have flown, won and read, which can be put away and brought back.

Networks, drawings and settings of taste are no progress, and stay.
"""

from __future__ import annotations

import json
import shutil
from contextlib import suppress
from dataclasses import fields
from datetime import datetime
from pathlib import Path
from typing import Any, Final

from ai.files import free_path, parse_json, read_bytes, read_text, sound_fields, write_bytes, write_text
from game.core import texts
from game.core.names import LibraryError, library_errors
from game.core.settings import Settings
from game.core.trash import Trash
from game.flight.days import FILE_NAME as DAYS
from game.flight.logbook import FOLDER, LOGBOOK, Records

FILES: Final = (LOGBOOK, DAYS, FOLDER)  # files and folders of the player's folder that are progress
SETTINGS: Final = ("tutored", "first_flown", "rung", "learnt", "chapter")  # and fields of the settings
_PREFIX: Final = "progress "  # of the folder that progress is put away in
_VALUES: Final = "progress.json"
_LARGEST: Final = 1_000_000  # bytes of the settings put away
_LOGBOOK: Final = 500_000_000  # and of a logbook, which grows by a line for each flight
_MOST: Final = 5  # resets that can be undone


class Progress:
    """Progress in a player's folder and settings. Methods that fail raise LibraryError, a sentence for the player."""

    def __init__(self, user_dir: Path, settings: Settings) -> None:
        self._folder, self._settings = user_dir, settings
        self._trash = Trash(user_dir, _MOST)

    @property
    def figures(self) -> tuple[int, int, int]:
        """How many flights, medals and chapters a reset would put away."""
        entries = Records(self._folder).entries()
        medals = {entry.course for entry in entries if entry.medal and not entry.outdated}
        return len(entries), len(medals), len(self._settings.learnt)

    @property
    def restorable(self) -> bool:
        """Whether a reset can be undone."""
        return bool(self._put_away)

    @property
    def _put_away(self) -> list[str]:
        return [name for name in self._trash.names if name.startswith(_PREFIX)]

    def reset(self) -> None:
        """Put all progress away into the trash, whole or not at all."""
        values = self._settings.to_dict()
        box = free_path(self._folder, f"{_PREFIX}{datetime.now():%Y-%m-%d %H.%M.%S}", "")
        with library_errors(texts.PROGRESS_FAILED, box.name):
            box.mkdir(parents=True)
            try:
                for name in FILES:
                    if (self._folder / name).exists():
                        (self._folder / name).rename(box / name)
                write_text(box / _VALUES, json.dumps({name: values[name] for name in SETTINGS}))
                self._trash.add(box, box.name)
            except (OSError, LibraryError):
                self._take_back(box)
                raise
        untouched = Settings()
        for name in SETTINGS:
            setattr(self._settings, name, getattr(untouched, name))

    def restore(self) -> None:
        """Bring back what was put away last; what was flown since stays, after it."""
        box = self._trash.restore(self._put_away[-1])
        with library_errors(texts.PROGRESS_FAILED, box.name):
            values: dict[str, Any] = {}
            with suppress(OSError, ValueError):
                values = parse_json(read_text(box / _VALUES, _LARGEST))
            self._take_back(box)
        known = {each.name for each in fields(Settings)}
        sound, _ = sound_fields(Settings, {name: values[name] for name in SETTINGS if name in values and name in known})
        untouched = Settings()
        for name, value in sound.items():
            now = getattr(self._settings, name)
            if now == getattr(untouched, name) or (name == "rung" and value > now):  # everybody begins at the lowest
                setattr(self._settings, name, value)

    def _take_back(self, box: Path) -> None:
        """Move a folder's files back to where they were, beside or before those of the same name."""
        for path in [path for path in box.rglob("*") if path.is_file() and path.name != _VALUES]:
            home = self._folder / path.relative_to(box)
            home.parent.mkdir(parents=True, exist_ok=True)
            if not home.exists():
                path.rename(home)
            elif home.name in (LOGBOOK, DAYS):  # a line for each flight or day: what was put away is older
                write_bytes(home, read_bytes(path, _LOGBOOK).rstrip(b"\n") + b"\n" + read_bytes(home, _LOGBOOK))
        shutil.rmtree(box)
