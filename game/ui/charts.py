"""Charts with a common x axis, cursor and marker; and a widget over them."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import pygame

from game.core.scene import Transition
from game.drawing.canvas import Canvas, Point
from game.ui.chart import Chart
from game.ui.widget import NOWHERE, OnPress, Widget


class Charts:
    """Charts with a common x axis, cursor and marker."""

    def __init__(self, charts: Sequence[Chart]) -> None:
        self.charts = tuple(charts)

    @property
    def box(self) -> pygame.Rect:
        first, *others = (pygame.Rect(chart.box) for chart in self.charts)
        return first.unionall(others)

    def at(self, point: Point) -> Chart | None:
        """Return the chart under a point of the canvas."""
        return next((chart for chart in self.charts if chart.x_at(point) is not None), None)

    def follow(self, event: pygame.event.Event) -> None:
        """Move the cursors to the mouse or a virtual pointer, in points, with a tooltip in the chart under it."""
        if event.type == pygame.MOUSEMOTION:
            under = self.at(event.pos)
            for chart in self.charts:
                chart.point_to(under.x_at(event.pos) if under else None, pointed=chart is under)

    def mark(self, x: float | None, caption: str = "") -> None:
        """Put the marker at x in every chart, its caption in the first."""
        for number, chart in enumerate(self.charts):
            chart.mark(x, caption if number == 0 else "")

    def draw(self, canvas: Canvas) -> None:
        for chart in sorted(self.charts, key=lambda chart: chart.pointed):
            chart.draw(canvas)


class Scrubber(Widget):
    """Scrubber over all charts. `on_move` gets an x, a float, or a step, the int -1 or 1."""

    def __init__(self, charts: Charts, on_move: Callable[[float | int], None], on_press: OnPress) -> None:
        super().__init__(NOWHERE, "")
        self._charts, self._on_move, self._on_press = charts, on_move, on_press
        self._dragged: Chart | None = None

    def press(self) -> Transition | None:
        return self._on_press() if self.ringed else None

    def shift(self, direction: int) -> bool:
        self._on_move(direction)
        return True

    def process_event(self, event: pygame.event.Event) -> bool:
        if event.type == pygame.MOUSEBUTTONDOWN:
            self._dragged = self._charts.at(event.pos)
        return super().process_event(event)

    def drag(self, x: float) -> None:
        if self._dragged:
            self._on_move(self._dragged.x_across(x))
