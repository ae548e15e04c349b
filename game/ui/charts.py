"""Charts with a common x axis, redrawn in turns so that no frame redraws more than one; and a widget over them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Final

import pygame

from game.core.scene import Transition
from game.drawing.canvas import Canvas, Point
from game.drawing.tokens import INK
from game.ui.chart import Chart
from game.ui.widget import OnPress, Widget

_RING: Final = (12, 8)  # points by which the focus ring is wider and higher than the charts


class Charts:
    """Charts with a common x axis, cursor and marker, redrawn in turns."""

    def __init__(self, charts: Sequence[Chart]) -> None:
        self.charts = tuple(charts)
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

    @property
    def box(self) -> pygame.Rect:
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
        for chart in sorted(self.charts, key=lambda chart: chart.pointed):
            chart.draw(canvas)


class Scrubber(Widget):
    """Scrubber over all charts. `on_move` gets an x, a float, or a step, the int -1 or 1."""

    def __init__(self, charts: Charts, on_move: Callable[[float | int], None], on_press: OnPress) -> None:
        # For the arrows, its box is the first row: the virtual pointer over all charts is reached from there.
        first, *others = (chart.box for chart in charts.charts)
        super().__init__(first.unionall([box for box in others if box.top == first.top]), "")
        self._charts, self._on_move, self._on_press = charts, on_move, on_press

    def hover_point(self, hover_x: float, hover_y: float) -> bool:
        return self._charts.box.collidepoint(hover_x, hover_y)

    def press(self) -> Transition | None:
        return self._on_press() if self.ringed else None

    def shift(self, direction: int) -> bool:
        self._on_move(direction)
        return True

    def process_event(self, event: pygame.event.Event) -> bool:
        if event.type == pygame.MOUSEBUTTONDOWN and event.button == 1:
            self._charts.grip(event.pos)
        return super().process_event(event)

    def drag(self, x: float) -> None:
        place = self._charts.gripped(x)
        if place is not None:
            self._on_move(float(place))

    def paint(self, canvas: Canvas) -> None:
        if self.ringed and self.warmth > 0.02:
            canvas.outline(self._charts.box.inflate(*_RING), 8, INK, 1, 0.4 * self.warmth)
