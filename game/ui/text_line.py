"""Editable line of text: pygame_gui's text entry line without its picture, which `game.ui.entry` draws in our type.

pygame_gui keeps the text, the caret and the selection, and knows the keys, clicks and clipboard that change them.
Here is added: steps by words, input methods, a text that is fitted instead of refused when it is pasted, and a key
repeat that is counted in steps. docs/adr/0014-what-pygame-gui-carries.md says why.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Final

import pygame
from pygame_gui.core.utility import clipboard_paste
from pygame_gui.elements import UITextEntryLine

from game.ui.widget import PointsManager

Fits = Callable[[str], str]
_CONTROL: Final = pygame.KMOD_CTRL | pygame.KMOD_META
_BY_WORD: Final = pygame.KMOD_CTRL | pygame.KMOD_ALT
_ARROWS: Final = {pygame.K_LEFT: -1, pygame.K_RIGHT: 1}
_ERASERS: Final = {pygame.K_BACKSPACE: -1, pygame.K_DELETE: 1}
_WORD: Final = re.compile(r"\w+")
_REPEAT_AFTER: Final = 24  # steps before a held key repeats, and between repeats
_REPEAT_EVERY: Final = 3


def printable(text: str) -> str:
    """Remove characters that cannot be shown on one line."""
    return "".join(letter for letter in text if letter.isprintable())


def digits(text: str) -> str:
    """Remove all but the digits 0 to 9."""
    return "".join(letter for letter in text if letter in "0123456789")


class TextLine(UITextEntryLine):
    """Text with a caret and a selection, in a box in points; the owner passes events to it while it is edited.

    `fits` removes from a text all that is not allowed; `limit` is the largest number of letters.

    Attributes:
        text: the text, without letters that are still being composed.
        composition: letters that an input method is composing at the caret.

    """

    def __init__(
        self,
        manager: PointsManager,
        box: pygame.typing.RectLike = (0, 0, 1, 1),
        text: str = "",
        limit: int = 40,
        fits: Fits = printable,
    ) -> None:
        self._fits, self._limit = fits, limit
        super().__init__(pygame.Rect(box), manager, visible=0)  # the manager gives it no events of its own
        self.is_focused = True  # its `focus` would switch on pygame's key repeat, for the whole game
        self.font = self.hidden_font  # without any, Backspace does nothing
        self.set(text)

    def rebuild_from_changed_theme_data(self) -> None:
        """Load no font and paint nothing."""

    def set(self, text: str) -> None:
        """Replace the text, and select all of it."""
        self.text = self._fits(text)[: self._limit]
        self.edit_position = len(self.text)
        self.select_range = [0, len(self.text)]
        self.rest()

    def rest(self) -> None:
        """Let go of a held key and of the mouse, and give up letters that are being composed."""
        self.composition = ""
        self.selection_in_progress = False
        self._held: pygame.event.Event | None = None

    @property
    def selection(self) -> tuple[int, int]:
        """First letter of the selection and the letter after it; both the caret's if nothing is selected."""
        low, high = sorted(self.select_range)
        return (low, high) if low < high else (self.edit_position, self.edit_position)

    @property
    def shown(self) -> str:
        """The text with the composed letters in it."""
        return self.text[: self.edit_position] + self.composition + self.text[self.edit_position :]

    @property
    def caret(self) -> int:
        """Index of the letter of `shown` after the caret."""
        return int(self.edit_position) + len(self.composition)

    def place(self, caret: int, *, extend: bool = False) -> None:
        """Move the caret to before a letter of the text; select the way there, or clear the selection."""
        caret = min(max(caret, 0), len(self.text))
        low, high = self.selection
        fixed = high if self.edit_position == low else low
        self.select_range = [fixed if extend else caret, caret]
        self.edit_position = caret

    def insert(self, text: str) -> None:
        """Put as much of a text as is allowed in place of the selection."""
        low, high = self.selection
        before, after = self.text[:low], self.text[high:]
        text = self._fits(text)[: self._limit - len(before + after)]
        self.text = before + text + after
        self.place(low + len(text))

    def process_event(self, event: pygame.event.Event) -> bool:
        if event.type == pygame.TEXTINPUT:
            self.composition = ""
            self.insert(event.text)
            return True
        if event.type == pygame.TEXTEDITING:
            if event.text:
                self.insert("")  # the composition replaces the selection
            self.composition = event.text
            return True
        if event.type == pygame.KEYUP and self._held and event.key == self._held.key:
            self._held = None
        if event.type != pygame.KEYDOWN:
            return bool(super().process_event(event))
        known = self._edit(event)
        self._held, self._held_steps = event if known else None, 0
        return known

    def update(self, time_delta: float) -> None:
        super().update(time_delta)
        if self._held:
            self._held_steps += 1
            since = self._held_steps - _REPEAT_AFTER
            if since >= 0 and since % _REPEAT_EVERY == 0:
                self._edit(self._held)

    def _edit(self, event: pygame.event.Event) -> bool:
        if self.composition:
            return True  # the key is the input method's
        modifiers = getattr(event, "mod", 0)
        if event.key in (pygame.K_RETURN, pygame.K_KP_ENTER):
            return False
        if event.key == pygame.K_v and modifiers & _CONTROL and not modifiers & pygame.KMOD_ALT:
            self.insert(_clipboard())
            return True
        direction = {**_ARROWS, **_ERASERS}.get(event.key)
        if direction and modifiers & _BY_WORD:
            return self._edit_word(event.key, direction, extend=bool(modifiers & pygame.KMOD_SHIFT))
        try:
            return bool(super().process_event(event))
        except pygame.error:
            return True  # there is no clipboard to copy to

    def _edit_word(self, key: int, direction: int, *, extend: bool) -> bool:
        """Move the caret to the next end of a word, or erase up to there; erase the selection if there is one."""
        low, high = self.selection
        if key in _ARROWS:
            self.place(self._word_end(direction), extend=extend)
            return True
        if low == high:
            self.place(self._word_end(direction), extend=True)
        self.insert("")
        return True

    def _word_end(self, direction: int) -> int:
        words, caret = list(_WORD.finditer(self.text)), self.edit_position
        if direction < 0:
            return max((word.start() for word in words if word.start() < caret), default=0)
        return min((word.end() for word in words if word.end() > caret), default=len(self.text))


def _clipboard() -> str:
    try:
        return str(clipboard_paste())  # type: ignore[no-untyped-call]
    except pygame.error:
        return ""
