"""The code that computes a stage, beside the stage's numbers: from the running source, its line of the sum lit."""

from __future__ import annotations

from types import FunctionType
from typing import Any, Final

import numpy as np
import pygame

from ai.digits.classifier import DigitClassifier
from ai.nn import ActivationLayer, ConvolutionLayer, FullyConnectedLayer, MaxPoolingLayer
from ai.nn.costs import softmax
from game.core import texts
from game.core.source import Source, source_of
from game.digits.unit_walk import UnitWalk
from game.drawing.canvas import Canvas
from game.drawing.prose import draw_wrapped
from game.drawing.tokens import MUTE, SMALL
from game.panels.code_listing import draw_listing

_BOX: Final = pygame.FRect(844, 150, 396, 420)
_BELOW: Final = 600.0  # first baseline of what the case at hand is


def code_of(walk: UnitWalk) -> tuple[Source, int] | None:
    """Return the code of the stage looked at, and the number of its line that computes the sum; None without source."""
    function, *line = _function(walk)
    source = source_of(function)
    if source is None:
        return None
    return source, source.line_of(*line) if line else source.lines[-1][0]


def _function(walk: UnitWalk) -> tuple[Any, ...]:
    """Return the function that computes a stage, and what the line is found by in which it does, if not its last."""
    if walk.at_answer:
        return DigitClassifier.probabilities, softmax if walk.logits else np.sum
    match walk.stage.layer:
        case ConvolutionLayer():
            return ConvolutionLayer._convolve, np.matmul
        case MaxPoolingLayer():
            return MaxPoolingLayer._maximum, np.maximum, 1
        case FullyConnectedLayer():
            return FullyConnectedLayer.predict, np.dot
        case ActivationLayer(activation=activation):
            own = activation.function
            return (own if isinstance(own, FunctionType) and own.__name__ != "<lambda>" else ActivationLayer.predict,)
    return (type(walk.stage.layer).predict,)


def draw_code(canvas: Canvas, walk: UnitWalk) -> None:
    """Draw the code of the stage looked at, and which of its numbers are on the left."""
    found = code_of(walk)
    if found is None:
        draw_wrapped(canvas, texts.PATCH_NO_CODE, (_BOX.left, 176), _BOX.width, size=SMALL, colour=MUTE)
        return
    source, line = found
    draw_listing(canvas, _BOX, source, line)
    if words := _said(walk):
        draw_wrapped(canvas, words, (_BOX.left, _BELOW), _BOX.width, size=SMALL, colour=MUTE, most=4)


def _said(walk: UnitWalk) -> str:
    """Return what the lit line's arrays are in the case at hand."""
    match walk.stage.layer:
        case _ if walk.at_answer:
            return ""
        case ConvolutionLayer(filters=filters, outputs=outputs) as layer:
            return texts.PATCH_CODE["convolution"].format(
                filters=filters, rows=len(layer.weights), windows=outputs[0] * outputs[1], number=walk.place[2] + 1
            )
        case FullyConnectedLayer() as layer:
            inputs, units = layer.weights.shape
            return texts.PATCH_CODE["connected"].format(inputs=inputs, units=units, number=walk.place[2] + 1)
    return ""
