"""Lessons of the first flight, as data: what is to be done, how to tell that it is, and what is urgent meanwhile."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

from ai.lander.environment import LanderEnv, Outcome
from game.flight.flight import Flight, StickHolder

_HIGH: Final = (0.0, 17.0, 0.0, 0.0, 0.0, 0.0)
_LOW: Final = (0.0, 8.0, 0.0, 0.0, 0.0, 0.0)
_MIDWAY: Final = (0.0, 14.0, 0.0, 0.0, 0.0, 0.0)  # with room above for players who fire for long
_LEANING: Final = (0.0, 17.0, 0.0, 0.0, 0.3, 0.0)
_SINKING: Final = (0.0, 16.0, 0.0, -2.0, 0.0, 0.0)
_ASIDE: Final = (4.0, 12.0, 0.0, 0.0, 0.0, 0.0)
_LEAN: Final = 0.15  # rad
UPRIGHT: Final = (0.08, 0.15)  # rad, rad/s
_SLOW: Final = 1.0  # m/s
RISING: Final = 0.3  # m/s upwards, above which the craft rises instead of braking
_MARGIN: Final = 2.0, 1.4  # metres, and shares of the braking distance, within which braking is urgent
_AHEAD: Final = 0.9  # seconds of look-ahead for stopping a turn
_TOP: Final = 3.5  # metres below the top of the area, within which to release the engine


@dataclass(frozen=True)
class Lesson:
    """One lesson: something to do, and how to tell that it is done.

    Attributes:
        name: key of its line in `texts.TUTORIAL`.
        done: predicate: whether the lesson's action is being done in this step of a flight.
        steps: number of steps for which it must be done, 60 per second; consecutive if `held`.
        start: state at which the lesson restarts after a crash.
        by: who must have the stick; None for anybody.
        hands_off: whether it begins with all controls released, and needs no touch.
        back: number of lessons to go back when it restarts.
        guarded: whether the co-pilot shares the stick, as far as the dial says; else it would do what is to be learnt.

    """

    name: str
    done: Callable[[Flight], bool]
    steps: int
    start: tuple[float, float, float, float, float, float] = _HIGH
    held: bool = True
    by: StickHolder | None = StickHolder.HUMAN
    back: int = 0
    hands_off: bool = False
    guarded: bool = False


def _fires(flight: Flight) -> bool:
    return bool(flight.env.actions[0] >= 3)


def _falls(flight: Flight) -> bool:
    return bool(flight.env.actions[0] == 0 and flight.env.velocity[0, 1] < -0.3)


def _leans(flight: Flight) -> bool:
    return bool(flight.env.tilt[0] > _LEAN)


def _stands_upright(flight: Flight) -> bool:
    env = flight.env
    return bool(env.tilt[0] < UPRIGHT[0] and abs(env.angular_velocity[0]) < UPRIGHT[1])


def _brakes(flight: Flight) -> bool:
    return bool(-_SLOW <= flight.env.velocity[0, 1] <= RISING)


def _lands(flight: Flight) -> bool:
    return flight.outcome is Outcome.LANDED


def turned(env: LanderEnv) -> float:
    """Return the predicted angle of the craft, counter-clockwise in rad, far enough ahead to stop a turn in time."""
    return float(env.angle[0] + _AHEAD * env.angular_velocity[0])


def falls_too_fast(env: LanderEnv) -> bool:
    """Return whether the craft must brake now to land softly."""
    descent, allowed = -float(env.velocity[0, 1]), env.limits.touch_speed
    if descent < allowed or env.outcome[0] != Outcome.FLYING:
        return False
    braking = env.params.main_thrust / env.params.mass - env.params.gravity
    way = (descent**2 - allowed**2) / (2 * braking)
    return bool(env.altitude[0] < _MARGIN[0] + _MARGIN[1] * way)


def leaves_at_the_top(env: LanderEnv) -> bool:
    """Return whether the craft must stop firing now, or it leaves the area at its invisible top."""
    rise, gravity = float(env.velocity[0, 1]), env.params.gravity
    room = env.limits.ceiling - _TOP - float(env.position[0, 1])
    return rise > 0 and rise**2 / (2 * gravity) > room and env.outcome[0] == Outcome.FLYING


LESSONS: Final = (
    Lesson("fire", _fires, 24, _MIDWAY, held=False),
    Lesson("fall", _falls, 50, hands_off=True),
    Lesson("brake", _brakes, 50, _SINKING),
    Lesson("lean", _leans, 1),
    Lesson("upright", _stands_upright, 20, _LEANING),
    Lesson("hand_over", lambda _: True, 1, by=StickHolder.NETWORK),
    Lesson("take_back", lambda _: True, 1, back=1),
    Lesson("land", _lands, 1, _LOW),
    Lesson("dial", lambda _: True, 1, _ASIDE, guarded=True),
    Lesson("rescue", _lands, 1, _ASIDE, by=None, back=1, guarded=True),
)
# Lessons that ask for a network to hand over to, and for one that can share the stick.
NEED_NETWORK: Final = ("hand_over", "take_back")
NEED_COPILOT: Final = ("dial", "rescue")
