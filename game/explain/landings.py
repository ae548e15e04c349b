"""Landings: after which of the six actions, held for half a second, a network still lands."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from ai.lander.environment import ACTION_NAMES
from game.core import texts
from game.drawing.canvas import Canvas
from game.drawing.tokens import INK, MUTE, NET, SMALL
from game.explain.q_values import FIRST, NAME, ROW

_WORDS: Final = {True: "lands", False: "lost", None: "unknown"}


def draw_landings(
    canvas: Canvas, lands: Sequence[bool | None], flown: int, left: float, top: float, width: float
) -> None:
    """Draw a row for each action: its name, and whether the network then `lands`; `top` is the first baseline.

    A mark stands beside the one that is `flown`; None is for what is not known yet.
    """
    for action, after in enumerate(lands):
        y, colour = top + FIRST + ROW * action, INK if action == flown else MUTE
        canvas.text(texts.said(ACTION_NAMES[action]), (left, y + 4), size=SMALL, colour=colour, room=NAME - 20)
        if action == flown:
            canvas.marker("triangle", (left + NAME - 8, y), 6, NET)
        said, room = texts.LANDINGS[_WORDS[after]], width - NAME - 20
        canvas.text(said, (left + width, y + 4), size=SMALL, colour=NET if after else colour, align="right", room=room)
        canvas.explain((left, y - ROW / 2, width, ROW), texts.EXPLAIN_LANDING)
