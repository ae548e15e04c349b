"""Group of charts with a common x axis, redrawn in turns so that no frame redraws more than one."""

from __future__ import annotations

from collections.abc import Sequence

import pygame

from game.drawing.canvas import Canvas, Point
from game.ui.chart import Chart
from game.ui.zoom import STEP, Zoom


class Charts:
    """Charts with a common x axis, cursor, marker and zoom, redrawn in turns; the mouse's wheel zooms."""

    def __init__(self, charts: Sequence[Chart]) -> None:
        self.charts = tuple(charts)
        self.zoom = Zoom()
        self._gripped: Chart | None = None  # on which the mouse button was pressed

    def hover(self, point: Point | None) -> float | None:
        """Move the cursors to the mouse, with a tooltip in the chart under it; return the x value there."""
        x = self.x_at(point) if point else None
        for chart in self.charts:
            chart.point_to(x, pointed=point is not None and chart.x_at(point) is not None)
        return x

    def follow(self, event: pygame.event.Event) -> None:
        """Follow an event of the mouse or of a virtual pointer, its position in points."""
        if event.type == pygame.MOUSEMOTION:
            self.hover(event.pos)
        elif event.type == pygame.MOUSEWHEEL:
            pointed = next((chart.cursor for chart in self.charts if chart.pointed), None)
            if pointed is not None:
                self.zoom.by(STEP**event.y, pointed)

    def zoom_by(self, steps: int) -> None:
        """Stretch the axis by so many steps of the keys, or with 0 show the whole of it."""
        if steps:
            self.zoom.by(STEP**steps, self.charts[0].marker)
        else:
            self.zoom.reset()

    @property
    def box(self) -> pygame.Rect:
        """Bounding box of all charts, in points."""
        first, *others = (pygame.Rect(chart.box) for chart in self.charts)
        return first.unionall(others)

    def x_at(self, point: Point) -> float | None:
        """Return the x value under a point of the canvas, or None outside all charts."""
        return next((x for chart in self.charts if (x := chart.x_at(point)) is not None), None)

    def grip(self, point: Point) -> None:
        """Begin a drag on the chart under a point of the canvas."""
        self._gripped = next((chart for chart in self.charts if chart.x_at(point) is not None), None)

    def gripped(self, across: float) -> float | None:
        """Return the x value on the chart that is dragged on, nearest to a place across the canvas; None off charts."""
        if self._gripped is None:
            return None
        plot = self._gripped.plot
        return self._gripped.x_at((min(max(across, plot.left), plot.right), plot.centery))

    def mark(self, x: float | None, caption: str = "") -> None:
        """Put the marker at x in every chart, its caption in the first."""
        for number, chart in enumerate(self.charts):
            chart.mark(x, caption if number == 0 else "")

    def update(self, at_once: bool = False, *, turn: bool = True) -> None:
        """Advance by 1/60 s; on its `turn`, the chart that has waited longest is redrawn in the next frame."""
        for chart in self.charts:
            chart.update(at_once, turn=False)
        if not turn:
            return
        patient = max(self.charts, key=lambda chart: chart.waiting, default=None)
        if patient is not None and patient.waiting:
            patient.renew()

    def draw(self, canvas: Canvas) -> None:
        """Draw all charts, the one with the tooltip last so that nothing covers it."""
        for chart in sorted(self.charts, key=lambda chart: chart.pointed):
            chart.draw(canvas)
