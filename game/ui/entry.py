"""Text entry of one line: it begins with a suggestion, which a gamepad's A accepts unchanged.

A `TextLine` is edited; here it is drawn, found by the mouse, and begun, accepted or cancelled on any device.
"""

from __future__ import annotations

from collections.abc import Callable

import pygame

from game.core.scene import Transition
from game.drawing import typeface
from game.drawing.canvas import Canvas
from game.drawing.tokens import FAINT, HUMAN, INK, LABEL, MUTE, TEXT
from game.input.controls import Command, translate
from game.ui.text_line import Fits, TextLine, printable
from game.ui.widget import PointsManager, Widget


class Entry(Widget):
    """Text entry: a `TextLine` under a label. Enter or a gamepad's A starts typing, then accepts; Escape cancels.

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
        self.line = TextLine(manager, box, text, limit, fits)
        self._on_accept, self._on_cancel, self._size = on_accept, on_cancel, size
        self._before = self.line.text
        self._fresh = False
        self._first = 0  # the first letter that is shown
        self._pressed: int | None = None  # the caret's index where the mouse was pressed

    def kill(self) -> None:
        self.line.kill()  # type: ignore[no-untyped-call]
        super().kill()  # type: ignore[no-untyped-call]

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
        if not self.typing:
            self.begin()
            return None
        if not self.line.text.strip():
            return None
        self.typing = False
        self.line.rest()
        return self._on_accept(self.line.text.strip())

    def take(self, event: pygame.event.Event) -> bool:
        if not self.typing:
            return False
        if event.type == pygame.TEXTINPUT and self._fresh:
            return True  # the letter of the key that started typing
        if self.line.process_event(event):
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
        self.outcome = self._on_cancel()

    def process_event(self, event: pygame.event.Event) -> bool:
        if event.type == pygame.MOUSEMOTION and self.typing and self._pressed is not None:
            letter = self._letter(event.pos[0])
            self.line.selection_in_progress |= letter != self._pressed
            if self.line.selection_in_progress:
                self.line.place(self._pressed)
                self.line.place(letter, extend=True)
            return True
        if event.type == pygame.MOUSEBUTTONUP and self._pressed is not None:
            self._pressed = None
            self.line.process_event(event)
            return True
        if event.type != pygame.MOUSEBUTTONDOWN or event.button != 1 or not self.hover_point(*event.pos):
            return False
        self._pressed = self._letter(event.pos[0])
        if self.typing:
            self.line.edit_position = self._pressed
            self.line.process_event(event)
            if not self.line.selection_in_progress:  # the second click has selected a word
                self._pressed = None
        self.begin()
        return True

    @property
    def start(self) -> tuple[float, float]:
        """Left end of the text on its baseline, in points."""
        return self.box.left, self.box.bottom - 9

    def _first_shown(self) -> int:
        return first_shown(self.line.shown, self.line.caret, self._size, self.box.width, self._first)

    def _letter(self, x: float) -> int:
        """Return the caret's index for a click at x; before the first letter shown, that of the letter before it."""
        text, first = self.line.text, self._first_shown()
        if first and x < self.start[0]:
            return first - 1
        lefts = [typeface.width(text[first:end], self._size, "regular") for end in range(first, len(text) + 1)]
        return first + min(range(len(lefts)), key=lambda number: abs(self.start[0] + lefts[number] - x))

    def ease(self, at_once: bool) -> None:
        super().ease(at_once)
        self._fresh = False
        self._first = self._first_shown()
        self.typing = self.typing and self.focused
        if not self.typing:
            self._pressed = None
            self.line.rest()

    def paint(self, canvas: Canvas) -> None:
        box = self.box
        canvas.text(self.label, (box.left, box.top - 6), size=LABEL, weight="medium", colour=MUTE)
        if self.typing and pygame.display.get_init():  # an input method shows its suggestions below
            pygame.key.set_text_input_rect(canvas.in_window(box))
        draw_line(canvas, self.line, self.start, box.width, self._size, self._first, typing=self.typing)
        y = box.bottom - 1
        canvas.line((box.left, y), (box.right, y), FAINT, 1)
        reach = box.width * (1.0 if self.typing else self.warmth)
        if reach > 1:
            canvas.line((box.left, y), (box.left + reach, y), HUMAN, 2, 1.0 if self.typing else 0.5 * self.warmth)


def draw_line(
    canvas: Canvas,
    line: TextLine,
    start: tuple[float, float],
    room: float,
    size: float,
    first: int = 0,
    *,
    typing: bool,
) -> None:
    """Draw a line on a baseline, within `room` points from a letter near `first` on.

    While `typing`, also its caret, its selection and the line under composed letters.
    """
    left, baseline = start
    text, caret = line.shown, line.caret
    first = first_shown(text, caret, size, room, first)
    last = len(text)
    while last > first and canvas.text_width(text[first:last], size=size) > room:
        last -= 1

    def x(letter: int) -> float:
        return left + canvas.text_width(text[first : min(letter, last)], size=size)

    low, high = line.selection
    if typing and low < high:
        begin, end = x(low) - 3 * (low == 0), x(high) + 3 * (high == len(text))
        canvas.rounded((begin, baseline - size, end - begin, 1.4 * size), 3, HUMAN, 0.2)
    canvas.text(text[first:last], start, size=size, colour=INK)
    if typing and line.composition:
        canvas.line((x(caret - len(line.composition)), baseline + 4), (x(caret), baseline + 4), HUMAN, 1)
    if typing:
        canvas.line((x(caret) + 0.5, baseline - 0.95 * size), (x(caret) + 0.5, baseline + 0.3 * size), HUMAN, 1.5)


def first_shown(text: str, caret: int, size: float, room: float, first: int = 0) -> int:
    """Return the index of the first letter to show, near `first`: the caret is visible, and the room is used."""
    first = min(first, caret)
    while first < caret and typeface.width(text[first:caret], size, "regular") > room:
        first += 1
    while first and typeface.width(text[first - 1 :], size, "regular") <= room:
        first -= 1
    return first
