"""Sum of one unit written out: patch, weights and products number by number, then what they add up to."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np
import pygame

from ai.explain.unit_sums import UnitSum
from game.core import texts
from game.digits.pictures import SIGNED, Numbers, Picture
from game.drawing.canvas import Canvas
from game.drawing.tokens import INK, LABEL, MUTE, NET
from game.scenes.digits.unit_walk import UnitWalk
from game.ui.panel import Column

_HEIGHT: Final = 176.0  # of a matrix
_LEAST, _LARGEST = 150.0, 44.0  # of a column, and of a cell
_MOST_WRITTEN: Final = 7  # cells along a side up to which figures fit into them
_FULL: Final = 0.84  # of a cell's width for its figure: any wider, two of them would read as one
_DIM: Final = 0.45  # of a cell's colour behind its figure


def figure(value: float, digits: int = 2) -> str:
    """Write a number with a true minus sign."""
    words = f"{value:.{digits}f}"
    return (words[1:] if float(words) == 0 and words.startswith("-") else words).replace("-", "−")


def describe_sum(column: Column, walk: UnitWalk) -> None:
    """Add the sum of the unit looked at, which may be another one of the same stage later."""
    unit = walk.unit
    if unit is None:
        return
    if unit.weights is not None:
        _describe_products(column, walk)
        return
    first, second = column.beside((1, 1), least=_LEAST, apart=26.0)
    _add_matrix(first, texts.PATCH_READS, lambda: _unit(walk).patch[:, :, 0])
    second.gap(24)
    pooling = walk.stage.kind == "pooling"
    word = texts.PATCH_LARGEST.format(count=unit.patch[:, :, 0].size) if pooling else texts.PATCH_BENT
    second.pair(word, lambda: figure(_unit(walk).output, 3), NET)


def describe_answer(column: Column, walk: UnitWalk) -> None:
    """Add the score and the probability of each digit."""
    column.caption(texts.PATCH_SCORES)
    scores, answer = walk.stages[-1].outputs.reshape(-1).tolist(), int(walk.probabilities.argmax())
    for digit, (score, probability) in enumerate(zip(scores, walk.probabilities.tolist(), strict=True)):
        column.pair(f"{digit}:  {figure(score)}", f"{100 * probability:.1f}%", NET if digit == answer else None)
    column.aside(texts.PATCH_SOFTMAX if walk.logits else texts.PATCH_CLIPPED)


def _unit(walk: UnitWalk) -> UnitSum:
    assert walk.unit is not None
    return walk.unit


def _weights(walk: UnitWalk) -> Numbers:
    weights = _unit(walk).weights
    assert weights is not None
    return weights


def _describe_products(column: Column, walk: UnitWalk) -> None:
    unit = _unit(walk)
    first, second = column.beside((1, 1), least=_LEAST, apart=26.0)
    _add_matrix(first, texts.PATCH_READS, lambda: _unit(walk).patch[:, :, walk.channel])
    _add_matrix(second, texts.PATCH_WEIGHTS, lambda: _weights(walk)[:, :, walk.channel])
    column.gap()
    first, second = column.beside((1, 1), least=_LEAST, apart=26.0)
    _add_matrix(first, texts.PATCH_PRODUCTS, lambda: _unit(walk).products[:, :, walk.channel])

    def here() -> float:
        return float(_unit(walk).products[:, :, walk.channel].sum(dtype=np.float64))

    def others() -> float:
        return float(_unit(walk).products.sum(dtype=np.float64)) - here()

    count, maps = unit.patch[:, :, 0].size, unit.patch.shape[2]
    second.pair(texts.PATCH_SUM.format(count=count) if count > 1 else texts.PATCH_ONE, lambda: figure(here(), 3))
    if maps > 1:
        second.pair(texts.PATCH_OTHERS.format(count=maps - 1), lambda: figure(others(), 3))
    second.pair(texts.PATCH_BIAS, lambda: figure(_unit(walk).bias, 3))
    second.line()
    second.pair(texts.PATCH_TOTAL, lambda: figure(_unit(walk).output, 3), NET)


def _add_matrix(column: Column, words: str, values: Callable[[], Numbers]) -> None:
    """Add a picture of numbers, with figures where these are large enough to be read."""
    shown = Picture(SIGNED)

    def draw(canvas: Canvas, box: pygame.FRect) -> None:
        matrix = values()
        largest, written = float(np.abs(matrix).max()), max(matrix.shape) <= _MOST_WRITTEN
        cell = min(min(box.size) / max(matrix.shape), _LARGEST)
        place = pygame.FRect(box.topleft, (cell * matrix.shape[1], cell * matrix.shape[0]))
        shown.draw(canvas, place, matrix / max(largest, 1e-9) * (_DIM if written else 1.0))
        size = LABEL * min(1.0, _FULL * cell / canvas.text_width(figure(-largest), size=LABEL, tabular=True))
        for (row, across), value in np.ndenumerate(matrix) if written else ():
            at = box.left + (across + 0.5) * cell, box.top + (row + 0.5) * cell + 0.36 * size
            colour = INK if value else MUTE
            canvas.text(figure(float(value)), at, size=size, align="centre", tabular=True, colour=colour)

    column.caption(words)
    column.picture(_HEIGHT, draw)
