"""Words and choices with a place of their own, for screens over a world; the rows of panels are in `game.ui.rows`."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import accumulate, pairwise
from typing import Final

import pygame

from game.core.scene import Transition
from game.drawing import typeface
from game.drawing.canvas import Canvas
from game.drawing.tokens import FAINT, INK, MUTE, NET, SMALL, TEXT, Colour
from game.drawing.typeface import Weight
from game.ui.widget import OnPress, PointsManager, Widget, mix

GAP: Final = 24  # points between two words
_ARROW: Final = 24  # points for an arrow on either side
_BESIDE: Final = 20.0  # points between a row and the word that opens a list


class TextButton(Widget):
    """Text button; a short line under the word shows the focus."""

    def __init__(
        self,
        manager: PointsManager,
        box: pygame.typing.RectLike,
        label: str,
        on_press: OnPress,
        *,
        size: float = TEXT,
        weight: Weight = "regular",
        colour: Colour = MUTE,
    ) -> None:
        super().__init__(manager, box, label)
        self._on_press, self._size, self._weight, self._colour = on_press, size, weight, colour

    @property
    def baseline(self) -> float:
        """The y of the word's baseline, in points."""
        return self.box.centery + 0.36 * self._size

    def press(self) -> Transition | None:
        return self._on_press()

    def tint(self) -> Colour:
        return mix(self._colour, INK, self.warmth)

    def paint(self, canvas: Canvas) -> None:
        left, baseline = self.box.left, self.baseline
        box = canvas.text(
            self.label, (left, baseline), size=self._size, weight=self._weight, colour=self.tint(), room=self.box.width
        )
        length = box.width * self.warmth
        if length > 1:
            y = baseline + 0.42 * self._size
            canvas.line((left, y), (left + length, y), NET, 2, self.warmth)


class Choice(Widget):
    """Choice of one word in a row, with a line under the chosen one.

    Words that do not fit into the box go on further pages, one of which is shown at a time, between arrows.
    """

    def __init__(
        self,
        manager: PointsManager,
        box: pygame.typing.RectLike,
        label: str,
        options: Sequence[str],
        index: int,
        on_change: Callable[[int], None],
        *,
        label_width: float = 0,
        size: float = TEXT,
        gap: float = GAP,
    ) -> None:
        super().__init__(manager, box, label)
        self.options, self.index, self._on_change, self._size = options, index, on_change, size
        self._label_room = max(label_width - 10, 0)
        self.row = TextButtonRow(options, self.box.left + label_width, self.box.right, size, gap)

    def choose(self, index: int) -> None:
        """Choose an option by its number."""
        index = min(max(index, 0), len(self.options) - 1)
        if index != self.index:
            self.index = index
            self._on_change(index)

    def press(self) -> Transition | None:
        self.choose(self.row.pressed(self.mouse_x, self.index))
        return None

    def shift(self, direction: int) -> bool:
        before = self.index
        self.choose(self.index + direction)
        return self.index != before

    def paint(self, canvas: Canvas) -> None:
        super().paint(canvas)
        baseline = self.box.centery + 0.36 * self._size
        canvas.text(self.label, (self.box.left, baseline), size=self._size, colour=self.tint(), room=self._label_room)
        self.row.paint(canvas, baseline, self.index)


class ChoiceOrList(Choice):
    """Choice that can also be made from a list: Enter, a gamepad's A or a click on `all_word` calls `on_open`.

    The word is shown at the right end if not all options fit into the row.
    """

    def __init__(
        self,
        manager: PointsManager,
        box: pygame.typing.RectLike,
        label: str,
        options: Sequence[str],
        index: int,
        on_change: Callable[[int], None],
        on_open: OnPress,
        all_word: str,
        *,
        label_width: float = 0,
        size: float = SMALL,
    ) -> None:
        super().__init__(manager, box, label, options, index, on_change, label_width=label_width, size=size)
        self._on_open, self._all_word = on_open, all_word
        self._open_left = float(self.box.right)
        if len(self.row.pages) > 1:
            self._open_left -= typeface.width(all_word, size, "regular")
            self.row = TextButtonRow(options, self.box.left + label_width, self._open_left - _BESIDE, size)

    def press(self) -> Transition | None:
        x = self.mouse_x
        return self._on_open() if x is None or x >= self._open_left - 4 else super().press()

    def paint(self, canvas: Canvas) -> None:
        super().paint(canvas)
        if len(self.row.pages) > 1:
            baseline = self.box.centery + 0.36 * self._size
            canvas.text(self._all_word, (self._open_left, baseline), size=self._size, colour=self.tint())


