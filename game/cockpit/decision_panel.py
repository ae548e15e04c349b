"""Decision panel of a network that flies alone: the six Q-values and nine inputs of the decision flown."""

from __future__ import annotations

from typing import Final

import numpy as np
import pygame

from ai.common.decision import Decision
from game.cockpit import hud
from game.core import texts
from game.drawing.canvas import Canvas
from game.drawing.tokens import INK, LABEL, LINE, MUTE, SMALL
from game.panels.q_values import HEIGHT, QValues, decision_words, draw_actions, draw_q_values

PANEL: Final = pygame.Rect(964, 84, 280, 504)
_COVER: Final = 0.92  # opacity: the small text must stay readable while landers fly past behind it
_LEFT: Final = 20  # left edge of the content, from the panel's corner
_VALUES: Final = 62  # first baseline of the values, from the panel's top
_WORDS: Final = _VALUES + HEIGHT + 28
_INPUTS: Final = _WORDS + 72  # first baseline of the inputs
_PITCH: Final = 18
_FIGURE: Final = 52  # room for an input's figure


def draw_decision(canvas: Canvas, decision: Decision) -> None:
    """Draw the decision of one lander exactly as it was made: nothing is recomputed or eased."""
    left, top, width = PANEL.left + _LEFT, PANEL.top, PANEL.width - 2 * _LEFT
    canvas.panel(PANEL, _COVER)
    values = QValues.of(decision)
    canvas.text(texts.DECISION_SCRIPTED_TITLE if values is None else texts.DECISION_TITLE, (left, top + 34), room=width)
    if values is None:
        draw_actions(canvas, int(decision.action[0]), left, top + _VALUES)
    else:
        draw_q_values(canvas, values, left, top + _VALUES, width)
    for number, line in enumerate(decision_words(decision)):
        canvas.text(line, (left, top + _WORDS + 18 * number), size=SMALL, colour=MUTE if number else INK, room=width)
    canvas.line((left, top + _WORDS + 32), (left + width, top + _WORDS + 32), LINE)
    canvas.text(texts.DECISION_INPUTS, (left, top + _WORDS + 54), size=LABEL, colour=MUTE, weight="medium")
    _draw_inputs(canvas, decision.observation[0].tolist(), left, top + _INPUTS, width)


def _draw_inputs(canvas: Canvas, inputs: list[float], left: float, top: float, width: float) -> None:
    """Draw each input of the network: its figure, and a bar compressed by tanh."""
    hud.draw_centred_bars(canvas, np.tanh(inputs).tolist(), top, left, width - _FIGURE, _PITCH)
    for number, (name, value) in enumerate(zip(texts.INPUTS, inputs, strict=True)):
        y = top + _PITCH * number + 4
        canvas.text(name, (left, y), size=LABEL, colour=MUTE, room=90)
        figure = f"{value:.2f}".replace("-", "−")
        canvas.text(figure, (left + width, y), size=LABEL, colour=MUTE, align="right", tabular=True)
