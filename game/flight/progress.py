"""Progress of the player: what they have flown, won and read, which can be put away into a folder of its own.

Networks, drawings and settings of taste are no progress, and stay.
"""

from __future__ import annotations

from contextlib import suppress
from datetime import datetime
from pathlib import Path
from typing import Final

from ai.files.writing import free_path
from game.core.settings import Settings
from game.flight.days import FILE_NAME as DAYS
from game.flight.logbook import FOLDER, LOGBOOK

FILES: Final = (LOGBOOK, DAYS, FOLDER)  # files and folders of the player's folder that are progress
SETTINGS: Final = ("tutored", "first_flown", "rung", "learnt")  # and fields of the settings


def put_away(user_dir: Path, settings: Settings) -> Path:
    """Move all progress into a dated folder, whole or not at all; return that folder. Raises OSError."""
    box = free_path(user_dir, f"progress-{datetime.now():%Y-%m-%d}")
    box.mkdir(parents=True)
    moved = [name for name in FILES if (user_dir / name).exists()]
    try:
        for name in moved:
            (user_dir / name).rename(box / name)
    except OSError:
        for name in moved:
            with suppress(OSError):
                (box / name).rename(user_dir / name)
        box.rmdir()
        raise
    untouched = Settings()
    for name in SETTINGS:
        setattr(settings, name, getattr(untouched, name))
    return box
