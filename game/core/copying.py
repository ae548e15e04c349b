"""Copying of a folder into a collection or out of one, whole or not at all."""

from __future__ import annotations

import os
import shutil
from pathlib import Path
from typing import Final

from ai.files import NEW, beside, brief
from game.core import texts
from game.core.names import LibraryError

_DEEPEST: Final = 8  # depth of folders within a network's folder, its fixes included
MOST_FILES: Final = 5_000
MOST_BYTES: Final = 500_000_000


def copy_folder(source: Path, target: Path) -> None:
    """Copy a folder whole or not at all; raises LibraryError if it holds files that no network has."""
    _check_plain(source)
    partial = beside(target, NEW)
    try:
        shutil.copytree(source, partial, symlinks=True)
        partial.rename(target)
    except BaseException:
        shutil.rmtree(partial, ignore_errors=True)
        raise


def _check_plain(folder: Path) -> None:
    """Raise LibraryError unless a folder holds only plain files, and no more than a network can have.

    A link may lead outside or in a circle, and a pipe never ends; the window waits while files are copied.
    """
    folders, files, size = [(folder, 0)], 0, 0
    while folders:
        parent, depth = folders.pop()
        with os.scandir(parent) as inside:
            for entry in inside:
                files += 1
                if entry.is_dir(follow_symlinks=False) and depth < _DEEPEST:
                    folders.append((Path(entry.path), depth + 1))
                elif entry.is_file(follow_symlinks=False):
                    size += entry.stat(follow_symlinks=False).st_size
                else:
                    raise LibraryError(texts.LIBRARY_NOT_PLAIN.format(name=folder.name, inside=brief(entry.name, 40)))
                if files > MOST_FILES or size > MOST_BYTES:
                    raise LibraryError(texts.LIBRARY_TOO_LARGE.format(name=folder.name))
