"""Key hints: a line that tells which key does what."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import Final

from game.core import texts
from game.drawing.canvas import LEAST, Canvas
from game.drawing.tokens import INK, MUTE, SMALL
from game.input.controls import Controls, Held, KeyName

_GAPS: Final = 8.0, 24.0  # points from a key to its meaning, and from there to the next key
_LINE: Final = 18.0  # points above its baseline in which a hint can be clicked


def draw_hints(
    canvas: Canvas,
    hints: Iterable[tuple[str, str]],
    position: tuple[float, float],
    *,
    from_right: bool = False,
    size: float = SMALL,
    room: float = math.inf,
) -> None:
    """Draw pairs of a key and its meaning on one baseline, starting or ending at a position, within `room` points.

    A click on a hint is a press of its key, so that the mouse can do all that the hints say.
    """
    pairs = list(hints)
    x, y = position
    if room < math.inf:
        gaps = len(pairs) * _GAPS[0] + (len(pairs) - 1) * _GAPS[1]  # gaps do not shrink
        for _ in range(1 if LEAST == 1 else 2):  # text that is made larger does not shrink quite in proportion
            size *= min(1.0, (room - gaps) / max(hints_width(canvas, pairs, size) - gaps, 1.0))
    widths = [_width(canvas, pair, size) for pair in pairs]
    if from_right:
        x -= sum(widths) + (len(widths) - 1) * _GAPS[1]
    for (key, meaning), width in zip(pairs, widths, strict=True):
        box = (x - 6, y - _LINE, width + 12, 1.6 * _LINE)
        pointed = isinstance(key, KeyName) and canvas.link(box, key.press)
        canvas.text(key, (x, y), size=size, colour=INK, weight="medium")
        end = x + width
        canvas.text(meaning, (end, y), size=size, colour=INK if pointed else MUTE, align="right")
        x = end + _GAPS[1]


def hints_width(canvas: Canvas, hints: Sequence[tuple[str, str]], size: float = SMALL) -> float:
    """Return the width of `draw_hints`, in points."""
    return sum(_width(canvas, pair, size) for pair in hints) + (len(hints) - 1) * _GAPS[1]


def _width(canvas: Canvas, pair: tuple[str, str], size: float) -> float:
    key, meaning = pair
    return canvas.text_width(key, size=size, weight="medium") + _GAPS[0] + canvas.text_width(meaning, size=size)


def flight_hints(controls: Controls) -> list[tuple[str, str]]:
    """Return the hints of the flight controls for the device in use; one for both turns if one control does both."""
    left, right = controls.word(Held.LEFT), controls.word(Held.RIGHT)
    turn = texts.TURN_TO_MOUSE if controls.mouse_in_use else texts.TURN
    turns = [(left, turn)] if left == right else [(left, texts.TURN_LEFT), (right, texts.TURN_RIGHT)]
    return [(controls.word(Held.MAIN), texts.MAIN_ENGINE), *turns]
