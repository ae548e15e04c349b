"""The system's clipboard."""

from __future__ import annotations

from typing import Final

import pygame

from game.core import texts
from game.ui.context import Context

_LONGEST: Final = 1_000_000  # characters of what is pasted


def pasted() -> str:
    """Return the text in the clipboard; empty if there is none that is UTF-8, or no clipboard."""
    try:
        return str(pygame.scrap.get_text())[:_LONGEST]
    except (pygame.error, UnicodeDecodeError):
        return ""


def give(context: Context, text: str, message: str) -> None:
    """Copy a text and say so in the words `message`, or that there is no clipboard."""
    try:
        pygame.scrap.put_text(text)
    except pygame.error:
        message = texts.CODE_NO_CLIPBOARD
    context.note(message)
