"""Sum of one unit written out: patch, weights and products number by number, then what they add up to."""

from __future__ import annotations

from typing import Final

import numpy as np
import pygame

from game.core import texts
from game.digits.pictures import SIGNED, Numbers, mosaic, picture, tiling
from game.drawing.canvas import Canvas, Point
from game.drawing.paint_cache import PaintCache
from game.drawing.prose import draw_wrapped
from game.drawing.tokens import HUMAN, INK, LABEL, LINE, MUTE, NET, SMALL, TEXT
from game.scenes.digits.unit_walk import UnitWalk

LEFT: Final = 392.0
TOP: Final = 148.0
_SIZE: Final = (440.0, 492.0)
_MATRIX: Final = (192.0, 140.0)
_SECOND: Final = 218.0  # left of the second column, from the first one
_ROWS: Final = (28.0, 202.0)  # tops of the two rows of matrices
_MOST_WRITTEN: Final = 7  # cells along a side up to which figures fit into them
_ALL: Final = (0.0, 374.0, 410.0, 112.0)
_LEADING: Final = 23.0
_FULL: Final = 0.84  # of a cell's width for its figure: any wider, two of them would read as one
_DIM: Final = 0.45  # of a cell's colour behind its figure


class PatchSums:
    """Panel of one unit's sum."""

    def __init__(self) -> None:
        self._painted = PaintCache()

    def draw(self, canvas: Canvas, walk: UnitWalk) -> None:
        """Draw the sum of the unit looked at."""
        shows = (id(walk), walk.number, walk.place, walk.channel)
        self._painted.draw(canvas, (LEFT, TOP, *_SIZE), shows, lambda sheet: _paint(sheet, walk))


def figure(value: float, digits: int = 2) -> str:
    """Write a number with a true minus sign."""
    words = f"{value:.{digits}f}"
    return (words[1:] if float(words) == 0 and words.startswith("-") else words).replace("-", "−")


def _paint(sheet: Canvas, walk: UnitWalk) -> None:
    unit = walk.unit
    if walk.at_answer:
        _paint_answer(sheet, walk)
    elif unit is None:
        words = texts.PATCH_OTHER.format(layer=type(walk.stage.layer).__name__)
        draw_wrapped(sheet, words, (0, 30), _SIZE[0] - 40, size=TEXT, colour=MUTE, leading=22)
    elif unit.weights is None:
        patch = unit.patch[:, :, 0]
        _label(sheet, texts.PATCH_READS, (0, _ROWS[0] - 8))
        _paint_matrix(sheet, patch, (0, _ROWS[0]), strongest=walk.stage.kind == "pooling")
        pooling = walk.stage.kind == "pooling"
        word = texts.PATCH_LARGEST.format(count=patch.size) if pooling else texts.PATCH_BENT
        _line(sheet, _ROWS[0] + 20, word, unit.output, _SECOND, weight=True)
    else:
        _paint_products(sheet, walk)


def _paint_products(sheet: Canvas, walk: UnitWalk) -> None:
    unit, channel = walk.unit, walk.channel
    assert unit is not None
    assert unit.weights is not None
    patch, weights, products = (each[:, :, channel] for each in (unit.patch, unit.weights, unit.products))
    second = _SECOND
    _label(sheet, texts.PATCH_READS, (0, _ROWS[0] - 8))
    _label(sheet, texts.PATCH_WEIGHTS, (second, _ROWS[0] - 8))
    _label(sheet, texts.PATCH_PRODUCTS, (0, _ROWS[1] - 8))
    _paint_matrix(sheet, patch, (0, _ROWS[0]))
    sheet.text("×", (_MATRIX[0] + 13, _ROWS[0] + 76), size=TEXT, colour=MUTE, align="centre")
    _paint_matrix(sheet, weights, (second, _ROWS[0]))
    _paint_matrix(sheet, products, (0, _ROWS[1]))
    sheet.text("Σ", (_MATRIX[0] + 13, _ROWS[1] + 76), size=TEXT, colour=MUTE, align="centre")
    y, here = _ROWS[1] + 12, float(products.sum(dtype=np.float64))
    word = texts.PATCH_SUM.format(count=products.size) if products.size > 1 else texts.PATCH_ONE
    _line(sheet, y, word, here, second)
    if unit.patch.shape[2] > 1:
        y += _LEADING
        others = float(unit.products.sum(dtype=np.float64)) - here
        _line(sheet, y, texts.PATCH_OTHERS.format(count=unit.patch.shape[2] - 1), others, second)
    y += _LEADING
    _line(sheet, y, texts.PATCH_BIAS, unit.bias, second)
    sheet.line((second, y + 8), (second + _MATRIX[0], y + 8), LINE)
    y += _LEADING + 4
    _line(sheet, y, texts.PATCH_TOTAL, unit.total, second, weight=True)
    _line(sheet, y + _LEADING, texts.PATCH_GAVE, unit.output, second)
    if unit.patch.shape[2] > 1:
        _paint_all(sheet, unit.products, channel)


