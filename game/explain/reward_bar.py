"""Reward bar: the parts of a flight's reward side by side, each with its own place and colour."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import partial
from typing import Final, NamedTuple

import numpy as np
import numpy.typing as npt
import pygame

from game.core import texts
from game.drawing.canvas import Canvas, Point
from game.drawing.paint import mix
from game.drawing.paint_cache import PaintCache
from game.drawing.tokens import INK, LABEL, LINE, MUTE, NIGHT0, SMALL, TEXT, Colour
from game.ui import plotting

# Neighbours in the strip differ in lightness as well as in hue, also for eyes without red, green or blue cones:
# by 28 or more in CIELAB. Amber and the network's blue stay free.
PART_COLOURS: Final[dict[str, Colour]] = {
    "distance": (82, 120, 190),
    "speed": (164, 226, 232),
    "alignment": (160, 140, 236),
    "tilt": (240, 178, 206),
    "feet": (104, 146, 84),
    "engine": (244, 204, 170),
    "switch": (170, 102, 78),
    "time": (116, 126, 154),
    "terminal": (240, 234, 206),
}
_BAR_TOP: Final = 25.0
_BAR_HEIGHT: Final = 13.0
_NAMES: Final = 55.0  # baseline, from the top of the box
_LEAST: Final = 0.5  # points below which a part is not drawn
_FADED: Final = 0.35  # strength of the other parts while one is hovered
_MARGIN: Final = 6.0  # of the sheet around the box


class RewardPiece(NamedTuple):
    """Place of a part in the bar, in points."""

    name: str
    value: float
    left: float
    right: float
    colour: Colour


class RewardBar:
    """Bar of the reward's parts: positive parts to the right of zero, negative ones to the left.

    A mark stands at the sum. Hovering a part explains it.
    """

    def __init__(self, box: pygame.typing.RectLike) -> None:
        self.box = pygame.FRect(box)
        self._parts: dict[str, float] = {}
        self._lines = plotting.grid(-1.0, 1.0)
        self._pointer: Point | None = None
        self._cache = PaintCache()

    def set(self, names: Sequence[str], values: npt.ArrayLike) -> None:
        """Set the reward of each part, per flight; a value that is not finite counts as 0."""
        numbers = np.nan_to_num(np.array(values, float).ravel(), nan=0.0, posinf=0.0, neginf=0.0)
        before, self._parts = self._parts, dict(zip(names, numbers.tolist(), strict=False))
        low, high = float(numbers[numbers < 0].sum()), float(numbers[numbers > 0].sum())
        if low or high:
            fresh = self._parts.keys() != before.keys() or not any(before.values())
            self._lines = plotting.steady_grid((low, high), None if fresh else self._lines)

    def hover(self, point: Point | None) -> None:
        """Highlight the part under a point of the canvas; None for none."""
        self._pointer = point

    def _across(self, value: float) -> float:
        low, high = min(float(self._lines[0]), 0.0), max(float(self._lines[-1]), 0.0)
        return float(self.box.x + self.box.width * (value - low) / (high - low))

    def pieces(self) -> list[RewardPiece]:
        """Return the parts at their places: outwards from zero, always in the same order."""
        sums = {False: 0.0, True: 0.0}
        pieces = []
        for name, value in self._parts.items():
            start = sums[value > 0]
            sums[value > 0] = end = start + value
            left, right = sorted((self._across(start), self._across(end)))
            pieces.append(RewardPiece(name, value, left, right, PART_COLOURS[name]))
        return pieces

    def piece_at(self, point: Point) -> RewardPiece | None:
        """Return the part under a point of the canvas."""
        if not self.box.collidepoint(point):
            return None
        near = [piece for piece in self.pieces() if piece.right - piece.left >= _LEAST]
        return next((piece for piece in near if piece.left <= point[0] < piece.right), None)

    def draw(self, canvas: Canvas) -> None:
        """Draw the bar."""
        pieces = self.pieces()
        hovered = self.piece_at(self._pointer) if self._pointer else None
        box = self.box.inflate(2 * _MARGIN, 2 * _MARGIN)
        shows = tuple(pieces), hovered and hovered.name
        self._cache.draw(canvas, box, shows, partial(self._paint, pieces=pieces, hovered=hovered))

    def _paint(self, sheet: Canvas, pieces: Sequence[RewardPiece], hovered: RewardPiece | None) -> None:
        left, right, top = _MARGIN, _MARGIN + self.box.width, _MARGIN + _BAR_TOP
        total = sum(piece.value for piece in pieces)
        title, colour = (_word(hovered.name), hovered.colour) if hovered else (texts.REWARD_BAR_LABEL, MUTE)
        sheet.text(title, (left, _MARGIN + 12), size=LABEL, colour=colour, weight="medium")
        if not any(piece.value for piece in pieces):
            middle = (left + self.box.width / 2, top + 14)
            sheet.text(texts.REWARD_BAR_EMPTY, middle, size=SMALL, colour=MUTE, align="centre", room=self.box.width)
            return
        figure, colour = (hovered.value, hovered.colour) if hovered else (total, INK)
        sheet.text(signed(figure), (right, _MARGIN + 13), size=TEXT, colour=colour, align="right", tabular=True)
        sheet.line((left, top + _BAR_HEIGHT / 2), (right, top + _BAR_HEIGHT / 2), LINE)
        for piece in pieces:
            _paint_piece(sheet, piece, self.box.x - left, top, faded=hovered is not None and hovered.name != piece.name)
        zero, mark = (self._across(value) - self.box.x + left for value in (0.0, total))
        sheet.line((zero, top - 3), (zero, top + _BAR_HEIGHT + 3), INK)
        sheet.marker("triangle_down", (mark, top - 5), 8, INK)
        if hovered:
            words = texts.REWARD_PARTS.get(hovered.name, ("", ""))[1]
            sheet.text(words, (left, _MARGIN + _NAMES), size=LABEL, colour=MUTE)
        else:
            self._paint_names(sheet, pieces)

    def _paint_names(self, sheet: Canvas, pieces: Sequence[RewardPiece]) -> None:
        """Name the parts below them, the widest first, as far as there is room."""
        taken: list[tuple[float, float]] = []
        for piece in sorted(pieces, key=lambda piece: piece.left - piece.right):
            word = _word(piece.name)
            width = sheet.text_width(word, size=LABEL - 1)
            if piece.right - piece.left < max(0.35 * width, 10.0):
                continue
            left = min(max((piece.left + piece.right - width) / 2, self.box.x), self.box.right - width)
            if all(left >= end + 8 or left + width <= start - 8 for start, end in taken):
                taken.append((left, left + width))
                where = (left - self.box.x + _MARGIN, _MARGIN + _NAMES)
                sheet.text(word, where, size=LABEL - 1, colour=piece.colour)


def signed(value: float) -> str:
    """Format a sum of rewards with its sign and no needless decimals."""
    if not math.isfinite(value):
        return "–"
    if abs(value) >= 1e4:
        return ("+" if value > 0 else "") + plotting.compact(value)
    digits = 0 if abs(value) >= 10 else 1
    text = f"{value:+.{digits}f}"
    return "0" if float(text) == 0 else text.replace("-", "−")


def _paint_piece(sheet: Canvas, piece: RewardPiece, shift: float, top: float, *, faded: bool) -> None:
    if piece.right - piece.left < _LEAST:
        return
    area = sheet.rect(piece.left - shift, top, piece.right - piece.left, _BAR_HEIGHT)
    sheet.fill(area, NIGHT0)
    if area.width > 2:  # a dark hairline between neighbours
        area.width -= 1
    sheet.fill(area, mix(NIGHT0, piece.colour, _FADED) if faded else piece.colour)


def _word(name: str) -> str:
    return texts.REWARD_PARTS.get(name, (name, ""))[0]
