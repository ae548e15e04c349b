"""A pen for those without a mouse: taken in hand on a drawing pad, it is moved by arrows or a stick."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import pygame

from game import texts
from game.controls import Command, Controls, presses_main, translate
from game.digits.pad import DrawingPad
from game.ui.canvas import Canvas
from game.ui.tokens import HUMAN, NIGHT0
from game.ui.widget import PointsManager, Widget

_PACE: Final = 4.5  # points in a step of 1/60 s
_DEAD: Final = 0.2  # of a stick's way, where it rests
_WAYS: Final = {Command.LEFT: (-1, 0), Command.RIGHT: (1, 0), Command.UP: (0, -1), Command.DOWN: (0, 1)}
_STICK: Final = (pygame.CONTROLLER_AXIS_LEFTX, pygame.CONTROLLER_AXIS_LEFTY)
_EDGE: Final = 2.0


class Pen(Widget):
    """Enter or a pad's A takes the pen, and held down draws with it; Escape or B lays it aside.

    What it does reaches the pad as a mouse's events would, so drawings are the same whatever they are made with.
    """

    def __init__(self, manager: PointsManager, pad: Callable[[], DrawingPad]) -> None:
        super().__init__(manager, pad().rect, texts.PEN)
        self._pad = pad  # there may be another one by then
        self._place = pygame.Vector2(self.box.center)
        self._held: dict[int, Command] = {}
        self._stick = [0.0, 0.0]
        self._drawn_by: int | None = None  # the key or button that holds it down

    def press(self) -> None:
        """Take it in hand; the mouse needs none."""
        self.typing = self.ringed

    def hints(self, controls: Controls) -> list[tuple[str, str]]:
        """Return what can be done with it."""
        return [(controls.arrows, texts.HINT_MOVE), (str(controls.word(Command.CONFIRM)), texts.PEN_HOLD),
                (controls.word(Command.BACK), texts.PEN_LEAVE)]  # fmt: skip

    def take(self, event: pygame.event.Event) -> bool:
        """Move, draw, or lay it aside."""
        if not self.typing:
            return False
        code = getattr(event, "key", getattr(event, "button", None))
        if event.type in (pygame.KEYUP, pygame.CONTROLLERBUTTONUP):
            self._held.pop(code or 0, None)
            if code == self._drawn_by:
                self._lift()
            return True
        if event.type == pygame.CONTROLLERAXISMOTION and event.axis in _STICK:
            share = event.value / 32767
            self._stick[_STICK.index(event.axis)] = share if abs(share) > _DEAD else 0.0
            return True
        return self._obey(event, code)

    def _obey(self, event: pygame.event.Event, code: int | None) -> bool:
        command = translate(event)
        if command is None and presses_main(event):
            command = Command.CONFIRM
        if code is not None and command is Command.CONFIRM:
            self._tell(pygame.MOUSEBUTTONDOWN)
            self._drawn_by = code
        elif code is not None and command in _WAYS:
            self._held[code] = command
        elif command in (Command.BACK, Command.PAUSE):
            self._lay_aside()
        else:
            return False
        return True

    def ease(self, at_once: bool) -> None:
        """Go on in the direction that is held."""
        super().ease(at_once)
        if self.typing and not self.focused:
            self._lay_aside()
        if not self.typing:
            return
        way = pygame.Vector2(self._stick)
        if self._held:
            way = pygame.Vector2(sum((pygame.Vector2(_WAYS[command]) for command in self._held.values()), way * 0))
            if way:
                way.normalize_ip()
        if not way:
            return
        box = self.box.inflate(-2 * _EDGE, -2 * _EDGE)
        self._place += _PACE * way
        self._place.x = min(max(self._place.x, box.left), box.right)
        self._place.y = min(max(self._place.y, box.top), box.bottom)
        if self._drawn_by is not None:
            self._tell(pygame.MOUSEMOTION)

    def _lay_aside(self) -> None:
        self.typing = False
        self._held.clear()
        self._stick = [0.0, 0.0]
        self._lift()

    def _lift(self) -> None:
        if self._drawn_by is not None:
            self._drawn_by = None
            self._tell(pygame.MOUSEBUTTONUP)

    def _tell(self, kind: int) -> None:
        self._pad().handle_event(pygame.Event(kind, pos=(self._place.x, self._place.y), button=1))

    def paint(self, canvas: Canvas) -> None:
        """Draw the ring of the focus, and the pen's point while it is in hand."""
        super().paint(canvas)
        if self.typing:
            x, y = self._place
            canvas.dot((x, y), 9, NIGHT0, 0.6)  # it has to be seen on ink, too
            canvas.marker("ring", (x, y), 14, HUMAN)
            for across, down in _WAYS.values():
                canvas.line((x + 9 * across, y + 9 * down), (x + 15 * across, y + 15 * down), HUMAN, 1.5)
