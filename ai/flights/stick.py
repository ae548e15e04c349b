"""Position of the stick: the action that a pilot asks for, and with how much thrust."""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from ai.common.environment import Doubles
from ai.lander.rules import ACTION_SHARES, nearest_action

STEPS: Final = 16  # from no thrust to all of it: a flight is recorded in them, so that it can be flown again exactly
_ENDS: Final = (-STEPS, 0, STEPS)  # these are always reached
_TREMBLE: Final = 0.75  # of a step

Shares = tuple[int, int]  # of the main engine, 0 to STEPS, and of the jets, -STEPS, left, to STEPS, right


class Stick(NamedTuple):
    """Position of the stick in one step.

    Attributes:
        action: the action asked for, 0 to 5.
        shares: its shares of thrust; None if all of it.

    """

    action: int = 0
    shares: Shares | None = None


def pushed(main: float, side: float, before: Shares | None = None) -> Stick:
    """Return the stick at shares of thrust, `main` 0 to 1 and `side` -1, left, to 1, right, rounded to a step.

    A share that is hardly another than `before` stays as it was, because hands tremble.
    """
    last_main, last_side = before or (None, None)
    shares = _rounded(min(max(main, 0.0), 1.0), last_main), _rounded(min(max(side, -1.0), 1.0), last_side)
    action = nearest_action(shares[0] / STEPS, shares[1] / STEPS)
    return Stick(action, None if shares == full(action) else shares)


def _rounded(share: float, before: int | None) -> int:
    nearest = round(STEPS * share)
    if not before or nearest in _ENDS or abs(STEPS * share - before) > _TREMBLE:
        return nearest
    return before


def full(action: int) -> Shares:
    """Return the shares of all the thrust that an action asks for."""
    main, side = ACTION_SHARES[action].tolist()
    return round(STEPS * main), round(STEPS * side)


def thrust(shares: Shares | None) -> Doubles | None:
    """Return shares as the environment takes them, (1, 2); None for all of the action's thrust."""
    return None if shares is None else np.array([shares]) / STEPS
