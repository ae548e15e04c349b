"""Curves of a chart: the numbers of runs, how they are drawn on its sheet, and ticks for special moments.

A curve is a smoothed line over raw points, with arrows for values outside.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, Literal, NamedTuple

import numpy as np
import numpy.typing as npt
import pygame

from game.drawing.canvas import Canvas
from game.drawing.shapes import Shape
from game.drawing.tokens import FAINT, HUMAN, NET, Colour
from game.ui import plotting
from game.ui.plotting import Bools, Limits, Numbers

_LINE_WIDTH: Final = 1.6
_SPECK: Final = 0.55  # radius of a raw point, in points
_SPECK_ALPHA: Final = 0.5
_SMOOTHING: Final = 0.022  # smoothing radius, as a share of the width
_ROOM: Final = 0.15  # share of the vertical axis: values are clipped this far outside, so as not to distort the line
_BEYOND: Final = 0.01  # share of the vertical axis: values further outside get an arrow
_ARROWS_APART: Final = 14.0
_BLEED: Final = 3.0  # points that a line may reach out of the plot
_TICK_SPACING: Final = 4.0  # points

# Blue is the current run; one beside it differs in colour and in dashes, for eyes of every kind.
RUN_STYLES: Final[tuple[tuple[Colour, tuple[float, ...]], ...]] = ((NET, ()), ((236, 140, 190), (7.0, 5.0)))


class Series:
    """Curve of one run, with its own copy of the numbers, so that later changes of the arrays do not matter.

    Args:
        x: (n,) rising; points with a value that is not finite are left out.
        y: (n,) values; a value that is not finite makes a gap.
        name: of the run.
        colour: of the line.
        dash: on, off, ... in points; empty for a solid line, which also shows its raw points.
        smooth: whether the line is smoothed; not for data without noise.

    """

    def __init__(
        self,
        x: npt.ArrayLike,
        y: npt.ArrayLike,
        name: str,
        colour: Colour = NET,
        dash: tuple[float, ...] = (),
        smooth: bool = True,
    ) -> None:
        places, values = np.asarray(x, float).ravel(), np.asarray(y, float).ravel()
        places, values = places[: len(values)], values[: len(places)]
        self.x: Numbers = places[np.isfinite(places)]  # a copy
        self.y: Numbers = values[np.isfinite(places)]
        self.name, self.colour, self.dash, self.smooth = name, colour, dash, smooth

    def logarithmic(self) -> Series:
        """Return it for a logarithmic axis: the logarithms to base 10; a value that is not positive makes a gap."""
        heights = np.log10(np.where(self.y > 0, self.y, np.nan))
        return Series(self.x, heights, self.name, self.colour, self.dash, self.smooth)

    def same(self, other: Series) -> bool:
        alike = (self.name, self.colour, self.dash, self.smooth) == (other.name, other.colour, other.dash, other.smooth)
        return alike and np.array_equal(self.x, other.x) and np.array_equal(self.y, other.y, equal_nan=True)

    def within(self, x_range: Limits) -> Numbers:
        """Return the values of a part of the x axis."""
        values: Numbers = self.y[(self.x >= x_range[0]) & (self.x <= x_range[1])]
        return values

    def nearest(self, x: float, slack: float) -> tuple[float, float] | None:
        """Return the finite point nearest to x; None if x lies more than `slack` outside the run."""
        finite = np.isfinite(self.y)
        at, y = self.x[finite], self.y[finite]
        if not len(at) or not at[0] - slack <= x <= at[-1] + slack:
            return None
        index = int(np.abs(at - x).argmin())
        return float(at[index]), float(y[index])

    def last(self) -> float | None:
        """Return the latest finite value."""
        finite = np.flatnonzero(np.isfinite(self.y))
        return float(self.y[finite[-1]]) if len(finite) else None


@dataclass(frozen=True)
class Tick:
    """Mark below the chart for a moment: a checkpoint, or a knob that was turned."""

    x: float
    text: str
    kind: Literal["checkpoint", "knob"] = "checkpoint"


def paint_ticks(sheet: Canvas, plot: pygame.FRect, ticks: Sequence[Tick], x_range: Limits) -> None:
    """Draw the ticks of the shown part of the x axis below a plot, of those too close together only the first."""
    start, end = x_range
    last, top, height = -math.inf, sheet.px(plot.bottom + 2), sheet.px(3)
    for tick in ticks:
        if not start <= tick.x <= end:
            continue
        x = plot.x + min(max((tick.x - start) / (end - start), 0.0), 1.0) * plot.width
        if tick.kind == "knob":
            sheet.marker("diamond", (x, plot.bottom), 8, HUMAN)
        elif x - last >= _TICK_SPACING:
            sheet.surface.fill(FAINT, (sheet.px(x), top, max(1, sheet.px(1)), height))
            last = x


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


def trace_run(run: Series, axes: Axes, columns: int) -> Numbers:
    """Return the value of a run's smoothed line in each pixel column (columns,), NaN for no line."""
    low, high = axes.goal
    room = _ROOM * (high - low)
    heights = np.where(np.isfinite(run.y), np.clip(run.y, low - room, high + room), np.nan)
    return plotting.trace(run.x, heights, axes.x_range, columns, round(_SMOOTHING * columns) if run.smooth else 0)


def paint_run(sheet: Canvas, area: pygame.Rect, run: Series, values: Numbers, axes: Axes) -> None:
    """Draw a run into an area of the sheet, in pixels; `values` is its `trace_run`."""
    colour, scale, bleed = run.colour, sheet.scale, sheet.px(_BLEED)
    low, high = axes.shown
    size = (area.width, area.height + 2 * bleed)
    corner = (area.x, area.y - bleed)

    def rows(of: Numbers) -> Numbers:
        row = (high - of) / (high - low) * (area.height - 1) + bleed
        clipped: Numbers = np.clip(row, -4.0 * bleed, size[1] + 4.0 * bleed)
        return clipped

    if not run.dash and run.smooth:
        shown = plotting.thinned(run.x, run.y, axes.x_range, area.width)
        columns = axes.across(run.x[shown], area.width)
        dots = plotting.specks(columns, rows(run.y[shown]), size, _SPECK * scale)
        _cover(sheet.surface, corner, colour, dots, _SPECK_ALPHA)
    heights = rows(values)
    dash = tuple(length * scale for length in run.dash)
    first, line = plotting.stroke(heights, size[1], _LINE_WIDTH * scale, dash)
    _cover(sheet.surface, (corner[0], corner[1] + first), colour, line)
    for column in plotting.alone(values):
        sheet.dot(((area.x + column) / scale, (corner[1] + heights[column]) / scale), _LINE_WIDTH, colour)
    _paint_arrows(sheet, area, run, axes)


def _paint_arrows(sheet: Canvas, area: pygame.Rect, run: Series, axes: Axes) -> None:
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
                sheet.marker(shape, (x, row / scale), 8, run.colour)


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
