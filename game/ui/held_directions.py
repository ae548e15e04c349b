"""Held directions: the arrow keys, cross buttons and stick that are held while something is moved by them."""

from __future__ import annotations

from typing import Final

import pygame

from game.input.controls import Command

DIRECTIONS: Final = {Command.LEFT: (-1, 0), Command.RIGHT: (1, 0), Command.UP: (0, -1), Command.DOWN: (0, 1)}
_DEAD: Final = 0.2  # dead zone of a stick, as a share of its range
_STICK: Final = (pygame.CONTROLLER_AXIS_LEFTX, pygame.CONTROLLER_AXIS_LEFTY)


class HeldDirections:
    """Directions that are held; x to the right, y down."""

    def __init__(self) -> None:
        self.clear()

    def clear(self) -> None:
        """Forget what is held."""
        self._arrows: dict[int, Command] = {}  # by the code of the key or button
        self._stick = [0.0, 0.0]

    def press(self, code: int | None, command: Command | None) -> bool:
        """Hold a key or button by its code; return whether its command is a direction."""
        if code is None or command not in DIRECTIONS:
            return False
        self._arrows[code] = command
        return True

    def release(self, code: int | None) -> bool:
        """Let go of a key or button; return whether it was held."""
        return self._arrows.pop(code or 0, None) is not None

    def tilt(self, event: pygame.event.Event) -> bool:
        """Follow the stick; return whether the event was one of its."""
        if event.type != pygame.CONTROLLERAXISMOTION or event.axis not in _STICK:
            return False
        share = event.value / 32767
        self._stick[_STICK.index(event.axis)] = share if abs(share) > _DEAD else 0.0
        return True

    @property
    def stick(self) -> pygame.Vector2:
        """Position of the stick, -1 to 1 along each axis."""
        return pygame.Vector2(self._stick)

    @property
    def arrows(self) -> pygame.Vector2 | None:
        """Sum of the directions of all keys and buttons that are held; None if none is."""
        ways = [pygame.Vector2(DIRECTIONS[command]) for command in self._arrows.values()]
        return sum(ways, pygame.Vector2()) if ways else None
