"""Virtual mouse pointer, moved by the arrow keys or a gamepad's stick, and pictures that are pointed at with it."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Final

import pygame

from game.core import texts
from game.drawing.canvas import Canvas
from game.drawing.tokens import HUMAN, NIGHT0
from game.input.controls import Command, Controls, presses_main, translate
from game.ui.hints import Hint
from game.ui.widget import RowWidget, Widget

if TYPE_CHECKING:
    from game.drawing.cursor import Cursor

DIRECTIONS: Final = {Command.LEFT: (-1, 0), Command.RIGHT: (1, 0), Command.UP: (0, -1), Command.DOWN: (0, 1)}
_DEAD: Final = 0.2  # dead zone of a stick, as a share of its range
_STICK: Final = (pygame.CONTROLLER_AXIS_LEFTX, pygame.CONTROLLER_AXIS_LEFTY)
_EDGE: Final = 2.0
_NOWHERE: Final = (-1.0, -1.0)


class VirtualPointer(Widget):
    """Virtual pointer: Enter or a gamepad's A activates it, and then is its mouse button; Escape or B ends it.

    `tell` receives its actions as mouse events in points, so that no other code need know of it. While inactive, it
    points outside the screen.

    Args:
        box: the area it can reach, in points.
        tell: receives the events.
        hold: hint for holding the button down; empty if that does nothing.
        leave: hint for ending it.
        pace: speed in points per step of 1/60 s.

    """

    def __init__(
        self,
        box: pygame.typing.RectLike,
        tell: Callable[[pygame.event.Event], object],
        *,
        hold: str = "",
        leave: str = "",
        pace: float = 6.0,
    ) -> None:
        super().__init__(box, texts.POINTER)
        self._hear, self._hold, self._leave, self._pace = tell, hold, leave or texts.POINTER_LEAVE, pace
        self.place = pygame.Vector2(self.box.center)
        self._arrows: dict[int, Command] = {}  # that are held, by the code of the key or button
        self._stick = pygame.Vector2()
        self._pressed_by: int | None = None  # the key or gamepad button that holds the mouse button down

    def press(self) -> None:
        self.typing = self.ringed
        if self.typing:
            if not self.box.collidepoint(self.place):
                self.place.update(self.box.center)
            self._tell(pygame.MOUSEMOTION)

    def process_event(self, event: pygame.event.Event) -> bool:  # noqa: ARG002
        return False

    def hints(self, controls: Controls) -> list[Hint]:
        hold = [Hint(controls.word(Command.CONFIRM), self._hold)] if self._hold else []
        leave = Hint(controls.word(Command.BACK), self._leave, self.lay_aside)
        return [Hint(controls.arrows, texts.HINT_MOVE), *hold, leave]

    def take(self, event: pygame.event.Event) -> bool:
        if not self.typing:
            return False
        code = getattr(event, "key", getattr(event, "button", None))
        if event.type in (pygame.KEYUP, pygame.CONTROLLERBUTTONUP):
            self._arrows.pop(code or 0, None)
            if code == self._pressed_by:
                self._lift()
            return True
        if event.type == pygame.CONTROLLERAXISMOTION and event.axis in _STICK:
            share = event.value / 32767
            self._stick[_STICK.index(event.axis)] = share if abs(share) > _DEAD else 0.0
            return True
        if event.type == pygame.WINDOWFOCUSLOST:  # releases will not be reported now
            self.lay_aside()
            return False
        return self._obey(event, code)

    def _obey(self, event: pygame.event.Event, code: int | None) -> bool:
        command = translate(event)
        if command is None and presses_main(event):
            command = Command.CONFIRM
        if code is not None and command is Command.CONFIRM:
            self._tell(pygame.MOUSEBUTTONDOWN)
            self._pressed_by = code
        elif code is not None and command in DIRECTIONS:
            self._arrows[code] = command
        elif command in (Command.BACK, Command.PAUSE, Command.UNPLUGGED):
            self.lay_aside()
        else:
            return False
        return True

    def ease(self, at_once: bool) -> None:
        super().ease(at_once)
        if self.typing and not self.focused:
            self.lay_aside()
        if not self.typing:
            return
        way = self._stick
        if self._arrows:
            way = sum((pygame.Vector2(DIRECTIONS[command]) for command in self._arrows.values()), pygame.Vector2())
            way = way.normalize() if way else way
        if not way:
            return
        box = self.box.inflate(-2 * _EDGE, -2 * _EDGE)
        self.place += self._pace * way
        self.place.x = min(max(self.place.x, box.left), box.right)
        self.place.y = min(max(self.place.y, box.top), box.bottom)
        self._tell(pygame.MOUSEMOTION)

    def lay_aside(self) -> None:
        """End pointing, and let go."""
        if not self.typing:
            return
        self.typing = False
        self._arrows.clear()
        self._stick.update(0, 0)
        self._lift()
        self._hear(pygame.Event(pygame.MOUSEMOTION, pos=_NOWHERE, rel=(0, 0), buttons=(0, 0, 0)))

    def _lift(self) -> None:
        if self._pressed_by is not None:
            self._pressed_by = None
            self._tell(pygame.MOUSEBUTTONUP)

    def _tell(self, kind: int) -> None:
        self._hear(pygame.Event(kind, pos=(self.place.x, self.place.y), button=1, rel=(0, 0), buttons=(0, 0, 0)))

    def paint(self, canvas: Canvas) -> None:
        super().paint(canvas)
        self.draw_pointer(canvas)

    def draw_pointer(self, canvas: Canvas) -> None:
        if self.typing:
            x, y = self.place
            canvas.dot((x, y), 9, NIGHT0, 0.6)  # visible on bright ink, too
            canvas.marker("ring", (x, y), 14, HUMAN)
            for across, down in DIRECTIONS.values():
                canvas.line((x + 9 * across, y + 9 * down), (x + 15 * across, y + 15 * down), HUMAN, 1.5)


class PictureRow(RowWidget, VirtualPointer):
    """Picture that is pointed at, by the mouse or a virtual pointer: `tell` gets their events, in points.

    Args:
        label: what it is called.
        height: of the picture in points, given the width.
        tell: receives the events: all motion, and each press within the picture until it is released.
        draw: draws it; without, whoever draws behind the panel does.
        square: whether it is as wide as high, instead of as its column.
        more: as for a `VirtualPointer`.

    Attributes:
        picture: where it is, in points.

    """

    pad, follows_mouse = 0.0, False

    def __init__(
        self,
        label: str,
        height: Callable[[float], float],
        tell: Callable[[pygame.event.Event], object],
        draw: Callable[[Canvas, pygame.FRect], None] = lambda *_: None,
        *,
        square: bool = False,
        **more: Any,
    ) -> None:
        super().__init__((0, 0, 1, 1), tell, **more)
        self.label, self._height, self._draw, self._square = label, height, draw, square
        self.picture = pygame.FRect(self.box)

    def write(self, cursor: Cursor) -> None:
        box = cursor.take(self._height(cursor.width))
        if self._square:
            box.width = box.height
        if cursor.canvas is None:
            self.picture = box
        else:
            self._draw(cursor.canvas, box)
            self.draw_pointer(cursor.canvas)

    def lay(self, cursor: Cursor) -> None:
        super().lay(cursor)
        if cursor.canvas is None:
            self.rect.width = round(self.picture.width)

    def process_event(self, event: pygame.event.Event) -> bool:
        down, up = event.type == pygame.MOUSEBUTTONDOWN, event.type == pygame.MOUSEBUTTONUP
        if (down or up) and event.button != 1:
            return False
        ends, self.held = up and self.held, (self.held and not up) or (down and self.hover_point(*event.pos))
        if event.type == pygame.MOUSEMOTION or ends or (down and self.held):
            self._hear(event)
        return self.held or ends
