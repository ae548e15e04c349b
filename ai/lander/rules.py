"""Rules of the lander: its craft, actions and observations, and what counts as a landing or a crash."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import IntEnum
from typing import Final

import numpy as np

from ai.environment import Ints

NUM_ACTIONS: Final = 6
NUM_FEATURES: Final = 9
ACTION_NAMES: Final = ("coast", "left", "right", "main", "main + left", "main + right")
# A pad six metres wide spans about two units: near it, small differences must look large to a network.
OBSERVATION_SCALE: Final = np.array([0.3, 0.3, 0.5, 0.5, 1.0, 1.0, 1.0, 1.0, 1.0])
# Shares of thrust of every action, (6, 2): of the main engine, and of the jets along the craft's right.
ACTION_SHARES: Final = np.array([[0.0, 0.0], [0.0, -1.0], [0.0, 1.0], [1.0, 0.0], [1.0, -1.0], [1.0, 1.0]])
# Swaps left and right: multiply an observation by this, and swap its two contacts.
MIRROR_SIGNS: Final = np.array([-1, 1, -1, 1, -1, 1, -1, 1, 1], dtype=np.float32)
MIRROR_FEATURES: Final = np.array([0, 1, 2, 3, 4, 5, 6, 8, 7])
MIRROR_ACTIONS: Final = np.array([0, 2, 1, 3, 5, 4])


class Outcome(IntEnum):
    """Outcome of a flight, so far or at its end."""

    FLYING = 0
    LANDED = 1
    CRASHED = 2
    OUT_OF_BOUNDS = 3
    TIMED_OUT = 4


# NumPy compares with plain numbers many times as fast as with members of an enumeration.
FLYING, LANDED, CRASHED, OUT, LATE = (int(outcome) for outcome in Outcome)


class Cause(IntEnum):
    """Cause of a crash."""

    NONE = 0
    HULL = 1  # something other than a foot touched
    TERRAIN = 2  # touched beside the pad
    HARD = 3  # came down too fast
    SLIDING = 4  # moved sideways too fast while touching
    TILTED = 5  # touched while leaning too far


@dataclass(frozen=True)
class Limits:
    """Limits that a touchdown must keep, and that a landing must reach."""

    touch_speed: float = 2.0  # m/s into the surface
    slide_speed: float = 2.0  # m/s along it
    touch_tilt: float = 0.5  # rad
    rest_speed: float = 0.5  # m/s
    rest_tilt: float = 0.15  # rad
    rest_spin: float = 0.3  # rad/s
    rest_steps: int = 30  # physics steps with both feet down and all of the above
    half_width: float = 22.0  # metres from the middle of the world
    ceiling: float = 26.0  # metres
    time: float = 25.0  # seconds

    def roomy(self) -> Limits:
        """Return the limits with the edges of recorded flights, which leave more room to turn back than in training."""
        return replace(self, half_width=30.0, ceiling=29.0)

    def stricter(self, share: float) -> Limits:
        """Return the limits with those of touches times `share`: an agent that learns under them keeps a margin."""
        return replace(
            self,
            touch_speed=share * self.touch_speed,
            slide_speed=share * self.slide_speed,
            touch_tilt=share * self.touch_tilt,
        )


@dataclass(frozen=True)
class LanderParams:
    """The craft and its moon, in SI units."""

    gravity: float = 1.62
    mass: float = 1.0
    inertia: float = 0.5
    main_thrust: float = 4.2
    side_thrust: float = 0.9
    side_arm: float = 0.7  # metres above the centre of mass
    linear_drag: float = 0.02
    quadratic_drag: float = 0.005
    angular_drag: float = 0.25
    angular_quadratic_drag: float = 0.1
    restitution: float = 0.15
    friction: float = 0.6
    ground: float = 1.0
    pad_top: float = 1.6
    pad_width: float = 6.0
    stand: float = 0.96  # height of the centre of mass above what the feet stand on
    jet_fuel: float = 0.1  # a second of jet, in seconds of main engine


HULL: Final = ((-0.62, -0.45), (0.62, -0.45), (0.72, 0.05), (0.42, 0.75), (-0.42, 0.75), (-0.72, 0.05))
FOOT_SIZE: Final = (0.40, 0.12)
FOOT_CENTRE: Final = (0.85, -0.90)
LIMITS: Final = Limits()
PARAMS: Final = LanderParams()


def tenths(seconds: float) -> float:
    """Return a flight's fuel or time as it is printed and judged: to a tenth, rounded from the thousandth on disk."""
    return round(round(seconds, 3), 1)


def engines_switched(held: Ints, actions: Ints) -> Ints:
    """Return how many engines, of main and jets, go on or off between two actions, each (n,)."""
    switched: Ints = ((held >= 3) != (actions >= 3)) * 1 + ((held % 3) != (actions % 3))
    return switched


def nearest_action(main: float, side: float) -> int:
    """Return the action nearest to shares of thrust, `main` 0 to 1 and `side` -1, left, to 1, right.

    Any thrust at all counts as an action: a pilot who asks for a little has not let go of the stick.
    """
    burns, turns = main >= 0.5, abs(side) >= 0.5
    if not burns and not turns:
        burns, turns = main > 0 and main >= abs(side), abs(side) > main
    return 3 * burns + turns * (1 if side < 0 else 2)
