"""Legend of runs side by side: a row of names, each with a piece of its line; the one in focus is emphasised."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from game.core.scene import Transition
from game.drawing import typeface
from game.drawing.canvas import Canvas
from game.drawing.tokens import INK, MUTE, SMALL
from game.ui.listing import shortened
from game.ui.series import run_style
from game.ui.tooltip import draw_swatch
from game.ui.widget import PointsManager, Widget

_SWATCH: Final = 27.0  # points from the piece of a line to the name
_APART: Final = 20.0
_ARROW: Final = 16.0  # points for the sign that there are more, at either end
_LONGEST: Final = 130.0  # points for a name


class RunLegend(Widget):
    """Legend; names that do not fit are on further pages, to which left and right lead.

    Attributes:
        names: name and line style of each run, the current one first.
        index: the name that keys or a gamepad have come to.

    """

    def __init__(
        self,
        manager: PointsManager,
        box: tuple[float, float, float, float],
        on_choose: Callable[[int], Transition | None],
    ) -> None:
        super().__init__(manager, box, "")
        self.names: list[tuple[str, int]] = []
        self.index = 0
        self._on_choose = on_choose

    @property
    def emphasised(self) -> int | None:
        """Line style of the run under the mouse, or in focus; None for none."""
        number = self._pointed
        return None if number is None else self.names[number][1]

    @property
    def _pointed(self) -> int | None:
        if not self.focused or not self.names:
            return None
        if self.ringed:
            return min(self.index, len(self.names) - 1)
        x, y = self.ui_manager.get_mouse_position()
        if not self.box.collidepoint(x, y):
            return None
        return next((number for number, left, right in self._places() if left <= x < right), None)

    def press(self) -> Transition | None:
        """Choose the run that is emphasised; the sign at either end leads to the next page."""
        page = [number for number, *_ in self._places()]
        x = self.mouse_x
        if page and x is not None and x > self.box.right - _ARROW and page[-1] + 1 < len(self.names):
            self.index = page[-1] + 1
        elif page and x is not None and x < self.box.left + _ARROW and page[0]:
            self.index = page[0] - 1
        elif (number := self._pointed) is not None:
            self.index = number
            return self._on_choose(self.names[number][1])
        return None

    def shift(self, direction: int) -> bool:
        """Go to the next name; false at either end, so that the focus moves on."""
        before = self.index
        self.index = min(max(self.index + direction, 0), max(len(self.names) - 1, 0))
        return self.index != before

    def _places(self) -> list[tuple[int, float, float]]:
        """Return the number of each name on the page of the chosen one, with its left and right end."""
        room = self.box.width - 2 * _ARROW
        page: list[tuple[int, float, float]] = []
        x = 0.0
        for number, (name, _) in enumerate(self.names):
            width = _SWATCH + min(typeface.width(name, SMALL, "regular"), _LONGEST)
            if page and x + width > room:
                if page[-1][0] >= self.index:
                    break
                page, x = [], 0.0
            page.append((number, x, x + width))
            x += width + _APART
        first = self.box.left + (_ARROW if page and page[0][0] else 0)
        return [(number, first + left, first + right) for number, left, right in page]

    def paint(self, canvas: Canvas) -> None:
        """Draw a page of names."""
        super().paint(canvas)
        baseline, page, lit = self.box.centery + 0.36 * SMALL, self._places(), self._pointed
        for number, left, _ in page:
            (name, style), colour = self.names[number], INK if number == lit else MUTE
            draw_swatch(canvas, (left, baseline - 4), *run_style(style))
            name = shortened(canvas, name, SMALL, _LONGEST)
            canvas.text(name, (left + _SWATCH, baseline), size=SMALL, colour=colour)
        if page and page[0][0]:
            canvas.text("‹", (self.box.left, baseline), size=SMALL, colour=INK)
        if page and page[-1][0] + 1 < len(self.names):
            canvas.text("›", (self.box.right, baseline), size=SMALL, colour=INK, align="right")
