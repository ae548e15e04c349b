"""Flight controls: what the player's keys, gamepads and mouse ask of the craft, as they wish to be read."""

from __future__ import annotations

from typing import Final

import pygame

from ai.lander.push import STEPS, Push
from game.core.settings import Settings
from game.input.analogue import pushed
from game.input.controls import Controls, Held

_FLOWN: Final = (Held.MAIN, Held.LEFT, Held.RIGHT)
_PRESSES: Final = (pygame.KEYDOWN, pygame.CONTROLLERBUTTONDOWN, pygame.MOUSEBUTTONDOWN)
FINE: Final = 0.25  # share of their thrust that jets give while the craft is turned finely
_FIRE, _FINE, _TURN = 1, 2, 3  # buttons of the mouse


class MouseStick:
    """Buttons of the mouse: left fires, right turns towards the pointer, middle makes that turn fine."""

    def __init__(self) -> None:
        self.down: set[int] = set()  # buttons
        self._x = 0.0

    def take(self, event: pygame.event.Event) -> None:
        if event.type == pygame.MOUSEBUTTONDOWN and event.button in (_FIRE, _FINE, _TURN):
            self.down.add(event.button)
            self._x = event.pos[0]
        elif event.type == pygame.MOUSEBUTTONUP:
            self.down.discard(event.button)
        elif event.type == pygame.MOUSEMOTION:
            self._x = event.pos[0]
        elif event.type == pygame.WINDOWFOCUSLOST:  # their release will not be reported
            self.down.clear()

    def side(self, craft: float) -> int:
        """Return where a craft drawn at the x coordinate `craft`, in points, is to turn: -1 left, 1 right, or 0."""
        return (-1 if self._x < craft else 1) if _TURN in self.down else 0


class FlightControls:
    """Flight controls of one player; call `read` once in every step.

    A press counts in the next step, even if it was let go before: a slow frame may bring both at once.
    """

    def __init__(self, controls: Controls, settings: Settings) -> None:
        self._controls, self._settings = controls, settings
        self._mouse = MouseStick()
        self._latched = self._held_before = self._switched = False
        self._before = Push()  # in the step before
        self._tapped: set[Held] = set()  # pressed since the last step

    @property
    def mouse_flies(self) -> bool:
        """Whether a mouse button is held down."""
        return bool(self._mouse.down)

    @property
    def switch(self) -> bool:
        """Whether the one switch is held: a key, a button, or the mouse's left one."""
        return self._controls.switch or _FIRE in self._mouse.down or self._switched

    def take(self, event: pygame.event.Event) -> None:
        """Process one event, its position in points."""
        self._mouse.take(event)
        if event.type in _PRESSES:
            self._tapped |= {held for held in _FLOWN if self._controls.holds(held, axes=False)}
            self._tapped |= {Held.MAIN} if _FIRE in self._mouse.down else set()
            self._switched |= self.switch
        if event.type == pygame.WINDOWFOCUSLOST:
            self.begin()

    def begin(self) -> None:
        """Switch a latched engine off, and forget what was pressed, for another flight."""
        self._latched = self._switched = False
        self._tapped.clear()

    def release(self) -> None:
        """Let go of the mouse too."""
        self._mouse.down.clear()
        self.begin()

    def read(self, craft: float) -> Push:
        """Return the push of the stick in this step, for a craft drawn at the x coordinate `craft`, in points."""
        if self._settings.one_switch:
            push = Push(STEPS * self.switch)
        else:
            main, side = self._thrust(craft)
            if self._controls.holds(Held.FINE) or _FINE in self._mouse.down:
                side *= FINE
            push = self._before = pushed(main, side, self._before)
        self._tapped.clear()
        self._switched = False
        return push

    def _thrust(self, craft: float) -> tuple[float, float]:
        """Return the shares of thrust asked for, of the main engine and, -1 to 1, of the jets."""
        controls, analogue = self._controls, self._settings.analogue
        throttle, stick = controls.shares if analogue else (0.0, 0.0)
        held = {each for each in _FLOWN if controls.holds(each, axes=not analogue)} | self._tapped
        main = float(Held.MAIN in held or _FIRE in self._mouse.down) or throttle
        side = ((Held.RIGHT in held) - (Held.LEFT in held)) or stick or self._mouse.side(craft)
        if self._settings.toggle_thrust:  # each new press switches the main engine on or off
            pressed = controls.main or Held.MAIN in held or _FIRE in self._mouse.down
            self._latched ^= pressed and not self._held_before
            self._held_before = pressed
            main = float(self._latched)
        return main, side
