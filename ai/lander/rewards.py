"""Rewards of the lander: a table of named parts, each a function of what one decision changed.

Distance, speed and alignment are differences Φ' - Φ of a potential, so in points a flight is paid for its two
ends alone, and no loop earns anything. An agent that discounts sees a little more: Ng, Harada and Russell 1999
would pay it γΦ' - Φ, and this is that plus (1 - γ)Φ'. Upright above the pad that is at most 0.45 points a
decision (modern; classic 0.30), less than its time costs (1.6; 0.4), so it does not pay to stay. The parts are
kept without γ because they are points that a player can follow: 0.5 for each 0.1 m. The rest is paid per physics
step.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final, Self

import numpy as np
from numpy.typing import NDArray

from ai.environment import Doubles, Floats, Ints
from ai.lander.rules import CRASHED, FLYING, LANDED, OUT, engines_switched

if TYPE_CHECKING:
    from ai.lander.environment import LanderEnv


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


TILT_ALLOWED: Final = 0.6
FEET_STEPS_PAID: Final = 30


@dataclass
class Situation:
    """All that rewards compare, before or after a decision; each (n,)."""

    distance: Doubles  # metres from standing on the middle of the pad
    across: Doubles  # metres from that to the right
    speed: Doubles  # m/s relative to the pad
    tilt: Doubles  # radians from upright, 0 to pi
    outcome: Ints
    actions: Ints
    steps: Ints  # physics steps flown
    tilted_steps: Ints  # of these, tilted by more than `TILT_ALLOWED`
    feet_steps: Ints  # of these, with both feet down

    @classmethod
    def of(cls, env: LanderEnv) -> Self:
        """Return the present situation of an environment's landers."""
        (across, above), (vx, vy) = (env.position - env.pad).T, env.relative_velocity.T
        above = above - env.params.stand
        return cls(
            distance=np.sqrt(across * across + above * above),
            across=across,
            speed=np.sqrt(vx * vx + vy * vy),
            tilt=env.tilt,
            outcome=env.outcome.copy(),
            actions=env.actions.copy(),
            steps=env.steps.copy(),
            tilted_steps=env.tilted_steps.copy(),
            feet_steps=env.feet_steps.copy(),
        )

    @property
    def aligned(self) -> Doubles:
        """How upright above the middle of the pad, 0 to 1, (n,)."""
        aligned: Doubles = np.maximum(0.0, 1.0 - np.abs(self.across) / 3.0) * np.maximum(0.0, 1.0 - self.tilt / 0.5)
        return aligned


def _feet(before: Situation, after: Situation) -> Ints:
    """Return for how many physics steps of a decision both feet were down, as far as they are paid."""
    return np.minimum(after.feet_steps, FEET_STEPS_PAID) - np.minimum(before.feet_steps, FEET_STEPS_PAID)


def _switched(before: Situation, after: Situation) -> Ints:
    switched: Ints = (before.outcome == FLYING) * engines_switched(before.actions, after.actions)
    return switched


def _ending(before: Situation, after: Situation) -> Doubles:
    """Return 1 for a landing in this decision, -1 for a crash or leaving the area, else 0."""
    flew, outcome = before.outcome == FLYING, after.outcome
    ending: Doubles = 1.0 * (flew & (outcome == LANDED)) - (flew & ((outcome == CRASHED) | (outcome == OUT)))
    return ending


Pay = Callable[[Situation, Situation], Floats]  # what landers earn, (n,), from before to after a decision
Part = Callable[[RewardWeights, Situation, Situation], NDArray[Any]]  # of the situations before and after a decision

REWARDS: Final[dict[str, Part]] = {
    "distance": lambda weights, before, after: weights.distance * 10.0 * (before.distance - after.distance),
    "speed": lambda weights, before, after: weights.speed * 10.0 * (before.speed - after.speed),
    "alignment": lambda weights, before, after: weights.alignment * (after.aligned - before.aligned),
    "tilt": lambda weights, before, after: weights.tilt * (after.tilted_steps - before.tilted_steps),
    "feet": lambda weights, before, after: weights.feet * _feet(before, after),
    "engine": lambda weights, before, after: weights.engine * ((after.steps - before.steps) * (after.actions > 0)),
    "switch": lambda weights, before, after: weights.switch * _switched(before, after),
    "time": lambda weights, before, after: weights.time * (after.steps - before.steps),
    "terminal": lambda weights, before, after: weights.terminal * _ending(before, after),
}
