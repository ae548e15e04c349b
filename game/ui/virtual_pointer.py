"""Virtual mouse pointer, moved by the arrow keys or a gamepad's stick within a part of the screen."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import pygame

from game.core import texts
from game.drawing.canvas import Canvas
from game.drawing.tokens import HUMAN, NIGHT0
from game.input.controls import Command, Controls, presses_main, translate
from game.ui.held_directions import DIRECTIONS, HeldDirections
from game.ui.hints import Hint
from game.ui.widget import PointsManager, Widget

_EDGE: Final = 2.0
_NOWHERE: Final = (-1.0, -1.0)


class VirtualPointer(Widget):
    """Virtual pointer: Enter or a gamepad's A activates it, and then is its mouse button; Escape or B ends it.

    `tell` receives its actions as mouse events in points, so that no other code need know of it. While inactive, it
    points outside the screen.

    Args:
        manager: the form's manager.
        box: the area it can reach, in points.
        tell: receives the events.
        hold: hint for holding the button down; empty if that does nothing.
        leave: hint for ending it.
        pace: speed in points per step of 1/60 s.

    """

    def __init__(
        self,
        manager: PointsManager,
        box: pygame.typing.RectLike,
        tell: Callable[[pygame.event.Event], object],
        *,
        hold: str = "",
        leave: str = "",
        pace: float = 6.0,
    ) -> None:
        super().__init__(manager, box, texts.POINTER)
        self._hear, self._hold, self._leave, self._pace = tell, hold, leave or texts.POINTER_LEAVE, pace
        self.place = pygame.Vector2(self.box.center)
        self._held = HeldDirections()
        self._pressed_by: int | None = None  # the key or gamepad button that holds the mouse button down

    def press(self) -> None:
        """Activate the pointer, unless a real mouse is in use."""
        self.typing = self.ringed
        if self.typing:
            self._tell(pygame.MOUSEMOTION)

    def process_event(self, event: pygame.event.Event) -> bool:  # noqa: ARG002
        """Ignore real mouse events, which are for the widgets below."""
        return False

    def hints(self, controls: Controls) -> list[Hint]:
        """Return the hints for the active pointer."""
        hold = [Hint(controls.word(Command.CONFIRM), self._hold)] if self._hold else []
        leave = Hint(controls.word(Command.BACK), self._leave, self._lay_aside)
        return [Hint(controls.arrows, texts.HINT_MOVE), *hold, leave]

    def take(self, event: pygame.event.Event) -> bool:
        """Move, press or end the active pointer; false if it is inactive."""
        if not self.typing:
            return False
        code = getattr(event, "key", getattr(event, "button", None))
        if event.type in (pygame.KEYUP, pygame.CONTROLLERBUTTONUP):
            self._held.release(code)
            if code == self._pressed_by:
                self._lift()
            return True
        if self._held.tilt(event):
            return True
        if event.type == pygame.WINDOWFOCUSLOST:  # releases will not be reported now
            self._lay_aside()
            return False
        return self._obey(event, code)

    def _obey(self, event: pygame.event.Event, code: int | None) -> bool:
        command = translate(event)
        if command is None and presses_main(event):
            command = Command.CONFIRM
        if code is not None and command is Command.CONFIRM:
            self._tell(pygame.MOUSEBUTTONDOWN)
            self._pressed_by = code
        elif self._held.press(code, command):
            pass
        elif command in (Command.BACK, Command.PAUSE, Command.UNPLUGGED):
            self._lay_aside()
        else:
            return False
        return True

    def ease(self, at_once: bool) -> None:
        """Move on in the direction that is held."""
        super().ease(at_once)
        if self.typing and not self.focused:
            self._lay_aside()
        if not self.typing:
            return
        way, arrows = self._held.stick, self._held.arrows
        if arrows is not None:
            way = arrows.normalize() if arrows else arrows
        if not way:
            return
        box = self.box.inflate(-2 * _EDGE, -2 * _EDGE)
        self.place += self._pace * way
        self.place.x = min(max(self.place.x, box.left), box.right)
        self.place.y = min(max(self.place.y, box.top), box.bottom)
        self._tell(pygame.MOUSEMOTION)

    def _lay_aside(self) -> None:
        self.typing = False
        self._held.clear()
        self._lift()
        self._hear(pygame.Event(pygame.MOUSEMOTION, pos=_NOWHERE, rel=(0, 0), buttons=(0, 0, 0)))

    def _lift(self) -> None:
        if self._pressed_by is not None:
            self._pressed_by = None
            self._tell(pygame.MOUSEBUTTONUP)

    def _tell(self, kind: int) -> None:
        self._hear(pygame.Event(kind, pos=(self.place.x, self.place.y), button=1, rel=(0, 0), buttons=(0, 0, 0)))

    def paint(self, canvas: Canvas) -> None:
        """Draw the focus ring, and the pointer while it is active."""
        super().paint(canvas)
        if self.typing:
            x, y = self.place
            canvas.dot((x, y), 9, NIGHT0, 0.6)  # visible on bright ink, too
            canvas.marker("ring", (x, y), 14, HUMAN)
            for across, down in DIRECTIONS.values():
                canvas.line((x + 9 * across, y + 9 * down), (x + 15 * across, y + 15 * down), HUMAN, 1.5)
