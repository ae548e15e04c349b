"""Flight controls: what the player's keys, gamepads and mouse ask of the craft, as they wish to be read."""

from __future__ import annotations

from typing import Final

import pygame

from ai.flights.recording import full
from ai.lander.pilots import COAST
from game.core.settings import Settings
from game.input.analogue import Stick, pushed
from game.input.controls import Controls, Held
from game.input.mouse import MouseStick

_FLOWN: Final = (Held.MAIN, Held.LEFT, Held.RIGHT)
_PRESSES: Final = (pygame.KEYDOWN, pygame.CONTROLLERBUTTONDOWN, pygame.MOUSEBUTTONDOWN)
FINE: Final = 0.25  # share of their thrust that jets give while the craft is turned finely


class FlightControls:
    """Flight controls of one player; call `read` once in every step.

    A press counts in the next step, even if it was let go before: a slow frame may bring both at once.
    """

    def __init__(self, controls: Controls, settings: Settings) -> None:
        self._controls, self._settings = controls, settings
        self._mouse = MouseStick()
        self._latched = self._held_before = self._switched = False
        self._shares = full(COAST)  # that were asked for in the step before
        self._tapped: set[Held] = set()  # pressed since the last step

    @property
    def mouse_flies(self) -> bool:
        """Whether a mouse button is held down."""
        return self._mouse.holds

    @property
    def switch(self) -> bool:
        """Whether the one switch is held: a key, a button, or the mouse's left one."""
        return self._controls.switch or self._mouse.fires or self._switched

    def take(self, event: pygame.event.Event) -> None:
        """Process one event, its position in points."""
        self._mouse.take(event)
        if event.type in _PRESSES:
            self._tapped |= {held for held in _FLOWN if self._controls.holds(held, axes=False)}
            self._tapped |= {Held.MAIN} if self._mouse.fires else set()
            self._switched |= self.switch
        if event.type == pygame.WINDOWFOCUSLOST:
            self._forget()

    def begin(self) -> None:
        """Switch a latched engine off, for another flight."""
        self._forget()

    def release(self) -> None:
        """Let go of the mouse, and of a latched engine."""
        self._mouse.release()
        self._forget()

    def _forget(self) -> None:
        """Switch a latched engine off, and forget what was pressed."""
        self._latched = self._switched = False
        self._tapped.clear()

    def read(self, craft: float) -> Stick:
        """Return the stick in this step, for a craft drawn at the x coordinate `craft`, in points."""
        try:
            return self._read(craft)
        finally:
            self._tapped.clear()
            self._switched = False

    def _read(self, craft: float) -> Stick:
        if self._settings.one_switch:
            return Stick(3 * self.switch)
        main, side = self._thrust(craft)
        if self._controls.holds(Held.FINE) or self._mouse.fine:
            side *= FINE
        stick = pushed(main, side, self._shares)
        self._shares = stick.shares or full(stick.action)
        return stick

    def _thrust(self, craft: float) -> tuple[float, float]:
        """Return the shares of thrust asked for, of the main engine and, -1 to 1, of the jets."""
        controls, settings = self._controls, self._settings
        throttle, stick = controls.shares if settings.analogue else (0.0, 0.0)
        axes = not settings.analogue
        held = {each for each in _FLOWN if controls.holds(each, axes=axes)} | self._tapped
        main = float(Held.MAIN in held or self._mouse.fires) or throttle
        left, right = Held.LEFT in held, Held.RIGHT in held
        side = (right - left) or stick or self._mouse.side(craft)
        if settings.toggle_thrust:
            main = self._latch(controls.main or Held.MAIN in held or self._mouse.fires)
        return main, side

    def _latch(self, held: bool) -> float:
        """Switch the main engine on or off at each new press; return its share of thrust."""
        self._latched ^= held and not self._held_before
        self._held_before = held
        return float(self._latched)
