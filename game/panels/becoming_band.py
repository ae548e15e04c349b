"""The band in which it probably lies how often the player would land alone."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Final

from ai.copilot.alone import Estimate
from game.drawing.canvas import Canvas, Point
from game.drawing.tokens import HUMAN

_BAND: Final = 0.16


def draw_band(canvas: Canvas, curve: Sequence[Estimate], place: Callable[[float, float], Point]) -> None:
    """Fill the band of estimates; `place` gives the point for a flight's number, from 1, and a share."""
    for number, estimate in enumerate(curve, 1):
        left, top = place(number - 0.5, estimate.high)
        right, bottom = place(number + 0.5, estimate.low)
        box = canvas.rect(left, top, right - left, bottom - top)
        if box.width > 0:
            canvas.fill(box, HUMAN, _BAND)
