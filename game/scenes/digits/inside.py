"""Inside scene: one digit on its way through a network, a patch, its sums and the answer, written out in numbers."""

from __future__ import annotations

from contextlib import suppress
from typing import TYPE_CHECKING, Final

import numpy as np
import pygame

from ai.digits.mnist import MnistError, bright
from ai.explain.excited import MostExciting
from ai.explain.unit_sums import Place
from ai.nn import ConvolutionLayer, FullyConnectedLayer
from game.core import texts
from game.core.scene import Replace, Route, Transition
from game.digits.cells import CellPicker
from game.digits.kept import mnist_test
from game.digits.pictures import GREY, SIGNED, Numbers, framed
from game.drawing.canvas import Canvas
from game.drawing.paint_cache import PaintCache
from game.drawing.tokens import HUMAN, TITLE
from game.input.controls import Command
from game.scenes.digits.sums import describe_sum, figure
from game.scenes.digits.unit_walk import UnitWalk, sentence_of
from game.ui.actions import Action, Table
from game.ui.context import Context
from game.ui.panel import Column, Panel
from game.ui.panel_scene import PanelScene

if TYPE_CHECKING:
    from ai.digits.classifier import DigitClassifier
    from ai.digits.preprocessing import Image

_LEAST: Final = 280.0
_READ, _GIVEN, _TILES, _SEEN = 250.0, 170.0, 76.0, 110.0  # heights of pictures
_SEARCHED: Final = 400  # digits of other people
_MOST_WEIGHTS: Final = 400_000  # of a stage whose weights are shown as pictures


