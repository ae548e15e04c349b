"""Decision panel of a pilot that flies alone: values and inputs of the decision flown, and the legend of the map."""

from __future__ import annotations

import math
from functools import partial
from typing import Final

import pygame

from ai.agent.decision import Decision
from ai.lander.environment import OBSERVATION_SCALE
from game.core import texts
from game.drawing.canvas import Canvas
from game.drawing.tokens import FAINT, INK, LABEL, LINE, MUTE, NET, SMALL
from game.explain.figures import what_is_sensed
from game.explain.q_values import FIRST, HEIGHT, ROW, QValues, decision_words, draw_actions, draw_q_values
from game.scenes.watch.policy_map import COLOURS

PANEL: Final = pygame.Rect(964, 84, 280, 504)
_COVER: Final = 0.92  # opacity: the small text must stay readable while landers fly past behind it
_LEFT: Final = 20  # left edge of the content, from the panel's corner
_VALUES: Final = 62  # first baseline of the values, from the panel's top
_WORDS: Final = _VALUES + HEIGHT + 28
_INPUTS: Final = _WORDS + 72  # first baseline of the inputs
_PITCH: Final = 18
_NAME, _FIGURE = 96, 52  # room for an input's name, and for its figure
_SWATCH: Final = (5.0, 12.0)  # of an action's colour on the map
_LEGEND: Final = pygame.Rect(PANEL.left, PANEL.bottom + 4, PANEL.width, 28)  # of the map


def draw_decision(canvas: Canvas, decision: Decision, *, mapped: bool = False) -> None:
    """Draw the decision of one lander exactly as it was made and, if `mapped`, what the colours of the sky mean."""
    canvas = canvas.at(1, -1)
    left, top, width = PANEL.left + _LEFT, PANEL.top, PANEL.width - 2 * _LEFT
    canvas.panel(PANEL, _COVER)
    values = QValues.of(decision)
    canvas.text(texts.DECISION_SCRIPTED_TITLE if values is None else texts.DECISION_TITLE, (left, top + 34), room=width)
    if values is None:
        draw_actions(canvas, int(decision.action[0]), left, top + _VALUES)
    else:
        draw_q_values(canvas, values, left, top + _VALUES, width)
    if mapped:
        _draw_swatches(canvas, top + _VALUES, by_rules=values is None)
    for number, line in enumerate(decision_words(decision)):
        canvas.text(line, (left, top + _WORDS + 18 * number), size=SMALL, colour=MUTE if number else INK, room=width)
    if decision.points is not None:
        words = texts.EXPLAIN_WHY_NOW if decision.margin else texts.EXPLAIN_WHY_BEST
        canvas.explain((left, top + _WORDS - 14, width, 38), words.format(margin=decision.margin))
    canvas.line((left, top + _WORDS + 32), (left + width, top + _WORDS + 32), LINE)
    canvas.text(texts.DECISION_INPUTS, (left, top + _WORDS + 54), size=LABEL, colour=MUTE, weight="medium")
    _draw_inputs(canvas, decision.observation[0].tolist(), left, top + _INPUTS, width)


def _draw_swatches(canvas: Canvas, top: float, by_rules: bool) -> None:
    """Draw the colour of each action on the map before its name, and below the panel what the map is."""
    canvas.panel(_LEGEND, _COVER)
    place = (_LEGEND.left + _LEFT, _LEGEND.top + 18)
    canvas.text(texts.MAP_COLOURS, place, size=SMALL, colour=MUTE, room=_LEGEND.width - 2 * _LEFT)
    for action, colour in enumerate(COLOURS):
        middle = top + ROW * action + (-4 if by_rules else FIRST)
        canvas.rounded((PANEL.left + _LEFT - 12, middle - _SWATCH[1] / 2, *_SWATCH), 2, colour)
    # As wide as the panel: what is said of it stands beside that, and not on the values.
    canvas.explain((PANEL.left, top - 10, PANEL.width, HEIGHT - 20), texts.EXPLAIN_MAP)


def _draw_inputs(canvas: Canvas, inputs: list[float], left: float, top: float, width: float) -> None:
    """Draw each input of the network: its figure, and a bar compressed by tanh."""
    start, half = left + _NAME, (width - _FIGURE - _NAME) / 2
    middle = start + half
    for number, (name, value) in enumerate(zip(texts.INPUTS, inputs, strict=True)):
        y, reach = top + _PITCH * number, math.tanh(value) * half
        canvas.pill((start, y - 1, 2 * half, 2), FAINT, 0.5)
        if abs(reach) >= 1:
            canvas.pill((min(middle, middle + reach), y - 1.5, abs(reach), 3), NET)
        canvas.line((middle, y - 4), (middle, y + 4), MUTE)
        y += 4
        canvas.text(name, (left, y), size=LABEL, colour=MUTE, room=_NAME - 6)
        figure = f"{value:.2f}".replace("-", "−")
        canvas.text(figure, (left + width, y), size=LABEL, colour=MUTE, align="right", tabular=True)
        canvas.explain((left, y - 13, width, _PITCH), what_is_sensed(number), partial(_sensed, inputs, number))


def _sensed(inputs: list[float], number: int) -> str:
    """Say what an input means, in metres, seconds and degrees."""
    value = inputs[number] / float(OBSERVATION_SCALE[number])
    if number in (4, 5):
        value = math.degrees(math.asin(value) if number == 4 else math.acos(value)) if abs(value) <= 1 else 0.0
    elif number == 6:
        value = math.degrees(value)
    return texts.EXPLAIN_INPUTS_NOW[number].format(value=value).replace("-", "−")
