"""Text entry of one line: it begins with a suggestion, which a gamepad's A accepts unchanged.

pygame_gui keeps the text, the caret and the selection, and knows the keys and the clipboard that change them. Here it
is drawn in our type, a text that is pasted is fitted instead of refused, and a key repeat is counted in steps.
docs/adr/0014-what-pygame-gui-carries.md says why.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Final

import pygame
from pygame_gui.elements import UITextEntryLine

from game.drawing.tokens import FAINT, HUMAN, TEXT
from game.input.controls import Command, code_of, copies_or_pastes, translate
from game.ui.clipboard import pasted
from game.ui.widget import NOWHERE, OnPress, PointsManager, RowWidget

if TYPE_CHECKING:
    from game.core.scene import Transition
    from game.drawing.canvas import Canvas
    from game.drawing.cursor import Cursor

Fits = Callable[[str], str]
_HEIGHT: Final = 28.0
_CONTROL: Final = pygame.KMOD_CTRL | pygame.KMOD_META
_REPEAT_AFTER: Final = 24  # steps before a held key repeats, and between repeats
_REPEAT_EVERY: Final = 3


class TextLine(UITextEntryLine):
    """Text with a caret and a selection; the owner passes events to it while it is edited.

    `composed` are letters under way, of a writing in which several keys make one; they are no part of the text yet.
    `fits` removes from a text all that is not allowed; `limit` is the largest number of letters.
    """

    def __init__(self, manager: PointsManager, text: str, limit: int, fits: Fits) -> None:
        self._fits, self._limit = fits, limit
        super().__init__(pygame.Rect(NOWHERE), manager, visible=0)  # the manager gives it no events of its own
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
        self._held: pygame.event.Event | None = None
        self.composed = ""

    @property
    def selection(self) -> tuple[int, int]:
        """First letter of the selection and the letter after it; both the caret's if nothing is selected."""
        low, high = sorted(self.select_range)
        return (low, high) if low < high else (self.edit_position, self.edit_position)

    def place(self, caret: int) -> None:
        """Move the caret to before a letter of the text, and clear the selection."""
        self.edit_position = min(max(caret, 0), len(self.text))
        self.select_range = [self.edit_position, self.edit_position]

    def insert(self, text: str) -> None:
        """Put as much of a text as is allowed in place of the selection."""
        low, high = self.selection
        before, after = self.text[:low], self.text[high:]
        text = self._fits(text)[: self._limit - len(before + after)]
        self.text = before + text + after
        self.place(low + len(text))

    def process_event(self, event: pygame.event.Event) -> bool:
        if event.type == pygame.TEXTEDITING:
            self.composed = self._fits(event.text)
            return True
        if event.type == pygame.TEXTINPUT:
            self.composed = ""
            self.insert(event.text)
            return True
        if event.type == pygame.KEYDOWN and self.composed:
            return True  # it belongs to the composition
        if event.type == pygame.KEYUP and self._held and event.key == self._held.key:
            self._held = None
        if event.type != pygame.KEYDOWN:
            return False
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
        if event.key in (pygame.K_RETURN, pygame.K_KP_ENTER):
            return False
        try:
            if copies_or_pastes(event) == "v":
                if text := pasted():
                    self.insert(text)
                return True
            known = {"key": code_of(event)} if getattr(event, "mod", 0) & _CONTROL else {}
            return bool(super().process_event(pygame.event.Event(event.type, {**event.dict, **known})))
        except pygame.error:
            return True  # there is no clipboard


