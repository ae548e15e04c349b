"""The sums of a network for one digit: a patch, its sum and the answer, written out in numbers."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Final

import numpy as np
import pygame

from ai.explain.unit_sums import Place
from ai.nn import ConvolutionLayer, FullyConnectedLayer
from game.core import texts
from game.digits.cells import CellPicker
from game.digits.pictures import GREY, Numbers, framed
from game.drawing.canvas import Canvas
from game.drawing.paint_cache import PaintCache
from game.drawing.tokens import HUMAN
from game.input.controls import Command
from game.scenes.digits.sums import describe_sum, figure
from game.scenes.digits.unit_walk import UnitWalk, sentence_of
from game.ui.actions import Action

if TYPE_CHECKING:
    from ai.digits.classifier import DigitClassifier
    from ai.digits.preprocessing import Image
    from game.ui.actions import Table
    from game.ui.panel import Column, Panel

_LEAST: Final = 280.0
_READ, _GIVEN, _TILES, _SEEN = 230.0, 170.0, 76.0, 100.0  # heights of pictures
_MOST_WEIGHTS: Final = 400_000  # of a stage whose weights are shown as pictures


class SumsTab:
    """A digit (28, 28) on its way through a network.

    Attributes:
        walk: the units that are looked at, one of each stage.

    """

    def __init__(self, classifier: DigitClassifier, image: Image, build: Callable[[], None]) -> None:
        self._image, self._build = image, build
        self.walk = UnitWalk(classifier, image)
        self._seen = PaintCache()
        self._following: list[Callable[[], None]] = []  # shows the unit that is looked at in one picture

    def actions(self) -> Table:
        return [
            Action(Command.NEXT, lambda: self.choose(self.walk.number + 1), texts.PATCH_ON),
            Action(Command.PREVIOUS, lambda: self.choose(self.walk.number - 1), texts.PATCH_BACK),
        ]

    # What is looked at

    def choose(self, number: int) -> None:
        """Look at another stage."""
        if 0 <= number <= len(self.walk.stages) and number != self.walk.number:
            self.walk.choose(number)
            self._build()

    def look_at(self, place: Place) -> None:
        """Look at another unit of the stage; within one channel, the map that was looked into stays."""
        channel, stage = self.walk.channel, self.walk.stage
        same = place[2] == self.walk.place[2] and max(stage.inputs.shape[:2]) > 1
        self.walk.look_at(place)
        if same and stage.kind in ("convolution", "connected"):
            self.walk.channel = channel
        self._follow()

    def _look_into(self, channel: int) -> None:
        self.walk.look_into(channel)
        self._follow()

    def _point_at_input(self, row: int, column: int) -> None:
        """Put the window's middle on a pixel, as nearly as it goes."""
        stage = self.walk.stage
        (height, width, _), step = stage.outputs.shape, stage.window[2]
        _, _, bottom, right = stage.read_by((0, 0, 1, 1))
        at = (row - bottom // 2) // step, (column - right // 2) // step
        self.look_at((min(max(at[0], 0), height - 1), min(max(at[1], 0), width - 1), self.walk.place[2]))

    def _follow(self) -> None:
        self._stages.options = self._named_stages()
        for follow in self._following:
            follow()

    # Rows

    def describe(self, panel: Panel) -> None:
        walk = self.walk
        self._following = []
        self._stages = panel.choice("", self._named_stages(), walk.number, self.choose)
        panel.aside(sentence_of(walk))
        panel.gap()
        left, middle, right = panel.beside((30, 40, 36), least=_LEAST)
        if walk.at_answer:
            left.caption(texts.PATCH_PICTURES["digit"].format(height=28, width=28))
            left.picture(_READ, self._draw_digit)
        else:
            self._describe_read(left)
            self._describe_given(right)
        describe_sum(middle, walk)
        self._follow()

    def _named_stages(self) -> list[str]:
        """Return the name of each stage, with what the followed unit gave there."""
        names = [*(texts.PATCH_STAGES[stage.kind] for stage in self.walk.stages), texts.PATCH_STAGES["answer"]]
        values = [self.walk.value(number) for number in range(len(names))]
        figures = ["" if value is None else figure(value) for value in values]
        if values[-1] is not None:
            figures[-1] = f"{100 * values[-1]:.1f}%"
        return [f"{name} {value}".rstrip() for name, value in zip(names, figures, strict=True)]

    def _describe_read(self, column: Column) -> None:
        walk, names = self.walk, texts.PATCH_PICTURES
        stage, first = walk.stage, walk.number == 0
        height, width, count = stage.inputs.shape
        maps: Numbers = np.moveaxis(stage.inputs if first else _signed(stage.inputs), 2, 0)
        spatial = max(height, width) > 1
        if spatial:
            read = column.widget(CellPicker(self._point_at_input, _READ, *([GREY] if first else [])))
            read.stride = stage.window[2]
            label = names["digit" if first else "map"]

            def follow() -> None:
                row, across, _ = walk.place
                window = stage.read_by((row, across, row + 1, across + 1))
                words = label.format(number=walk.channel + 1, count=count, height=height, width=width)
                read.show_map(maps[walk.channel], words, window)
                read.cell = (window[0] + window[2]) // 2, (window[1] + window[3]) // 2

            self._following.append(follow)
            column.gap()
        if count > 1:
            words = names["maps" if spatial else "inputs"]
            self._tiles(column, lambda _: maps, words, self._look_into, _TILES if spatial else _READ)
        if not first:
            column.caption(names["sees"])
            column.picture(_SEEN, self._draw_digit)

    def _describe_given(self, column: Column) -> None:
        walk, stage, names = self.walk, self.walk.stage, texts.PATCH_PICTURES
        height, width, count = stage.outputs.shape
        maps: Numbers = np.moveaxis(_signed(stage.outputs), 2, 0)
        if spatial := max(height, width) > 1:
            given = column.widget(CellPicker(lambda row, at: self.look_at((row, at, walk.place[2])), _GIVEN))

            def follow() -> None:
                row, across, channel = walk.place
                words = names["map"].format(number=channel + 1, count=count, height=height, width=width)
                given.show_map(maps[channel], words, (row, across, row + 1, across + 1))
                given.cell = (row, across)

            self._following.append(follow)
            column.gap()
        filters = self._filters
        if filters(walk.channel) is not None:
            self._tiles(column, filters, names["filters"], self._turn_to)
        else:
            words = names["maps" if spatial else "scores" if walk.number == len(walk.stages) - 1 else "units"]
            self._tiles(column, lambda _: maps, words, self._turn_to, _TILES if spatial else _GIVEN)

    def _tiles(
        self,
        column: Column,
        shown: Callable[[int], Numbers | None],
        words: str,
        choose: Callable[[int], None],
        most: float = _TILES,
    ) -> None:
        """Add pictures to choose from: those of the map that is looked at, of which there are some for each map."""
        walk = self.walk
        picker = column.widget(CellPicker(lambda row, across: choose(row * picker.columns + across), most))
        known: dict[int, Numbers | None] = {}

        def follow() -> None:
            if walk.channel not in known:
                known.clear()
                known[walk.channel] = shown(walk.channel)
            if (tiles := known[walk.channel]) is not None:
                chosen = walk.channel if choose == self._look_into else walk.place[2]
                label = words.format(count=len(tiles), number=chosen + 1, digit=chosen)
                picker.show_tiles(tiles, label, chosen)

        self._following.append(follow)
        column.gap()

    def _turn_to(self, channel: int) -> None:
        self.look_at((*self.walk.place[:2], channel))

    def _filters(self, channel: int) -> Numbers | None:
        """Return each filter's weights for one map of the input, (filters, height, width); None for too many."""
        match self.walk.stage.layer:
            case ConvolutionLayer() as layer:
                return _signed(layer.kernels[:, :, channel].transpose(2, 1, 0))
            case FullyConnectedLayer() as layer:
                order = self.walk.stage.order[:, :, channel]
                if order.size * layer.weights.shape[1] <= _MOST_WEIGHTS:
                    return _signed(layer.weights[order].transpose(2, 0, 1))
        return None

    # Pictures

    def _draw_digit(self, canvas: Canvas, box: pygame.FRect) -> None:
        """Draw the digit, and which part of it the unit depends on."""
        side = min(box.size)
        self._seen.draw(canvas, (*box.topleft, side, side), side, framed(self._image))
        if not self.walk.at_answer:
            pixel, (above, beside, below, right) = side / self._image.shape[0], self.walk.field
            corner = (box.left + beside * pixel, box.top + above * pixel)
            canvas.outline((*corner, (right - beside) * pixel, (below - above) * pixel), 1, HUMAN, 1.5)


def _signed(values: Numbers) -> Numbers:
    """Return values in -1 to 1."""
    return np.asarray(values / max(float(np.abs(values).max(initial=0.0)), 1e-9), np.float32)
