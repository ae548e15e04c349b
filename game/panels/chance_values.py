"""Chances to be saved after each of the six actions, drawn as a guardian with a safety critic weighs them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial
from typing import Final

from ai.lander.environment import ACTION_NAMES
from game.core import texts
from game.drawing.canvas import Canvas
from game.drawing.paint import mix
from game.drawing.tokens import FAINT, HUMAN, INK, LABEL, LINE, MUTE, NET, SMALL, TEXT

HUNDRED: Final = 100.0
_NAME: Final = 96.0
_FIGURE: Final = 52.0
_FIRST: Final = 28.0  # the first bar, below the first baseline
_ROW: Final = 23.0
_AXIS: Final = _FIRST + 6 * _ROW + 6.0
_BAR: Final = 3.0
_MOST: Final = 3  # digits after the point, where two figures must be told apart


@dataclass(frozen=True)
class ChanceValues:
    """Chances to be saved of one shared decision, 0 to 1.

    Attributes:
        chances: chance after each action.
        flown: the action that is flown.
        asked: the action that the pilot asked for; to coast is one as well.
        required: the chance that the dial asks for.

    """

    chances: tuple[float, ...]
    flown: int
    asked: int
    required: float

    @property
    def readable(self) -> bool:
        """Whether all chances are finite."""
        return all(map(math.isfinite, self.chances))

    @property
    def told(self) -> tuple[str, str]:
        """The chance after the action asked for, and the one required, as every figure and sentence has them."""
        return told_apart(self.chances[self.asked], self.required)


def of_hundred(chance: float, digits: int = 0) -> str:
    """Format a chance as so many of 100; what is not certain never reads as 0 or 100."""
    if not math.isfinite(chance):
        return "–"
    figure = HUNDRED * chance
    while digits < _MOST and 0 < figure < HUNDRED and float(f"{figure:.{digits}f}") in (0.0, HUNDRED):
        digits += 1
    least = 10.0**-_MOST
    if 0 < figure < HUNDRED:
        figure = min(max(figure, least), HUNDRED - least)
    return f"{figure:.{digits}f}"


def told_apart(one: float, other: float) -> tuple[str, str]:
    """Format two chances as so many of 100, with enough digits that the larger one also reads as larger."""
    words = of_hundred(one), of_hundred(other)
    for digits in range(1, _MOST + 1):
        if one == other or float(words[0].replace("–", "nan")) != float(words[1].replace("–", "nan")):
            break
        words = of_hundred(one, digits), of_hundred(other, digits)
    return words


def draw_chances(canvas: Canvas, values: ChanceValues, left: float, top: float, width: float) -> None:
    """Draw a bar for each action from 0 to 100, with a line for the chance asked for; `top` is the first baseline."""
    start, track = left + _NAME, width - _NAME - _FIGURE
    canvas.text(texts.CHANCE_ASKED, (left, top), size=SMALL, colour=MUTE, room=width - _FIGURE - 72)
    canvas.text(values.told[1], (start + track, top), size=TEXT, align="right", tabular=True)
    canvas.text(texts.CHANCE_UNIT, (left + width, top), size=LABEL, colour=MUTE, align="right", room=_FIGURE - 8)
    canvas.explain((left, top - 14, width, 20), texts.EXPLAIN_CHANCE_ASKED)
    for action in range(len(ACTION_NAMES)):
        _draw_row(canvas, values, action, left, top + _FIRST + _ROW * action, width)
        row = (left, top + _FIRST + _ROW * (action - 0.5), width, _ROW)
        canvas.explain(row, texts.EXPLAIN_CHANCE, partial(chance_words, values, action))
    y = top + _AXIS
    canvas.line((start, y - 13), (start + track, y - 13), LINE)
    for share in (0.0, 0.5, 1.0):
        canvas.line((start + share * track, y - 16), (start + share * track, y - 12), MUTE)
    canvas.text("0", (start, y), size=LABEL, colour=MUTE, align="centre")
    canvas.text("100", (start + track, y), size=LABEL, colour=MUTE, align="centre")
    x, y = start + values.required * track, top + _FIRST
    canvas.line((x, y - 9), (x, y + 5 * _ROW + 9), MUTE)
    canvas.marker("triangle_down", (x, y - 11), 6, INK, 0.8)


def _draw_row(canvas: Canvas, values: ChanceValues, action: int, left: float, y: float, width: float) -> None:
    x, track, chance = left + _NAME, width - _NAME - _FIGURE, values.chances[action]
    flown, enough = action == values.flown, chance >= values.required
    colour = INK if flown else MUTE
    alpha = 1.0 if enough or flown else 0.6
    name = texts.said(ACTION_NAMES[action])
    canvas.text(name, (left, y + 4), size=SMALL, colour=colour, alpha=alpha, room=_NAME - 20)
    fraction = chance if math.isfinite(chance) else 0.0
    canvas.bar((x, y - 1, track, _BAR), fraction, NET if flown else mix(FAINT, NET, 0.45 if enough else 0.2))
    if flown:
        canvas.marker("triangle", (x - 8, y), 6, NET)
    if action == values.asked:
        canvas.dot((x + fraction * track, y), 4, HUMAN)
    figure = values.told[0] if action == values.asked else of_hundred(chance)
    place = (left + width, y + 4)
    canvas.text(figure, place, size=SMALL, colour=colour, align="right", tabular=True, alpha=alpha)


def chance_words(values: ChanceValues, action: int) -> str:
    """Say what the chance after an action means now."""
    name = texts.said(ACTION_NAMES[action]).capitalize()
    chance = values.chances[action]
    if not math.isfinite(chance):
        return texts.EXPLAIN_VALUE_NONE.format(name=name)
    chance_figure, asked = told_apart(chance, values.required)
    enough = chance >= values.required
    return texts.EXPLAIN_CHANCE_NOW[enough].format(name=name, chance=chance_figure, asked=asked)
