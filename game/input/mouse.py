"""Mouse flight controls: the left button fires the main engine, the right one turns towards the pointer.

While the middle button is held, too, the jets turn the craft finely.
"""

from __future__ import annotations

from typing import Final

import pygame

_FIRE, _FINE, _TURN = 1, 2, 3
_BUTTONS: Final = (_FIRE, _FINE, _TURN)


class MouseStick:
    """Flight controls held by the mouse buttons."""

    def __init__(self) -> None:
        self._down: set[int] = set()
        self._x = 0.0

    @property
    def holds(self) -> bool:
        """Whether a mouse button is held down."""
        return bool(self._down)

    @property
    def fires(self) -> bool:
        """Whether the left button is held down."""
        return _FIRE in self._down

    @property
    def fine(self) -> bool:
        """Whether the middle button is held down."""
        return _FINE in self._down

    def take(self, event: pygame.event.Event) -> None:
        """Process one event, its position in points."""
        if event.type == pygame.MOUSEBUTTONDOWN and event.button in _BUTTONS:
            self._down.add(event.button)
            self._x = event.pos[0]
        elif event.type == pygame.MOUSEBUTTONUP:
            self._down.discard(event.button)
        elif event.type == pygame.MOUSEMOTION:
            self._x = event.pos[0]
        elif event.type == pygame.WINDOWFOCUSLOST:
            self.release()

    def release(self) -> None:
        """Release both buttons, because their release will not be reported."""
        self._down.clear()

    def side(self, craft: float) -> int:
        """Return where a craft drawn at the x coordinate `craft`, in points, is to turn: -1 left, 1 right, or 0."""
        return (-1 if self._x < craft else 1) if _TURN in self._down else 0
