"""Sentences with changing figures: digits have a fixed width, so that the rest does not move."""

from __future__ import annotations

import math
import re
from typing import Final

from game.drawing import typeface
from game.drawing.canvas import Canvas, Point
from game.drawing.tokens import MUTE, Colour

_FIGURES: Final = re.compile(r"([0-9][0-9.]*)")


def write_figures(
    canvas: Canvas,
    text: str,
    position: Point,
    *,
    size: float,
    colour: Colour = MUTE,
    centred: bool = False,
    room: float = math.inf,
) -> tuple[float, float]:
    """Write a sentence on one baseline; return its left and right end, in points.

    One that is wider than `room` is written smaller, as `Canvas.text` does it.
    """
    runs = [(run, bool(_FIGURES.fullmatch(run))) for run in _FIGURES.split(text) if run]
    widths = [canvas.text_width(run, size=size, tabular=tabular) for run, tabular in runs]
    if sum(widths) > room:
        size *= max(room / sum(widths), canvas.least(size) / typeface.grown(size))
        widths = [canvas.text_width(run, size=size, tabular=tabular) for run, tabular in runs]
    start = x = position[0] - (sum(widths) / 2 if centred else 0.0)
    for (run, tabular), width in zip(runs, widths, strict=True):
        canvas.text(run, (x, position[1]), size=size, colour=colour, tabular=tabular)
        x += width
    return start, x
