"""What the network thinks: its six values and nine inputs, eased so that an eye can follow."""

from __future__ import annotations

from typing import Final

import numpy as np
import pygame

from ai.env import Floats
from ai.lander import ACTION_NAMES, NUM_ACTIONS, NUM_FEATURES
from game import hud, texts
from game.networks import Flyer, Thinker
from game.ui.canvas import Canvas
from game.ui.tokens import LABEL, LINE, MUTE, SMALL, TEXT

PANEL: Final = pygame.Rect(984, 84, 260, 426)
_COVER: Final = 0.92  # landers fly past behind it, and its small words are to be read all the same
_EASE: Final = 0.3
_LEAST_SPAN: Final = 0.05  # values closer together than this count as equal


class Mind:
    """Follows one lander of a flyer's; `follow` once after every step."""

    def __init__(self) -> None:
        self.best = 0
        self.thinks = True
        self.value = 0.0
        self._bars = np.zeros(NUM_ACTIONS)
        self._inputs = np.zeros(NUM_FEATURES)

    def follow(self, flyer: Flyer, observation: Floats, action: int) -> None:
        """Think about one observation (9,); `action` is what is being flown."""
        wanted = np.zeros(NUM_ACTIONS)
        self.thinks = isinstance(flyer, Thinker)
        if isinstance(flyer, Thinker):
            values = flyer.q_values(observation[None])[0]
            self.value = float(values.max())
            span = max(float(np.ptp(values)), _LEAST_SPAN)
            wanted = 1 - (self.value - values) / span * 0.94
        else:
            wanted[action] = 1.0
        self.best = action
        self._bars += _EASE * (wanted - self._bars)
        self._inputs += _EASE * (np.tanh(observation) - self._inputs)

    def draw(self, canvas: Canvas) -> None:
        """Draw the panel."""
        left, top, width = PANEL.left + 20, PANEL.top, PANEL.width - 40
        canvas.panel(PANEL, _COVER)
        title = texts.MIND_TITLE if self.thinks else texts.MIND_SCRIPTED_TITLE
        canvas.text(title, (left, top + 34), size=TEXT)
        rows = list(zip(ACTION_NAMES, self._bars.tolist(), strict=True))
        hud.draw_bars(canvas, rows, top + 62, left, width, self.best)
        if not self.thinks:
            canvas.text(texts.MIND_SCRIPTED, (left, top + 214), size=LABEL, colour=MUTE)
        else:
            canvas.text(texts.MIND_VALUE, (left, top + 214), size=LABEL, colour=MUTE)
            figure = f"{self.value:+.2f}".replace("-", "−")
            canvas.text(figure, (left + width, top + 214), size=SMALL, align="right", tabular=True)
        canvas.line((left, top + 230), (left + width, top + 230), LINE)
        canvas.text(texts.MIND_INPUTS, (left, top + 252), size=LABEL, colour=MUTE, weight="medium")
        inputs = list(zip(texts.INPUTS, self._inputs.tolist(), strict=True))
        hud.draw_centred_bars(canvas, inputs, top + 268, left, width, 18)
