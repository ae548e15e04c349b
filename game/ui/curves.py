"""Drawing of a run's curve on a chart's sheet: a smoothed line over raw points, with arrows for values outside."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, NamedTuple

import numpy as np
import pygame

from game.drawing.canvas import Canvas
from game.drawing.shapes import Shape
from game.drawing.tokens import Colour
from game.ui import plotting
from game.ui.plotting import Bools, Limits, Numbers
from game.ui.series import SavedSeries

_LINE_WIDTH: Final = 1.6
_SPECK: Final = 0.55  # radius of a raw point, in points
_SPECK_ALPHA: Final = 0.5
_SMOOTHING: Final = 0.022  # smoothing radius, as a share of the width
_ROOM: Final = 0.15  # share of the vertical axis: values are clipped this far outside, so as not to distort the line
_BEYOND: Final = 0.01  # share of the vertical axis: values further outside get an arrow
_ARROWS_APART: Final = 14.0
_BLEED: Final = 3.0  # points that a line may reach out of the plot


class Axes(NamedTuple):
    """Ranges of a plot's axes: of x, of the vertical axis as shown now, and the goal that it eases to."""

    x_range: Limits
    shown: Limits
    goal: Limits

    def across(self, x: Numbers, columns: int) -> Numbers:
        """Return the pixel columns of x, as fractions."""
        start, end = self.x_range
        places: Numbers = (x - start) / (end - start) * (columns - 1)
        return places


def trace_run(run: SavedSeries, axes: Axes, columns: int) -> Numbers:
    """Return the value of a run's smoothed line in each pixel column (columns,), NaN for no line."""
    known = run.traced
    if known is not None and known[0] == (axes.x_range, axes.goal, columns):
        return known[1]
    low, high = axes.goal
    room = _ROOM * (high - low)
    heights = np.where(np.isfinite(run.y), np.clip(run.y, low - room, high + room), np.nan)
    radius = round(_SMOOTHING * columns) if run.series.smooth else 0
    values = plotting.trace(run.x, heights, axes.x_range, columns, radius)
    run.traced = (axes.x_range, axes.goal, columns), values
    return values


def paint_run(sheet: Canvas, area: pygame.Rect, run: SavedSeries, values: Numbers, axes: Axes) -> None:
    """Draw a run into an area of the sheet, in pixels; `values` is its `trace_run`."""
    colour, scale, bleed = run.series.colour, sheet.scale, sheet.px(_BLEED)
    low, high = axes.shown
    size = (area.width, area.height + 2 * bleed)
    corner = (area.x, area.y - bleed)

    def rows(of: Numbers) -> Numbers:
        row = (high - of) / (high - low) * (area.height - 1) + bleed
        clipped: Numbers = np.clip(row, -4.0 * bleed, size[1] + 4.0 * bleed)
        return clipped

    if not run.series.dash and run.series.smooth:
        shown = plotting.thinned(run.x, run.y, axes.x_range, area.width)
        columns = axes.across(run.x[shown], area.width)
        dots = plotting.specks(columns, rows(run.y[shown]), size, _SPECK * scale)
        _cover(sheet.surface, corner, colour, dots, _SPECK_ALPHA)
    heights = rows(values)
    dash = tuple(length * scale for length in run.series.dash)
    first, line = plotting.stroke(heights, size[1], _LINE_WIDTH * scale, dash)
    _cover(sheet.surface, (corner[0], corner[1] + first), colour, line)
    for column in plotting.alone(values):
        sheet.dot(((area.x + column) / scale, (corner[1] + heights[column]) / scale), _LINE_WIDTH, colour)
    _paint_arrows(sheet, area, run, axes)


class PaintedRuns:
    """Curves of the runs behind the current one, painted once and copied until any of them or the axes change."""

    def __init__(self) -> None:
        self._runs: list[SavedSeries] = []
        self._key: tuple[object, ...] = ()
        self._sheet: Canvas | None = None

    def lay(
        self, sheet: Canvas, area: pygame.Rect, runs: Sequence[SavedSeries], traces: Sequence[Numbers], axes: Axes
    ) -> None:
        """Draw runs, the last one first, with their `traces`, into an area of the sheet, in pixels."""
        if not runs:
            self._sheet = None
            return
        key = (*map(id, runs), axes, tuple(area), sheet.size, sheet.scale)
        if self._sheet is None or key != self._key:
            width, height = sheet.size
            self._runs, self._key = [*runs], key  # kept, so that no other run gets the same id
            self._sheet = sheet.sheet(width / sheet.scale, height / sheet.scale)
            for run, values in reversed(list(zip(runs, traces, strict=True))):
                paint_run(self._sheet, area, run, values, axes)
        sheet.lay(self._sheet, 0, 0)


def _paint_arrows(sheet: Canvas, area: pygame.Rect, run: SavedSeries, axes: Axes) -> None:
    """Draw arrows for values beyond the chart, also for a single one that smoothing hides."""
    (low, high), (start, end) = axes.goal, axes.x_range
    slack = _BEYOND * (high - low)
    shown = (run.x >= start) & (run.x <= end)
    at, y, scale = run.x[shown], run.y[shown], sheet.scale
    above: tuple[Shape, Bools, int] = ("triangle", y > high + slack, area.top)
    below: tuple[Shape, Bools, int] = ("triangle_down", y < low - slack, area.bottom)
    for shape, beyond, row in (above, below):
        if beyond.any():
            places = (area.x + axes.across(at, area.width)) / scale
            for x in plotting.starts(beyond, places, _ARROWS_APART):
                sheet.marker(shape, (x, row / scale), 8, run.series.colour)


def _cover(
    surface: pygame.Surface, corner: tuple[int, int], colour: Colour, cover: Numbers, alpha: float = 1.0
) -> None:
    """Blend a colour onto a surface with the coverage (rows, columns)."""
    rows, columns = cover.shape
    layer = pygame.Surface((columns, rows), pygame.SRCALPHA)
    layer.fill((*colour, 0))
    pixels = pygame.surfarray.pixels_alpha(layer)
    pixels.T[...] = np.multiply(cover, 255 * alpha, dtype=np.float32)
    del pixels
    surface.blit(layer, corner)
