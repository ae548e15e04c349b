"""Scanning for one switch: what can be chosen on a screen is marked in turn, and the switch chooses what is marked."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import pygame

from game.core.scene import Scene, Transition
from game.drawing.canvas import Canvas
from game.drawing.tokens import HUMAN
from game.input.controls import Command, Held
from game.input.layout import place_of
from game.ui.context import Context
from game.ui.form import Form
from game.ui.listing import ListRow
from game.ui.widget import Widget

DWELL: Final = 75  # steps for which each choice is marked
HELD: Final = 180  # steps that the switch is held to pause a flight
_STILL: Final = 90  # steps since the mouse moved after which its button is the switch, wherever it points
_LEAST: Final = 12  # steps between two choices: a hand that trembles presses once


@dataclass(frozen=True)
class Stop:
    """One thing that can be chosen: a widget, which may be a hint, or a row of a list; `box` is in points."""

    box: pygame.FRect
    widget: Widget
    row: int = -1


class SwitchScan:
    """Scanning of one window; call `update` in every step, and `take` for every event.

    Attributes:
        index: number of the choice that is marked, counted on and on.

    """

    def __init__(self, context: Context) -> None:
        self._context = context
        self.index = self._since = self._held = 0
        self._calm = 0  # steps since the last choice
        self._mouse_still, self._mouse_down = _STILL, False
        self._scene: Scene | None = None

    def stops(self, scene: Scene, canvas: Canvas) -> list[Stop]:
        """Return what can be chosen: the widgets in their order, and then the hints that a click would run."""
        form, canvas = _form_of(scene), canvas.reading
        if form is None:
            return []
        form.lay_keys(scene.hint_rows(canvas), canvas)
        keys = [key for key in form.keys if key.hint.run != form.confirm]
        return [stop for widget in (*form.widgets, *keys) for stop in _stops_of(widget)]

    def update(self, scene: Scene, canvas: Canvas) -> Transition | None:
        """Advance by 1/60 s; return what a long press in flight leads to."""
        if not self._context.settings.one_switch:
            return None
        self._mouse_still += 1
        self._since += 1
        self._calm += 1
        if scene is not self._scene:
            self._scene, self.index, self._since, self._calm = scene, 0, 0, 0
        if scene.takes_switch:
            self.index = self._since = self._calm = 0
            return self._hold(scene)
        self._held = 0
        if self._since >= DWELL:
            self.index, self._since = self.index + 1, 0
        self._mark(scene, canvas)
        return None

    def take(self, event: pygame.event.Event, scene: Scene, canvas: Canvas) -> tuple[bool, Transition | None]:
        """Choose what is marked, if an event is a press of the switch; return whether it was, and where that leads."""
        if event.type == pygame.MOUSEMOTION:
            self._mouse_still = 0
        elif event.type in (pygame.MOUSEBUTTONDOWN, pygame.MOUSEBUTTONUP) and event.button == 1:
            self._mouse_down = event.type == pygame.MOUSEBUTTONDOWN
        if not (self._context.settings.one_switch and not scene.takes_switch and self._is_press(event, scene)):
            return False, None
        if self._calm < _LEAST:
            return True, None  # the press that led here is still being let go, by a hand that trembles
        stops = self.stops(scene, canvas)
        self._since = self._calm = 0
        return True, self._choose(scene, stops[self.index % len(stops)]) if stops else None

    def draw(self, scene: Scene, canvas: Canvas) -> None:
        """Mark what the switch would choose, and how long it still would."""
        if not self._context.settings.one_switch or scene.takes_switch:
            return
        stops = self.stops(scene, canvas)
        if not stops:
            return
        canvas, box = canvas.reading, stops[self.index % len(stops)].box.inflate(16, 6)
        canvas.outline(box, 8, HUMAN, 1.5)
        if not self._context.settings.reduced_motion:
            left = 1 - self._since / DWELL
            canvas.line((box.left + 8, box.bottom), (box.left + 8 + (box.width - 16) * left, box.bottom), HUMAN, 3)

    def _hold(self, scene: Scene) -> Transition | None:
        """Count how long the switch is held in flight; pause once that is long enough."""
        self._held = self._held + 1 if self._context.controls.switch or self._mouse_down else 0
        if self._held < HELD:
            return None
        self._held, self._mouse_down = 0, False
        return scene.pause()

    def _mark(self, scene: Scene, canvas: Canvas) -> None:
        """Move the focus to what is marked."""
        stops = self.stops(scene, canvas)
        stop, form = stops[self.index % len(stops)] if stops else None, _form_of(scene)
        if stop and form and stop.widget in form.widgets and not form.typing:
            form.focus(stop.widget)
            if isinstance(stop.widget, ListRow) and self._since == 0:
                stop.widget.choose(stop.row)

    def _choose(self, scene: Scene, stop: Stop) -> Transition | None:
        widget, form = stop.widget, _form_of(scene)
        if form is None or widget not in form.widgets:
            return widget.press()
        form.focus(widget)
        if not widget.by_arrows:
            return form.confirm(pointed=False)
        widget.advance()
        return None

    def _is_press(self, event: pygame.event.Event, scene: Scene) -> bool:
        """Whether an event presses the switch; Up, which fires the engine too, still moves the focus."""
        controls, form = self._context.controls, _form_of(scene)
        if form and form.typing:
            return False
        if event.type == pygame.MOUSEBUTTONDOWN:
            return bool(event.button == 1 and self._mouse_still >= _STILL)
        by_key = event.type == pygame.KEYDOWN
        bindings = controls.keys if by_key else controls.buttons
        code = place_of(event) if by_key else getattr(event, "button", None)
        if event.type == pygame.CONTROLLERAXISMOTION:
            code = getattr(event, "trigger", None)
        elif not by_key and event.type != pygame.CONTROLLERBUTTONDOWN:
            return False
        switches = bindings.codes(Held.MAIN) + bindings.codes(Command.CONFIRM)
        return code in switches and code not in bindings.codes(Command.UP)


def _form_of(scene: Scene) -> Form | None:
    form = getattr(scene, "form", None)
    return form if isinstance(form, Form) else None


def _stops_of(widget: Widget) -> list[Stop]:
    box = pygame.FRect(widget.box)
    if not isinstance(widget, ListRow):
        return [Stop(box, widget)]
    seen = range(widget.first, min(len(widget.rows), widget.first + widget.room))
    pitch = widget.baseline(1) - widget.baseline(0)
    return [
        Stop(pygame.FRect(box.left, box.top + number * pitch, box.width, pitch), widget, row)
        for number, row in enumerate(seen)
    ]
