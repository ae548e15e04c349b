"""The system's clipboard, and a file in its place where there is none."""

from __future__ import annotations

from datetime import datetime
from typing import Final

import pygame

from ai.files import free_path, write_text
from game.core import texts
from game.ui.context import Context

FOLDER: Final = "codes"  # in the player's folder, where there is no clipboard
_LONGEST: Final = 1_000_000  # characters of what is pasted


def pasted() -> str:
    """Return the text in the clipboard; empty if there is none that is UTF-8, or no clipboard."""
    try:
        return str(pygame.scrap.get_text())[:_LONGEST]
    except (pygame.error, UnicodeDecodeError):
        return ""


def give(context: Context, text: str, message: str) -> None:
    """Copy a text and say so in the words `message`; without a clipboard, write it to a file and say where that is."""
    try:
        pygame.scrap.put_text(text)
    except pygame.error:
        message = _written(context, text)
    context.note(message)


def _written(context: Context, text: str) -> str:
    path = free_path(context.user_dir / FOLDER, f"{datetime.now():%Y-%m-%d %H.%M.%S}", ".txt")
    try:
        write_text(path, text + "\n", flush=False)
    except OSError as error:
        return texts.CODE_NOT_WRITTEN.format(reason=error.strerror or error)
    return texts.CODE_NO_CLIPBOARD.format(path=path)
