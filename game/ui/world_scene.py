"""Base of the scenes whose words stand in columns of rows over a world, which the camera frames between them."""

from __future__ import annotations

from abc import abstractmethod
from typing import TYPE_CHECKING, Final

import pygame

from game.core.scene import Pop
from game.drawing.tokens import MARGIN, STEP
from game.ui.form import FormScene
from game.ui.hints import HintRow, hint_lines
from game.ui.panel import Panel

if TYPE_CHECKING:
    from collections.abc import Sequence

    from game.drawing.canvas import Canvas
    from game.ui.context import Context
    from game.ui.widget import OnPress

_SIDES: Final = 0.05  # of a window's width, at most `MARGIN`, left free at either side
_TOP: Final = 18.0  # points above the head
_SIDE: Final = 280.0  # points of the column at the right side
_MOST: Final = 0.5  # of the height that the foot takes at most
_MOST_SIDE: Final = 0.36  # of the width, that this takes at most: the flight has more
_INSIDE: Final = 18.0  # points from its edge to its rows
_HINTS: Final = 26.0  # points of a line of hints
_PADS: Final = 26.0  # points above the foot that pads reach down into the ground


class WorldScene(FormScene):
    """Scene with rows at its head, at its foot and, if there are any, on a panel at its right side.

    Attributes:
        head, side, foot: the rows.
        free: what they leave free of the window, in points.

    """

    def __init__(self, context: Context, on_back: OnPress = Pop) -> None:
        super().__init__(context, on_back)
        self.head, self.side, self.foot = (Panel(self.form) for _ in range(3))
        self.free = pygame.FRect(context.reading().view)

    @abstractmethod
    def describe(self) -> None:
        """Add the rows."""

    def add_rows(self) -> None:
        self.head, self.side, self.foot = (Panel(self.form, each) for each in (self.head, self.side, self.foot))
        self.describe()

    def lay_out(self) -> None:
        """Lay the rows out for the window: the foot first, then what stands above it."""
        canvas, view = self.context.reading(), self.context.reading().view
        margin = min(MARGIN, _SIDES * view.width)
        left, width = margin, view.width - 2 * margin
        hints = _HINTS * len(self.hint_rows(canvas))
        before = -1.0
        while self.foot.height != before:  # it is as high as in the frame before, or is measured first
            before, height = self.foot.height, min(self.foot.height, _MOST * view.height)
            foot = view.bottom - hints - 2 * STEP - height
            self.foot.lay_out(pygame.FRect(left, foot, width, height), canvas.scale)
        self.free = pygame.FRect(0, 0, view.width, foot)
        if self.side.rows:
            wide = min(_SIDE, _MOST_SIDE * view.width)
            box = pygame.FRect(view.right - wide - min(margin, 36.0), _TOP, wide, foot - _TOP - STEP)
            inside = box.inflate(-2 * _INSIDE, -_INSIDE)
            self.side.lay_out(inside, canvas.scale)
            self._panel = pygame.FRect(box.left, box.top, wide, min(self.side.height + _INSIDE, box.height))
            self.free.width = self._panel.left - 2 * STEP
        self.head.lay_out(pygame.FRect(left, _TOP, self.free.width - 2 * left, foot - _TOP), canvas.scale)
        top = _TOP + self.head.height
        if self.side.rows and view.height > view.width:  # a high window has more room below the panel than beside it
            self.free.width, top = view.width, max(top, self._panel.bottom)
        self.free.top, self.free.height = top, foot - _PADS - top

    def hint_rows(self, canvas: Canvas) -> Sequence[HintRow]:
        view = canvas.view
        margin = min(MARGIN, _SIDES * view.width)
        return hint_lines(self.hints, canvas, (margin, view.bottom - 2 * STEP), view.width - 2 * margin)

    def framed(self, canvas: Canvas) -> Canvas:
        """Return the canvas on which the world is drawn: its ground is above the foot."""
        return canvas.above(canvas.view.bottom - self.free.bottom)

    def draw_rows(self, canvas: Canvas) -> None:
        """Draw the rows over the world."""
        if self.side.rows:
            canvas.panel(self._panel, 1.0)  # whatever flies past behind it
            self.side.draw(canvas)
        for panel in (self.head, self.foot):
            panel.draw(canvas)
        self.draw_hints(canvas)
