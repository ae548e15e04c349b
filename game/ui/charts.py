"""Charts with a common x axis, redrawn in turns so that no frame redraws more than one; and a widget over them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Final

import pygame

from game.core.scene import Transition
from game.drawing.canvas import Canvas, Point
from game.drawing.tokens import INK
from game.ui.chart import Chart
from game.ui.plotting import Limits
from game.ui.widget import OnPress, Widget

MOST: Final = 64.0  # times that the axis can be stretched
STEP: Final = 1.25  # times for a notch of the wheel, or a press of + or -
_ZOOMS: Final = {
    **dict.fromkeys((pygame.K_PLUS, pygame.K_EQUALS, pygame.K_KP_PLUS), 2),
    **dict.fromkeys((pygame.K_MINUS, pygame.K_KP_MINUS), -2),
    **dict.fromkeys((pygame.K_0, pygame.K_KP_0), 0),
}
_RING: Final = (12, 8)  # points by which the focus ring is wider and higher than the charts


class Zoom:
    """Part of an axis from 0 to its `end`, which grows as a run goes on; a part that reaches the end goes with it."""

    def __init__(self) -> None:
        self.end = 1.0
        self.reset()

    def reset(self) -> None:
        self.factor, self._middle = 1.0, 1.0  # the middle in units of the axis; the end, if it is beyond that

    @property
    def shown(self) -> Limits:
        """Ends of the part that is shown."""
        half = self.end / self.factor / 2
        middle = min(max(self._middle, half), self.end - half)
        return middle - half, middle + half

    def by(self, factor: float, about: float | None = None) -> None:
        """Stretch the axis by a factor; `about`, by default the middle, stays where it is."""
        start, end = self.shown
        held = (start + end) / 2 if about is None else about
        share = (held - start) / (end - start)
        follows = end >= self.end and about is None
        self.factor = min(max(self.factor * factor, 1.0), MOST)
        width = self.end / self.factor
        self._middle = held + (0.5 - share) * width
        if follows or self._middle + width / 2 >= self.end:
            self._middle = float("inf")
        if self.factor == 1.0:
            self.reset()

    def reach(self, x: float) -> None:
        """Move the part so that x is in it."""
        start, end = self.shown
        if not start <= x <= end:
            self._middle = x


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
    """Scrubber over all charts. `on_move` gets an x, a float, or a step, the int -1 or 1.

    `on_zoom` gets how many steps to stretch the axis, or 0 for the whole of it.
    """

    def __init__(
        self, charts: Charts, on_move: Callable[[float | int], None], on_press: OnPress, on_zoom: Callable[[int], None]
    ) -> None:
        # For the arrows, its box is the first row: the virtual pointer over all charts is reached from there.
        first, *others = (chart.box for chart in charts.charts)
        super().__init__(first.unionall([box for box in others if box.top == first.top]), "")
        self._charts, self._on_move, self._on_press, self._on_zoom = charts, on_move, on_press, on_zoom

    def hover_point(self, hover_x: float, hover_y: float) -> bool:
        return self._charts.box.collidepoint(hover_x, hover_y)

    def press(self) -> Transition | None:
        return self._on_press() if self.ringed else None

    def shift(self, direction: int) -> bool:
        self._on_move(direction)
        return True

    def take(self, event: pygame.event.Event) -> bool:
        steps = _ZOOMS.get(event.key) if event.type == pygame.KEYDOWN else None
        if steps is None:
            return False
        self._on_zoom(steps)
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
