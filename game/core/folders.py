"""Folders that may be items of a collection, also where they cannot be read."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path


def looks_like_item(folder: Path, parts: Iterable[str]) -> bool:
    """Whether a folder looks like an item of the collection: it has one of the parts, or it cannot be read.

    A folder that cannot be read, such as a broken link, counts too, so that it is listed with its problem.
    """
    if folder.name.startswith("."):
        return False
    try:
        return any(there(folder / part) for part in parts) or leads_nowhere(folder)
    except OSError:
        return True


def there(path: Path) -> bool:
    """Whether a path exists; raises OSError where that is unknown, for which `Path.exists` returns False."""
    try:
        path.stat()
    except (FileNotFoundError, NotADirectoryError, ValueError):
        return False
    return True


def leads_nowhere(path: Path) -> bool:
    """Whether a path is a broken link; raises OSError for a link to itself."""
    return path.is_symlink() and not there(path)
