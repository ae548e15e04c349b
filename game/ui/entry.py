"""Text entry of one line: it begins with a suggestion, which a gamepad's A accepts unchanged."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Final

import pygame

from game.drawing.tokens import FAINT, HUMAN, TEXT
from game.input.controls import Command, copies_or_pastes, translate
from game.ui.clipboard import pasted
from game.ui.widget import NOWHERE, OnPress, RowWidget

if TYPE_CHECKING:
    from game.core.scene import Transition
    from game.drawing.canvas import Canvas
    from game.drawing.cursor import Cursor

_HEIGHT: Final = 28.0


class EntryRow(RowWidget):
    """Line to type in. Enter or a gamepad's A starts typing, then accepts; Escape cancels.

    The first letter takes the place of what stands there. Up, down and Tab leave it and keep the text. `accept` is
    given the text, stripped and never empty. `fits` removes from a text all that is not allowed; `limit` is the largest
    number of letters. `composed` are letters under way, of a writing in which several keys make one.
    """

    spells = True

    def __init__(
        self,
        text: str,
        accept: Callable[[str], Transition | None],
        cancel: OnPress,
        limit: int,
        fits: Callable[[str], str],
    ) -> None:
        super().__init__(NOWHERE, "")
        self._accept, self._cancelled, self._limit, self._fits = accept, cancel, limit, fits
        self.text, self._before, self.composed = text, text, ""
        self.caret = len(text)
        self._whole = self._fresh = False  # whether the next letter takes the place of all; or is that of the first key

    def begin(self) -> None:
        if not self.typing:
            self.typing = self._whole = self._fresh = True
            self._before, self.caret = self.text, len(self.text)

    def press(self) -> Transition | None:
        if not self.typing:
            self.begin()
        elif self.text.strip():
            self.typing = False
            return self._accept(self.text.strip())
        return None

    def take(self, event: pygame.event.Event) -> bool:
        if not self.typing:
            return False
        key = event.key if event.type == pygame.KEYDOWN else None
        if event.type == pygame.TEXTEDITING:
            self.composed = self._fits(event.text)
        elif event.type == pygame.TEXTINPUT:
            self.composed = ""
            if not self._fresh:
                self._put(event.text)
        elif self.composed:
            return True  # a key that belongs to the composition
        elif copies_or_pastes(event) == "v":
            if text := pasted():
                self._put(text)
        elif key == pygame.K_BACKSPACE:
            self._put("", before=1)
        elif key == pygame.K_DELETE:
            self._put("", after=1)
        elif key in (pygame.K_HOME, pygame.K_END):
            self._go(len(self.text) if key == pygame.K_END else 0)
        else:
            return self._obey(translate(event), key)
        return True

    def _obey(self, command: Command | None, key: int | None) -> bool:
        match command:
            case Command.CONFIRM:
                self.outcome = self.press()
            case Command.BACK | Command.PAUSE:
                self.typing, self.text = False, self._before
                self.outcome = self._cancelled()
            case Command.LEFT | Command.RIGHT:
                self._go(self.caret + (1 if command is Command.RIGHT else -1))
            case Command.UP | Command.DOWN:
                self.typing = False
        self.typing = self.typing and key != pygame.K_TAB
        return command not in (Command.UP, Command.DOWN) and key != pygame.K_TAB

    def _go(self, caret: int) -> None:
        self.caret, self._whole = min(max(caret, 0), len(self.text)), False

    def _put(self, text: str, before: int = 0, after: int = 0) -> None:
        """Put as much of a text as is allowed at the caret, in place of so many letters before it and after it."""
        first, last = self.text[: max(self.caret - before, 0)], self.text[self.caret + after :]
        if self._whole:
            first = last = ""
        text = self._fits(text)[: self._limit - len(first + last)]
        self.text = first + text + last
        self._go(len(first + text))

    def process_event(self, event: pygame.event.Event) -> bool:
        pressed = event.type == pygame.MOUSEBUTTONDOWN and event.button == 1 and self.hover_point(*event.pos)
        if pressed:
            self.begin()
        return pressed

    def ease(self, at_once: bool) -> None:
        super().ease(at_once)
        self._fresh = False
        self.typing = self.typing and self.focused
        if not self.typing:
            self.composed = ""

    def write(self, cursor: Cursor) -> None:
        box, before = cursor.take(_HEIGHT), cursor.measured(self.text[: self.caret] + self.composed)
        left = box.left - max(before + 2 - box.width, 0.0)  # the caret is in sight
        if canvas := cursor.canvas:
            with canvas.clipped(box.inflate(8, 8)):
                self._paint(canvas, box, left, left + before)

    def _paint(self, canvas: Canvas, box: pygame.FRect, left: float, caret: float) -> None:
        y, baseline = box.bottom - 1, box.bottom - 9
        if self.typing and self._whole:
            canvas.rounded((left - 3, baseline - TEXT, caret - left + 6, 1.4 * TEXT), 3, HUMAN, 0.2)
        canvas.text(self.text[: self.caret] + self.composed + self.text[self.caret :], (left, baseline))
        if self.composed:
            canvas.line((caret - canvas.text_width(self.composed), y - 4), (caret, y - 4), HUMAN)
        if self.typing:
            canvas.line((caret + 0.5, baseline - 0.95 * TEXT), (caret + 0.5, baseline + 0.3 * TEXT), HUMAN, 1.5)
        canvas.line((box.left, y), (box.right, y), FAINT, 1)
        reach = box.width * (1.0 if self.typing else self.warmth)
        if reach > 1:
            canvas.line((box.left, y), (box.left + reach, y), HUMAN, 2, 1.0 if self.typing else 0.5 * self.warmth)
