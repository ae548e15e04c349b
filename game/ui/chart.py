"""Live line charts over one x axis: smoothed lines over raw points, several runs, a cursor and a marker.

A chart is drawn onto a sheet that is kept until its numbers, its limits or the window change; only what
follows the mouse is drawn every frame. `Charts` lets several take turns, so that no frame draws more than one.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final, Literal

import numpy as np
import numpy.typing as npt
import pygame

from game import texts
from game.ui import plotting
from game.ui.canvas import Canvas, Point
from game.ui.plotting import Limits, Numbers
from game.ui.tokens import FAINT, HUMAN, INK, LABEL, LINE, MUTE, NET, NIGHT0, SMALL, TEXT, Colour

_HEADER: Final = 24.0  # from the top of the box to the highest line
_FOOT: Final = 18.0  # from the lowest line to the bottom of the box
_GUTTER: Final = 34.0  # for the lines' numbers, on the right
_MARGIN: Final = 6.0  # of the sheet around the box
_LINE_WIDTH: Final = 1.6
_SPECK: Final = 0.55  # radius of a raw point
_SPECK_ALPHA: Final = 0.5
_SMOOTHING: Final = 0.022  # of the width, to either side
_REST: Final = 6  # sixtieths of a second between two drawings of new numbers
_EASE: Final = 0.2
_REACH: Final = 5.0  # points from a tick within which it tells what it stands for
_ROW: Final = 15.0  # of the read-out
_TICK_SPACING: Final = 4.0

# Blue is the run of now; the others differ from it, and from each other, in colour, lightness and dashes.
RUN_STYLES: Final[tuple[tuple[Colour, tuple[float, ...]], ...]] = (
    (NET, ()),
    ((236, 140, 190), (7.0, 5.0)),
    ((222, 214, 160), (2.0, 4.0)),
    ((168, 146, 240), (10.0, 4.0, 2.0, 4.0)),
)


@dataclass(frozen=True, eq=False)
class Series:
    """One run's curve.

    Attributes:
        x: (n,) rising.
        y: (n,) values; one that is not finite makes a gap.
        dash: on, off, ... in points; empty for a solid line, which also shows its raw points.
        smooth: whether the line is smoothed; not for what has no noise.

    """

    x: npt.ArrayLike
    y: npt.ArrayLike
    name: str
    colour: Colour = NET
    dash: tuple[float, ...] = ()
    smooth: bool = True


@dataclass(frozen=True)
class Tick:
    """A moment worth a mark below the chart: a checkpoint, or a knob that was turned."""

    x: float
    text: str
    kind: Literal["checkpoint", "knob"] = "checkpoint"


@dataclass(frozen=True)
class _Run:
    """A series, its numbers copied, sorted out once for as many drawings as there may be."""

    series: Series
    x: Numbers
    y: Numbers

    @classmethod
    def of(cls, series: Series) -> _Run:
        x, y = (np.array(values, float).ravel() for values in (series.x, series.y))
        length = min(len(x), len(y))
        x, y = x[:length], y[:length]
        placed = np.isfinite(x)
        return cls(series, x[placed], y[placed])

    def same(self, other: _Run) -> bool:
        looks = [(each.series.name, each.series.colour, each.series.dash) for each in (self, other)]
        return (
            looks[0] == looks[1] and np.array_equal(self.x, other.x) and np.array_equal(self.y, other.y, equal_nan=True)
        )

    def nearest(self, x: float, slack: float) -> tuple[float, float] | None:
        """Return the finite point nearest to x, unless the run ends more than `slack` before or after it."""
        finite = np.flatnonzero(np.isfinite(self.y))
        if not len(finite):
            return None
        at = self.x[finite]
        if not at[0] - slack <= x <= at[-1] + slack:
            return None
        after = min(int(np.searchsorted(at, x)), len(at) - 1)
        before = max(after - 1, 0)
        index = before if x - at[before] <= at[after] - x else after
        return float(at[index]), float(self.y[finite[index]])

    def last(self) -> float | None:
        """Return the latest finite value."""
        finite = self.y[np.isfinite(self.y)]
        return float(finite[-1]) if len(finite) else None


class Chart:
    """One chart in a box of points.

    `read` writes a value, `read_x` a place on the x axis. `limits` fixes the vertical axis; otherwise it
    follows the numbers, and a few that have exploded are cut off and marked by an arrow.
    """

    def __init__(
        self,
        box: pygame.typing.RectLike,
        label: str,
        *,
        limits: Limits | None = None,
        read: Callable[[float], str] = plotting.compact,
        read_x: Callable[[float], str] = texts.CHART_SECONDS.format,
    ) -> None:
        self.box = pygame.FRect(box)
        self.label, self.read, self.read_x = label, read, read_x
        self.fixed = limits
        self.redraws = 0  # how often the sheet was drawn
        self._runs: list[_Run] = []
        self._ticks: tuple[Tick, ...] = ()
        self._x_range: Limits = (0.0, 1.0)
        self._lines = plotting.grid(*(limits or (0.0, 1.0)))
        self._shown = self._goal
        self._traces: list[Numbers] = []
        self._cursor: float | None = None
        self._pointed = False
        self._marker: tuple[float, str] | None = None
        self._sheet: Canvas | None = None
        self._stale = True
        self._rested = 0

    @property
    def plot(self) -> pygame.FRect:
        """The box of the curves, in points."""
        box = self.box
        return pygame.FRect(box.x, box.y + _HEADER, box.width - _GUTTER, box.height - _HEADER - _FOOT)

    @property
    def limits(self) -> Limits:
        """The lowest and the highest value of the vertical axis, where it is going."""
        return self._goal

    @property
    def _goal(self) -> Limits:
        return self.fixed or (float(self._lines[0]), float(self._lines[-1]))

    # What is shown

    def set(self, series: Sequence[Series], x_range: Limits, ticks: Sequence[Tick] = ()) -> None:
        """Show these runs, the current one first; the same numbers again cost nothing. Call it when new ones came."""
        runs = [_Run.of(each) for each in series]
        start, end = (float(x) if math.isfinite(x) else 0.0 for x in x_range)
        span = (start, end) if end > start else (start, start + 1.0)
        if (
            span == self._x_range
            and tuple(ticks) == self._ticks
            and len(runs) == len(self._runs)
            and all(run.same(old) for run, old in zip(runs, self._runs, strict=True))
        ):
            return
        first = not any(run.last() is not None for run in self._runs)
        self._runs, self._x_range, self._ticks = runs, span, tuple(ticks)
        self._set_limits()
        if first:
            self._shown = self._goal
        self._stale = True

    def _set_limits(self) -> None:
        if self.fixed:
            return
        start, end = self._x_range
        shown = [run.y[(run.x >= start) & (run.x <= end)] for run in self._runs]
        span = plotting.robust_range(np.concatenate(shown)) if shown else None
        if span is not None:
            self._lines = plotting.steady_grid(span, self._lines)

    def mark(self, x: float | None, caption: str = "") -> None:
        """Let an upright line stand at x, with a dot on the current run's curve and a caption; None for none."""
        self._marker = None if x is None else (x, caption)

    def hover(self, point: Point | None) -> None:
        """Let the cursor follow the mouse, a point of the canvas; None for none."""
        self.point_to(None if point is None else self.x_at(point), pointed=True)

    def point_to(self, x: float | None, *, pointed: bool = False) -> None:
        """Put the cursor at x. Only where it is `pointed` at by the mouse, a read-out says what is there."""
        self._cursor, self._pointed = x, pointed and x is not None

    def x_at(self, point: Point) -> float | None:
        """Return the x under a point of the canvas, or None outside the chart."""
        plot = self.plot
        if not plot.inflate(2 * _MARGIN, 0).collidepoint(point) and not self._on_foot(point):
            return None
        share = min(max((point[0] - plot.x) / plot.width, 0.0), 1.0)
        return self._x_range[0] + share * (self._x_range[1] - self._x_range[0])

    def _on_foot(self, point: Point) -> bool:
        plot = self.plot
        return plot.x <= point[0] <= plot.right and plot.bottom <= point[1] <= self.box.bottom

    def place(self, x: float, y: float) -> Point:
        """Return the point of the canvas for x and a value, no further out than the chart's edges."""
        plot, (start, end), (low, high) = self.plot, self._x_range, self._shown
        across = min(max((x - start) / (end - start), 0.0), 1.0)
        up = min(max((y - low) / (high - low), 0.0), 1.0)
        return plot.x + across * plot.width, plot.bottom - up * plot.height

    # Time

    @property
    def waiting(self) -> int:
        """For how many steps there has been something new to draw; 0 if there is nothing, or it is too soon."""
        moving = self._shown != self._goal
        return self._rested if moving or (self._stale and self._rested >= _REST) else 0

    def update(self, at_once: bool = False, *, turn: bool = True) -> None:
        """Let 1/60 s pass: limits ease, or jump `at_once`. On its `turn`, new numbers are drawn next."""
        self._rested += 1
        if self._shown != self._goal:
            self._shown = self._goal if at_once else _eased(self._shown, self._goal)
            self._stale = True
        if turn and self.waiting:
            self.renew()

    def renew(self) -> None:
        """Have the sheet drawn anew in the next frame."""
        self._sheet, self._rested = None, 0

    # The picture

    def draw(self, canvas: Canvas) -> None:
        """Draw the chart, and the marker and the cursor over it."""
        if self._sheet is None or self._sheet.scale != canvas.scale:
            self._sheet = self._paint(canvas)
            self._stale = False
        corner = (canvas.px(self.box.x - _MARGIN), canvas.px(self.box.y - _MARGIN))
        canvas.surface.blit(self._sheet.surface, corner)
        if self._marker:
            self._draw_marker(canvas, *self._marker)
        if self._cursor is not None:
            self._draw_cursor(canvas, self._cursor)

    def _paint(self, canvas: Canvas) -> Canvas:
        self.redraws += 1
        sheet = canvas.sheet(self.box.width + 2 * _MARGIN, self.box.height + 2 * _MARGIN)
        box = pygame.FRect(_MARGIN, _MARGIN, *self.box.size)
        plot = pygame.FRect(box.x, box.y + _HEADER, *self.plot.size)
        self._paint_header(sheet, box)
        self._paint_grid(sheet, plot)
        area = sheet.rect(*plot)
        self._traces = [self._trace(run, area.width) for run in self._runs]
        for run, values in reversed(list(zip(self._runs, self._traces, strict=True))):
            self._paint_run(sheet, area, run, values)
        if not any(np.isfinite(values).any() for values in self._traces):
            middle = (plot.centerx, plot.centery + 4)
            sheet.text(texts.CHART_EMPTY, middle, size=SMALL, colour=FAINT, align="centre")
        self._paint_ticks(sheet, plot)
        return sheet

    def _paint_header(self, sheet: Canvas, box: pygame.FRect) -> None:
        sheet.text(self.label, (box.x, box.y + 12), size=LABEL, colour=MUTE, weight="medium")
        value = self._runs[0].last() if self._runs else None
        figure, colour = ("–", FAINT) if value is None else (self.read(value), self._runs[0].series.colour)
        right = (box.right - _GUTTER, box.y + 13)
        sheet.text(figure, right, size=TEXT, colour=colour, align="right", tabular=True)

    def _paint_grid(self, sheet: Canvas, plot: pygame.FRect) -> None:
        low, high = self._shown
        lines = plotting.grid(*self.fixed) if self.fixed else self._lines
        for number, value in enumerate(lines):
            up = (float(value) - low) / (high - low)
            if -0.01 <= up <= 1.01:
                y = plot.bottom - up * plot.height
                sheet.line((plot.x, y), (plot.right, y), LINE)
                if number in (0, len(lines) - 1):
                    text = plotting.round_number(float(value))
                    sheet.text(text, (plot.right + 6, y + 4), size=LABEL - 1.5, colour=FAINT, tabular=True)
        y = plot.bottom + 15
        for x, side, align in ((self._x_range[0], plot.x, "left"), (self._x_range[1], plot.right, "right")):
            sheet.text(self.read_x(x), (side, y), size=LABEL - 1.5, colour=FAINT, tabular=True, align=align)  # type: ignore[arg-type]

    def _trace(self, run: _Run, columns: int) -> Numbers:
        low, high = self._goal
        span = high - low
        radius = round(_SMOOTHING * columns) if run.series.smooth else 0
        return plotting.trace(run.x, np.where(np.isfinite(run.y), np.clip(run.y, low - span, high + span), np.nan),
                              self._x_range, columns, radius)  # fmt: skip

    def _paint_run(self, sheet: Canvas, area: pygame.Rect, run: _Run, values: Numbers) -> None:
        colour, scale = run.series.colour, sheet.scale
        pad = sheet.px(3)
        low, high = self._shown
        size = (area.width, area.height + 2 * pad)

        def rows(of: Numbers) -> Numbers:
            row = (high - of) / (high - low) * (area.height - 1) + pad
            clipped: Numbers = np.clip(row, -4.0 * pad, size[1] + 4.0 * pad)
            return clipped

        where = (area.x, area.y - pad)
        if not run.series.dash and run.series.smooth:
            kept = plotting.thinned(run.x, run.y, self._x_range, area.width)
            start, end = self._x_range
            columns = (run.x[kept] - start) / (end - start) * (area.width - 1)
            dots = plotting.specks(columns, rows(run.y[kept]), size, _SPECK * scale)
            _cover(sheet.surface, where, colour, _SPECK_ALPHA * dots)
        dash = tuple(length * scale for length in run.series.dash)
        heights = rows(values)
        _cover(sheet.surface, where, colour, plotting.stroke(heights, size[1], _LINE_WIDTH * scale, dash))
        for column in _alone(values):
            sheet.dot(((area.x + column) / scale, (area.y - pad + heights[column]) / scale), 1.6, colour)
        for shape, beyond, y in (("triangle", values > high, area.y), ("triangle_down", values < low, area.bottom)):
            for column in _starts(beyond, 14 * scale):
                x = min((area.x + column) / scale + 3, area.right / scale)
                sheet.marker(shape, (x, y / scale), 8, colour)  # type: ignore[arg-type]

    def _paint_ticks(self, sheet: Canvas, plot: pygame.FRect) -> None:
        last = -math.inf
        for tick in self._ticks:
            x = plot.x + self.place(tick.x, 0.0)[0] - self.plot.x
            if tick.kind == "knob":
                sheet.marker("diamond", (x, plot.bottom), 8, HUMAN)
            elif x - last >= _TICK_SPACING:
                sheet.line((x, plot.bottom + 2), (x, plot.bottom + 5), FAINT)
                last = x

    def _value_at(self, x: float) -> float | None:
        """Return the height of the current run's curve at x."""
        if not self._traces:
            return None
        values = self._traces[0]
        start, end = self._x_range
        column = round((x - start) / (end - start) * (len(values) - 1))
        if not 0 <= column < len(values) or np.isnan(values[column]):
            return None
        return float(values[column])

    def _draw_marker(self, canvas: Canvas, x: float, caption: str) -> None:
        plot = self.plot
        value = self._value_at(x)
        across, y = self.place(x, self._shown[0] if value is None else value)
        canvas.line((across, plot.top), (across, plot.bottom), INK, 1, 0.6)
        canvas.dot((across, y), 4, INK)
        if caption:
            width = canvas.text_width(caption, size=SMALL) + 12
            left = across + 6 if across + 6 + width <= self.box.right else across - 6 - width
            left = max(left, self.box.x)
            top = plot.bottom - 22 if y < plot.bottom - 28 else plot.top + 3
            canvas.rounded((left, top, width, 18), 4, NIGHT0, 0.8)
            canvas.text(caption, (left + 6, top + 13), size=SMALL)

    def _draw_cursor(self, canvas: Canvas, x: float) -> None:
        plot = self.plot
        across, _ = self.place(x, 0.0)
        canvas.line((across, plot.top), (across, plot.bottom), MUTE, 1, 0.7)
        slack = 0.02 * (self._x_range[1] - self._x_range[0])
        rows = []
        for run in self._runs:
            point = run.nearest(x, slack)
            if point:
                canvas.dot(self.place(*point), 3, run.series.colour)
                rows.append((run.series, self.read(point[1])))
        if self._pointed:
            self._draw_readout(canvas, across, x, rows)

    def _draw_readout(self, canvas: Canvas, across: float, x: float, rows: list[tuple[Series, str]]) -> None:
        words = [tick.text for tick in self._ticks if abs(self.place(tick.x, 0.0)[0] - across) <= _REACH][-1:]
        heads = [self.read_x(x), *words]
        swatch, gap = 26.0, 14.0
        names = max((canvas.text_width(series.name, size=LABEL) for series, _ in rows), default=0.0)
        values = max((canvas.text_width(value, size=SMALL, tabular=True) for _, value in rows), default=0.0)
        inner = max(swatch + names + gap + values if rows else 0.0, *(canvas.text_width(h, size=LABEL) for h in heads))
        width, height = inner + 20, _ROW * (len(heads) + len(rows)) + 8
        left = across + 10 if across + 10 + width <= self.box.right else across - 10 - width
        left = max(min(left, self.box.right - width), self.box.x)
        top = min(self.plot.top, self.box.bottom - height)
        canvas.rounded((left, top, width, height), 6, NIGHT0, 0.88)
        canvas.outline((left, top, width, height), 6, LINE)
        y = top + 15
        for head in heads:
            canvas.text(head, (left + 10, y), size=LABEL, colour=MUTE, tabular=True)
            y += _ROW
        for series, value in rows:
            draw_swatch(canvas, (left + 10, y - 4), series.colour, series.dash)
            canvas.text(series.name, (left + 10 + swatch, y), size=LABEL, colour=INK)
            canvas.text(value, (left + width - 10, y), size=SMALL, colour=series.colour, align="right", tabular=True)
            y += _ROW


