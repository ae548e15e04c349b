"""Which key does what, in one quiet line."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import Final

from game import texts
from game.controls import Controls, Held
from game.ui.canvas import Canvas
from game.ui.tokens import INK, MUTE, SMALL

_GAPS: Final = 8.0, 24.0  # from a key to its meaning, from there to the next key


def draw_hints(
    canvas: Canvas,
    hints: Iterable[tuple[str, str]],
    position: tuple[float, float],
    *,
    from_right: bool = False,
    size: float = SMALL,
    room: float = math.inf,
) -> None:
    """Write pairs of a key and its meaning on one baseline, starting (or ending) at the position, in that room."""
    pairs = list(hints)
    x, y = position
    size *= min(1.0, room / max(hints_width(canvas, pairs, size), 1.0))
    if from_right:
        x -= hints_width(canvas, pairs, size)
    for key, meaning in pairs:
        x += canvas.text(key, (x, y), size=size, colour=INK, weight="medium").width + _GAPS[0]
        x += canvas.text(meaning, (x, y), size=size, colour=MUTE).width + _GAPS[1]


def hints_width(canvas: Canvas, hints: Sequence[tuple[str, str]], size: float = SMALL) -> float:
    """Return how wide `draw_hints` will be."""
    keys = sum(canvas.text_width(key, size=size, weight="medium") for key, _ in hints)
    meanings = sum(canvas.text_width(meaning, size=size) for _, meaning in hints)
    return keys + meanings + len(hints) * sum(_GAPS) - _GAPS[1]


def flight_hints(controls: Controls) -> list[tuple[str, str]]:
    """Return what flies, on the device in use; one word for both turns where one stick does both."""
    left, right = controls.word(Held.LEFT), controls.word(Held.RIGHT)
    turns = [(left, texts.TURN)] if left == right else [(left, texts.TURN_LEFT), (right, texts.TURN_RIGHT)]
    return [(controls.word(Held.MAIN), texts.MAIN_ENGINE), *turns]
