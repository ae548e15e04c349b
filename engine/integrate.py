"""Semi-implicit Euler: velocity first, then position with the new velocity."""

from __future__ import annotations

import numpy as np

from engine.state import BodyParams, BodyState, Span
from engine.vector import Array, Bools


def integrate_velocity(
    state: BodyState, params: BodyParams, movers: Span, gravity: Array, dt: float, awake: Bools | None = None
) -> None:
    """Change the velocities of `movers` by gravity (2,) or (batch, 2), by the accumulated forces, and by drag.

    Of them, those move that are active, and `awake` (batch, bodies) if that is given. Gravity pulls only at bodies that
    forces can move.

    Drag is the force -(k + q·|v|)·v, with k the linear coefficient (kg/s) and q the quadratic one (kg/m):

        v' = (v + (F/m + g)·dt) / (1 + (k + q·|v|)·dt/m)

    and likewise for the spin, with torque, inertia, kg·m²/s and kg·m². v is taken as it is after the step (implicitly),
    |v| as it was before. So no coefficient, however large, can turn a motion round, and terminal speeds are exact.
    """
    velocity = state.velocity[:, movers]
    per_force = params.inverse_mass[movers] * dt
    fall = gravity[..., None, :] * (dt * params.dynamic[movers, None])
    moving = _moving(state, movers, awake)
    if moving is not None:
        per_force, fall = per_force * moving, fall * moving
    drag, quadratic = params.linear_drag[movers], params.quadratic_drag[..., movers, :]
    if quadratic.any():
        drag = drag + quadratic * _speeds(velocity)
    velocity = velocity + state.force[:, movers] * per_force
    velocity[..., :2] += fall
    if drag.any():
        velocity /= 1.0 + drag * per_force
    state.velocity[:, movers] = velocity


def integrate_position(state: BodyState, movers: Span, dt: float, awake: Bools | None = None) -> None:
    """Move `movers`, if active, and awake if that is given, along their velocities."""
    step = state.velocity[:, movers] * dt
    moving = _moving(state, movers, awake)
    if moving is not None:
        step *= moving
    state.pose[:, movers] += step


def _moving(state: BodyState, movers: Span, awake: Bools | None) -> Bools | None:
    """Which of the movers are active and awake, (batch, movers, 1); None if all are."""
    moving = state.active[:, movers] if awake is None else state.active[:, movers] & awake[:, movers]
    return None if moving.all() else moving[..., None]


def _speeds(velocity: Array) -> Array:
    """|v|, |v|, |ω| for each body, (..., 3)."""
    speed = np.abs(velocity)
    speed[..., 0] = np.sqrt(velocity[..., 0] ** 2 + velocity[..., 1] ** 2)
    speed[..., 1] = speed[..., 0]
    return speed
