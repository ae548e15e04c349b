"""Scrubber: a widget over charts with a common x axis, along which the mouse or the arrows move a marker."""

from __future__ import annotations

from collections.abc import Callable

from game.charts.charts import Charts
from game.core.scene import Transition
from game.drawing.canvas import Canvas
from game.drawing.tokens import INK
from game.ui.widget import OnPress, PointsManager, Widget


class Scrubber(Widget):
    """Scrubber over the first row of charts. `on_move` gets an x, a float, or a step, the int -1 or 1."""

    def __init__(
        self, manager: PointsManager, charts: Charts, on_move: Callable[[float | int], None], on_press: OnPress
    ) -> None:
        first, *others = (chart.box for chart in charts.charts)
        super().__init__(manager, first.unionall([box for box in others if box.top == first.top]), "")
        self._charts, self._on_move, self._on_press = charts, on_move, on_press

    def press(self) -> Transition | None:
        """Call `on_press`, except for a mouse, which only moves the marker."""
        return self._on_press() if self.ringed else None

    def shift(self, direction: int) -> bool:
        """Move the marker one step."""
        self._on_move(direction)
        return True

    def drag(self, x: float) -> None:
        """Move the marker to the mouse."""
        place = self._charts.x_at((x, self.box.centery))
        if place is not None:
            self._on_move(float(place))

    def paint(self, canvas: Canvas) -> None:
        """Draw the focus ring only."""
        if self.ringed and self.warmth > 0.02:
            canvas.outline(self.box.inflate(12, 8), 8, INK, 1, 0.4 * self.warmth)