def _paint_matrix(sheet: Canvas, values: Numbers, at: Point, *, strongest: bool = False) -> None:
    """Draw numbers in their cells, or as a picture alone where they would be too small to read."""
    rows, columns = values.shape
    written = max(rows, columns) <= _MOST_WRITTEN
    width, height = _MATRIX if written else (_MATRIX[1], _MATRIX[1])
    if written and columns < 3:
        width, height = 64.0 * columns, 44.0 * rows
    area = sheet.rect(*at, width, height)
    scale = max(float(np.abs(values).max()), 1e-9)
    sheet.surface.blit(picture(values / scale * (_DIM if written else 1.0), area.size, SIGNED), area)
    pygame.draw.rect(sheet.surface, LINE, area, 1)
    if not written:
        return
    across, down = width / columns, height / rows
    largest = figure(-float(np.abs(values).max()))
    size = LABEL * min(1.0, _FULL * across / sheet.text_width(largest, size=LABEL, tabular=True))
    best = np.unravel_index(int(values.argmax()), values.shape)
    for (row, column), value in np.ndenumerate(values):
        lit = strongest and (row, column) == best
        middle = at[0] + (column + 0.5) * across, at[1] + (row + 0.5) * down + 0.36 * size
        sheet.text(figure(float(value)), middle, size=size, align="centre", tabular=True, room=across - 2,
                   colour=NET if lit else INK if value else MUTE)  # fmt: skip


def _paint_all(sheet: Canvas, products: Numbers, channel: int) -> None:
    """Draw the products of all maps, and an edge around those that are written out."""
    left, top, width, most = _ALL
    _label(sheet, texts.PATCH_ALL.format(count=products.shape[2]), (left, top - 8))
    tiles = np.moveaxis(products, 2, 0)
    columns, size = tiling(len(tiles), products.shape[:2], (width, most), 2.0)
    area = sheet.rect(left, top, *size)
    shown = tiles / max(float(np.abs(tiles).max()), 1e-9)
    sheet.surface.blit(mosaic(shown, columns, area.size, 2.0 * sheet.scale), area)
    row, column = divmod(channel, columns)
    across, down = (size[0] + 2) / columns, (size[1] + 2) / -(-len(tiles) // columns)
    sheet.outline((left + column * across - 2, top + row * down - 2, across + 2, down + 2), 1, INK)


def _paint_answer(sheet: Canvas, walk: UnitWalk) -> None:
    outputs = walk.stages[-1].outputs.reshape(-1)
    _label(sheet, texts.PATCH_SCORES, (40, _ROWS[0] - 4))
    _label(sheet, texts.PATCH_PROBABILITIES, (140, _ROWS[0] - 4))
    answer = int(walk.probabilities.argmax())
    for digit, (score, probability) in enumerate(zip(outputs.tolist(), walk.probabilities.tolist(), strict=True)):
        y = _ROWS[0] + 22 + 30 * digit
        followed = digit == walk.place[2]
        colour = INK if digit == answer else MUTE
        sheet.text(str(digit), (0, y), size=TEXT, colour=HUMAN if followed else colour, tabular=True)
        sheet.text(figure(score), (100, y), size=SMALL, colour=colour, align="right", tabular=True)
        sheet.bar((140, y - 7, 200, 4), probability, NET if digit == answer else MUTE)
        sheet.text(f"{100 * probability:.1f} %", (410, y), size=SMALL, colour=colour, align="right", tabular=True)
    words = texts.PATCH_SOFTMAX if walk.logits else texts.PATCH_CLIPPED
    draw_wrapped(sheet, words, (0, _ROWS[0] + 346), _SIZE[0] - 20, size=SMALL, colour=MUTE)


def _line(sheet: Canvas, y: float, word: str, value: float, left: float, *, weight: bool = False) -> None:
    right = left + _MATRIX[0]
    number = sheet.text(figure(value, 3), (right, y), size=SMALL, align="right", tabular=True,
                        colour=NET if weight else INK)  # fmt: skip
    sheet.text(word, (left, y), size=SMALL, colour=MUTE, room=number.left - left - 8)


def _label(sheet: Canvas, words: str, place: Point) -> None:
    sheet.text(words, place, size=LABEL, colour=MUTE, weight="medium", room=_MATRIX[0] if place[0] else 2 * _MATRIX[0])
