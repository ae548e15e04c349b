"""Live line chart: smoothed lines over raw points, several runs, a cursor and a marker.

It is drawn onto a sheet that is kept until its numbers or the window change; only the marker and the cursor are drawn
every frame.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Final

import numpy as np
import pygame

from game.core import texts
from game.drawing.canvas import Canvas, Point
from game.drawing.paint import mix
from game.drawing.tokens import FAINT, INK, LABEL, LINE, MUTE, NIGHT0, SMALL, TEXT
from game.ui import plotting
from game.ui.curves import Series, Tick, paint_run, paint_ticks
from game.ui.plotting import Limits
from game.ui.tooltip import TooltipRow, draw_tooltip

_HEADER: Final = 24.0  # points from the top of the box to the highest grid line
_FOOT: Final = 18.0  # points from the lowest grid line to the bottom of the box
_GUTTER: Final = 34.0  # points for the grid lines' numbers, on the right
_APART: Final = 8.0  # points between the label and the latest number
_MARGIN: Final = 6.0  # points of the sheet around the box
_AXES: Final = mix(FAINT, MUTE, 0.55)
_REACH: Final = 5.0  # points from a tick within which its caption shows
_DOTTED: Final = 4  # runs with a dot at the cursor of a chart that the mouse is not over
_SLACK: Final = 0.02  # share of the x axis by which the cursor may lie beyond a run's end


class Chart:
    """Line chart in a box, in points.

    `read` formats a value; the x axis counts seconds from 0 on. `limits` fixes the vertical axis; otherwise it follows
    the numbers, and a few that have exploded are cut off. `empty` is the text while there is nothing to show.
    """

    def __init__(
        self,
        label: str,
        *,
        limits: Limits | None = None,
        read: Callable[[float], str] = plotting.compact,
        empty: str,
    ) -> None:
        self.box = pygame.FRect(0, 0, 300, 100)
        self.label, self._read, self._empty = label, read, empty
        self._fixed = limits
        self._lines = plotting.grid(*(limits or (0.0, 1.0)))
        self.runs: list[Series] = []  # the current one first
        self._ticks: Sequence[Tick] = ()
        self.end = 1.0  # of the horizontal axis
        self.cursor: float | None = None  # an x, for all charts of a row
        self.pointed = False  # whether the mouse is over this one
        self.marker: float | None = None
        self._mark = ""
        self.caption = ""  # said below the chart
        self._sheet: Canvas | None = None  # until the numbers or the window change

    def move(self, box: pygame.FRect) -> None:
        if box != self.box:
            self.box, self._sheet = box, None

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
        """Lowest and highest value of the vertical axis."""
        return self._fixed or (float(self._lines[0]), float(self._lines[-1]))

    # Data

    def set(self, runs: Sequence[Series], end: float, ticks: Sequence[Tick] = (), caption: str = "") -> None:
        """Show these runs, the current one first, from 0 to `end` seconds."""
        self.runs, self.end, self._ticks, self.caption, self._sheet = list(runs), end, ticks, caption, None
        shown = plotting.robust_range(np.concatenate([run.y for run in runs])) if runs and not self._fixed else None
        if shown is not None:
            self._lines = plotting.steady_grid(shown, self._lines)

    def mark(self, x: float | None, caption: str = "") -> None:
        """Put the marker at x: a vertical line with a caption and a dot on the current run's curve; None removes it."""
        self.marker, self._mark = x, caption

    def point_to(self, x: float | None, *, pointed: bool = False) -> None:
        """Put the cursor at x; None removes it. A tooltip shows the values only if the mouse has `pointed` here."""
        self.cursor, self.pointed = x, pointed

    def x_at(self, point: Point) -> float | None:
        """Return the x value under a point of the canvas, or None outside the chart."""
        plot = self.plot.inflate(2 * _MARGIN, 0)
        plot.height += _FOOT
        return self.x_across(point[0]) if plot.collidepoint(point) else None

    def x_across(self, across: float) -> float:
        """Return the x value nearest to a place across the canvas."""
        return min(max((across - self.plot.x) / self.plot.width, 0.0), 1.0) * self.end

    def place(self, x: float, y: float) -> Point:
        """Return the point of the canvas for x and a value, clipped to the plot."""
        plot, (low, high) = self.plot, self.limits
        up = min(max((y - low) / (high - low), 0.0), 1.0)
        return plot.x + min(max(x / self.end, 0.0), 1.0) * plot.width, plot.bottom - up * plot.height

    # Drawing

    def draw(self, canvas: Canvas) -> None:
        if self._sheet is None or self._sheet.scale != canvas.scale:
            self._sheet = self._paint(canvas)
        canvas.lay(self._sheet, self.box.x - _MARGIN, self.box.y - _MARGIN)
        if self.marker is not None:
            self._draw_marker(canvas, self.marker)
        if self.cursor is not None:
            self._draw_cursor(canvas, self.cursor)

    def _paint(self, canvas: Canvas) -> Canvas:
        sheet = canvas.sheet(self.box.width + 2 * _MARGIN, self.box.height + 2 * _MARGIN)
        box = pygame.FRect(_MARGIN, _MARGIN, *self.box.size)
        plot = pygame.FRect(box.x, box.y + _HEADER, *self.plot.size)
        self._paint_header(sheet, box)
        if any(len(run.y) for run in self.runs):
            self._paint_grid(sheet, plot)
        else:
            for y in (plot.top, plot.bottom):
                sheet.line((plot.x, y), (plot.right, y), LINE)
            sheet.text(self._empty, (plot.x, plot.bottom - 9), size=SMALL, colour=_AXES, room=plot.width)
        for run in reversed(self.runs):
            paint_run(sheet, sheet.rect(*plot), run, self.end, self.limits)
        paint_ticks(sheet, plot, self._ticks, self.end)
        return sheet

    def _paint_header(self, sheet: Canvas, box: pygame.FRect) -> None:
        value = self.runs[0].last if self.runs else None
        figure, colour = ("–", FAINT) if value is None else (self._read(value), self.runs[0].colour)
        right = (box.right - _GUTTER, box.y + 13)
        taken = sheet.text(figure, right, size=TEXT, colour=colour, align="right", tabular=True)
        room = taken.left - _APART - box.x
        sheet.text(self.label, (box.x, box.y + 12), size=LABEL, colour=MUTE, weight="medium", room=room)

    def _paint_grid(self, sheet: Canvas, plot: pygame.FRect) -> None:
        low, high = self.limits
        for number, value in enumerate(self._lines.tolist()):
            y = plot.bottom - (value - low) / (high - low) * plot.height
            sheet.line((plot.x, y), (plot.right, y), LINE)
            if number in (0, len(self._lines) - 1):
                words = plotting.round_number(value)
                sheet.text(words, (plot.right + 6, y + 4), size=LABEL, colour=_AXES)
        below = plot.bottom + 15
        sheet.text("0", (plot.x, below), size=LABEL, colour=_AXES)
        words = texts.CHART_SECONDS.format(self.end)
        sheet.text(words, (plot.right, below), size=LABEL, colour=_AXES, tabular=True, align="right")

    def _draw_marker(self, canvas: Canvas, x: float) -> None:
        plot = self.plot
        point = self.runs[0].nearest(x, self.end) if self.runs else None
        across, y = self.place(x, point[1] if point else self.limits[0])
        canvas.line((across, plot.top), (across, plot.bottom), INK, 1, 0.6)
        canvas.dot((across, y), 4, INK)
        if self._mark:
            width = canvas.text_width(self._mark, size=SMALL) + 12
            left = across + 6 if across + 6 + width <= self.box.right else across - 6 - width
            left = max(left, self.box.x)
            top = plot.bottom - 22 if y < plot.bottom - 28 else plot.top + 3
            canvas.rounded((left, top, width, 18), 4, NIGHT0, 0.8)
            canvas.text(self._mark, (left + 6, top + 13), size=SMALL)

    def _draw_cursor(self, canvas: Canvas, x: float) -> None:
        plot = self.plot
        across, _ = self.place(x, 0.0)
        canvas.line((across, plot.top), (across, plot.bottom), MUTE, 1, 0.7)
        rows = []
        for run in self.runs if self.pointed else self.runs[:_DOTTED]:
            if point := run.nearest(x, _SLACK * self.end):
                canvas.dot(self.place(*point), 3, run.colour)
                rows.append(TooltipRow(run.name, self._read(point[1]), run.colour, run.dash))
        if self.pointed:
            # Below the label and the figure.
            below = (self.box.x, plot.top - 6, self.box.width, self.box.bottom - plot.top + 6)
            lines = [texts.CHART_SECONDS.format(x), *self._ticks_at(across)]
            draw_tooltip(canvas, (across, plot.top), below, lines, rows)

    def _ticks_at(self, across: float) -> list[str]:
        """Return what is said of the tick at a place across the canvas; a turned knob goes before a checkpoint."""
        near = [tick for tick in self._ticks if abs(self.place(tick.x, 0.0)[0] - across) <= _REACH]
        return [tick.text for tick in sorted(near, key=lambda tick: tick.kind != "knob")][:1]
