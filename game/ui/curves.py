"""Curves of a chart: the numbers of runs, how they are drawn on its sheet, and ticks for special moments."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, Literal

import numpy as np
import numpy.typing as npt
import pygame

from game.drawing.canvas import Canvas
from game.drawing.tokens import FAINT, HUMAN, NET, Colour
from game.ui import plotting
from game.ui.plotting import Limits, Numbers

_LINE_WIDTH: Final = 1.6
_SPECK: Final = 0.55  # radius of a raw point, in points
_SPECK_ALPHA: Final = 0.5
_SMOOTHING: Final = 0.022  # smoothing radius, as a share of the width
_ROOM: Final = 0.15  # share of the vertical axis: values are clipped this far outside, so as not to distort the line
_BLEED: Final = 3.0  # points that a line may reach out of the plot

# Blue is the current run; one beside it differs in colour and in dashes, for eyes of every kind.
BESIDE: Final = ((236, 140, 190), (7.0, 5.0))


class Series:
    """Curve of one run, with its own copy of the numbers, so that later changes of the arrays do not matter.

    Args:
        x: (n,) rising.
        y: (n,) values; the line leaves out those that are not finite.
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
        places, values = np.asarray(x, float), np.asarray(y, float)
        finite = np.isfinite(values)
        self.x: Numbers = places[finite]
        self.y: Numbers = values[finite]
        self.name, self.colour, self.dash, self.smooth = name, colour, dash, smooth

    def nearest(self, x: float, slack: float) -> tuple[float, float] | None:
        """Return the point nearest to x; None if x lies more than `slack` outside the run."""
        if not len(self.x) or not self.x[0] - slack <= x <= self.x[-1] + slack:
            return None
        index = int(np.abs(self.x - x).argmin())
        return float(self.x[index]), float(self.y[index])

    @property
    def last(self) -> float | None:
        """The latest value."""
        return float(self.y[-1]) if len(self.y) else None


@dataclass(frozen=True)
class Tick:
    """Mark below the chart for a moment: a checkpoint, or a knob that was turned."""

    x: float
    text: str
    kind: Literal["checkpoint", "knob"] = "checkpoint"


def paint_ticks(sheet: Canvas, plot: pygame.FRect, ticks: Sequence[Tick], end: float) -> None:
    """Draw ticks below a plot."""
    for tick in ticks:
        x = plot.x + min(tick.x / end, 1.0) * plot.width
        if tick.kind == "knob":
            sheet.marker("diamond", (x, plot.bottom), 8, HUMAN)
        else:
            sheet.line((x, plot.bottom + 2), (x, plot.bottom + 5), FAINT)


def paint_run(sheet: Canvas, area: pygame.Rect, run: Series, end: float, limits: Limits) -> None:
    """Draw a run into an area of the sheet, in pixels; its axes reach from 0 to `end`, and from limit to limit."""
    colour, scale, bleed, (low, high) = run.colour, sheet.scale, sheet.px(_BLEED), limits
    room = _ROOM * (high - low)
    heights = np.clip(run.y, low - room, high + room)
    size, corner = (area.width, area.height + 2 * bleed), (area.x, area.y - bleed)

    def rows(of: Numbers) -> Numbers:
        row: Numbers = (high - of) / (high - low) * (area.height - 1) + bleed
        return row

    if not run.dash and run.smooth:
        some = slice(None, None, len(heights) // area.width + 1)
        dots = plotting.specks(run.x[some] / end * (area.width - 1), rows(heights[some]), size, _SPECK * scale)
        _cover(sheet.surface, corner, colour, dots, _SPECK_ALPHA)
    values = plotting.trace(run.x, heights, end, area.width, round(_SMOOTHING * area.width) if run.smooth else 0)
    dash = tuple(length * scale for length in run.dash)
    first, line = plotting.stroke(rows(values), size[1], _LINE_WIDTH * scale, dash)
    _cover(sheet.surface, (corner[0], corner[1] + first), colour, line)


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
