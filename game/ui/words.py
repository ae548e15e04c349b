"""Row of words with a line under the chosen one; words that do not fit go on further pages."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import accumulate, pairwise
from typing import Final

from game.drawing import typeface
from game.drawing.canvas import Canvas
from game.drawing.tokens import INK, MUTE, NET, Colour

GAP: Final = 24  # points between two words
_ARROW: Final = 24  # points for an arrow on either side


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

    def paint(
        self,
        canvas: Canvas,
        baseline: float,
        chosen: int,
        *,
        ink: Colour = INK,
        line: Colour = NET,
        drop: float = 8.0,
        thickness: float = 2.0,
    ) -> None:
        """Draw the page of the chosen word; the line under it is `drop` points below the baseline."""
        page, size = self._page(chosen), self._size
        if page.start:
            canvas.text("‹", (self.lefts[page.start] - 16, baseline), size=size, colour=INK)
        if page.stop < len(self.words):
            canvas.text("›", (self.right, baseline), size=size, colour=INK, align="right")
        for number in page:
            left, colour = self.lefts[number], ink if number == chosen else MUTE
            box = canvas.text(self.words[number], (left, baseline), size=size, colour=colour)
            if number == chosen:
                canvas.line((left, baseline + drop), (left + box.width, baseline + drop), line, thickness)


def row_width(words: Sequence[str], size: float, gap: float = GAP) -> int:
    """Return the width that a row of words takes on one page, in whole points."""
    return math.ceil(sum(typeface.width(word, size, "regular") + gap for word in words) - gap)


def _pages(widths: Sequence[float], room: float, gap: float) -> list[range]:
    """Return the numbers of the words on each page; a page has at least one word."""
    starts, x = [0], 0.0
    for number, width in enumerate(widths):
        if x and x + width > room:
            starts.append(number)
            x = 0.0
        x += width + gap
    return [range(start, stop) for start, stop in pairwise([*starts, len(widths)])]
