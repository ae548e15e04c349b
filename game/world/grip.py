"""The mouse takes hold of a body: a damped spring between a point of it and the mouse."""

from __future__ import annotations

from typing import Final

import numpy as np

from engine import Body
from engine.vector import Array, cross, rotate

_PACE: Final = 12.0  # of the spring, rad/s
_DAMPING: Final = 0.8  # 1 would be critical
_STRONGEST: Final = 150.0  # m/s² of the grabbed body: a hand may throw, it may not tear through the floor


class Grip:
    """Holds `body` where it was taken; `target` in metres is where the hand is now."""

    def __init__(self, body: Body, place: Array) -> None:
        self.body = body
        self.target = place
        angle = float(body.angle[0])
        self._arm = rotate(place - body.position[0], np.cos(-angle), np.sin(-angle))

    def place(self, pose: Array) -> Array:
        """Where the grabbed point is, in metres, with the body at a pose (3,)."""
        return pose[:2] + rotate(self._arm, np.cos(pose[2]), np.sin(pose[2]))

    def pull(self) -> None:
        """Pull for the next step."""
        body = self.body
        arm = self.place(np.append(body.position[0], body.angle[0])) - body.position[0]
        turning = float(body.angular_velocity[0])
        velocity = body.velocity[0] + turning * np.array([-arm[1], arm[0]])
        away = self.target - body.position[0] - arm
        # How heavy the body feels at that point: less and less the farther it is from the middle.
        mass = 1.0 / (1.0 / body.mass + float(arm @ arm) / body.inertia)
        force = mass * (_PACE**2 * away - 2 * _DAMPING * _PACE * velocity)
        most = _STRONGEST * mass
        force *= min(1.0, most / max(float(np.hypot(*force)), 1e-9))
        body.apply_force(force)
        body.apply_torque(cross(arm, force))
