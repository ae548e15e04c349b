"""Explanation of a reading: preprocessing stages, saliency map, filters, and feature maps of each layer."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np
import pygame

from ai.digits.preprocessing import SIDE, Image
from game.core import texts
from game.digits.pictures import AMBER, height_of, mosaic, picture
from game.drawing.canvas import Canvas
from game.drawing.tokens import HUMAN, INK, LABEL, LINE, MUTE, NET, NIGHT0, Colour
from game.scenes.digits.answer import best_two
from game.scenes.digits.reader import Explanation, Numbers, Reading, Verdict
from game.ui.widget import PointsManager
from game.ui.widgets import Toggle, draw_switch

LEFT: Final = 900.0
RIGHT: Final = 1244.0
STEPS: Final = ("crop", "fit", "width", "centre")  # each turns one stage into the next
_TILE: Final = 62.0
_PITCH: Final = (RIGHT - LEFT - _TILE) / len(STEPS)
_TILES_TOP: Final = 58.0
_SWITCH: Final = 26.0, 13.0
_WHY: Final = (LEFT, 240.0, 132.0)
_FILTERS: Final = (LEFT + 160, 240.0)
_MAPS_TOP: Final = 426.0
_MAPS_BOTTOM: Final = 704.0  # layers of a large network that would reach below it are left out
_GAP: Final = 3.0


class StageSwitch(Toggle):
    """Switch for one preprocessing step, under the picture of that step's result."""

    def __init__(self, manager: PointsManager, number: int, on_change: Callable[[bool], None]) -> None:
        left = LEFT + (number + 1) * _PITCH
        box = (round(left), round(_TILES_TOP + _TILE + 22), round(_TILE), 20)
        super().__init__(manager, box, texts.DIGITS_STAGES[number + 1], True, on_change)

    def paint(self, canvas: Canvas) -> None:
        """Draw the switch without a label, since its name stands above."""
        if self.ringed and self.warmth > 0.02:
            canvas.outline(self.box.inflate(0, 4), 8, INK, 1, 0.4 * self.warmth)
        (width, height), box = _SWITCH, self.box
        draw_switch(canvas, (box.centerx - width / 2, box.centery - height / 2, width, height), self._slid)


class ExplanationView:
    """View of a reading and its explanation; its pictures are cached until these change."""

    def __init__(self) -> None:
        self._read: tuple[Reading | None, float] = None, 0.0  # reading and scale for which the pictures were made
        self._explained: tuple[Explanation | None, float] = None, 0.0
        self._stages: list[pygame.Surface] = []
        self._saliency = self._filters = pygame.Surface((1, 1))
        self._layers: list[pygame.Surface] = []

    def draw(
        self,
        canvas: Canvas,
        reading: Reading,
        name: str,
        why: Explanation | None,
        steps: list[bool],
        *,
        aside: bool = False,
    ) -> None:
        """Draw the explanation; `steps` says which preprocessing steps are on.

        With `aside`, saliency and filters make room for something else.
        """
        if self._read != (reading, canvas.scale):
            self._read = reading, canvas.scale
            self._stages = [_fitted(image, canvas.px(_TILE)) for image in reading.stages]
        if self._explained != (why, canvas.scale):
            self._explained = why, canvas.scale
            self._build(canvas, why)
        self._draw_stages(canvas, steps)
        if why is None:
            return
        if not aside:
            self._draw_why(canvas, reading, name)
            self._draw_filters(canvas, why)
        self._draw_layers(canvas, why)

    def _build(self, canvas: Canvas, why: Explanation | None) -> None:
        if why is None:
            return
        size = canvas.px(_WHY[2])
        self._saliency = picture(why.saliency, (size, size), AMBER)
        self._filters = _mosaic(canvas, why.filters, 8, RIGHT - _FILTERS[0], _GAP)
        self._layers = [_layer(canvas, layer) for layer in why.layers]

    def _draw_stages(self, canvas: Canvas, steps: list[bool]) -> None:
        _label(canvas, texts.DIGITS_SEES, (LEFT, 42))
        for number, (picture_of, words) in enumerate(zip(self._stages, texts.DIGITS_STAGES, strict=True)):
            left = LEFT + number * _PITCH
            taken = number == 0 or steps[number - 1]
            area = canvas.rect(left, _TILES_TOP, _TILE, _TILE)
            picture_of.set_alpha(None if taken else 90)  # an alpha of 255 would take forty times as long
            canvas.surface.blit(picture_of, area)
            pygame.draw.rect(canvas.surface, LINE, area, 1)
            colour = INK if number == len(STEPS) else MUTE
            canvas.text(words, (left + _TILE / 2, _TILES_TOP + _TILE + 16), size=LABEL, colour=colour, align="centre",
                        alpha=1.0 if taken else 0.5)  # fmt: skip

    def _draw_why(self, canvas: Canvas, reading: Reading, name: str) -> None:
        left, top, size = _WHY
        canvas.surface.blit(self._saliency, (canvas.px(left), canvas.px(top)))
        if reading.verdict(name) is Verdict.EMPTY:
            _label(canvas, texts.DIGITS_WHY_EMPTY, (left, top - 12))
            return
        first, second = best_two(reading.probabilities[name])
        _label(canvas, texts.DIGITS_WHY.format(digit=first, other=second), (left, top - 12))
        _legend(canvas, texts.DIGITS_WHY_LEGEND, (HUMAN, MUTE), (left, top + size + 17))

    def _draw_filters(self, canvas: Canvas, why: Explanation) -> None:
        left, top = _FILTERS
        _label(canvas, texts.DIGITS_FILTERS[why.filters.shape[1] == SIDE], (left, top - 12))
        canvas.surface.blit(self._filters, (canvas.px(left), canvas.px(top)))
        below = top + self._filters.get_height() / canvas.scale
        _legend(canvas, texts.DIGITS_FILTERS_LEGEND, (NET, canvas.palette.warn), (left, below + 17))

    def _draw_layers(self, canvas: Canvas, why: Explanation) -> None:
        top = _MAPS_TOP
        for number, (layer, surface) in enumerate(zip(why.layers, self._layers, strict=True), 1):
            if layer.ndim == 3:
                count, height, width = layer.shape
                words = texts.DIGITS_MAPS.format(number=number, count=count, height=height, width=width)
            else:
                words = texts.DIGITS_UNITS.format(number=number, count=len(layer))
            if top + 10 + surface.get_height() / canvas.scale > _MAPS_BOTTOM:
                return
            _label(canvas, words, (LEFT, top))
            canvas.surface.blit(surface, (canvas.px(LEFT), canvas.px(top + 10)))
            top += 10 + surface.get_height() / canvas.scale + 28


