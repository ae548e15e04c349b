"""What a network reads, and how sure it is: the digit, large, and ten bars."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Final

import pygame

from ai.digits.classifier import DIGITS
from game.core import texts
from game.core.scene import Transition
from game.digits import certainty
from game.drawing.cursor import LEADING, Cursor
from game.drawing.shapes import Shape
from game.drawing.tokens import HUMAN, INK, LABEL, MUTE, NET, SMALL, TEXT, TITLE, Colour
from game.input.controls import Command, translate
from game.scenes.digits.reader import LEAST_INK, Reading, Verdict, best_two
from game.training.library import called
from game.ui.widget import RowWidget, mix

_ROW: Final = 22.0
_LARGE: Final = 124.0  # size of a digit
_HEIGHT: Final = 128.0
_INDENT: Final = 20.0  # of words after a mark


class DigitBars(RowWidget):
    """The ten digits, one below the other, each with a bar: up and down go on, a press takes the digit.

    Attributes:
        digit: the digit that the keys are at, or that was taken last.
        values: probabilities, 0 to 1, digit by digit; the bar of the largest is lit.

    """

    pad = 2.0

    def __init__(self, press: Callable[[int], Transition | None], digit: int = 0) -> None:
        super().__init__((0, 0, 1, 1), texts.HINT_DIGIT)
        self._on_press, self.digit = press, digit
        self.values = [0.0] * DIGITS

    def place(self, digit: int) -> pygame.FRect:
        """Return the box of a digit's line, in points."""
        return pygame.FRect(self.box.left, self.box.top + self.pad + digit * _ROW, self.box.width, _ROW)

    def press(self) -> Transition | None:
        if not self.ringed:
            mouse = self.ui_manager.get_mouse_position()
            self.digit = next((each for each in range(DIGITS) if self.place(each).collidepoint(mouse)), self.digit)
        return self._on_press(self.digit)

    def take(self, event: pygame.event.Event) -> bool:
        step = {Command.UP: -1, Command.DOWN: 1}.get(command) if (command := translate(event)) else None
        if step is None or not 0 <= self.digit + step < DIGITS:
            return False
        self.digit += step
        return True

    def advance(self) -> None:
        """Go to the next digit, and after the last to the first."""
        self.digit = (self.digit + 1) % DIGITS

    def write(self, cursor: Cursor) -> None:
        box = cursor.take(DIGITS * _ROW)
        if (canvas := cursor.canvas) is None:
            return
        for digit, value in enumerate(self.values):
            y, best = box.top + (digit + 0.5) * _ROW, value and value == max(self.values)
            lit = digit == self.digit and self.ringed
            colour = INK if best else mix(MUTE, INK, self.warmth if lit else 0.0)
            if lit and self.focused:
                canvas.marker("triangle", (box.left - 10, y), 7, HUMAN)
            canvas.text(str(digit), (box.left, y + 5), colour=colour, tabular=True)
            bar = (box.left + 30, y - 2, box.width - 30, 4)
            canvas.bar(bar, value if value > 0.01 else 0, NET if best else MUTE)


def write_legend(cursor: Cursor, words: Iterable[tuple[str, Colour]]) -> None:
    """Write words in a line, each after a square of its colour."""
    if canvas := cursor.canvas:
        x, y = cursor.left, cursor.y + 15
        for word, colour in words:
            canvas.rounded((x, y - 7, 7, 7), 1.5, colour)
            x += 24 + canvas.text(word, (x + 12, y), size=LABEL, colour=MUTE).width
    cursor.gap(24)


def write_answer(cursor: Cursor, reading: Reading, name: str) -> None:
    """Write a network's answer large, and below what the other reads."""
    verdict, top = reading.verdict(name), cursor.y
    if verdict is Verdict.EMPTY:
        cursor.styled(texts.DIGITS_EMPTY, TITLE)
        cursor.aside(texts.DIGITS_EMPTY_HOW)
        cursor.y = top + _HEIGHT + LEADING * (TEXT + SMALL)  # what stands below stays where it is
        return
    first, second = best_two(reading.probabilities[name])
    share, other = (certainty(float(reading.probabilities[name][digit])) for digit in (first, second))
    sure = verdict is not Verdict.UNSURE
    box = cursor.take(_HEIGHT)
    if canvas := cursor.canvas:
        words, colour = (str(first), INK) if sure else ("?", MUTE)
        canvas.text(words, (box.left - 6, box.bottom - 20), size=_LARGE, weight="extralight", colour=colour)
    palette = cursor.palette
    marks: dict[Verdict, tuple[Shape, str, Colour]] = {
        Verdict.SURE: ("check", texts.DIGITS_SURE, palette.good),
        Verdict.LIKELY: ("ring", texts.DIGITS_LIKELY, INK),
        Verdict.DISPUTED: ("ring", texts.DIGITS_DISPUTED, INK),
        Verdict.UNSURE: ("triangle", texts.DIGITS_UNSURE, palette.warn),
    }
    sign, words, colour = marks[verdict]
    if canvas:
        canvas.marker(sign, (cursor.left + 5, cursor.y + LEADING * TEXT / 2), 10, colour)
    cursor.styled(words.format(percent=share), TEXT, colour, indent=_INDENT, tabular=True)
    if sure:
        shown = reading.probabilities[name][second] >= 0.005
        cursor.aside(texts.DIGITS_OR.format(digit=second, percent=other) if shown else "")
    elif reading.image.sum() < LEAST_INK:
        cursor.aside(texts.DIGITS_TOO_LITTLE)
    else:
        cursor.aside(texts.DIGITS_EITHER.format(digit=first, percent=share, other=second, other_percent=other))
    for other in reading.probabilities.keys() - {name}:
        best = int(reading.probabilities[other].argmax())
        words = texts.DIGITS_UNSURE if reading.verdict(other) is Verdict.UNSURE else f"{best}"
        cursor.aside(f"{called(other)}: {words}")