class EntryRow(RowWidget):
    """Line to type in. Enter or a gamepad's A starts typing, then accepts; Escape cancels.

    Up, down and Tab leave it and keep the text. `accept` is given the text, stripped and never empty.
    """

    spells = True

    def __init__(
        self, text: str, accept: Callable[[str], Transition | None], cancel: OnPress, limit: int, fits: Fits
    ) -> None:
        super().__init__(NOWHERE, "")
        self._given = text, limit, fits
        self._accept, self._cancelled = accept, cancel
        self._before, self._fresh = text, False
        self._lefts = [0.0]  # where each letter begins, and the last one ends, in points

    def join(self, manager: PointsManager) -> None:
        if not self._joined:
            self.line = TextLine(manager, *self._given)
        super().join(manager)

    def kill(self) -> None:
        self.line.kill()  # type: ignore[no-untyped-call]
        super().kill()  # type: ignore[no-untyped-call]

    @property
    def text(self) -> str:
        return self.line.text

    @text.setter
    def text(self, text: str) -> None:
        self.line.set(text)

    def begin(self) -> None:
        if not self.typing:
            self.typing = self._fresh = True
            self._before = self.line.text
            self.line.set(self.line.text)

    def press(self) -> Transition | None:
        if not self.typing:
            self.begin()
            return None
        if not self.line.text.strip():
            return None
        self.typing = False
        self.line.rest()
        return self._accept(self.line.text.strip())

    def take(self, event: pygame.event.Event) -> bool:
        if not self.typing:
            return False
        if event.type == pygame.TEXTINPUT and self._fresh:
            return True  # the letter of the key that started typing
        if self.line.process_event(event) or getattr(event, "chord", False):
            return True
        if event.type == pygame.KEYDOWN and event.key in (pygame.K_RETURN, pygame.K_KP_ENTER):
            self.outcome = self.press()
        elif event.type == pygame.KEYDOWN and event.key == pygame.K_ESCAPE:
            self._cancel()
        elif event.type == pygame.KEYDOWN:
            self.typing = event.key not in (pygame.K_UP, pygame.K_DOWN, pygame.K_TAB)
            return self.typing
        else:
            return self._take_gamepad(translate(event))
        return True

    def _take_gamepad(self, command: Command | None) -> bool:
        match command:
            case Command.CONFIRM:
                self.outcome = self.press()
            case Command.BACK | Command.PAUSE:
                self._cancel()
            case Command.LEFT | Command.RIGHT:
                self.line.place(self.line.edit_position + (1 if command is Command.RIGHT else -1))
            case Command.UP | Command.DOWN:
                self.typing = False
                return False
        return command is not None

    def _cancel(self) -> None:
        self.typing = False
        self.line.set(self._before)
        self.outcome = self._cancelled()

    def process_event(self, event: pygame.event.Event) -> bool:
        if event.type != pygame.MOUSEBUTTONDOWN or event.button != 1 or not self.hover_point(*event.pos):
            return False
        if self.typing:
            self.line.place(min(range(len(self._lefts)), key=lambda letter: abs(self._lefts[letter] - event.pos[0])))
        self.begin()
        return True

    def ease(self, at_once: bool) -> None:
        super().ease(at_once)
        self._fresh = False
        self.typing = self.typing and self.focused
        if not self.typing:
            self.line.rest()

    def write(self, cursor: Cursor) -> None:
        box, text, caret = cursor.take(_HEIGHT), self.line.text, self.line.edit_position
        reach = max(cursor.measured(text[:caret]) + 2 - box.width, 0.0)  # the caret is in sight
        lefts = [box.left - reach + cursor.measured(text[:letter]) for letter in range(len(text) + 1)]
        if canvas := cursor.canvas:
            with canvas.clipped(box.inflate(8, 8)):
                self._paint(canvas, box, lefts)
        else:
            self._lefts = lefts

    def _paint(self, canvas: Canvas, box: pygame.FRect, lefts: list[float]) -> None:
        size, caret, (low, high) = TEXT, lefts[self.line.edit_position], self.line.selection
        y, baseline = box.bottom - 1, box.bottom - 9
        if self.typing and low < high:
            canvas.rounded((lefts[low] - 3, baseline - size, lefts[high] - lefts[low] + 6, 1.4 * size), 3, HUMAN, 0.2)
        before, after = self.line.text[: self.line.edit_position], self.line.text[self.line.edit_position :]
        canvas.text(before, (lefts[0], baseline), size=size)
        if self.typing and self.line.composed:
            under_way = canvas.text(self.line.composed, (caret, baseline), size=size, colour=HUMAN)
            canvas.line(under_way.bottomleft, under_way.bottomright, HUMAN, 1)
            canvas.text(after, (under_way.right, baseline), size=size)
        else:
            canvas.text(after, (caret, baseline), size=size)
        if self.typing and not self.line.composed:
            canvas.line((caret + 0.5, baseline - 0.95 * size), (caret + 0.5, baseline + 0.3 * size), HUMAN, 1.5)
        canvas.line((box.left, y), (box.right, y), FAINT, 1)
        reach = box.width * (1.0 if self.typing else self.warmth)
        if reach > 1:
            canvas.line((box.left, y), (box.left + reach, y), HUMAN, 2, 1.0 if self.typing else 0.5 * self.warmth)