def _label(canvas: Canvas, words: str, place: tuple[float, float]) -> None:
    canvas.text(words, place, size=LABEL, colour=MUTE, weight="medium", room=RIGHT + 24 - place[0])


def _legend(canvas: Canvas, words: tuple[str, ...], colours: tuple[Colour, ...], place: tuple[float, float]) -> None:
    x, y = place
    for word, colour in zip(words, colours, strict=True):
        canvas.rounded((x, y - 7, 7, 7), 1.5, colour)
        x += 12 + canvas.text(word, (x + 12, y), size=LABEL, colour=MUTE).width + 12


def _layer(canvas: Canvas, layer: Numbers) -> pygame.Surface:
    width = RIGHT - LEFT
    if layer.ndim == 3:
        return _mosaic(canvas, layer, 11 if len(layer) <= 33 else 32, width, _GAP)
    return _mosaic(canvas, layer[:, None, None], 50 if len(layer) % 50 == 0 else 64, width, _GAP / 2)


def _mosaic(canvas: Canvas, tiles: Numbers, columns: int, width: float, gap: float) -> pygame.Surface:
    """Return a mosaic of tiles that fills a width in points."""
    columns = min(columns, len(tiles))
    height = height_of(len(tiles), columns, (tiles.shape[1], tiles.shape[2]), width, gap)
    return mosaic(tiles, columns, (canvas.px(width), canvas.px(height)), gap * canvas.scale)


def _fitted(image: Image, side: int) -> pygame.Surface:
    """Return an image of any shape fitted into a square; small images keep sharp pixels."""
    coarse = max(image.shape) // side
    if coarse > 1:
        rows, columns = (max(1, length // coarse) for length in image.shape)
        part = np.pad(image, [(0, max(0, coarse - length)) for length in image.shape])
        part = part[: rows * coarse, : columns * coarse].reshape(rows, coarse, -1).mean(axis=1)
        image = part.reshape(rows, columns, coarse) @ np.full(coarse, 1 / coarse, np.float32)
    height, width = image.shape
    scale = side / max(height, width)
    size = (max(1, round(width * scale)), max(1, round(height * scale)))
    surface = pygame.Surface((side, side))
    surface.fill(NIGHT0)
    surface.blit(picture(image, size), ((side - size[0]) // 2, (side - size[1]) // 2))
    return surface
