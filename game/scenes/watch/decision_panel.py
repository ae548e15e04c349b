"""Decision of a pilot that flies alone, as a row of a panel: its values, why it was flown, and what was sensed."""

from __future__ import annotations

import math
from functools import partial
from typing import Final

import pygame

from ai.agent.decision import Decision
from ai.lander.environment import OBSERVATION_SCALE
from game.core import texts
from game.drawing.canvas import Canvas
from game.drawing.cursor import LEADING, Cursor
from game.drawing.tokens import FAINT, INK, LABEL, MUTE, NET, SMALL, STEP
from game.explain.figures import what_is_sensed
from game.explain.q_values import FIRST, HEIGHT, ROW, QValues, decision_words, draw_actions, draw_q_values
from game.scenes.watch.policy_map import COLOURS

_BASELINE: Final = 14.0  # of the first line of the values, below their top
_NARROW: Final = 236.0  # points, below which the words take a third line
_PITCH: Final = 18.0
_NAME, _FIGURE = 96.0, 52.0  # room for an input's name, and for its figure
_SWATCH: Final = (5.0, 12.0)  # of an action's colour on the map


def write_decision(cursor: Cursor, decision: Decision, *, mapped: bool = False, inputs: bool = True) -> None:
    """Write the decision of one lander exactly as it was made, with what it was made of, if `inputs`.

    `mapped` is whether the colours of the sky are to be named.
    """
    values = QValues.of(decision)
    cursor.text(texts.DECISION_SCRIPTED_TITLE if values is None else texts.DECISION_TITLE)
    cursor.gap()
    box = cursor.take(HEIGHT + 1.5 * _BASELINE)
    if canvas := cursor.canvas:
        if values is None:
            draw_actions(canvas, int(decision.action[0]), box.left, box.top + _BASELINE)
        else:
            draw_q_values(canvas, values, box.left, box.top + _BASELINE, box.width)
        if mapped:
            _draw_swatches(canvas, box, by_rules=values is None)
    if mapped:
        cursor.aside(texts.MAP_COLOURS)
    _write_words(cursor, decision)
    if inputs:
        cursor.line()
        cursor.gap()
        cursor.caption(texts.DECISION_INPUTS)
        _write_inputs(cursor, decision.observation[0].tolist())


def _write_words(cursor: Cursor, decision: Decision) -> None:
    """Say why, on as many lines as it ever takes: what stands below must not jump."""
    box = cursor.take(LEADING * SMALL * (2 + (cursor.width < _NARROW)))
    if canvas := cursor.canvas:
        words = Cursor(box.left, box.top, box.width, cursor.scale, canvas, size=SMALL)
        for number, line in enumerate(decision_words(decision)):
            words.styled(line, colour=MUTE if number else INK)
        if decision.points is not None:
            why = texts.EXPLAIN_WHY_NOW if decision.margin else texts.EXPLAIN_WHY_BEST
            canvas.explain(box, why.format(margin=decision.margin))
    cursor.gap()


def _draw_swatches(canvas: Canvas, box: pygame.FRect, by_rules: bool) -> None:
    """Draw the colour of each action on the map before its name."""
    for action, colour in enumerate(COLOURS):
        middle = box.top + _BASELINE + ROW * action + (-4 if by_rules else FIRST)
        canvas.rounded((box.left - 12, middle - _SWATCH[1] / 2, *_SWATCH), 2, colour)
    # Wider than the values: what is said of it stands beside them, and not on them.
    canvas.explain(box.inflate(2 * STEP, 0), texts.EXPLAIN_MAP)


def _write_inputs(cursor: Cursor, inputs: list[float]) -> None:
    """Write each input of the network: its figure, and a bar compressed by tanh."""
    half = (cursor.width - _FIGURE - _NAME) / 2
    for number, (name, value) in enumerate(zip(texts.INPUTS, inputs, strict=True)):
        box = cursor.take(_PITCH)
        if (canvas := cursor.canvas) is None:
            continue
        y, middle, reach = box.centery, box.left + _NAME + half, math.tanh(value) * half
        canvas.pill((middle - half, y - 1, 2 * half, 2), FAINT, 0.5)
        if abs(reach) >= 1:
            canvas.pill((min(middle, middle + reach), y - 1.5, abs(reach), 3), NET)
        canvas.line((middle, y - 4), (middle, y + 4), MUTE)
        canvas.text(name, (box.left, y + 4), size=LABEL, colour=MUTE, room=_NAME - 6)
        figure = f"{value:.2f}".replace("-", "−")
        canvas.text(figure, (box.right, y + 4), size=LABEL, colour=MUTE, align="right", tabular=True)
        canvas.explain(box, what_is_sensed(number), partial(_sensed, inputs, number))


def _sensed(inputs: list[float], number: int) -> str:
    value = inputs[number] / float(OBSERVATION_SCALE[number])
    if number in (4, 5):
        value = math.degrees(math.asin(value) if number == 4 else math.acos(value)) if abs(value) <= 1 else 0.0
    elif number == 6:
        value = math.degrees(value)
    return texts.EXPLAIN_INPUTS_NOW[number].format(value=value).replace("-", "−")
