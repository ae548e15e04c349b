"""The curve of how often the player would land alone, with the band in which the truth probably lies."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import Final

from ai.copilot.alone import Estimate
from game.drawing.canvas import Canvas, Point
from game.drawing.tokens import HUMAN

_BAND: Final = 0.16


def draw_band(
    canvas: Canvas, curve: Sequence[Estimate], place: Callable[[float, float], Point], first: float = 1.0
) -> None:
    """Fill the band of estimates; `place` gives the point for a flight's number, from `first` on, and a share."""
    for number, estimate in enumerate(curve):
        left, top = place(first + number - 0.5, estimate.high)
        right, bottom = place(first + number + 0.5, estimate.low)
        box = canvas.rect(left, top, right - left, bottom - top)
        if box.width > 0:
            canvas.fill(box, HUMAN, _BAND)


def draw_curve(canvas: Canvas, curve: Sequence[Estimate], place: Callable[[float, float], Point]) -> None:
    """Draw the band, and the expected share after each flight as a line that ends in a dot."""
    draw_band(canvas, curve, place)
    points = [place(number, estimate.mean) for number, estimate in enumerate(curve, 1)]
    for start, end in pairwise(points):
        canvas.line(start, end, HUMAN, 1.5)
    if points:
        canvas.dot(points[-1], 4, HUMAN)
