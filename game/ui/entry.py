"""Text entry of one line: it begins with a suggestion, which a gamepad's A accepts unchanged.

pygame_gui's own text line uses its own type and pixels, and has no gamepad support: this one is a `Widget`
like the others. Letters arrive as TEXTINPUT events, so that any keyboard layout and any script works.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import pygame

from game.core.scene import Transition
from game.drawing import typeface
from game.drawing.canvas import Canvas
from game.drawing.tokens import FAINT, HUMAN, INK, LABEL, MUTE, TEXT
from game.input.controls import Command, translate
from game.ui.widget import PointsManager, Widget

Fits = Callable[[str], str]
_PASTE: Final = pygame.KMOD_CTRL | pygame.KMOD_META
_REPEAT_AFTER: Final = 24  # steps before a held key repeats, and between repeats
_REPEAT_EVERY: Final = 3


def printable(text: str) -> str:
    """Remove characters that cannot be shown on one line."""
    return "".join(letter for letter in text if letter.isprintable())


def digits(text: str) -> str:
    """Remove all but the digits 0 to 9."""
    return "".join(letter for letter in text if letter in "0123456789")


class EditedLine:
    """Editable line of text with a caret, and its editing keys.

    Attributes:
        caret: index of the letter after the caret.
        selected: whether the whole text is selected, so that the next letter replaces it.

    """

    def __init__(self, text: str = "", limit: int = 40, fits: Fits = printable) -> None:
        self._limit, self._fits = limit, fits
        self._key, self._held_steps = 0, 0
        self.set(text)

    def set(self, text: str) -> None:
        """Replace the text, and select all of it."""
        self.text = self._fits(text)[: self._limit]
        self.caret = len(self.text)
        self.selected = bool(self.text)
        self._key = 0

    def insert(self, text: str) -> None:
        """Insert as much of a text at the caret as is allowed."""
        if self.selected:
            self._clear()
        text = self._fits(text)[: self._limit - len(self.text)]
        self.text = self.text[: self.caret] + text + self.text[self.caret :]
        self.caret += len(text)

    def place(self, caret: int) -> None:
        """Move the caret, and clear the selection."""
        self.caret, self.selected = min(max(caret, 0), len(self.text)), False

    def take(self, event: pygame.event.Event) -> bool:
        """Handle a letter or an editing key; false for any other event."""
        if event.type == pygame.TEXTINPUT:
            self.insert(event.text)
            return True
        if event.type == pygame.KEYUP and event.key == self._key:
            self._key = 0
        if event.type != pygame.KEYDOWN:
            return False
        if event.key == pygame.K_v and getattr(event, "mod", 0) & _PASTE:
            self.insert(_clipboard())
            return True
        if event.key == pygame.K_a and getattr(event, "mod", 0) & _PASTE:
            self.selected = bool(self.text)
            return True
        known = self._edit(event.key)
        self._key, self._held_steps = (event.key, 0) if known else (0, 0)
        return known

    def update(self) -> None:
        """Advance by 1/60 s: repeat a held key."""
        if not self._key:
            return
        self._held_steps += 1
        since = self._held_steps - _REPEAT_AFTER
        if since >= 0 and since % _REPEAT_EVERY == 0:
            self._edit(self._key)

    def _edit(self, key: int) -> bool:
        match key:
            case pygame.K_BACKSPACE | pygame.K_DELETE if self.selected:
                self._clear()
            case pygame.K_BACKSPACE:
                self.text = self.text[: max(0, self.caret - 1)] + self.text[self.caret :]
                self.place(self.caret - 1)
            case pygame.K_DELETE:
                self.text = self.text[: self.caret] + self.text[self.caret + 1 :]
            case pygame.K_LEFT:
                self.place(0 if self.selected else self.caret - 1)
            case pygame.K_RIGHT:
                self.place(self.caret + 1)
            case pygame.K_HOME:
                self.place(0)
            case pygame.K_END:
                self.place(len(self.text))
            case _:
                return False
        return True

    def _clear(self) -> None:
        self.text, self.caret, self.selected = "", 0, False


class Entry(Widget):
    """Text entry: a `EditedLine` under a label. Enter or a gamepad's A starts typing, then accepts; Escape cancels.

    Up, down and Tab leave it and accept the text. `on_accept` is given the text, stripped
    and never empty; `on_cancel` is called when typing is cancelled.
    """

    spells = True

    def __init__(
        self,
        manager: PointsManager,
        box: pygame.typing.RectLike,
        label: str,
        text: str,
        on_accept: Callable[[str], Transition | None],
        *,
        on_cancel: Callable[[], Transition | None] = lambda: None,
        limit: int = 40,
        fits: Fits = printable,
        size: float = TEXT,
    ) -> None:
        super().__init__(manager, box, label)
        self.line = EditedLine(text, limit, fits)
        self._on_accept, self._on_cancel, self._size = on_accept, on_cancel, size
        self._before = self.line.text
        self._fresh = False

    @property
    def text(self) -> str:
        """The text in the entry."""
        return self.line.text

    @text.setter
    def text(self, text: str) -> None:
        self.line.set(text)

    def begin(self) -> None:
        """Start typing."""
        if not self.typing:
            self.typing = self._fresh = True
            self._before = self.line.text
            self.line.set(self.line.text)

    def press(self) -> Transition | None:
        """Start typing, or accept the text."""
        if not self.typing:
            self.begin()
            return None
        if not self.line.text.strip():
            return None
        self.typing = False
        return self._on_accept(self.line.text.strip())

    def take(self, event: pygame.event.Event) -> bool:
        """Handle every event while typing, except those that leave the entry."""
        if not self.typing:
            return False
        if event.type == pygame.TEXTINPUT and self._fresh:
            return True  # the letter of the key that started typing
        if self.line.take(event):
            return True
        if event.type == pygame.KEYDOWN and event.key in (pygame.K_RETURN, pygame.K_KP_ENTER):
            self.outcome = self.press()
        elif event.type == pygame.KEYDOWN and event.key == pygame.K_ESCAPE:
            self._cancel()
        elif event.type == pygame.KEYDOWN:
            self.typing = event.key not in (pygame.K_UP, pygame.K_DOWN, pygame.K_TAB)
            return self.typing
        else:
            return self._take_pad(translate(event))
        return True

    def _take_pad(self, command: Command | None) -> bool:
        match command:
            case Command.CONFIRM:
                self.outcome = self.press()
            case Command.BACK | Command.PAUSE:
                self._cancel()
            case Command.LEFT | Command.RIGHT:
                self.line.place(self.line.caret + (1 if command is Command.RIGHT else -1))
            case Command.UP | Command.DOWN:
                self.typing = False
                return False
        return command is not None

    def _cancel(self) -> None:
        self.typing = False
        self.line.set(self._before)
        self.outcome = self._on_cancel()

    def process_event(self, event: pygame.event.Event) -> bool:
        """Start typing at the letter that is clicked."""
        if event.type != pygame.MOUSEBUTTONDOWN or event.button != 1 or not self.hover_point(*event.pos):
            return False
        if self.typing:
            self.line.place(self._letter(event.pos[0]))
        self.begin()
        return True

    @property
    def start(self) -> tuple[float, float]:
        """Left end of the text on its baseline, in points."""
        return self.box.left, self.box.bottom - 9

    def _letter(self, x: float) -> int:
        """Return the caret's index for a click at x."""
        text = self.line.text
        first = first_shown(text, self.line.caret, self._size, self.box.width)
        lefts = [typeface.width(text[first:end], self._size, "regular") for end in range(first, len(text) + 1)]
        return first + min(range(len(lefts)), key=lambda number: abs(self.start[0] + lefts[number] - x))

    def ease(self, at_once: bool) -> None:
        """Repeat a held key, and stop typing once the focus is elsewhere."""
        super().ease(at_once)
        self._fresh = False
        self.typing = self.typing and self.focused
        if self.typing:
            self.line.update()

    def paint(self, canvas: Canvas) -> None:
        """Draw the label, the text and the line under it."""
        box = self.box
        canvas.text(self.label, (box.left, box.top - 6), size=LABEL, weight="medium", colour=MUTE)
        draw_line(canvas, self.line, self.start, box.width, self._size, typing=self.typing)
        y = box.bottom - 1
        canvas.line((box.left, y), (box.right, y), FAINT, 1)
        reach = box.width * (1.0 if self.typing else self.warmth)
        if reach > 1:
            canvas.line((box.left, y), (box.left + reach, y), HUMAN, 2, 1.0 if self.typing else 0.5 * self.warmth)


