"""Word wrap: sentences on as many lines as they need, or as there is room for."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from game.drawing import typeface
from game.drawing.canvas import Canvas, Point
from game.drawing.tokens import INK, SMALL, Colour

_LONGEST: Final = 4000  # characters: more than fit on a screen


def wrapped(canvas: Canvas, text: str, size: float, width: float) -> list[str]:
    """Break a text between words into lines no wider than `width` points; a longer word has a line of its own."""
    return _broken(text, width, lambda line: canvas.text_width(line, size=size))


def line_count(text: str, size: float, width: float) -> int:
    """Return the number of lines of a wrapped text, for layout before there is a canvas."""
    return len(_broken(text, width, lambda line: typeface.width(line, size, "regular")))


def _broken(text: str, width: float, measure: Callable[[str], float]) -> list[str]:
    lines = [""]
    for word in text[:_LONGEST].split():
        longer = f"{lines[-1]} {word}".strip()
        if lines[-1] and measure(longer) > width:
            lines.append(word)
        else:
            lines[-1] = longer
    return lines


def draw_wrapped(
    canvas: Canvas,
    text: str,
    start: Point,
    width: float,
    *,
    size: float = SMALL,
    colour: Colour = INK,
    leading: float = 16.0,
    most: int | None = None,
) -> float:
    """Draw a text from its first baseline on, `leading` points from each line to the next, `most` lines at most.

    Return the y of the baseline after the last line, in points.
    """
    x, y = start
    for line in wrapped(canvas, text, size, width)[:most]:
        canvas.text(line, (x, y), size=size, colour=colour)
        y += leading
    return y
