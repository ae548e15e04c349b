"""Words and choices with a place of their own, for screens over a world; the rows of panels are in `game.ui.rows`."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import accumulate, pairwise
from typing import Final

import pygame

from game.core.scene import Transition
from game.drawing import typeface
from game.drawing.canvas import Canvas
from game.drawing.tokens import FAINT, INK, MUTE, NET, TEXT, Colour
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

    Words that do not fit into the box go on further pages, one of which is shown at a time, between arrows. `on_open`
    opens a list of all: with Enter, a gamepad's A, or a click on `all_word`, which stands behind such pages.
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
        on_open: OnPress | None = None,
        all_word: str = "",
    ) -> None:
        super().__init__(manager, box, label)
        self.options, self.index, self._on_change, self._size = options, index, on_change, size
        self._label_width, self._on_open, self._all_word = label_width, on_open, all_word

    def choose(self, index: int) -> None:
        """Choose an option by its number."""
        index = min(max(index, 0), len(self.options) - 1)
        if index != self.index:
            self.index = index
            self._on_change(index)

    def press(self) -> Transition | None:
        x = self.mouse_x
        pages, _, right = self.laid()
        if self._on_open and (x is None or (len(pages) > 1 and x >= right + _BESIDE - 4)):
            return self._on_open()
        self.choose((self.index + 1) % len(self.options) if x is None else self._at(x))
        return None

    def shift(self, direction: int) -> bool:
        before = self.index
        self.choose(self.index + direction)
        return self.index != before

    def laid(self) -> tuple[list[range], list[float], float]:
        """Return the numbers of the words on each page, the left end of each word, and the right end of the row."""
        left, right = self.box.left + self._label_width, float(self.box.right)
        widths = [typeface.width(word, self._size, "regular") for word in self.options]
        if sum(widths) + GAP * (len(widths) - 1) <= right - left + 1:
            pages = [range(len(widths))]
        else:
            right -= typeface.width(self._all_word, self._size, "regular") + _BESIDE if self._all_word else 0.0
            pages = _pages(widths, right - left - 2 * _ARROW)
        lefts = [
            left + (_ARROW if page.start else 0) + place
            for page in pages
            for place in accumulate((widths[number] + GAP for number in page[:-1]), initial=0.0)
        ]
        return pages, lefts, right

    def _at(self, x: float) -> int:
        """Return the number of the word at x on the chosen word's page, or of the word that an arrow there leads to."""
        pages, lefts, right = self.laid()
        page = next(page for page in pages if self.index in page)
        if page.stop < len(self.options) and x > right - _ARROW:
            return page.stop
        if page.start and lefts[page.start] - _ARROW <= x < lefts[page.start] - 4:
            return page.start - 1
        return max((number for number in page if lefts[number] - GAP / 2 <= x), default=self.index)

    def paint(self, canvas: Canvas) -> None:
        super().paint(canvas)
        baseline, size = self.box.centery + 0.36 * self._size, self._size
        room = max(self._label_width - 10, 0)
        canvas.text(self.label, (self.box.left, baseline), size=size, colour=self.tint(), room=room)
        pages, lefts, right = self.laid()
        page = next(page for page in pages if self.index in page)
        if page.start:
            canvas.text("‹", (lefts[page.start] - 16, baseline), size=size)
        if page.stop < len(self.options):
            canvas.text("›", (right, baseline), size=size, align="right")
        if len(pages) > 1:
            canvas.text(self._all_word, (right + _BESIDE, baseline), size=size, colour=self.tint())
        for number in page:
            left, colour = lefts[number], INK if number == self.index else MUTE
            box = canvas.text(self.options[number], (left, baseline), size=size, colour=colour)
            if number == self.index:
                canvas.line((left, baseline + 8), (left + box.width, baseline + 8), NET, 2)


def _pages(widths: Sequence[float], room: float) -> list[range]:
    """Return the numbers of the words on each page; a page has at least one word."""
    starts, x = [0], 0.0
    for number, width in enumerate(widths):
        if x and x + width > room:
            starts.append(number)
            x = 0.0
        x += width + GAP
    return [range(start, stop) for start, stop in pairwise([*starts, len(widths)])]


def draw_switch(canvas: Canvas, rect: tuple[float, float, float, float], slid: float) -> None:
    """Draw a switch; `slid` is the position of its knob, from 0, off, to 1, on."""
    left, top, width, height = rect
    canvas.pill(rect, mix(FAINT, NET, slid))
    half = height / 2
    canvas.dot((left + half + (width - height) * slid, top + half), half - 2.5, INK)
