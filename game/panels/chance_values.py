"""Chances to be saved after each of the six actions, drawn as a guardian with a safety critic weighs them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial
from typing import Final

from ai.lander.environment import ACTION_NAMES
from game.core import texts
from game.drawing.canvas import Canvas
from game.panels.action_rows import ActionRow, ActionRows

HUNDRED: Final = 100.0
_DIMMED: Final = (0.6, 0.2)  # words and bar of an action that is not safe enough
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
    def told(self) -> tuple[str, ...]:
        """The chance after the action asked for, the one required, and after the one that is flown."""
        return told_apart(self.chances[self.asked], self.required, self.chances[self.flown])


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


def told_apart(*chances: float) -> tuple[str, ...]:
    """Format chances as so many of 100, with enough digits that different ones also read as different."""
    different = len({chance for chance in chances if math.isfinite(chance)})
    words: tuple[str, ...] = ()
    for digits in range(_MOST + 1):
        words = tuple(of_hundred(chance, digits) for chance in chances)
        if len({float(word) for word in words if word != "–"}) == different:
            break
    return words


def draw_chances(canvas: Canvas, values: ChanceValues, left: float, top: float, width: float) -> None:
    """Draw a bar for each action from 0 to 100, with a line for the chance asked for; `top` is the first baseline."""
    rows = ActionRows(canvas, left, top, width)
    rows.draw_heading(texts.CHANCE_ASKED, values.told[1], texts.CHANCE_UNIT)
    canvas.explain((left, top - 14, width, 20), texts.EXPLAIN_CHANCE_ASKED)
    for action, chance in enumerate(values.chances):
        fraction = chance if math.isfinite(chance) else 0.0
        flown, asked, enough = action == values.flown, action == values.asked, chance >= values.required
        figure = values.told[0] if asked else values.told[2] if flown else of_hundred(chance)
        rows.draw_row(action, ActionRow(fraction, figure, flown, asked, enough), _DIMMED)
        canvas.explain(rows.box(action), texts.EXPLAIN_CHANCE, partial(chance_words, values, action))
    rows.draw_scale("0", "100")
    rows.draw_limit(values.required)


def chance_words(values: ChanceValues, action: int) -> str:
    """Say what the chance after an action means now."""
    name = texts.said(ACTION_NAMES[action]).capitalize()
    chance = values.chances[action]
    if not math.isfinite(chance):
        return texts.EXPLAIN_VALUE_NONE.format(name=name)
    chance_figure, asked = told_apart(chance, values.required)
    enough = chance >= values.required
    return texts.EXPLAIN_CHANCE_NOW[enough].format(name=name, chance=chance_figure, asked=asked)
