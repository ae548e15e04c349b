"""Ten dreams: for each digit, the ink in which a network reads it most surely (activation maximisation)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np
import pygame

from ai.digits.classifier import DIGITS
from ai.digits.dream import ActivationMaximisation
from game.core import texts
from game.digits import certainty
from game.digits.pictures import picture
from game.drawing.canvas import Canvas
from game.drawing.tokens import SMALL

if TYPE_CHECKING:
    from ai.digits.classifier import DigitClassifier
    from game.ui.panel import Panel

_COLUMNS: Final = 5
_LARGEST: Final = 180.0  # points of a picture's side
_GAP, _BELOW = 16.0, 40.0  # points between two pictures, and below each for its words
_FAINTEST: Final = 0.3  # least peak brightness for scaling: dimmer images stay dim


class DreamsTab:
    """Dreams of all ten digits, which go on a step a frame."""

    def __init__(self, classifier: DigitClassifier) -> None:
        self.dreams = [
            ActivationMaximisation(classifier, digit, np.random.default_rng(digit)) for digit in range(DIGITS)
        ]

    def update(self) -> None:
        dream = min(self.dreams, key=lambda each: each.step)
        if not dream.done:
            dream.advance()

    def describe(self, panel: Panel) -> None:
        panel.aside(texts.DREAMS_LINE)
        panel.gap()
        panel.picture(lambda width: 2 * (_side(width) + _BELOW), self._draw)

    def _draw(self, canvas: Canvas, box: pygame.FRect) -> None:
        side = _side(box.width)
        for digit, dream in enumerate(self.dreams):
            left = box.left + digit % _COLUMNS * (side + _GAP)
            top = box.top + digit // _COLUMNS * (side + _BELOW)
            area = canvas.rect(left, top, side, side)
            image = dream.image / max(float(dream.image.max()), _FAINTEST)
            canvas.surface.blit(picture(image, area.size), area)
            best = int(dream.probabilities.argmax())
            words = texts.WHY_NOT_READS.format(digit=best, percent=certainty(float(dream.probabilities[best])))
            colour = canvas.palette.good if best == digit else canvas.palette.warn
            canvas.text(words, (left, top + side + 18), size=SMALL, colour=colour, tabular=True)


def _side(width: float) -> float:
    """Return the side of a picture, of which five stand in a row."""
    return min((width + _GAP) / _COLUMNS - _GAP, _LARGEST)
