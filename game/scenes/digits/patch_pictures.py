"""Pictures around a unit's sum: what its stage reads on the left, its filters and what it gives on the right."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np

from ai.explain.unit_sums import Place
from ai.nn import ConvolutionLayer, FullyConnectedLayer
from game.core import texts
from game.digits.pictures import GREY, SIGNED, Numbers, picture
from game.drawing.canvas import Canvas
from game.drawing.paint_cache import PaintCache
from game.drawing.tokens import HUMAN, LABEL, LINE, MUTE
from game.scenes.digits.pickers import CellPicker, MapPicker, TilesPicker
from game.scenes.digits.unit_walk import UnitWalk
from game.ui.widget import PointsManager

_TOP: Final = 176
_READS: Final = (40, _TOP, 320, 320)
_READ_MAPS: Final = (40, 522, 320, 112)
_GIVES: Final = (844, _TOP, 240, 240)
_FILTERS: Final = (844, 448, 396, 76)
_GIVEN_MAPS: Final = (844, 558, 396, 76)
_SEES: Final = (1108, _TOP, 132)
_MOST_WEIGHTS: Final = 400_000  # of a stage whose weights are shown as pictures


class PatchPictures:
    """Pickers of one stage, those on the right only where no code is shown.

    `on_touch` is called before the player's choice changes what is looked at.

    Attributes:
        pickers: the widgets, from left to right.

    """

    def __init__(
        self,
        manager: PointsManager,
        walk: UnitWalk,
        image: Numbers,
        on_touch: Callable[[], None],
        *,
        in_code: bool = False,
    ) -> None:
        self._walk, self._image, self._touch, self._in_code = walk, image, on_touch, in_code
        self._seen = PaintCache()
        self._reads: MapPicker | None = None
        self._read_maps: TilesPicker | None = None
        self._gives: MapPicker | None = None
        self._filters: TilesPicker | None = None
        self._given_maps: TilesPicker | None = None
        if not walk.at_answer:
            self._add_left(manager)
            if not in_code:
                self._add_right(manager)
        row: list[CellPicker | None] = [
            self._reads, self._read_maps, self._gives, self._filters, self._given_maps,
        ]  # fmt: skip
        self.pickers: list[CellPicker] = [picker for picker in row if picker is not None]
        self.follow()

    def _add_left(self, manager: PointsManager) -> None:
        """Add what the stage reads."""
        inputs, first = self._walk.stage.inputs, self._walk.number == 0
        tiles = np.moveaxis(inputs if first else _signed(inputs), 2, 0)
        self._inputs = list(tiles)
        spatial = max(inputs.shape[:2]) > 1
        if spatial:
            self._reads = MapPicker(manager, _READS, "", self._point_at_input, GREY if first else SIGNED)
        if len(tiles) > 1:
            room = _READ_MAPS if spatial else _READS
            self._read_maps = TilesPicker(manager, room, "", tiles, self._look_into)

    def _add_right(self, manager: PointsManager) -> None:
        """Add what the stage gives, and its filters."""
        stage, channel = self._walk.stage, self._walk.channel
        tiles = np.moveaxis(_signed(stage.outputs), 2, 0)
        self._outputs, room = list(tiles), _GIVES
        if max(stage.outputs.shape[:2]) > 1:
            self._gives, room = MapPicker(manager, _GIVES, "", self._point_at_output, SIGNED), _GIVEN_MAPS
        weights, self._weights_of = self._filters_of(channel), channel
        if weights is not None:
            self._filters = TilesPicker(manager, _FILTERS, "", weights, self._choose_map)
        elif self._gives:
            room = _FILTERS
        self._given_maps = TilesPicker(manager, room, "", tiles, self._choose_map)

    def follow(self) -> None:
        """Show the unit that is looked at now."""
        walk = self._walk
        if walk.at_answer:
            return
        row, column, channel = walk.place
        inputs, outputs = walk.stage.inputs, walk.stage.outputs
        height, width, count = inputs.shape
        names = texts.PATCH_PICTURES
        if self._reads:
            name = names["digit" if walk.number == 0 else "map"]
            window = walk.stage.read_by((row, column, row + 1, column + 1))
            label = name.format(number=walk.channel + 1, count=count, height=height, width=width)
            self._reads.show_map(self._inputs[walk.channel], label, window)
            self._reads.cell = (window[0] + window[2]) // 2, (window[1] + window[3]) // 2
            self._reads.stride = self._step
        if self._read_maps:
            name = names["maps" if max(height, width) > 1 else "inputs"]
            self._read_maps.show_tiles(walk.channel, name.format(count=count, number=walk.channel + 1))
        height, width, count = outputs.shape
        if self._gives:
            label = names["map"].format(number=channel + 1, count=count, height=height, width=width)
            self._gives.show_map(self._outputs[channel], label, (row, column, row + 1, column + 1))
            self._gives.cell = (row, column)
        if self._filters:
            anew = None
            if self._weights_of != walk.channel:
                self._weights_of, anew = walk.channel, self._filters_of(walk.channel)
            self._filters.show_tiles(channel, names["filters"].format(count=count, number=channel + 1), anew)
        if self._given_maps:
            last = walk.number == len(walk.stages) - 1
            name = names["maps" if self._gives else "scores" if last else "units"]
            self._given_maps.show_tiles(channel, name.format(count=count, number=channel + 1, digit=channel))

    def draw(self, canvas: Canvas) -> None:
        """Draw what the unit sees of the digit; the pickers are drawn by their form."""
        walk = self._walk
        if walk.number and not (self._in_code and not walk.at_answer):
            left, top, size = (*_READS[:2], _READS[2]) if walk.at_answer else _SEES
            shows = (id(self), size)
            self._seen.draw(canvas, (left, top, size, size), shows, lambda sheet: self._paint_digit(sheet, size))
            pixel = size / self._image.shape[0]
            above, beside, below, right = walk.field
            box = (left + beside * pixel, top + above * pixel, (right - beside) * pixel, (below - above) * pixel)
            if not walk.at_answer:
                canvas.outline(box, 1, HUMAN, 1.5)
            words = texts.PATCH_PICTURES["digit" if walk.at_answer else "sees"].format(height=28, width=28)
            canvas.text(words, (left, top - 10), size=LABEL, colour=MUTE, weight="medium", room=size)

    def _paint_digit(self, sheet: Canvas, size: float) -> None:
        area = sheet.rect(0, 0, size, size)
        sheet.surface.blit(picture(self._image, area.size), area)
        sheet.outline((0, 0, size, size), 0, LINE)

    def _filters_of(self, channel: int) -> Numbers | None:
        """Return each filter's weights for one map of the input, (filters, height, width); None for too many."""
        match self._walk.stage.layer:
            case ConvolutionLayer() as layer:
                weights = layer.kernels[:, :, channel].transpose(2, 1, 0)
            case FullyConnectedLayer() as layer:
                order = self._walk.stage.order[:, :, channel]
                if order.size * layer.weights.shape[1] > _MOST_WEIGHTS:
                    return None
                weights = layer.weights[order].transpose(2, 0, 1)
            case _:
                return None
        return _signed(weights)

    # What is pointed at

    def _look_at(self, place: Place) -> None:
        self._touch()
        channel, stage = self._walk.channel, self._walk.stage
        self._walk.look_at(place)
        if stage.kind in ("convolution", "connected") and place[2] == self._walk.place[2] and self._reads:
            self._walk.channel = channel  # the map that was looked into stays
        self.follow()

    def _point_at_output(self, row: int, column: int) -> None:
        self._look_at((row, column, self._walk.place[2]))

    def _choose_map(self, channel: int) -> None:
        self._look_at((*self._walk.place[:2], channel))

    def _look_into(self, channel: int) -> None:
        self._touch()
        self._walk.look_into(channel)
        self.follow()

    def _point_at_input(self, row: int, column: int) -> None:
        """Put the window's middle on a pixel, as nearly as it goes."""
        stage, step = self._walk.stage, self._step
        height, width, _ = stage.outputs.shape
        _, _, bottom, right = stage.read_by((0, 0, 1, 1))
        at = (row - bottom // 2) // step, (column - right // 2) // step
        self._look_at((min(max(at[0], 0), height - 1), min(max(at[1], 0), width - 1), self._walk.place[2]))

    @property
    def _step(self) -> int:
        """Pixels of the input from one window to the next."""
        return self._walk.stage.window[2]


def _signed(values: Numbers) -> Numbers:
    """Return values in -1 to 1."""
    return np.asarray(values / max(float(np.abs(values).max(initial=0.0)), 1e-9), np.float32)
