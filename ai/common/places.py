"""Place on disk that commands and the game share."""

from __future__ import annotations

from pathlib import Path


def user_dir() -> Path:
    """Return the user's own folder for settings, scores, networks and studies."""
    import platformdirs

    return Path(platformdirs.user_data_dir("tranquility", appauthor=False))