class DigitInsideScene(PanelScene):
    """A digit (28, 28) on its way through a network.

    Attributes:
        walk: the units that are looked at, one of each stage.

    """

    def __init__(self, context: Context, classifier: DigitClassifier, image: Image) -> None:
        super().__init__(context)
        self._classifier, self._image = classifier, np.asarray(image, np.float32)
        self.walk = UnitWalk(classifier, self._image)
        self._seen, self._exciting = PaintCache(), PaintCache()
        self._digits = np.empty((0, 28, 28), np.float32)  # of other people, in which is searched what excites a filter
        with suppress(MnistError):  # without them the picture is left out
            self._digits = bright(mnist_test(context.assets_dir)[0][:_SEARCHED])
        self._searches: dict[int, MostExciting] = {}
        self.build()

    def actions(self) -> Table:
        return [
            Action(Command.NEXT, lambda: self._choose(self.walk.number + 1), texts.PATCH_ON),
            Action(Command.PREVIOUS, lambda: self._choose(self.walk.number - 1), texts.PATCH_BACK),
            self.form.goes_back(texts.HINT_BACK),
        ]

    def update(self) -> Transition | None:
        """Search on for what excites the filters that are shown, a part per frame."""
        walk = self.walk
        if walk.stage.kind == "convolution" and not walk.at_answer and len(self._digits):
            if walk.number not in self._searches:
                before = walk.stages[: walk.number + 1]
                self._searches[walk.number] = MostExciting(self._classifier.network, before, self._digits)
            if not self._searches[walk.number].done:
                self._searches[walk.number].go_on()
        return super().update()

    # What is looked at

    def _choose(self, number: int) -> None:
        if 0 <= number <= len(self.walk.stages) and number != self.walk.number:
            self.walk.choose(number)
            self.build()

    def _look_at(self, place: Place) -> None:
        channel, stage = self.walk.channel, self.walk.stage
        self.walk.look_at(place)
        if stage.kind in ("convolution", "connected") and place[2] == self.walk.place[2] and self._reads:
            self.walk.channel = channel  # the map that was looked into stays
        self._follow()

    def _look_into(self, row: int, column: int) -> None:
        assert self._read_maps
        self.walk.look_into(row * self._read_maps.columns + column)
        self._follow()

    def _point_at_input(self, row: int, column: int) -> None:
        """Put the window's middle on a pixel, as nearly as it goes."""
        stage, step = self.walk.stage, self._step
        height, width, _ = stage.outputs.shape
        _, _, bottom, right = stage.read_by((0, 0, 1, 1))
        at = (row - bottom // 2) // step, (column - right // 2) // step
        self._look_at((min(max(at[0], 0), height - 1), min(max(at[1], 0), width - 1), self.walk.place[2]))

    def _map_of(self, row: int, column: int, picker: CellPicker) -> None:
        self._look_at((*self.walk.place[:2], row * picker.columns + column))

    @property
    def _step(self) -> int:
        """Pixels of the input from one window to the next."""
        return self.walk.stage.window[2]

    # Rows

    def describe(self, panel: Panel) -> None:
        self._reads: CellPicker | None = None
        self._read_maps: CellPicker | None = None
        self._gives: CellPicker | None = None
        self._filters: CellPicker | None = None
        self._given_maps: CellPicker | None = None
        walk = self.walk
        panel.text(texts.PATCH_TITLE, size=TITLE)
        self._tabs = panel.choice("", self._stages(), walk.number, self._choose)
        panel.aside(sentence_of(walk))
        panel.gap()
        left, middle, right = panel.beside((30, 40, 36), least=_LEAST)
        if walk.at_answer:
            left.caption(texts.PATCH_PICTURES["digit"].format(height=28, width=28))
            left.picture(_READ, self._draw_digit)
        else:
            self._describe_read(left)
        describe_sum(middle, walk)
        if not walk.at_answer:
            self._describe_given(right)
        right.words([(texts.WHY_NOT_WORD, lambda: Replace(Route("why_not", (self._classifier, self._image))))])
        self._follow()

    def _stages(self) -> list[str]:
        """Return the name of each stage, with what the followed unit gave there."""
        names = [*(texts.PATCH_STAGES[stage.kind] for stage in self.walk.stages), texts.PATCH_STAGES["answer"]]
        values = [self.walk.value(number) for number in range(len(names))]
        figures = ["" if value is None else figure(value) for value in values]
        if values[-1] is not None:
            figures[-1] = f"{100 * values[-1]:.1f}%"
        return [f"{name} {value}".rstrip() for name, value in zip(names, figures, strict=True)]

    def _describe_read(self, column: Column) -> None:
        inputs, first = self.walk.stage.inputs, self.walk.number == 0
        self._inputs: Numbers = np.moveaxis(inputs if first else _signed(inputs), 2, 0)
        spatial = max(inputs.shape[:2]) > 1
        if spatial:
            shades = GREY if first else SIGNED
            self._reads = column.widget(CellPicker(self._point_at_input, _READ, shades))
            column.gap()
        if len(self._inputs) > 1:
            most = _TILES if spatial else _READ
            self._read_maps = column.widget(CellPicker(self._look_into, most))
            column.gap()
        if not first:
            column.caption(texts.PATCH_PICTURES["sees"])
            column.picture(_SEEN, self._draw_digit)

    def _describe_given(self, column: Column) -> None:
        stage = self.walk.stage
        self._outputs: Numbers = np.moveaxis(_signed(stage.outputs), 2, 0)
        if max(stage.outputs.shape[:2]) > 1:
            picker = CellPicker(lambda row, across: self._look_at((row, across, self.walk.place[2])), _GIVEN)
            self._gives = column.widget(picker)
            column.gap()
        if (weights := self._filters_of(self.walk.channel)) is not None:
            self._weights, self._weights_of = weights, self.walk.channel
            self._filters = self._tiles(column)
            column.gap()
        if stage.kind == "convolution" and len(self._digits):
            column.caption(texts.PATCH_PICTURES["excites"])
            column.picture(_SEEN, self._draw_exciting)
            column.gap()
        self._given_maps = self._tiles(column, _TILES if self._gives else _GIVEN)

    def _tiles(self, column: Column, most: float = _TILES) -> CellPicker:
        picker = CellPicker(lambda row, across: self._map_of(row, across, picker), most)
        return column.widget(picker)

    def _follow(self) -> None:
        """Show the unit that is looked at now."""
        walk, names = self.walk, texts.PATCH_PICTURES
        self._tabs.options = self._stages()
        if walk.at_answer:
            return
        (row, column, channel), stage = walk.place, walk.stage
        height, width, count = stage.inputs.shape
        if self._reads:
            window = stage.read_by((row, column, row + 1, column + 1))
            name = names["map" if walk.number else "digit"]
            label = name.format(number=walk.channel + 1, count=count, height=height, width=width)
            self._reads.show_map(self._inputs[walk.channel], label, window)
            self._reads.cell = (window[0] + window[2]) // 2, (window[1] + window[3]) // 2
            self._reads.stride = self._step
        if self._read_maps:
            name = names["maps" if max(height, width) > 1 else "inputs"]
            label = name.format(count=count, number=walk.channel + 1)
            self._read_maps.show_tiles(self._inputs, label, walk.channel)
        height, width, count = stage.outputs.shape
        if self._gives:
            label = names["map"].format(number=channel + 1, count=count, height=height, width=width)
            self._gives.show_map(self._outputs[channel], label, (row, column, row + 1, column + 1))
            self._gives.cell = (row, column)
        if self._filters:
            if self._weights_of != walk.channel and (weights := self._filters_of(walk.channel)) is not None:
                self._weights, self._weights_of = weights, walk.channel
            self._filters.show_tiles(self._weights, names["filters"].format(count=count), channel)
        if self._given_maps:
            last = walk.number == len(walk.stages) - 1
            name = names["maps" if self._gives else "scores" if last else "units"]
            label = name.format(count=count, number=channel + 1, digit=channel)
            self._given_maps.show_tiles(self._outputs, label, channel)

    def _filters_of(self, channel: int) -> Numbers | None:
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

    def _draw_exciting(self, canvas: Canvas, box: pygame.FRect) -> None:
        """Draw the ink that excites the filter most, of what was searched so far."""
        search, channel, side = self._searches.get(self.walk.number), self.walk.place[2], min(box.size)
        if search and channel in search.patches:
            patch = search.patches[channel]
            self._exciting.draw(canvas, (*box.topleft, side, side), patch.tobytes(), framed(patch))


def _signed(values: Numbers) -> Numbers:
    """Return values in -1 to 1."""
    return np.asarray(values / max(float(np.abs(values).max(initial=0.0)), 1e-9), np.float32)
