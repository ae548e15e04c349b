"""Widgets as rows of a panel: each lays itself out with a cursor, and is painted by the same lines."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Final

import pygame

from game.core import texts
from game.core.scene import Transition
from game.drawing.cursor import BASELINE, LEADING, Cursor
from game.drawing.tokens import FAINT, HUMAN, INK, MUTE, NET, SMALL, STEP, TEXT, Colour
from game.drawing.typeface import Weight
from game.ui.widget import NOWHERE, OnPress, RowWidget, mix

Words = str | Callable[[], str]  # a function for words that change
_SWITCH: Final = (32.0, 16.0)
_LABELS: Final = 150.0  # points for the label before a slider or a choice
_ALL: Final = -1  # the word that opens a list, among the numbers of the options
_FIGURES: Final = 66.0
_TRACK: Final = 120.0  # the shortest track beside its label
_WORDS: Final = 24.0  # between two options
_SHARE: Final = 0.4  # of a line, that a choice among others takes at most


def said(words: Words) -> str:
    """Return words as they are now."""
    return words if isinstance(words, str) else words()


def percent(share: float) -> str:
    """Return a share, 0 to 1, as it is written."""
    return texts.SOUND_SHARE.format(percent=round(100 * share))


class ButtonRow(RowWidget):
    """Words to press, with the player's figure beside them and an explanation below; a short line shows the focus.

    Attributes:
        size: of the words, in points.

    """

    acts = True

    def __init__(
        self,
        label: str,
        press: OnPress,
        aside: Words = "",
        *,
        figure: Words = "",
        size: float = TEXT,
        weight: Weight = "regular",
        colour: Colour = MUTE,
    ) -> None:
        super().__init__(NOWHERE, label)
        self._on_press, self.size, self._weight, self._colour = press, size, weight, colour
        self._aside, self._figure = aside, figure

    def press(self) -> Transition | None:
        return self._on_press()

    def measured(self, cursor: Cursor) -> float:
        """Return the width of its words on one line, with something to spare."""
        return cursor.in_style(self.size, weight=self._weight).measured(self.label) + 1

    def write(self, cursor: Cursor) -> None:
        label = cursor.in_style(self.size, mix(self._colour, INK, self.warmth), self._weight)
        top, wide, figure = cursor.y, min(label.measured(self.label), cursor.width), said(self._figure)
        label.text(self.label)
        if cursor.canvas and self.warmth * wide > 1:
            y = label.y - 0.05 * self.size + 2
            cursor.canvas.line((cursor.left, y), (cursor.left + wide * self.warmth, y), NET, 2, self.warmth)
        if figure:
            beside = cursor.in_style(TEXT, HUMAN)
            if wide + _WORDS + beside.measured(figure) <= cursor.width:
                beside.left, beside.y = cursor.left + wide + _WORDS, top + BASELINE * (self.size - TEXT)
                beside.text(figure)
            else:
                beside.y = label.y
                beside.text(figure)
                label.y = beside.y
        cursor.y = label.y
        if aside := said(self._aside):
            cursor.gap(3)
            cursor.aside(aside)

    def lay(self, cursor: Cursor) -> None:
        ringed, self.ringed = self.ringed, False
        super().lay(cursor)
        self.ringed = ringed
        if cursor.canvas is None:
            self.rect.width = min(round(self._reach(cursor)), self.rect.width)

    def _reach(self, cursor: Cursor) -> float:
        """Return how far to the right a pointer finds it."""
        figure, aside = said(self._figure), said(self._aside)
        beside = _WORDS + cursor.in_style(TEXT).measured(figure) if figure else 0.0
        below = cursor.in_style(SMALL).measured(aside) if aside else 0.0
        return max(self.measured(cursor) + beside, below) + _WORDS


class ToggleRow(RowWidget):
    """Switch at the right end, its label and an explanation on the left."""

    def __init__(self, label: str, value: bool, change: Callable[[bool], None], aside: str = "") -> None:
        super().__init__(NOWHERE, label)
        self.value, self._on_change, self._aside = value, change, aside

    def press(self) -> None:
        self.value = not self.value
        self._on_change(self.value)

    def advance(self) -> None:
        self.press()

    def write(self, cursor: Cursor) -> None:
        words = replace(cursor, width=cursor.width - _SWITCH[0] - 2 * STEP)
        words.colour = mix(mix(MUTE, INK, 0.6), INK, self.warmth)
        if cursor.canvas:
            top = cursor.y + LEADING * cursor.size / 2 - _SWITCH[1] / 2
            box = pygame.FRect(cursor.right - _SWITCH[0], top, *_SWITCH)
            half = box.height / 2
            cursor.canvas.pill(box, NET if self.value else FAINT)
            knob = box.right - half if self.value else box.left + half
            cursor.canvas.dot((knob, box.centery), half - 2.5, INK)
        words.text(self.label)
        if self._aside:
            words.gap(2)
            words.aside(self._aside)
        cursor.y = words.y


class SliderRow(RowWidget):
    """Slider: its label on the left or above, the figure at the right end."""

    by_arrows = True
    colour: Colour = NET

    def __init__(
        self,
        label: str,
        value: float,
        limits: tuple[float, float],
        change: Callable[[float], None],
        *,
        step: float,
        figure: Callable[[float], str],
    ) -> None:
        super().__init__(NOWHERE, label)
        self.value, self.limits, self._on_change = value, limits, change
        self._step, self._figure = step, figure
        self._track, self._line = (0.0, 1.0), pygame.FRect()

    @property
    def fraction(self) -> float:
        low, high = self.limits
        return min(max((self.value - low) / (high - low), 0.0), 1.0)

    def set(self, value: float) -> None:
        """Set the value, clipped to the limits and rounded to a step."""
        low, high = self.limits
        value = min(max(low + round((value - low) / self._step) * self._step, low), high)
        if value != self.value:
            self.value = value
            self._on_change(value)

    def shift(self, direction: int) -> bool:
        self.set(self.value + direction * self._step)
        return True

    def advance(self) -> None:
        """Move the handle one step to the right, or from the right end to the left one."""
        if self.value >= self.limits[1]:
            self.set(self.limits[0])
        else:
            self.shift(1)

    def process_event(self, event: pygame.event.Event) -> bool:
        """Take the mouse on its line: a click on its label sets nothing."""
        elsewhere = event.type == pygame.MOUSEBUTTONDOWN and not self._line.collidepoint(event.pos)
        return not elsewhere and super().process_event(event)

    def drag(self, x: float) -> None:
        (left, right), (low, high) = self._track, self.limits
        self.set(low + min(max((x - left) / (right - left), 0.0), 1.0) * (high - low))

    def write(self, cursor: Cursor) -> None:
        words = replace(cursor, colour=mix(mix(MUTE, INK, 0.6), INK, self.warmth))
        left = cursor.left
        if cursor.width - _LABELS - _FIGURES >= _TRACK and cursor.measured(self.label) <= _LABELS - STEP:
            left += _LABELS
            replace(words).text(self.label)
        else:
            words.text(self.label)
        middle, right = words.y + LEADING * cursor.size / 2, cursor.right - _FIGURES
        if canvas := cursor.canvas:
            canvas.bar((left, middle - 1, right - left, 2), self.fraction, self.colour)
            canvas.dot((left + self.fraction * (right - left), middle), 5 + self.warmth, INK)
            place = (cursor.right, words.baseline)
            canvas.text(self._figure(self.value), place, colour=self.colour, align="right", tabular=True)
        else:
            self._track, high = (left, right), LEADING * cursor.size + 2 * STEP
            self._line = pygame.FRect(left - STEP, middle - high / 2, cursor.right - left + STEP, high)
        cursor.y = words.y + LEADING * cursor.size


class ChoiceRow(RowWidget):
    """Choice of one word: the label on the left or above, the words on as many lines as they need.

    With `on_open`, words for which one line is too short are one alone, the chosen one, and then `all_word`, which
    opens a list of all, as a press of a key does.

    """

    _labels = _LABELS

    def __init__(
        self,
        label: str,
        options: Sequence[str],
        index: int,
        change: Callable[[int], None],
        size: float = TEXT,
        *,
        on_open: OnPress | None = None,
        all_word: str = "",
    ) -> None:
        super().__init__(NOWHERE, label)
        self.options, self.index, self._on_change, self._size = options, index, change, size
        self._on_open, self._all_word = on_open, all_word
        self._places: dict[int, pygame.FRect] = {}

    def measured(self, cursor: Cursor) -> float:
        """Return the width that its words need side by side with others; the label has no column of its own then."""
        self._labels, words = 0.0, cursor.in_style(self._size)
        wide = self._width(words, self.options)
        if self._on_open and wide > _SHARE * cursor.width:
            wide = self._width(words, (self.options[self.index], self._all_word))
        return words.measured(self.label) + _WORDS * bool(self.label) + wide + 1

    @staticmethod
    def _width(words: Cursor, options: Sequence[str]) -> float:
        return sum(map(words.measured, options)) + _WORDS * (len(options) - 1)

    def choose(self, index: int) -> None:
        """Choose an option by its number."""
        index = min(max(index, 0), len(self.options) - 1)
        if index != self.index:
            self.index = index
            self._on_change(index)

    def press(self) -> Transition | None:
        mouse = self.ui_manager.get_mouse_position()
        under = next((number for number, place in self._places.items() if place.collidepoint(mouse)), None)
        if self._on_open and (self.ringed or under == _ALL):
            return self._on_open()
        if self.ringed:
            if not self.by_arrows:
                self.advance()
        elif under is not None:
            self.choose(under)
        return None

    def advance(self) -> None:
        self.choose((self.index + 1) % len(self.options))

    def shift(self, direction: int) -> bool:
        before = self.index
        self.choose(self.index + direction)
        return self.index != before

    def write(self, cursor: Cursor) -> None:
        words = cursor.in_style(self._size, mix(mix(MUTE, INK, 0.6), INK, self.warmth))
        options = dict(enumerate(self.options))
        left, wide = cursor.left, self._width(words, self.options)
        if self.label:
            beside = cursor.left + max(self._labels, words.measured(self.label) + _WORDS)
            if beside + wide <= cursor.right or self._on_open:
                left = beside
                replace(words).text(self.label)
            else:
                words.text(self.label)
        if self._on_open and left + wide > cursor.right:
            options = {self.index: self.options[self.index], _ALL: self._all_word}
        x, places = left, {}
        for number, option in options.items():
            width = words.measured(option)
            if x > left and x + width > cursor.right:
                x, words.y = left, words.y + LEADING * self._size + STEP
            if canvas := cursor.canvas:
                colour = INK if number == self.index else MUTE
                canvas.text(option, (x, words.baseline), size=self._size, colour=colour)
                if number == self.index:
                    y = words.baseline + 0.5 * self._size
                    canvas.line((x, y), (x + width, y), NET, 2)
            places[number] = pygame.FRect(x - _WORDS / 2, words.y - 4, width + _WORDS, LEADING * self._size + 8)
            x += width + _WORDS
        if cursor.canvas is None:
            self._places = places
            ends = max(place.right for place in places.values()) - _WORDS / 2
            self.reach = 0.0 if self.label and self._labels else ends - cursor.left
        cursor.y = words.y + LEADING * self._size
