"""Word wrap: sentences on as many lines as they need."""

from __future__ import annotations

from typing import Final

from game.drawing.canvas import Canvas

_LONGEST: Final = 4000  # characters: more than fit on a screen


def wrapped(canvas: Canvas, text: str, size: float, width: float) -> list[str]:
    """Break a text between words into lines no wider than `width` points; a longer word has a line of its own."""
    lines = [""]
    for word in text[:_LONGEST].split():
        longer = f"{lines[-1]} {word}".strip()
        if lines[-1] and canvas.text_width(longer, size=size) > width:
            lines.append(word)
        else:
            lines[-1] = longer
    return lines
