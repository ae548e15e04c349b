"""Mouse grip: a damped spring between a point of a body and the mouse."""

from __future__ import annotations

from typing import Final

import numpy as np

from engine import Body
from engine.vector import Array, cross, rotate

_PACE: Final = 12.0  # of the spring, rad/s
_DAMPING: Final = 0.8  # 1 would be critical
_STRONGEST: Final = 150.0  # m/s² of the grabbed body: a hand may throw, it may not tear through the floor


class Grip:
    """Spring that pulls the gripped point of `body` towards `target`, the place of the hand in metres."""

    def __init__(self, body: Body, place: Array) -> None:
        self.body = body
        self.target = place
        angle = float(body.angle[0])
        self._arm = rotate(place - body.position[0], np.cos(-angle), np.sin(-angle))

    def place(self, pose: Array) -> Array:
        """Return the gripped point, in metres, with the body at a pose (3,)."""
        return pose[:2] + rotate(self._arm, np.cos(pose[2]), np.sin(pose[2]))

    def pull(self) -> None:
        """Apply the spring's force for the next step."""
        body = self.body
        arm = self.place(np.append(body.position[0], body.angle[0])) - body.position[0]
        turning = float(body.angular_velocity[0])
        velocity = body.velocity[0] + turning * np.array([-arm[1], arm[0]])
        away = self.target - body.position[0] - arm
        # Effective mass of the body at that point: it falls with the distance from the centre of mass.
        mass = 1.0 / (1.0 / body.mass + float(arm @ arm) / body.inertia)
        force = mass * (_PACE**2 * away - 2 * _DAMPING * _PACE * velocity)
        most = _STRONGEST * mass
        force *= min(1.0, most / max(float(np.hypot(*force)), 1e-9))
        body.apply_force(force)
        body.apply_torque(cross(arm, force))