class Charts:
    """Charts over one x axis, which share the cursor and the marker and take turns at being drawn anew."""

    def __init__(self, charts: Sequence[Chart]) -> None:
        self.charts = tuple(charts)

    def hover(self, point: Point | None) -> float | None:
        """Let the cursors follow the mouse; the chart under it tells its values. Returns the x there."""
        x = self.x_at(point) if point else None
        for chart in self.charts:
            chart.point_to(x, pointed=point is not None and chart.x_at(point) is not None)
        return x

    def x_at(self, point: Point) -> float | None:
        """Return the x under a point of the canvas, or None outside all charts."""
        return next((x for chart in self.charts if (x := chart.x_at(point)) is not None), None)

    def mark(self, x: float | None, caption: str = "") -> None:
        """Put the marker at x in every chart, its caption in the first."""
        for number, chart in enumerate(self.charts):
            chart.mark(x, caption if number == 0 else "")

    def update(self, at_once: bool = False) -> None:
        """Let 1/60 s pass; the chart that has waited longest is drawn anew in the next frame."""
        for chart in self.charts:
            chart.update(at_once, turn=False)
        patient = max(self.charts, key=lambda chart: chart.waiting, default=None)
        if patient is not None and patient.waiting:
            patient.renew()

    def draw(self, canvas: Canvas) -> None:
        """Draw all charts; the one with the read-out last, so that nothing lies over it."""
        for chart in sorted(self.charts, key=lambda chart: chart._pointed):
            chart.draw(canvas)


