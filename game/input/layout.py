"""The keyboard's layout: which key stands where, and what is printed on it.

A place is named by the code of the key that stands there on an American keyboard, as SDL's scancodes are. Keys that
type nothing have the same code on every keyboard.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import pygame

_PRINTED: Final = range(33, 0x530)  # codes of keys in Latin, Greek and Cyrillic; of others the place is named
_SIGNS: Final = ("MINUS", "EQUALS", "LEFTBRACKET", "RIGHTBRACKET", "BACKSLASH", "SEMICOLON", "COMMA", "PERIOD", "SLASH")
_PLACES: Final[dict[int, int]] = {
    **{getattr(pygame, f"KSCAN_{letter.upper()}"): ord(letter) for letter in "abcdefghijklmnopqrstuvwxyz0123456789"},
    **{getattr(pygame, f"KSCAN_{name}"): getattr(pygame, f"K_{name}") for name in _SIGNS},
    pygame.KSCAN_APOSTROPHE: pygame.K_QUOTE,
    pygame.KSCAN_GRAVE: pygame.K_BACKQUOTE,
}
_SCANCODES: Final = {code: scancode for scancode, code in _PLACES.items()}
# Looked up by a key's code, it gives what stands at that key's scancode: here, the scancode itself.
_every_scancode: Final = pygame.key.ScancodeWrapper(tuple(range(512)))  # type: ignore[arg-type]


def place_of(event: pygame.event.Event) -> int:
    """Return the place of a key event."""
    place: int = _PLACES.get(getattr(event, "scancode", 0), event.key)
    return place


class Layout:
    """The layout that is switched on; `scancode_of` tells where a key stands, 0 if there is none."""

    def __init__(self, scancode_of: Callable[[int], int] = _every_scancode.__getitem__) -> None:
        self._scancode_of = scancode_of
        self._printed = {scancode: code for code in _PRINTED if (scancode := scancode_of(code))}

    def code_of(self, event: pygame.event.Event) -> int:
        """Return the code by which a key event gives a command: what is printed on it.

        A key that no American keyboard has is the one of its place, if that is nowhere else.
        """
        place = place_of(event)
        return event.key if event.key in _SCANCODES or self._scancode_of(place) else place

    def printed(self, place: int) -> int:
        """Return the code of what is printed on the key of a place."""
        return self._printed.get(_SCANCODES.get(place, 0), place)

    def key(self, code: int) -> int:
        """Return the code of what is printed on the key that gives the commands of `code`."""
        return code if self._scancode_of(code) else self.printed(code)
