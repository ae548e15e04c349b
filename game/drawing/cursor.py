"""Cursor: writes and draws downwards in a column, line after line, and knows where it stands.

What places words says what stands below what, and not where. A cursor without a canvas writes nothing and only moves
on, so the same lines of code measure a panel, lay it out and draw it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Final

import pygame

from game.drawing import typeface
from game.drawing.canvas import SHIFT, Align, Canvas
from game.drawing.prose import lines
from game.drawing.tokens import FAINT, INK, LABEL, LINE, MUTE, NET, PALETTE, SMALL, STEP, TEXT, Colour, Palette
from game.drawing.typeface import Weight

# Height of a line, and of its baseline below its top, in sizes of the type.
LEADING: Final = 1.4
BASELINE: Final = 1.02
_APART: Final = 32.0  # points between two columns
_STACKED: Final = 12.0  # and between two that stand one below the other
_BAR: Final = 3.0


@dataclass
class Cursor:
    """A column from `left` on, `width` wide; the next thing stands at `y`. All in points.

    Attributes:
        scale: pixels per point, by which words are measured.
        canvas: what is drawn on; None to measure alone.
        seen: the part of the page that is not scrolled away; None if all is seen.
        size, colour, weight: of text for which nothing else is said.

    """

    left: float
    y: float
    width: float
    scale: float = 1.0
    canvas: Canvas | None = None
    seen: pygame.FRect | None = None
    size: float = TEXT
    colour: Colour = INK
    weight: Weight = "regular"

    @property
    def right(self) -> float:
        """Right end of the column."""
        return self.left + self.width

    @property
    def palette(self) -> Palette:
        """The player's colours for within and beyond limits."""
        return self.canvas.palette if self.canvas else PALETTE

    @property
    def style(self) -> dict[str, Any]:
        """Its style, as `Canvas.text` takes it."""
        return {"size": self.size, "colour": self.colour, "weight": self.weight}

    def in_style(self, size: float | None = None, colour: Colour | None = None, weight: Weight | None = None) -> Cursor:
        """Return a cursor at the same place that writes in another style."""
        styled = self.column(self.left, self.width)
        styled.size, styled.colour, styled.weight = size or self.size, colour or self.colour, weight or self.weight
        return styled

    def column(self, left: float, width: float) -> Cursor:
        """Return a cursor at the same height in another column."""
        return Cursor(left, self.y, width, self.scale, self.canvas, self.seen, self.size, self.colour, self.weight)

    def measured(self, words: str, size: float | None = None, *, tabular: bool = False) -> float:
        """Return the width of words on one line."""
        pixels = round((size or self.size) * self.scale, 2)
        return typeface.span(words, pixels, self.weight, tabular) / self.scale

    def text(self, words: str, align: Align = "left", alpha: float = 1.0, *, tabular: bool = False) -> pygame.FRect:
        """Write words on as many lines as they need, and go on below; return the box of all of them.

        `tabular` is for words with figures that change: see `Canvas.text`.
        """
        top = self.y
        for line in lines(words, self.size, self.weight, self.width, self.scale):
            if self.canvas:
                place = (self.left + SHIFT[align] * self.width, self.baseline)
                self.canvas.text(line, place, align=align, alpha=alpha, tabular=tabular, **self.style)
            self.y += LEADING * self.size
        return pygame.FRect(self.left, top, self.width, self.y - top)

    @property
    def baseline(self) -> float:
        """The y of the baseline of a line that begins here."""
        return self.y + BASELINE * self.size

    def styled(
        self,
        words: str,
        size: float | None = None,
        colour: Colour | None = None,
        weight: Weight | None = None,
        *,
        align: Align = "left",
        tabular: bool = False,
        indent: float = 0.0,
    ) -> pygame.FRect:
        """Write words in another style, as `text` does, in the column from `indent` on."""
        other = self.in_style(size, colour, weight)
        other.left, other.width = self.left + indent, self.width - indent
        box = other.text(words, align, tabular=tabular)
        self.y = other.y
        return box

    def caption(self, words: str) -> None:
        """Write the words that stand over a group of rows."""
        self.styled(words, LABEL, MUTE, "medium")
        self.gap(STEP / 2)

    def aside(self, words: str) -> None:
        """Write small muted words that explain what stands above."""
        self.styled(words, SMALL, MUTE)

    def pair(self, words: str, figure: str, colour: Colour | None = None) -> None:
        """Write words on the left, and a figure at the right end; below them, if there is no room beside them."""
        label = self.column(self.left, self.width - self.measured(figure, tabular=True) - _APART)
        if label.width < self.width / 3:
            label = self
        label.text(words)
        if self.canvas:
            style = self.in_style(colour=colour).style
            self.canvas.text(figure, (self.right, self.baseline), align="right", tabular=True, **style)
        self.y = max(label.y, self.y + LEADING * self.size)

    def bar(self, share: float, colour: Colour = NET, track: Colour = FAINT) -> None:
        """Draw a thin bar over the whole column, filled to a share from 0 to 1."""
        if self.canvas:
            self.canvas.bar((self.left, self.y, self.width, _BAR), share, colour, track)
        self.y += _BAR + STEP / 2

    def line(self) -> None:
        """Draw a hairline."""
        if self.canvas:
            self.canvas.line((self.left, self.y), (self.right, self.y), LINE)
        self.y += 1

    def gap(self, points: float = STEP) -> None:
        """Leave some room."""
        self.y += points

    def take(self, height: float) -> pygame.FRect:
        """Return a box of that height over the whole column, for a drawing of its own, and go on below."""
        self.y += height
        return pygame.FRect(self.left, self.y - height, self.width, height)

    def beside(
        self, parts: Sequence[Callable[[Cursor], None]], shares: Sequence[float], least: float, apart: float = _APART
    ) -> None:
        """Run each part in a column of its own, as wide as its share, and go on below the longest.

        Where a column would be narrower than `least`, they stand one below the other.
        """
        room = self.width - apart * (len(parts) - 1)
        widths = [room * share / sum(shares) for share in shares]
        if min(widths) < least:
            for number, part in enumerate(parts):
                self.gap(_STACKED if number else 0.0)
                part(self)
            return
        left, below = self.left, self.y
        for part, width in zip(parts, widths, strict=True):
            column = self.column(left, width)
            part(column)
            left, below = left + width + apart, max(below, column.y)
        self.y = below