def draw_swatch(canvas: Canvas, start: Point, colour: Colour, dash: Sequence[float], length: float = 20.0) -> None:
    """Draw a short level piece of a run's line."""
    x, y = start
    lengths = list(dash) or [length, 0.0]
    at = 0.0
    while at < length:
        for on, off in zip(lengths[::2], lengths[1::2], strict=True):
            if at < length:
                canvas.pill((x + at, y - 1, min(on, length - at), 2), colour)
            at += on + off


def draw_legend(canvas: Canvas, series: Sequence[Series], position: Point) -> float:
    """Name runs side by side on one baseline, each with a piece of its line; return where they end."""
    x, y = position
    for each in series:
        draw_swatch(canvas, (x, y - 4), each.colour, each.dash)
        x = canvas.text(each.name, (x + 27, y), size=SMALL, colour=MUTE).right + 20
    return x - 20


def _cover(surface: pygame.Surface, where: tuple[int, int], colour: Colour, cover: Numbers) -> None:
    """Lay a colour over a surface, as far as `cover` (rows, columns) says."""
    rows, columns = cover.shape
    layer = pygame.Surface((columns, rows), pygame.SRCALPHA)
    layer.fill((*colour, 0))
    alpha = pygame.surfarray.pixels_alpha(layer)
    alpha[:] = (255 * cover + 0.5).astype(np.uint8).T
    del alpha
    surface.blit(layer, where)


def _alone(values: Numbers) -> list[int]:
    """Return the columns that have a value and no neighbour: no line runs through them."""
    known = np.pad(np.isfinite(values), 1)
    columns: list[int] = np.flatnonzero(known[1:-1] & ~known[:-2] & ~known[2:]).tolist()
    return columns


def _starts(flags: npt.NDArray[np.bool_], spacing: float) -> list[int]:
    """Return where stretches of True begin, those too near to the one before left out."""
    begins = np.flatnonzero(flags & ~np.roll(flags, 1) | (flags & (np.arange(len(flags)) == 0)))
    kept: list[int] = []
    for column in begins.tolist():
        if not kept or column - kept[-1] >= spacing:
            kept.append(column)
    return kept


def _eased(shown: Limits, goal: Limits) -> Limits:
    """Return limits a step nearer to the goal; at once if they are near, or worlds away."""
    wide, far = goal[1] - goal[0], max(abs(goal[0] - shown[0]), abs(goal[1] - shown[1]))
    if far < 0.004 * wide or far > 20 * wide:
        return goal
    low, high = (old + (new - old) * _EASE for old, new in zip(shown, goal, strict=True))
    return low, high
