"""Mark of the place on the ladder of starts: a row of rungs, those reached lit."""

from __future__ import annotations

from typing import Final

from ai.lander.spawns import RUNGS
from game.drawing.canvas import Canvas
from game.drawing.tokens import FAINT, HUMAN

_PITCH: Final = 7.0  # points from rung to rung
_HIGH: Final = (5.0, 0.7)  # points, of the lowest, and more for each above it
WIDTH: Final = _PITCH * len(RUNGS)


def draw_ladder(canvas: Canvas, left: float, baseline: float, rung: int) -> None:
    """Draw the ladder from `left`; of a player at its top, all rungs are lit."""
    low, more = _HIGH
    for number in range(len(RUNGS)):
        x = left + number * _PITCH
        lit = number <= rung
        canvas.line((x, baseline), (x, baseline - low - more * number), HUMAN if lit else FAINT, 2.0)
