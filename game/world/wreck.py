"""The craft after its flight: a wreck tumbles, a whole craft comes to rest. Decoration only."""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from ai.environment import Doubles
from ai.lander.environment import LanderEnv
from ai.lander.rules import FOOT_CENTRE, FOOT_SIZE, HULL
from engine import Polygon, Sprite, World
from game.world.lander import LANDER, SIZE, WRECK

_STEPS: Final = 420  # at most; after them the wreck lies still
_STILL: Final = 0.05  # m/s and rad/s
_SPIN: Final = 0.6  # rad/s for every m/s of the blow, at most
_HOP: Final = 0.12  # share of the blow that throws it up again
_TUMBLES: Final[dict[str, Any]] = {"restitution": 0.25, "friction": 0.7}
# Feet dig in: it stays where it came down, on a slope too.
_STAYS: Final[dict[str, Any]] = {"restitution": 0.0, "friction": 1.6}


class Wreck:
    """The craft of one slot from the moment it came down off the pad; call `step` once for every step of 1/60 s.

    Gravity, hills and pads are those of the flight, with moving pads frozen at that moment. A craft that is whole is
    set down without a blow.

    Attributes:
        sprite: picture of the moving body.

    """

    def __init__(self, env: LanderEnv, slot: int, rng: np.random.Generator) -> None:
        params, whole = env.params, bool(env.intact[slot])
        surface = _STAYS if whole else _TUMBLES
        self._world = World(gravity=(0.0, -env.gravity), batch=1, iterations=5)
        x, y = FOOT_CENTRE
        feet = [(-x, y), (x, y)] if whole else [(-x, y)]  # without the other leg it comes to lie on its hull
        shapes = [Polygon(HULL), *(Polygon.box(*FOOT_SIZE, foot) for foot in feet)]
        blow = 0.0 if whole else float(env.impact[slot, :2].max())
        physics = {"mass": params.mass, "inertia": params.inertia, "angular_drag": 4.0 if whole else 0.3, **surface}
        start = env.position[slot], float(env.angle[slot])
        self._body = self._world.add(shapes, *start, centre_of_mass=(0.0, 0.0), **physics)
        self.sprite = Sprite(self._body, LANDER if whole else WRECK, SIZE)
        for pad in env.ground.build(self._world, **surface):
            pad.position = pad.position + np.array([float(env.pad_shift[slot]), 0.0])
        self._body.velocity = env.velocity[slot] + np.array([0.0, _HOP * blow])
        self._body.angular_velocity = env.angular_velocity[slot] + _SPIN * blow * rng.uniform(-1.0, 1.0)
        self._steps = self._rest = 0
        self._now = self._before = self._pose()

    @property
    def moves(self) -> bool:
        """Whether the wreck still moves."""
        return self._steps < _STEPS and self._rest < 20

    def step(self) -> None:
        """Advance by 1/60 s."""
        self._before = self._now
        if not self.moves:
            return
        self._world.step()
        self._now = self._pose()
        self._steps += 1
        slow = np.abs(self._body.velocity).max() < _STILL and abs(float(self._body.angular_velocity[0])) < _STILL
        self._rest = self._rest + 1 if slow else 0

    def pose(self, alpha: float) -> Doubles:
        """Return x, y and angle, `alpha` of the way from the last step to this one."""
        pose: Doubles = self._before + alpha * (self._now - self._before)
        return pose

    def _pose(self) -> Doubles:
        return np.append(self._body.position[0], self._body.angle[0])
