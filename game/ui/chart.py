"""Live line chart: smoothed lines over raw points, several runs, a cursor and a marker.

It is drawn onto a sheet that is kept until its numbers, its limits or the window change; only the marker and the
cursor are drawn every frame.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Final

import numpy as np
import pygame

from game.core import texts
from game.drawing.canvas import Align, Canvas, Point
from game.drawing.paint import mix
from game.drawing.tokens import FAINT, INK, LABEL, LINE, MUTE, NIGHT0, SMALL, TEXT
from game.ui import plotting
from game.ui.curves import RUN_STYLES, Axes, Series, Tick, paint_run, paint_ticks, trace_run
from game.ui.plotting import Limits, Numbers
from game.ui.tooltip import TooltipRow, draw_tooltip

__all__ = ["RUN_STYLES", "Chart", "Series", "Tick"]

Painted = tuple[Canvas, Numbers]  # a sheet, and the current run's value in every pixel column

_HEADER: Final = 24.0  # points from the top of the box to the highest grid line
_FOOT: Final = 18.0  # points from the lowest grid line to the bottom of the box
_GUTTER: Final = 34.0  # points for the grid lines' numbers, on the right
_APART: Final = 8.0  # points between the label and the latest number
_MARGIN: Final = 6.0  # points of the sheet around the box
_AXES: Final = mix(FAINT, MUTE, 0.55)
_AXES_SIZE: Final = LABEL
_REST: Final = 6  # steps of 1/60 s between two drawings of new numbers
_EASE: Final = 0.2
_REACH: Final = 5.0  # points from a tick within which its caption shows
_DOTTED: Final = 4  # runs with a dot at the cursor of a chart that the mouse is not over
_SLACK: Final = 0.02  # share of the x axis by which the cursor may lie beyond a run's end


class Chart:
    """Line chart in a box, in points.

    `read` formats a value; the x axis counts seconds. `limits` fixes the vertical axis; otherwise it
    follows the numbers, and a few that have exploded are cut off and marked by an arrow. On a `log` axis, values that
    are not positive make a gap. `empty` is the text while there is nothing to show.
    """

    def __init__(
        self,
        box: pygame.typing.RectLike,
        label: str,
        *,
        limits: Limits | None = None,
        read: Callable[[float], str] = plotting.compact,
        log: bool = False,
        empty: str = "",
    ) -> None:
        self.box = pygame.FRect(box)
        self.label, self._empty = label, empty or texts.CHART_EMPTY
        self._value: Callable[[float], float] = (lambda height: 10.0**height) if log else float
        self._make_grid = plotting.decades if log else plotting.grid
        self._log, self._read = log, read
        self.fixed = limits
        self.redraws = 0  # number of times the sheet was drawn
        self.runs: list[Series] = []  # as shown, the current one first
        self._ticks: tuple[Tick, ...] = ()
        self.x_range: Limits = (0.0, 1.0)  # ends of the horizontal axis
        self._x_ends: tuple[float, ...] = ()  # both ends of the x axis, or one if they are the same
        self._lines = self._make_grid(*(limits or (0.0, 1.0)))
        self._shown = self.limits
        self.cursor: float | None = None  # an x, for all charts of a row
        self.pointed = False  # whether the mouse is over this one
        self._marker: tuple[float, str] | None = None
        self.caption = ""  # said below the chart
        self._painted: Painted | None = None  # until the numbers or the window change
        self._others: tuple[object, Canvas] | None = None  # the runs behind the current one, and what they look like
        self._stale = True
        self._rested = 0

    def move(self, box: pygame.FRect) -> None:
        if box != self.box:
            self.box, self._painted = box, None

    @property
    def plot(self) -> pygame.FRect:
        """Box of the curves, in points."""
        box = self.box
        return pygame.FRect(box.x, box.y + _HEADER, box.width - _GUTTER, box.height - _HEADER - _FOOT)

    @property
    def header(self) -> pygame.FRect:
        """Box of the name and the latest value, in points."""
        return pygame.FRect(self.box.x, self.box.y, self.plot.width, _HEADER - 4)

    @property
    def gutter(self) -> pygame.FRect:
        """Box of the numbers of the scale, in points."""
        plot = self.plot
        return pygame.FRect(plot.right + _MARGIN, plot.top - 8, _GUTTER - _MARGIN, plot.height + 8 + _FOOT)

    @property
    def limits(self) -> Limits:
        """Lowest and highest value of the vertical axis once its easing ends."""
        return self.fixed or (float(self._lines[0]), float(self._lines[-1]))

    def read(self, height: float) -> str:
        """Format the value at a height of the vertical axis, which for a `log` axis is a logarithm."""
        return self._read(self._value(height))

    # Data

    def set(self, series: Sequence[Series], x_range: Limits, ticks: Sequence[Tick] = (), caption: str = "") -> None:
        """Show these runs, the current one first. Call it when new numbers arrive; unchanged ones cost nothing."""
        runs = [each.logarithmic() if self._log else each for each in series]
        if len(runs) == len(self.runs):  # of one that is the same, what was painted stays
            runs = [old if run.same(old) else run for run, old in zip(runs, self.runs, strict=True)]
        start, end = (float(x) if math.isfinite(x) else 0.0 for x in x_range)
        span = (start, end) if end > start else (start, start + 1.0)
        if span == self.x_range and tuple(ticks) == self._ticks and runs == self.runs and caption == self.caption:
            return
        first = not any(run.last() is not None for run in self.runs)
        self.runs, self.x_range, self._ticks, self.caption = runs, span, tuple(ticks), caption
        self._x_ends = tuple(dict.fromkeys((start, max(start, end))))
        within = [plotting.calm(run.within(span)) for run in runs]
        shown = plotting.robust_range(np.concatenate(within)) if within and not self.fixed else None
        if shown is not None:
            self._lines = plotting.steady_grid(shown, self._lines, self._make_grid)
        if first:
            self._shown = self.limits
        self._stale = True

    def mark(self, x: float | None, caption: str = "") -> None:
        """Put the marker at x: a vertical line with a caption and a dot on the current run's curve; None removes it."""
        self._marker = None if x is None else (x, caption)

    @property
    def marker(self) -> float | None:
        return self._marker[0] if self._marker else None

    def hover(self, point: Point | None) -> None:
        """Move the cursor to the mouse, a point of the canvas; None removes it."""
        self.point_to(None if point is None else self.x_at(point), pointed=True)

    def point_to(self, x: float | None, *, pointed: bool = False) -> None:
        """Put the cursor at x; None removes it. A tooltip shows the values only if the mouse has `pointed` here."""
        self.cursor, self.pointed = x, pointed and x is not None

    def x_at(self, point: Point) -> float | None:
        """Return the x value under a point of the canvas, or None outside the chart."""
        plot = self.plot
        foot = pygame.FRect(plot.x, plot.bottom, plot.width, _FOOT)
        if not plot.inflate(2 * _MARGIN, 0).collidepoint(point) and not foot.collidepoint(point):
            return None
        share = min(max((point[0] - plot.x) / plot.width, 0.0), 1.0)
        return self.x_range[0] + share * (self.x_range[1] - self.x_range[0])

    def place(self, x: float, y: float) -> Point:
        """Return the point of the canvas for x and a value, clipped to the plot."""
        plot, (start, end), (low, high) = self.plot, self.x_range, self._shown
        across = min(max((x - start) / (end - start), 0.0), 1.0)
        up = min(max((y - low) / (high - low), 0.0), 1.0)
        return plot.x + across * plot.width, plot.bottom - up * plot.height

    # Time

    @property
    def waiting(self) -> int:
        """Steps since the last drawing, if there is something new to draw; 0 if there is nothing, or it is too soon."""
        moving = self._shown != self.limits
        return self._rested if moving or (self._stale and self._rested >= _REST) else 0

    def update(self, at_once: bool = False, *, turn: bool = True) -> None:
        """Advance by 1/60 s: ease the limits, or jump `at_once`. On its `turn`, the next frame draws new numbers."""
        self._rested += 1
        if self._shown != self.limits:
            self._shown = self.limits if at_once else plotting.eased(self._shown, self.limits, _EASE)
            self._stale = True
        if turn and self.waiting:
            self.renew()

    def renew(self) -> None:
        """Mark the sheet to be redrawn in the next frame."""
        self._painted, self._stale, self._rested = None, False, 0

    # Drawing

    def draw(self, canvas: Canvas) -> None:
        if self._painted is None or self._painted[0].scale != canvas.scale:
            self._painted = self._paint(canvas)
        canvas.lay(self._painted[0], self.box.x - _MARGIN, self.box.y - _MARGIN)
        if self._marker and self.x_range[0] <= self._marker[0] <= self.x_range[1]:
            self._draw_marker(canvas, *self._marker)
        if self.cursor is not None:
            self._draw_cursor(canvas, self.cursor)

    def _paint(self, canvas: Canvas) -> Painted:
        self.redraws += 1
        sheet = canvas.sheet(self.box.width + 2 * _MARGIN, self.box.height + 2 * _MARGIN)
        box = pygame.FRect(_MARGIN, _MARGIN, *self.box.size)
        plot = pygame.FRect(box.x, box.y + _HEADER, *self.plot.size)
        self._paint_header(sheet, box)
        area = sheet.rect(*plot)
        axes = Axes(self.x_range, self._shown, self.limits)
        if any(np.isfinite(run.within(self.x_range)).any() for run in self.runs):
            self._paint_grid(sheet, plot)
        else:
            self._paint_empty(sheet, plot)
        if len(self.runs) > 1:
            self._lay_others(sheet, area, axes)
        values = trace_run(self.runs[0], axes, area.width) if self.runs else np.zeros(0)
        if self.runs:
            paint_run(sheet, area, self.runs[0], values, axes)
        paint_ticks(sheet, plot, self._ticks, self.x_range)
        return sheet, values

    def _lay_others(self, sheet: Canvas, area: pygame.Rect, axes: Axes) -> None:
        """Draw the runs behind the current one, which are painted once, until any of them or the axes change."""
        key = (*self.runs[1:], axes, tuple(area), sheet.scale)
        if self._others is None or self._others[0] != key:
            self._others = key, sheet.sheet(sheet.size[0] / sheet.scale, sheet.size[1] / sheet.scale)
            for run in reversed(self.runs[1:]):
                paint_run(self._others[1], area, run, trace_run(run, axes, area.width), axes)
        sheet.lay(self._others[1], 0, 0)

    def _paint_header(self, sheet: Canvas, box: pygame.FRect) -> None:
        value = self.runs[0].last() if self.runs else None
        figure, colour = ("–", FAINT) if value is None else (self.read(value), self.runs[0].colour)
        right = (box.right - _GUTTER, box.y + 13)
        taken = sheet.text(figure, right, size=TEXT, colour=colour, align="right", tabular=True)
        room = taken.left - _APART - box.x
        sheet.text(self.label, (box.x, box.y + 12), size=LABEL, colour=MUTE, weight="medium", room=room)

    def _paint_empty(self, sheet: Canvas, plot: pygame.FRect) -> None:
        for y in (plot.top, plot.bottom):
            sheet.line((plot.x, y), (plot.right, y), LINE)
        sheet.text(self._empty, (plot.x, plot.bottom - 9), size=SMALL, colour=_AXES, room=plot.width)

    def _paint_grid(self, sheet: Canvas, plot: pygame.FRect) -> None:
        low, high = self._shown
        lines = self._make_grid(*self.fixed) if self.fixed else self._lines
        for number, value in enumerate(lines):
            up = (float(value) - low) / (high - low)
            if -0.01 <= up <= 1.01:
                y = plot.bottom - up * plot.height
                sheet.line((plot.x, y), (plot.right, y), LINE)
                if number in (0, len(lines) - 1):
                    end = self._value(float(value))  # no round number where it is written in other units
                    text = min(plotting.round_number(end), plotting.compact(end), key=len)
                    sheet.text(text, (plot.right + 6, y + 4), size=_AXES_SIZE, colour=_AXES)
        if self._log:
            for word, y in zip(texts.CHART_LOG, (plot.centery - 2, plot.centery + 9), strict=True):
                room = sheet.size[0] / sheet.scale - plot.right - 6
                sheet.text(word, (plot.right + 6, y), size=_AXES_SIZE, colour=_AXES, room=room)
        ends: tuple[tuple[float, Align], ...] = ((plot.x, "left"), (plot.right, "right"))
        for (x, align), x_end in zip(ends, self._x_ends, strict=False):
            place = (x, plot.bottom + 15)
            sheet.text(
                texts.CHART_SECONDS.format(x_end), place, size=_AXES_SIZE, colour=_AXES, tabular=True, align=align
            )

    def _value_at(self, x: float) -> float | None:
        """Return the value of the current run's curve at x."""
        values = self._painted[1] if self._painted else np.zeros(0)
        start, end = self.x_range
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
        slack = _SLACK * (self.x_range[1] - self.x_range[0])
        rows = []
        for run in self.runs if self.pointed else self.runs[:_DOTTED]:
            point = run.nearest(x, slack)
            if point:
                canvas.dot(self.place(*point), 3, run.colour)
                rows.append(TooltipRow(run.name, self.read(point[1]), run.colour, run.dash))
        if self.pointed:
            tick = self._tick_at(across)
            # Below the label and the figure.
            below = (self.box.x, plot.top - 6, self.box.width, self.box.bottom - plot.top + 6)
            draw_tooltip(
                canvas, (across, plot.top), below, [texts.CHART_SECONDS.format(x), *([tick.text] if tick else [])], rows
            )

    def _tick_at(self, across: float) -> Tick | None:
        """Return the tick nearest to x on the canvas, if one is near; a turned knob goes before a checkpoint."""
        away = {tick: abs(self.place(tick.x, 0.0)[0] - across) for tick in self._ticks}
        near = [tick for tick in self._ticks if away[tick] <= _REACH]
        return min(near, key=lambda tick: (tick.kind != "knob", away[tick]), default=None)
