"""The wind of a flight, drawn beside the craft."""

from __future__ import annotations

from typing import Final

from ai.environment import Doubles
from ai.lander.environment import LanderEnv
from game.core import texts
from game.drawing.canvas import Canvas
from game.drawing.tokens import INK, SMALL
from game.explain.readouts import draw_arrow
from game.world.camera import ClearArea, View

_CALM: Final = 0.05  # m/s², below which there is no wind
_STRONGEST: Final = 0.6  # m/s², of the longest arrow
_ARROW: Final = (14.0, 40.0)  # points of the shortest and more for the longest
_BESIDE: Final = 1.9  # metres from the middle of a craft to the wind beside it
_LOW: Final = 110.0  # points from the lower edge


def wind(env: LanderEnv) -> float:
    """Return how the wind accelerates the craft to the right, in m/s²."""
    return float(env.conditions.push(env.time)[0]) / env.params.mass if env.conditions.pushes else 0.0


def draw_wind(canvas: Canvas, view: View, pose: Doubles, env: LanderEnv, clear: ClearArea) -> None:
    """Draw the wind as an arrow that blows at the craft, with its strength over it."""
    push = wind(env)
    if abs(push) < _CALM:
        return
    side = -1.0 if push > 0 else 1.0  # from where it comes
    reach = _ARROW[0] + _ARROW[1] * min(1.0, abs(push) / _STRONGEST)
    size, words = max(SMALL, 12.0 / canvas.scale), texts.WIND_FIGURE.format(push=abs(push))
    wide = max(reach, canvas.text_width(words, size=size, tabular=True))
    x, y = view.points((pose[0] + side * _BESIDE, pose[1])).tolist()
    middle, seen = x + side * wide / 2, canvas.view
    if not seen.left + reach < middle < min(clear.right, seen.right) - reach:  # beyond an edge: on the other side
        middle = view.points((pose[0] - side * _BESIDE, pose[1])).tolist()[0] - side * wide / 2
    y = min(max(y, seen.top + clear.head), seen.bottom - _LOW)
    draw_arrow(canvas, (middle, y), -side * reach, INK)
    canvas.text(words, (middle, y - 8), size=size, colour=INK, align="centre", tabular=True)