def draw_line(
    canvas: Canvas, line: EditedLine, start: tuple[float, float], room: float, size: float, *, typing: bool
) -> None:
    """Draw a line of text on a baseline, with its caret or its selection while `typing`."""
    x, baseline = start
    first = first_shown(line.text, line.caret, size, room)
    shown = line.text[first:]
    while shown and canvas.text_width(shown, size=size) > room:
        shown = shown[:-1]
    if typing and line.selected:
        width = canvas.text_width(shown, size=size)
        canvas.rounded((x - 3, baseline - size, width + 6, 1.4 * size), 3, HUMAN, 0.2)
    canvas.text(shown, start, size=size, colour=INK)
    if typing:
        x += canvas.text_width(line.text[first : line.caret], size=size)
        canvas.line((x + 0.5, baseline - 0.95 * size), (x + 0.5, baseline + 0.3 * size), HUMAN, 1.5)


def first_shown(text: str, caret: int, size: float, room: float) -> int:
    """Return the index of the first letter to show, so that the caret is visible."""
    first = 0
    while first < caret and typeface.width(text[first:caret], size, "regular") > room:
        first += 1
    return first


def _clipboard() -> str:
    try:
        return str(pygame.scrap.get_text())
    except (pygame.error, AttributeError):
        return ""
