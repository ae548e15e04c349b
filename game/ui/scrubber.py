"""Scrubber: a widget over charts with a common x axis, along which the mouse or the arrows move a marker."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import pygame

from game.core.scene import Transition
from game.drawing.canvas import Canvas
from game.drawing.tokens import INK
from game.ui.charts import Charts
from game.ui.widget import OnPress, PointsManager, Widget

_ZOOMS: Final = {
    **dict.fromkeys((pygame.K_PLUS, pygame.K_EQUALS, pygame.K_KP_PLUS), 2),
    **dict.fromkeys((pygame.K_MINUS, pygame.K_KP_MINUS), -2),
    **dict.fromkeys((pygame.K_0, pygame.K_KP_0), 0),
}
_RING: Final = (12, 8)  # points by which the focus ring is wider and higher than the charts


class Scrubber(Widget):
    """Scrubber over all charts. `on_move` gets an x, a float, or a step, the int -1 or 1.

    `on_zoom` gets how many steps to stretch the axis, or 0 for the whole of it.
    """

    def __init__(
        self,
        manager: PointsManager,
        charts: Charts,
        on_move: Callable[[float | int], None],
        on_press: OnPress,
        on_zoom: Callable[[int], None],
    ) -> None:
        # For the arrows, its box is the first row: the virtual pointer over all charts is reached from there.
        first, *others = (chart.box for chart in charts.charts)
        super().__init__(manager, first.unionall([box for box in others if box.top == first.top]), "")
        self._charts, self._on_move, self._on_press, self._on_zoom = charts, on_move, on_press, on_zoom

    def hover_point(self, hover_x: float, hover_y: float) -> bool:
        """Whether a point is on any of the charts."""
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
