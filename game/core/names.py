"""Names of files and folders that every system allows, and what a player reads when one can't be used."""

from __future__ import annotations

import shutil
import unicodedata
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Final

from game.core import texts

LONGEST_NAME: Final = 40
_DEVICES: Final = {"con", "prn", "aux", "nul"} | {f"{port}{n}" for port in ("com", "lpt") for n in "123456789¹²³"}


class LibraryError(Exception):
    """Failed operation on a collection; its message is a sentence for the player."""


def fitting(text: str) -> str:
    """Remove from a text the characters that no name may contain."""
    return "".join(letter for letter in unicodedata.normalize("NFC", text) if letter.isalnum() or letter in " -_.")


def name_problem(text: str) -> str:
    """Return a sentence why a text is not a valid folder name on every system; empty if it is valid."""
    if not text.strip():
        return texts.NAME_EMPTY
    if len(text) > LONGEST_NAME:
        return texts.NAME_LONG.format(count=LONGEST_NAME)
    if fitting(text) != unicodedata.normalize("NFC", text):
        return texts.NAME_LETTERS
    if text[0] == "." or text[-1] == "." or text != text.strip():
        return texts.NAME_ENDS
    if text.partition(".")[0].strip().casefold() in _DEVICES:
        return texts.NAME_DEVICE.format(name=text)
    return ""


def is_valid_name(text: str) -> bool:
    """Whether a text is a valid folder name on every system."""
    return not name_problem(text)


def holder(folder: Path, name: str) -> str:
    """Return the name in a folder that some systems take for the same as this one; empty if there is none."""
    with suppress(OSError):
        return next((path.name for path in folder.iterdir() if _same(path.name) == _same(name)), "")
    return ""


@contextmanager
def library_errors(sentence: str, name: str) -> Iterator[None]:
    """Turn an OSError into a LibraryError with a sentence for the player; a context manager."""
    try:
        yield
    except OSError as error:
        raise LibraryError(sentence.format(name=name, reason=reason(error))) from error


def reason(error: OSError) -> str:
    """Return in a few words what went wrong; a copy of many files names the first that failed."""
    if isinstance(error, shutil.Error) and error.args and isinstance(error.args[0], list):
        return str(error.args[0][0][-1])
    return error.strerror or str(error)


def _same(name: str) -> str:
    return unicodedata.normalize("NFC", name).casefold()
