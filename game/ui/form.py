"""A screen's widgets with one of them in focus, for mouse, keyboard and gamepad alike."""

from __future__ import annotations

from typing import Final, TypeVar

import pygame

from game.context import Context
from game.controls import Command, presses_main, translate
from game.scene import Transition
from game.ui import focus
from game.ui.canvas import Canvas
from game.ui.widgets import OnPress, PointsManager, Widget

W = TypeVar("W", bound=Widget)
_ARROWS: Final = {
    Command.UP: focus.UP,
    Command.DOWN: focus.DOWN,
    Command.LEFT: focus.LEFT,
    Command.RIGHT: focus.RIGHT,
}
# Steps a held direction waits before it repeats, and between repeats.
_REPEAT_AFTER: Final = 24
_REPEAT_EVERY: Final = 4


class Form:
    """Widgets are made with `form.manager` and added in the order in which Tab visits them.

    A scene passes on `handle_event` and `update` and returns what they return; what a widget's callback
    returns comes out of one of the two. `on_back` answers Escape, or the pad's B.
    """

    def __init__(self, context: Context, on_back: OnPress | None = None) -> None:
        self.manager = PointsManager()
        self.widgets: list[Widget] = []
        self._context, self._on_back = context, on_back
        self._index = 0
        self._held_steps = 0

    @property
    def focused(self) -> Widget | None:
        """The widget in focus."""
        return self.widgets[self._index] if self.widgets else None

    def add(self, widget: W) -> W:
        """Add a widget and return it."""
        self.widgets.append(widget)
        return widget

    def focus(self, widget: Widget) -> None:
        """Move the focus."""
        self._index = self.widgets.index(widget)

    def handle_event(self, event: pygame.event.Event) -> Transition | None:
        """Take one event; the mouse's are in points."""
        if event.type in (pygame.MOUSEMOTION, pygame.MOUSEBUTTONDOWN, pygame.MOUSEBUTTONUP):
            return self._handle_mouse(event)
        command = translate(event)
        if command is None and presses_main(event):
            command = Command.CONFIRM
        tab = _tab(event)
        if tab:
            self._index = (self._index + tab) % max(1, len(self.widgets))
        elif command in _ARROWS:
            self._move(command)
        elif command is Command.CONFIRM and self.focused:
            self._show_focus()
            return self.focused.press()
        elif command in (Command.BACK, Command.PAUSE) and self._on_back:
            return self._on_back()
        return None

    def update(self) -> Transition | None:
        """Let 1/60 s pass: hovering, easing, and a direction held down."""
        self.manager.update(1 / 60)
        self._repeat()
        self._show_focus()
        for widget in self.widgets:
            widget.ease(at_once=self._context.settings.reduced_motion)
        return None

    def draw(self, canvas: Canvas) -> None:
        """Draw the widgets."""
        for widget in self.widgets:
            widget.paint(canvas)

    def _handle_mouse(self, event: pygame.event.Event) -> Transition | None:
        for index, widget in enumerate(self.widgets):
            if widget.hover_point(*event.pos) and not any(other.held for other in self.widgets):
                self._index = index
        self._show_focus()
        self.manager.process_events(event)
        for widget in self.widgets:
            if widget.outcome is not None:
                outcome, widget.outcome = widget.outcome, None
                return outcome
        return None

    def _move(self, command: Command) -> None:
        if not self.widgets:
            return
        direction = _ARROWS[command]
        if not (direction[0] and self.widgets[self._index].shift(direction[0])):
            self._index = focus.neighbour([w.box for w in self.widgets], self._index, direction)

    def _repeat(self) -> None:
        steer = self._context.controls.steer
        self._held_steps = self._held_steps + 1 if steer else 0
        since = self._held_steps - _REPEAT_AFTER
        if since >= 0 and since % _REPEAT_EVERY == 0 and self.focused:
            self.focused.shift(-1 if steer == 1 else 1)

    def _show_focus(self) -> None:
        for index, widget in enumerate(self.widgets):
            widget.focused = index == self._index
            widget.ringed = not self._context.controls.mouse_in_use


def _tab(event: pygame.event.Event) -> int:
    if event.type != pygame.KEYDOWN or event.key != pygame.K_TAB:
        return 0
    return -1 if getattr(event, "mod", 0) & pygame.KMOD_SHIFT else 1
