"""Free flight of one body in a world that is alone in its batch, in plain floats.

NumPy takes about a microsecond for a call on an array of length one, and a step without contacts makes eighty such
calls. Python's floats are the same doubles and take a thirtieth of that, so that one body flies many times as fast.
"""

from __future__ import annotations

from math import sqrt
from typing import TYPE_CHECKING, Final

import numpy as np

from engine.contacts import MARGIN

if TYPE_CHECKING:
    from engine.world import World

_SLACK: Final = 1e-6  # metres by which boxes are larger than the broad phase's: far more than rounding makes of them


class FreeFlight:
    """The only body that forces can move in a world of batch 1, while nothing fixed is near it.

    `step` is `World.step` without contacts, in the same operations and the same order: its results are the same, bit
    for bit. `take` and `feel` read what it needs, `give` writes the body's state back after some steps. Mass and linear
    drag are read once, by the constructor, and so are the boxes of fixed bodies; those that may sway by some metres
    to both sides of their places are counted as everywhere at once.

    Attributes:
        x, y, angle: metres and radians.
        vx, vy, spin: m/s and rad/s.
        cos, sin: of the angle.

    """

    def __init__(self, world: World, body: int, sway: float = 0.0) -> None:
        self._world, self._body = world, body
        params, shapes, state = world.params, world.detector.shapes, world.state
        self._inverse_mass, _, self._inverse_inertia = params.inverse_mass[body].tolist()
        self._drag, _, self._turn_drag = params.linear_drag[body].tolist()
        mine = shapes.body == body
        circles = np.column_stack([shapes.centre, shapes.reach + MARGIN + _SLACK])[mine]
        self._circles: list[list[float]] = circles.tolist()
        self._reach = float((np.hypot(*circles[:, :2].T) + circles[:, 2]).max())
        fixed = np.flatnonzero(~mine & state.active[0, shapes.body])
        low, high = shapes.bounds(state, fixed)
        sideways = np.array([2 * sway, 0.0])
        self._boxes: list[list[float]] = np.concatenate([low - sideways, high + sideways], axis=2)[0].tolist()
        self._highest = max((box[3] for box in self._boxes), default=-np.inf)
        self.take()
        self.feel()

    def take(self) -> None:
        """Read the body's state."""
        state, body = self._world.state, self._body
        self.x, self.y, self.angle = state.pose[0, body].tolist()
        self.vx, self.vy, self.spin = state.velocity[0, body].tolist()
        self.cos, self.sin = state.cos.item(0, body), state.sin.item(0, body)

    def feel(self) -> None:
        """Read gravity and the air's drag, which may have changed since the last flight."""
        self._gravity = self._world.gravity.ravel().tolist()
        self._air, _, self._turn_air = self._world.params.quadratic_drag[..., self._body, :].ravel().tolist()

    def give(self) -> None:
        """Write the body's state back, as after a step in which nothing touched."""
        state, body = self._world.state, self._body
        pose, velocity = state.pose, state.velocity
        pose[0, body, 0], pose[0, body, 1], pose[0, body, 2] = self.x, self.y, self.angle
        velocity[0, body, 0], velocity[0, body, 1], velocity[0, body, 2] = self.vx, self.vy, self.spin
        state.cos[0, body], state.sin[0, body] = self.cos, self.sin
        self._world.untouched()

    def near(self) -> bool:
        """Whether something fixed is so near that a step must look for contacts: the broad phase, in floats."""
        x, y, reach = self.x, self.y, self._reach
        if y - reach > self._highest:
            return False
        around = [
            box
            for box in self._boxes
            if y - reach <= box[3] and box[1] <= y + reach and x - reach <= box[2] and box[0] <= x + reach
        ]
        for right, up, own in self._circles if around else ():
            centre_x = right * self.cos - up * self.sin + x
            centre_y = right * self.sin + up * self.cos + y
            for low_x, low_y, high_x, high_y in around:
                if (
                    centre_y - own <= high_y
                    and low_y <= centre_y + own
                    and centre_x - own <= high_x
                    and low_x <= centre_x + own
                ):
                    return True
        return False

    def step(self, force_x: float, force_y: float, torque: float, dt: float) -> None:
        """Advance by `dt` seconds under gravity, drag and this force, as `integrate` does."""
        vx, vy, spin = self.vx, self.vy, self.spin
        ease, turn_ease = self._inverse_mass * dt, self._inverse_inertia * dt
        gravity_x, gravity_y = self._gravity
        slowing = 1.0 + (self._drag + self._air * sqrt(vx * vx + vy * vy)) * ease
        turn_slowing = 1.0 + (self._turn_drag + self._turn_air * abs(spin)) * turn_ease
        self.vx = (vx + force_x * ease + gravity_x * dt) / slowing
        self.vy = (vy + force_y * ease + gravity_y * dt) / slowing
        self.spin = (spin + torque * turn_ease) / turn_slowing
        self.x += self.vx * dt
        self.y += self.vy * dt
        self.angle += self.spin * dt
        # NumPy's own functions: `math` has others, which may differ in the last bit.
        self.cos, self.sin = float(np.cos(self.angle)), float(np.sin(self.angle))
