"""The sums of a network for one digit: what a unit of each layer reads, its sum, and what the layer gave."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Final

import numpy as np
import pygame

from ai.explain.unit_sums import Box
from game.core import texts
from game.digits.pictures import GREY, SIGNED, Numbers, Picture
from game.drawing.canvas import Canvas
from game.drawing.tokens import HUMAN
from game.scenes.digits.map_row import MapRow
from game.scenes.digits.sums import describe_answer, describe_sum
from game.scenes.digits.unit_walk import UnitWalk, sentence_of

if TYPE_CHECKING:
    from ai.digits.classifier import DigitClassifier
    from ai.digits.preprocessing import Image
    from game.ui.panel import Column, Panel

_LEAST: Final = 280.0
_SEEN: Final = 100.0  # height of the digit


class SumsTab:
    """A digit (28, 28) on its way through a network.

    Attributes:
        walk: the units that are looked at, one of each stage.

    """

    def __init__(self, classifier: DigitClassifier, image: Image, build: Callable[[], None]) -> None:
        self._image, self._build = image, build
        self.walk = UnitWalk(classifier, image)
        self._seen = Picture()

    def choose(self, number: int) -> None:
        """Look at another stage."""
        self.walk.choose(number)
        self._build()

    def _point_at_input(self, row: int, column: int) -> None:
        """Put the window's middle on a pixel, as nearly as it goes."""
        stage = self.walk.stage
        (height, width, _), step = stage.outputs.shape, stage.window[2]
        _, _, bottom, right = stage.read_by((0, 0, 1, 1))
        at = (row - bottom // 2) // step, (column - right // 2) // step
        self.walk.look_at((min(max(at[0], 0), height - 1), min(max(at[1], 0), width - 1), self.walk.place[2]))

    # Rows

    def describe(self, panel: Panel) -> None:
        walk = self.walk
        panel.choice("", [texts.PATCH_STAGES[stage.kind] for stage in walk.stages], walk.number, self.choose)
        panel.aside(sentence_of(walk))
        panel.gap()
        left, middle, right = panel.beside((30, 40, 36), least=_LEAST)
        self._describe_read(left)
        self._describe_given(right)
        if walk.at_answer:
            describe_answer(right, walk)
        if walk.number:
            left.caption(texts.PATCH_PICTURES["digit"])
            left.picture(_SEEN, self._draw_digit)
        describe_sum(middle, walk)

    def _describe_read(self, column: Column) -> None:
        walk, stage, first = self.walk, self.walk.stage, self.walk.number == 0
        maps: Numbers = np.moveaxis(stage.inputs if first else _signed(stage.inputs), 2, 0)
        if maps[0].size == 1:
            return
        label = texts.PATCH_PICTURES["digit" if first else "map"]
        column.add(lambda cursor: cursor.caption(label.format(number=walk.channel + 1, count=len(maps))))

        def lit() -> Box:
            row, across, _ = walk.place
            return stage.read_by((row, across, row + 1, across + 1))

        column.widget(MapRow(lambda: maps[walk.channel], lit, self._point_at_input, GREY if first else SIGNED))
        column.gap()

    def _describe_given(self, column: Column) -> None:
        """Add a slider over all maps, or units, that the layer gave, and the map."""
        walk = self.walk
        maps: Numbers = np.moveaxis(_signed(walk.stage.outputs), 2, 0)
        figure = partial(_counted, len(maps))
        column.slider(texts.PATCH_GAVE, walk.place[2], (0, len(maps) - 1), self._turn_to, step=1, figure=figure)

        def lit() -> Box:
            row, across, _ = walk.place
            return row, across, row + 1, across + 1

        if maps[0].size > 1:
            column.widget(MapRow(lambda: maps[walk.place[2]], lit, lambda *at: walk.look_at((*at, walk.place[2]))))

    def _turn_to(self, channel: float) -> None:
        self.walk.look_at((*self.walk.place[:2], round(channel)))

    def _draw_digit(self, canvas: Canvas, box: pygame.FRect) -> None:
        """Draw the digit, and which part of it the unit depends on."""
        self._seen.draw(canvas, box, self._image)
        pixel, (above, beside, below, right) = min(box.size) / self._image.shape[0], self.walk.field
        corner = (box.left + beside * pixel, box.top + above * pixel)
        canvas.outline((*corner, (right - beside) * pixel, (below - above) * pixel), 1, HUMAN, 1.5)


def _counted(count: int, number: float) -> str:
    return texts.PATCH_PICTURES["units"].format(number=round(number) + 1, count=count)


def _signed(values: Numbers) -> Numbers:
    """Return values in -1 to 1."""
    return np.asarray(values / max(float(np.abs(values).max(initial=0.0)), 1e-9), np.float32)
