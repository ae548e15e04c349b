"""Rewards of the lander: a table of named parts, each a function of what one decision changed.

Distance, speed and alignment are differences Φ' - Φ of a potential, so in points a flight is paid for its two
ends alone, and no loop earns anything. An agent that discounts sees a little more: Ng, Harada and Russell 1999
would pay it γΦ' - Φ, and this is that plus (1 - γ)Φ'. Upright above the pad that is at most 0.45 points a
decision (modern; classic 0.30), less than its time costs (1.6; 0.4), so it does not pay to stay. The parts are
kept without γ because they are points that a player can follow: 0.5 for each 0.1 m. The rest is paid per physics
step. Every part takes arrays (n,), or the plain numbers of one lander.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final, Self

import numpy as np
from numpy.typing import NDArray

from ai.common.environment import Bools, Doubles, Ints
from ai.lander.rules import Outcome, engines_switched

# NumPy compares with plain numbers many times as fast as with members of an enumeration.
_FLYING, _LANDED, _CRASHED, _OUT, _LATE = (int(outcome) for outcome in Outcome)


@dataclass(frozen=True)
class RewardWeights:
    """Weight of each part of the reward, in points."""

    distance: float = 0.5  # per 0.1 m nearer to standing on the middle of the pad
    speed: float = 0.05  # per 0.1 m/s slower
    alignment: float = 30.0  # for being upright above the middle of the pad, falling to 0 at 3 m or 0.5 rad
    tilt: float = -0.05  # per physics step tilted by more than 0.6 rad: 0.2 for a decision of four
    feet: float = 1.0  # per physics step with both feet down, thirty of them at the most
    engine: float = -0.02  # per physics step in which an engine fires
    switch: float = 0.0  # per engine that goes on or off at a decision: jets that flicker are unpleasant to watch
    time: float = -0.2  # per physics step: hovering must not pay
    terminal: float = 120.0  # for a landing; as much is lost by a crash or by leaving the area


@dataclass
class Situation:
    """State of the landers that the potentials depend on, each (n,)."""

    distance: Doubles  # metres from standing on the middle of the pad
    offset: Doubles  # metres sideways from it
    speed: Doubles  # m/s
    tilt: Doubles  # radians from upright, 0 to pi


def situated(across: Any, above: Any, velocity_x: Any, velocity_y: Any, tilt: Any, root: Any = np.sqrt) -> Situation:
    """Return the situation at these metres from standing on the middle of the pad, at m/s relative to it.

    `root` is a square root of what is given, arrays (n,) or plain numbers.
    """
    return Situation(
        distance=root(across * across + above * above),
        offset=abs(across),
        speed=root(velocity_x * velocity_x + velocity_y * velocity_y),
        tilt=tilt,
    )


@dataclass
class Moment:
    """All that rewards compare, before or after a decision: each (n,), or the plain numbers of one lander."""

    situation: Situation
    outcome: Any
    actions: Any
    steps: Any  # physics steps flown
    tilted: Any  # of these, tilted by more than `TILT_ALLOWED`
    feet_down: Any  # of these, with both feet down, as far as they are paid


@dataclass
class SituationChange:
    """Change made by one decision: the situations before and after, and counts of its physics steps, each (n,)."""

    before: Situation
    after: Situation
    flown: Ints  # physics steps flown
    fired: Ints  # of these, with an engine on
    tilted: Ints  # of these, tilted too far
    switched: Ints  # engines that went on or off as it began
    feet_down: Ints  # of these, with both feet down, as far as they are paid
    landed: Bools  # ended by a landing in this decision
    lost: Bools  # ended by a crash, or out of bounds, in this decision

    @classmethod
    def between(cls, before: Moment, after: Moment) -> Self:
        """Return the change that one decision made."""
        flying, flown, outcome = before.outcome == _FLYING, after.steps - before.steps, after.outcome
        ended = flying & (outcome != _FLYING)
        return cls(
            before.situation,
            after.situation,
            flown=flown,
            fired=flown * (after.actions > 0),
            tilted=after.tilted - before.tilted,
            switched=flying * engines_switched(before.actions, after.actions),
            feet_down=after.feet_down - before.feet_down,
            landed=ended & (outcome == _LANDED),
            lost=ended & ((outcome == _CRASHED) | (outcome == _OUT)),
        )


TILT_ALLOWED: Final = 0.6
FEET_STEPS_PAID: Final = 30


def _aligned(situation: Situation) -> Any:
    return _at_least_0(1.0 - situation.offset / 3.0) * _at_least_0(1.0 - situation.tilt / 0.5)


def _at_least_0(value: Any) -> Any:
    return np.maximum(0.0, value) if isinstance(value, np.ndarray) else max(0.0, value)


REWARDS: Final[dict[str, Callable[[SituationChange, RewardWeights], NDArray[np.floating[Any]]]]] = {
    "distance": lambda c, w: w.distance * 10.0 * (c.before.distance - c.after.distance),
    "speed": lambda c, w: w.speed * 10.0 * (c.before.speed - c.after.speed),
    "alignment": lambda c, w: w.alignment * (_aligned(c.after) - _aligned(c.before)),
    "tilt": lambda c, w: w.tilt * c.tilted,
    "feet": lambda c, w: w.feet * c.feet_down,
    "engine": lambda c, w: w.engine * c.fired,
    "switch": lambda c, w: w.switch * c.switched,
    "time": lambda c, w: w.time * c.flown,
    "terminal": lambda c, w: w.terminal * (1.0 * c.landed - c.lost),
}
