"""Words to press in the panel of knobs: the chosen preset, and rows of buttons."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import pygame

from game.core import texts
from game.drawing import typeface
from game.drawing.canvas import Canvas
from game.drawing.tokens import HUMAN, INK, LABEL, MUTE, NET, TITLE, Colour
from game.ui.widget import OnPress, PointsManager, Widget
from game.ui.widgets import TextButton

BASELINE: Final = 21.5  # of the presets, from the top of the panel
Word = tuple[str, OnPress]


class Title(TextButton):
    """Name of the chosen preset: large, with a line under it."""

    def paint(self, canvas: Canvas) -> None:
        """Draw the word and its line."""
        Widget.paint(self, canvas)
        box = self.box
        canvas.text(self.label, (box.left, box.top - 4 + BASELINE), size=TITLE, colour=INK)
        canvas.line((box.left, box.top + 30), (box.left + box.width, box.top + 30), NET, 2)


def make_words(
    manager: PointsManager, words: Sequence[Word], right: float, row: pygame.Rect, size: float, colour: Colour = MUTE
) -> list[Widget]:
    """Make buttons in a row that ends at `right`; the row's width is the gap between them, in points."""
    made: list[Widget] = []
    for name, press in reversed(words):
        width = word_width(name, size)
        made.insert(0, TextButton(manager, (right - width, row.top, width, row.height), name, press,
                                  size=size, colour=colour))  # fmt: skip
        right -= width + row.width
    return made


def draw_changed(canvas: Canvas, box: pygame.Rect, name: str, right: float) -> None:
    """Mark beside the preset's name that knobs were changed: by a word, or by a dot where there is no room for it."""
    left, baseline = box.left + canvas.text_width(name, size=TITLE) + 9, box.top + BASELINE
    if canvas.text_width(texts.KNOBS_CHANGED, size=LABEL) <= right - left - 9:
        canvas.text(texts.KNOBS_CHANGED, (left, baseline), size=LABEL, colour=HUMAN)
    else:
        canvas.dot((left, baseline - 5), 2.5, HUMAN)


def word_width(text: str, size: float) -> float:
    """Return the width of a word, in points."""
    return typeface.width(text, size, "regular")
