"""Invisible conditions of a flight: wind, gravity, a moving pad, an engine failure."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Final

from ai.lander.environment import PARAMS, LanderEnv
from ai.lander.sensing import near_edges
from game.core import texts
from game.drawing.canvas import Canvas
from game.drawing.tokens import INK, MARGIN, MUTE, SMALL

_FIRST: Final = 98.0  # the first row, below the flight's goal
_ROW: Final = 20.0
_SOON: Final = 3.0  # seconds ahead that a failure is announced
_ARROW: Final = 52.0  # length of the strongest wind's arrow, in points
_STRONGEST, _CALM = 0.6, 0.05  # m/s²


def draw_surroundings(canvas: Canvas, env: LanderEnv) -> None:
    """Draw a row for each condition in which this flight differs from one on the moon."""
    canvas = canvas.at(-1, -1)
    for number, (text, wind, warns) in enumerate(surroundings(env)):
        y = _FIRST + number * _ROW
        x = float(MARGIN)
        if warns:
            canvas.marker("triangle", (x + 5, y - 4), 9, canvas.palette.warn)
            x += 18
        end = canvas.text(text, (x, y), size=SMALL, colour=canvas.palette.warn if warns else MUTE, tabular=True).right
        if abs(wind) >= _CALM:
            _draw_arrow(canvas, (end + 12, y - 4), wind)


def surroundings(env: LanderEnv) -> Iterator[tuple[str, float, bool]]:
    """Yield the rows: text, wind in m/s² to the right (0 on other rows), and whether the row is a warning."""
    conditions, params, time = env.conditions, env.params, float(env.time[0])
    yield from _edges(env)  # first: lower down, the glow above the craft would cross it
    if params.gravity != PARAMS.gravity:
        yield texts.GRAVITY.format(gravity=params.gravity, times=params.gravity / PARAMS.gravity), 0.0, False
    if conditions.pushes:
        push = float(conditions.push(env.time)[0]) / params.mass
        yield texts.WIND.format(push=abs(push)), push, False
    if conditions.moves:
        speed = float(env.pad_velocity[0])
        yield (texts.PAD_RIGHT if speed > 0 else texts.PAD_LEFT).format(speed=abs(speed)), 0.0, False
    start, end = conditions.outage
    if start <= time < end:
        yield texts.ENGINE_DEAD.format(seconds=end - time), 0.0, True
    elif time < start < math.inf:
        yield texts.ENGINE_FAILS.format(seconds=start - time), 0.0, start - time < _SOON
    if float(env.fuel[0]) >= conditions.tank:
        yield texts.TANK_EMPTY, 0.0, True


def _edges(env: LanderEnv) -> Iterator[tuple[str, float, bool]]:
    """Yield one row with the distances to the edges of the area that the flight comes near and heads for, if any."""
    words = {"above": texts.EDGE_ABOVE, "left": texts.EDGE_LEFT, "right": texts.EDGE_RIGHT}
    ahead = [words[edge.side].format(metres=math.ceil(edge.away)) for edge in near_edges(env) if edge.ahead]
    if ahead:
        yield texts.EDGE_ENDS.format(where=texts.AND.join(ahead)), 0.0, True


def _draw_arrow(canvas: Canvas, start: tuple[float, float], push: float) -> None:
    """Draw an arrow in the wind's direction; its length shows the strength."""
    left, y = start
    right = left + 6 + (_ARROW - 6) * min(1.0, abs(push) / _STRONGEST)
    tip, side = (right, 1.0) if push > 0 else (left, -1.0)
    canvas.line((left, y), (right, y), INK, 1.5)
    for lean in (-3.5, 3.5):
        canvas.line((tip, y), (tip - side * 5, y + lean), INK, 1.5)
