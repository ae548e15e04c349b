"""Axes of a gamepad: what its sticks and triggers do as buttons, and how far they are pushed, as shares of thrust."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

import pygame

from ai.lander.push import STEPS, Push
from game.input.bindings import TRIGGERS, Bindings, Command, Held

# Commands of a stick that is pushed to the left or up, and to the right or down.
STICK_COMMANDS: Final[dict[int, tuple[Command, Command]]] = {
    pygame.CONTROLLER_AXIS_LEFTX: (Command.LEFT, Command.RIGHT),
    pygame.CONTROLLER_AXIS_LEFTY: (Command.UP, Command.DOWN),
    pygame.CONTROLLER_AXIS_RIGHTX: (Command.SLOWER, Command.FASTER),
}
TURN: Final = pygame.CONTROLLER_AXIS_LEFTX
TURNS: Final = {Held.LEFT: -1, Held.RIGHT: 1}  # directions of that axis
STICK_PUSHED: Final = 20000
STICK_RELEASED: Final = 12000
STICK_USED: Final = 11000  # out of 32767, beyond which a stick holds a control, and its gamepad counts as used
TRIGGER_PRESSED: Final = 8000
TRIGGER_RELEASED: Final = 5000
_FARTHEST: Final = 32767
_END, _AWAY = 32000, 16000  # from where on an axis is at its end, and below which it was moved away from there
# Shares of the whole way within which a control is at rest, and beyond which it is pushed as far as it goes.
_STICK: Final = (0.16, 0.95)
_TRIGGER: Final = (0.06, 0.95)
_CURVE: Final = 1.5  # a stick near its rest turns the craft more finely
_ENDS: Final = (-STEPS, 0, STEPS)  # shares that are always reached
_TREMBLE: Final = 0.75  # of a step
_RISE: Final = pygame.CONTROLLER_AXIS_RIGHTY


def pushed(main: float, side: float, before: Push) -> Push:
    """Return the push of shares of thrust, `main` 0 to 1 and `side` -1, left, to 1, right, rounded to a step.

    A share that is hardly another than `before` stays as it was, because hands tremble.
    """
    return Push(_rounded(min(max(main, 0.0), 1.0), before.main), _rounded(min(max(side, -1.0), 1.0), before.side))


def _rounded(share: float, before: float) -> float:
    nearest = round(STEPS * share)
    if not before or nearest in _ENDS or abs(STEPS * share - before) > _TREMBLE:
        return nearest
    return before


class Axes:
    """Axes of one gamepad: where each was last reported to be.

    Most triggers rest at 0. Some rest at the far end of the other side, which shows in the first value below 0. An axis
    that is at its end when it is first heard of rests there, and asks for nothing until it was moved away from it.
    """

    def __init__(self) -> None:
        self._values: dict[int, int] = {}
        self._below_zero: set[int] = set()
        self._heard: set[int] = set()
        self._at_end: set[int] = set()  # axes that have rested at an end since they were first heard of

    def move(self, axis: int, value: int) -> None:
        """Take a reported value, -32768 to 32767."""
        if axis not in self._heard and abs(value) >= _END:
            self._at_end.add(axis)
        elif abs(value) < _AWAY:
            self._at_end.discard(axis)
        self._heard.add(axis)
        if axis in self._at_end:
            self._values.pop(axis, None)
        else:
            self._values[axis] = value
        if axis in TRIGGERS and value < 0:
            self._below_zero.add(axis)

    def value(self, axis: int) -> int:
        """Return the last value of an axis; 0 for one that was never reported."""
        return self._values.get(axis, 0)

    def clear(self) -> None:
        """Let go of everything."""
        self._values.clear()

    def stick(self, axis: int) -> float:
        """Return how far a stick is pushed along an axis, -1 to 1."""
        value = self.value(axis) / _FARTHEST
        pushed: float = _beyond(abs(value), _STICK) ** _CURVE
        return pushed if value > 0 else -pushed

    def trigger(self, axis: int) -> float:
        """Return how far a trigger is pulled, 0 to 1."""
        if axis not in self._values:
            return 0.0
        value = self._values[axis] / _FARTHEST
        return _beyond((value + 1) / 2 if axis in self._below_zero else value, _TRIGGER)


def shares(pads: Iterable[Axes], buttons: Bindings) -> tuple[float, float]:
    """Return the shares of thrust that all gamepads ask for: main engine, 0 to 1, and jets, -1, left, to 1, right.

    The left stick turns, the right one pushed up is the throttle, and so are triggers bound to the engines.
    """
    main = side = 0.0
    for axes in pads:
        pulled = {
            held: max(axes.trigger(axis) * (code in buttons.codes(held)) for axis, code in TRIGGERS.items())
            for held in (Held.MAIN, Held.LEFT, Held.RIGHT)
        }
        main = max(main, pulled[Held.MAIN], -axes.stick(_RISE))
        side = max(side, axes.stick(TURN) + pulled[Held.RIGHT] - pulled[Held.LEFT], key=abs)
    return main, side


def _beyond(value: float, zone: tuple[float, float]) -> float:
    """Return the share of the way between the ends of a zone, 0 to 1."""
    rest, end = zone
    return min(max((value - rest) / (end - rest), 0.0), 1.0)
