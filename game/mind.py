"""What the network thinks: its six values and nine inputs, eased so that an eye can follow."""

from __future__ import annotations

from typing import Final

import numpy as np
import pygame

from ai.env import Floats
from ai.lander import ACTION_NAMES, NUM_ACTIONS, NUM_FEATURES
from game import hud, texts
from game.flight import DECISION_STEPS
from game.networks import Flyer, Thinker
from game.ui.canvas import Canvas
from game.ui.kept import Kept
from game.ui.tokens import INK, LABEL, LINE, MUTE, SMALL, TEXT

PANEL: Final = pygame.Rect(984, 84, 260, 432)
_COVER: Final = 0.92  # landers fly past behind it, and its small words are to be read all the same
_LEFT: Final = 20  # of what stands on the panel, from its corner
_BARS: Final = 62  # the first of the bars, from its top
_INPUTS: Final = 268  # and the first of the inputs'
_PITCH: Final = 18
_EASE: Final = 0.3
_LEAST_SPAN: Final = 0.05  # values closer together than this count as equal


class Mind:
    """Follows one lander of a flyer's; `follow` once after every step."""

    def __init__(self) -> None:
        self.best = 0
        self.thinks = True
        self.value = 0.0
        self._bars = np.zeros(NUM_ACTIONS)
        self._wanted = np.zeros(NUM_ACTIONS)
        self._step = 0
        self._inputs = np.zeros(NUM_FEATURES)
        self._words = Kept()

    def follow(self, flyer: Flyer, observation: Floats, action: int) -> None:
        """Think about one observation (9,), as often as a flyer decides; `action` is what is being flown."""
        if self._step % DECISION_STEPS == 0:
            self._think(flyer, observation, action)
        self._step += 1
        self.best = action
        self._bars += _EASE * (self._wanted - self._bars)
        self._inputs += _EASE * (np.tanh(observation) - self._inputs)

    def _think(self, flyer: Flyer, observation: Floats, action: int) -> None:
        self.thinks = isinstance(flyer, Thinker)
        if isinstance(flyer, Thinker):
            values = flyer.q_values(observation[None])[0]
            self.value = float(values.max())
            span = max(float(np.ptp(values)), _LEAST_SPAN)
            self._wanted = 1 - (self.value - values) / span * 0.94
        else:
            self._wanted = np.eye(NUM_ACTIONS)[action]

    def draw(self, canvas: Canvas) -> None:
        """Draw the panel."""
        left, top, width = PANEL.left + _LEFT, PANEL.top, PANEL.width - 2 * _LEFT
        self._words.draw(canvas, PANEL, (self.thinks, self.best), self._paint_words)
        hud.draw_bars(canvas, self._bars.tolist(), top + _BARS, left, width, self.best)
        if self.thinks:
            figure = f"{self.value:+.2f}".replace("-", "−")
            canvas.text(figure, (left + width, top + 214), size=SMALL, align="right", tabular=True)
        hud.draw_centred_bars(canvas, self._inputs.tolist(), top + _INPUTS, left, width, _PITCH)

    def _paint_words(self, canvas: Canvas) -> None:
        """Draw the panel and what stands on it, but for what moves all the time."""
        canvas.panel((0, 0, PANEL.width, PANEL.height), _COVER)
        title = texts.MIND_TITLE if self.thinks else texts.MIND_SCRIPTED_TITLE
        canvas.text(title, (_LEFT, 34), size=TEXT)
        for number, name in enumerate(ACTION_NAMES):
            colour = INK if number == self.best else MUTE
            canvas.text(name, (_LEFT, _BARS + hud.BAR_ROW * number + 4), size=SMALL, colour=colour)
        text = texts.MIND_VALUE if self.thinks else texts.MIND_SCRIPTED
        canvas.text(text, (_LEFT, 214), size=LABEL, colour=MUTE)
        canvas.line((_LEFT, 230), (PANEL.width - _LEFT, 230), LINE)
        canvas.text(texts.MIND_INPUTS, (_LEFT, 252), size=LABEL, colour=MUTE, weight="medium")
        for number, name in enumerate(texts.INPUTS):
            canvas.text(name, (_LEFT, _INPUTS + _PITCH * number + 4), size=LABEL, colour=MUTE)
