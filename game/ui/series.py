"""Data of a chart: the curves of runs, and ticks for special moments."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Final, Literal

import numpy as np
import numpy.typing as npt
import pygame

from game.drawing.canvas import Canvas
from game.drawing.tokens import FAINT, HUMAN, NET, Colour
from game.ui.plotting import Limits, Numbers

_TICK_SPACING: Final = 4.0  # points

# Blue is the current run; the others differ from it and from each other in dashes, and in colour, for eyes of
# every kind: neighbours in both, and no two of them are alike in both.
_COLOURS: Final[tuple[Colour, ...]] = (
    (236, 140, 190), (222, 214, 160), (144, 98, 244), (168, 182, 96), (204, 208, 220), (206, 118, 236),
)  # fmt: skip
_DASHES: Final[tuple[tuple[float, ...], ...]] = ((7.0, 5.0), (2.0, 4.0), (10.0, 4.0, 2.0, 4.0), (16.0, 5.0))
_OTHERS: Final = len(_COLOURS) * len(_DASHES)
RUN_STYLES: Final[tuple[tuple[Colour, tuple[float, ...]], ...]] = (
    (NET, ()),
    *(
        (_COLOURS[number % len(_COLOURS)], _DASHES[(number + number // len(_COLOURS)) % len(_DASHES)])
        for number in range(_OTHERS)
    ),
)


def run_style(number: int) -> tuple[Colour, tuple[float, ...]]:
    """Return colour and dashes of a run, 0 for the current one; beyond those there are, they begin again."""
    return RUN_STYLES[number] if number == 0 else RUN_STYLES[1 + (number - 1) % _OTHERS]


@dataclass(frozen=True, eq=False)
class Series:
    """Curve of one run.

    Attributes:
        x: (n,) rising; points with a value that is not finite are left out.
        y: (n,) values; a value that is not finite makes a gap.
        dash: on, off, ... in points; empty for a solid line, which also shows its raw points.
        smooth: whether the line is smoothed; not for data without noise.

    """

    x: npt.ArrayLike
    y: npt.ArrayLike
    name: str
    colour: Colour = NET
    dash: tuple[float, ...] = ()
    smooth: bool = True


@dataclass(frozen=True)
class Tick:
    """Mark below the chart for a moment: a checkpoint, or a knob that was turned."""

    x: float
    text: str
    kind: Literal["checkpoint", "knob"] = "checkpoint"


class SavedSeries:
    """Series with its own copy of the numbers, so that later changes of the arrays do not matter.

    For a `log` axis, `y` is the logarithm to base 10, and NaN for values that are not positive.
    """

    def __init__(self, series: Series, *, log: bool = False) -> None:
        self.series = series
        self.look = (series.name, series.colour, series.dash, series.smooth)
        x, y = np.array(series.x, float).ravel(), np.array(series.y, float).ravel()
        length = min(len(x), len(y))
        placed = np.isfinite(x[:length])
        self.x: Numbers = x[:length][placed]
        y = y[:length][placed]
        self.traced: tuple[object, Numbers] | None = None  # its line in pixels, and for what axes
        self.y: Numbers = np.log10(np.where(y > 0, y, np.nan)) if log else y

    def same(self, other: SavedSeries) -> bool:
        """Whether another run would be drawn the same."""
        same_x = self.look == other.look and np.array_equal(self.x, other.x)
        return same_x and np.array_equal(self.y, other.y, equal_nan=True)

    @cached_property
    def _finite(self) -> npt.NDArray[np.intp]:
        return np.flatnonzero(np.isfinite(self.y))

    @cached_property
    def _known(self) -> Numbers:
        """Return the places of the finite values."""
        return self.x[self._finite]

    def nearest(self, x: float, slack: float) -> tuple[float, float] | None:
        """Return the finite point nearest to x; None if x lies more than `slack` outside the run."""
        finite, at = self._finite, self._known
        if not len(finite):
            return None
        if not at[0] - slack <= x <= at[-1] + slack:
            return None
        after = min(int(np.searchsorted(at, x)), len(at) - 1)
        before = max(after - 1, 0)
        index = before if x - at[before] <= at[after] - x else after
        return float(at[index]), float(self.y[finite[index]])

    def last(self) -> float | None:
        """Return the latest finite value."""
        return float(self.y[self._finite[-1]]) if len(self._finite) else None


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