class TextButtonRow:
    """Row of words from `left` to `right`, in points. One page is shown at a time, between arrows.

    Attributes:
        pages: the numbers of the words on each page.
        lefts: the left end of each word, in points.
        right: the right end of the row, in points.

    """

    def __init__(self, words: Sequence[str], left: float, right: float, size: float, gap: float = GAP) -> None:
        self.words, self._size, self._gap, self._left, self.right = words, size, gap, left, right
        self._growth = 0.0
        self._lay_out()

    def _lay_out(self) -> None:
        """Lay out the words again if the size of text has changed."""
        if self._growth == typeface.growth():
            return
        self._growth = typeface.growth()
        left, gap = self._left, self._gap
        widths = [typeface.width(word, self._size, "regular") for word in self.words]
        room = self.right - left
        if sum(widths) + gap * (len(widths) - 1) > room + 1:
            room -= 2 * _ARROW
        self.pages = _pages(widths, room, gap)
        self.lefts = [
            left + (_ARROW if page.start else 0) + place
            for page in self.pages
            for place in accumulate((widths[number] + gap for number in page[:-1]), initial=0.0)
        ]

    def _page(self, chosen: int) -> range:
        self._lay_out()
        return next(page for page in self.pages if chosen in page)

    def at(self, x: float, chosen: int) -> int:
        """Return the number of the word at x on the chosen word's page, or of the word that an arrow there leads to."""
        page = self._page(chosen)
        if page.stop < len(self.words) and x > self.right - _ARROW:
            return page.stop
        if page.start and self.lefts[page.start] - _ARROW <= x < self.lefts[page.start] - 4:
            return page.start - 1
        return max((number for number in page if self.lefts[number] - self._gap / 2 <= x), default=chosen)

    def pressed(self, x: float | None, chosen: int) -> int:
        """Return the number that a press chooses: that of the word at x, or without a mouse that of the next word."""
        return (chosen + 1) % len(self.words) if x is None else self.at(x, chosen)

    def paint(self, canvas: Canvas, baseline: float, chosen: int) -> None:
        """Draw the page of the chosen word, with a line under it."""
        page, size = self._page(chosen), self._size
        if page.start:
            canvas.text("‹", (self.lefts[page.start] - 16, baseline), size=size, colour=INK)
        if page.stop < len(self.words):
            canvas.text("›", (self.right, baseline), size=size, colour=INK, align="right")
        for number in page:
            left, colour = self.lefts[number], INK if number == chosen else MUTE
            box = canvas.text(self.words[number], (left, baseline), size=size, colour=colour)
            if number == chosen:
                canvas.line((left, baseline + 8), (left + box.width, baseline + 8), NET, 2)


def _pages(widths: Sequence[float], room: float, gap: float) -> list[range]:
    """Return the numbers of the words on each page; a page has at least one word."""
    starts, x = [0], 0.0
    for number, width in enumerate(widths):
        if x and x + width > room:
            starts.append(number)
            x = 0.0
        x += width + gap
    return [range(start, stop) for start, stop in pairwise([*starts, len(widths)])]


def draw_switch(canvas: Canvas, rect: tuple[float, float, float, float], slid: float, colour: Colour = NET) -> None:
    """Draw a switch; `slid` is the position of its knob, from 0, off, to 1, on."""
    left, top, width, height = rect
    canvas.pill(rect, mix(FAINT, colour, slid))
    half = height / 2
    canvas.dot((left + half + (width - height) * slid, top + half), half - 2.5, INK)
