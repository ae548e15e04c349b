"""Base of the scenes that are one panel: laid out for any window and any size of text, over a night sky."""

from __future__ import annotations

from abc import abstractmethod
from typing import TYPE_CHECKING, Final

import pygame

from game.core import texts
from game.core.scene import Pop, Scene, Transition
from game.drawing.sky import NightSky
from game.drawing.tokens import MARGIN, NIGHT0, VIEW_SIZE
from game.input.controls import Command, translate
from game.ui.form import FormScene
from game.ui.hints import HintRow, hint_lines
from game.ui.panel import Panel

if TYPE_CHECKING:
    from collections.abc import Sequence

    from game.drawing.canvas import Canvas
    from game.ui.context import Context
    from game.ui.widget import OnPress

_SIDES: Final = 0.05  # of a window's width, at most `MARGIN`, left free at either side
_ENDS: Final = 0.07  # of its height, above and below
_CLEAR: Final = 16.0  # points beside the panel without stars
_WIDEST: Final = VIEW_SIZE[0] - 2.0 * MARGIN  # points between the margins; a wider window has wider margins


class PanelScene(FormScene):
    """Scene with a panel and a row of hints below it.

    Attributes:
        panel: the rows.
        most: the greatest width of the panel, in points.

    """

    most = _WIDEST

    def __init__(self, context: Context, on_back: OnPress = Pop) -> None:
        super().__init__(context, on_back)
        self.panel = Panel(self.form)
        self._sky = NightSky(context.rng)

    @abstractmethod
    def describe(self, panel: Panel) -> None:
        """Add the rows."""

    def add_rows(self) -> None:
        self.panel = Panel(self.form, self.panel)
        self.describe(self.panel)

    def room(self, canvas: Canvas) -> pygame.FRect:
        """Return the room of the panel, above the hints, in points."""
        view, (left, width) = canvas.view, self._between(canvas)
        end = min(MARGIN, _ENDS * view.height)
        foot = min((row.top for row in self.hint_rows(canvas)), default=view.bottom)
        return pygame.FRect(left, view.top + end, min(width, self.most), foot - view.top - 1.5 * end)

    def hint_rows(self, canvas: Canvas) -> Sequence[HintRow]:
        view, (left, width) = canvas.view, self._between(canvas)
        return hint_lines(self.hints, canvas, (left, view.bottom - min(40.0, _ENDS * view.height)), width)

    def _between(self, canvas: Canvas) -> tuple[float, float]:
        """Return the left margin, and the width between both."""
        view = canvas.view
        side = max(min(MARGIN, _SIDES * view.width), (view.width - _WIDEST) / 2)
        return view.left + side, view.width - 2 * side

    def lay_out(self) -> None:
        canvas = self.context.reading()
        self.panel.lay_out(self.room(canvas), canvas.scale)

    def handle_event(self, event: pygame.event.Event) -> Transition | None:
        form = self.form
        outcome = super().handle_event(event)
        if form.used or self.form is not form:  # an action has described other rows
            return outcome
        if event.type == pygame.MOUSEWHEEL:
            self.form.used = self.panel.turn_wheel(event.y)
        elif (command := translate(event)) in (Command.NEXT, Command.PREVIOUS):
            page = self.panel.box.height * 0.8
            self.form.used = self.panel.scroll(page if command is Command.NEXT else -page)
        return outcome

    def draw_behind(self, canvas: Canvas, alpha: float) -> None:  # noqa: ARG002
        room = self.room(canvas)
        self._sky.draw(canvas, pygame.FRect(room.left - _CLEAR, room.top, room.width + 2 * _CLEAR, self.panel.height))

    def draw(self, canvas: Canvas, alpha: float) -> None:
        self.draw_behind(canvas, alpha)
        self.panel.draw(canvas)
        self.draw_hints(canvas)


class StillPicture:
    """Picture of a scene, `dimmed` by a share, and blurred unless `sharp`; painted once a window size and language."""

    def __init__(self, below: Scene, dimmed: float = 0.5, *, sharp: bool = False) -> None:
        self._below, self._dimmed, self._sharp = below, dimmed, sharp
        self._picture: pygame.Surface | None = None
        self._language = texts.LANGUAGE

    def draw(self, canvas: Canvas) -> None:
        whole = canvas.whole
        size, language = whole.surface.get_size(), texts.LANGUAGE
        if self._picture is None or (self._picture.get_size(), self._language) != (size, language):
            self._picture, self._language = self._paint(whole), language
        else:
            whole.surface.blit(self._picture, (0, 0))

    def _paint(self, canvas: Canvas) -> pygame.Surface:
        self._below.draw_on(canvas, 1.0)
        if not self._sharp:
            width, height = canvas.surface.get_size()
            # What a Gaussian takes grows with the fourth power of the resolution.
            small = pygame.transform.smoothscale(canvas.surface, (max(1, width // 8), max(1, height // 8)))
            soft = pygame.transform.gaussian_blur(small, max(1, canvas.px(1.5)))
            pygame.transform.smoothscale(soft, (width, height), canvas.surface)
        canvas.fill(canvas.surface.get_rect(), NIGHT0, self._dimmed)
        return canvas.surface.copy()
