"""Semi-implicit Euler: velocity first, then position with the new velocity."""

from __future__ import annotations

import numpy as np

from engine.state import BodyParams, BodyState, Span, span
from engine.vector import Array, Bools, every


class MovingBodies:
    """Bodies that a step moves, as `chosen` (bodies,) marks them, with the parameters it needs gathered once."""

    def __init__(self, params: BodyParams, chosen: Bools) -> None:
        self.bodies: Span = span(chosen)
        self.inverse_mass = params.inverse_mass[self.bodies]
        self.linear_drag = params.linear_drag[self.bodies]
        self.quadratic_drag = params.quadratic_drag[..., self.bodies, :]
        self.falls = params.dynamic[self.bodies, None]
        self.all_fall = bool(self.falls.all())
        # Whether any grows with the square of the speed; the air of each world may be changed in place.
        self.fast_drag = self.quadratic_drag.ndim == 3 or bool(self.quadratic_drag.any())
        self.any_drag = self.fast_drag or bool(self.linear_drag.any())
        self._ease = (np.nan, self.inverse_mass)

    def ease(self, dt: float) -> Array:
        """Change of velocity (bodies, 3) per unit of force in a step of `dt` seconds, kept from the last call."""
        if self._ease[0] != dt:
            self._ease = (dt, self.inverse_mass * dt)
        return self._ease[1]


def integrate_velocity(
    state: BodyState, movers: MovingBodies, gravity: Array, dt: float, awake: Bools | None = None
) -> None:
    """Apply gravity (2,) or (batch, 2), accumulated forces and drag to the velocities of `movers`, in place.

    Of them, those move that are active, and `awake` (batch, bodies) if that is given.

    Drag is the force -(linear + quadratic·|v|)·v, for translation and rotation apart. It is taken implicitly
    in v, so that no coefficient, however large, can reverse a motion; terminal speeds are exact.
    """
    bodies = movers.bodies
    velocity = state.velocity[:, bodies]
    ease = movers.ease(dt)
    fall = np.asarray(gravity)[..., None, :] * dt
    if not movers.all_fall:
        fall = np.where(movers.falls, fall, 0.0)
    active = state.active[:, bodies, None]
    if awake is not None:
        active = active & awake[:, bodies, None]
    if not every(active):
        ease, fall = ease * active, fall * active
    damping = movers.linear_drag
    if movers.fast_drag:
        damping = damping + movers.quadratic_drag * _speeds(velocity)
    velocity += state.force[:, bodies] * ease
    places = velocity[..., :2]
    places += fall
    if movers.any_drag:
        velocity /= 1.0 + damping * ease
    if not isinstance(bodies, slice):  # indexing made a copy; a slice is a view
        state.velocity[:, bodies] = velocity


def integrate_position(state: BodyState, bodies: Span, dt: float, awake: Bools | None = None) -> None:
    """Move `bodies`, if active, and awake if that is given, along their velocities, in place."""
    step = state.velocity[:, bodies] * dt
    active = state.active[:, bodies, None]
    if awake is not None:
        active = active & awake[:, bodies, None]
    if not every(active):
        step *= active
    if isinstance(bodies, slice):
        pose = state.pose[:, bodies]
        pose += step
    else:
        state.pose[:, bodies] += step


def _speeds(velocity: Array) -> Array:
    """|v|, |v|, |ω| for each body, (..., 3)."""
    speed = np.abs(velocity)
    speed[..., 0] = np.sqrt(velocity[..., 0] ** 2 + velocity[..., 1] ** 2)
    speed[..., 1] = speed[..., 0]
    return speed
