"""Words around the drawing pad and its answer: buttons in a row, above, below and beside."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from game.drawing import typeface
from game.drawing.canvas import Canvas
from game.drawing.tokens import SMALL, TEXT
from game.ui.form import Form
from game.ui.widget import OnPress
from game.ui.widgets import TextButton

_GAP: Final = 26.0
_PITCH: Final = 80  # from one word below the pad to the next
_SIZE: Final = SMALL + 1

Words = Sequence[tuple[str, OnPress]]


def add_row(form: Form, words: Words, right: float, top: float) -> None:
    """Add words that lead to other screens, in a row that ends at `right`."""
    widths = [typeface.width(word, TEXT, "medium") for word, _ in words]
    left = right - sum(widths) - _GAP * (len(widths) - 1)
    for (word, press), width in zip(words, widths, strict=True):
        form.add(TextButton(form.manager, (left, top, width, 28), word, press, size=TEXT, weight="medium"))
        left += width + _GAP


def add_below(form: Form, words: Words, left: float, top: float) -> list[TextButton]:
    """Add short words at equal distances, with room for the name of a key after each."""
    return [
        form.add(TextButton(form.manager, (left + _PITCH * number, top, 56, 24), word, press, size=_SIZE))
        for number, (word, press) in enumerate(words)
    ]


def draw_keys(canvas: Canvas, words: Sequence[TextButton], keys: Sequence[str]) -> None:
    """Write the names of keys after the words of `add_below`."""
    for widget, key in zip(words, keys, strict=True):
        left = widget.box.left + canvas.text_width(widget.label, size=_SIZE) + 8
        canvas.text(key, (left, widget.baseline), size=SMALL, weight="medium")
