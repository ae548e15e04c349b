"""Semi-implicit Euler: velocity first, then position with the new velocity."""

from __future__ import annotations

import numpy as np

from engine.state import BodyParams, BodyState
from engine.vector import Array


def integrate_velocity(state: BodyState, params: BodyParams, gravity: Array, dt: float) -> None:
    """Let gravity (2,) or (batch, 2), gathered forces and drag change the velocities in place.

    Drag is the force -(linear + quadratic·|v|)·v, for translation and rotation apart. It is taken implicitly
    in v, so that no coefficient, however large, can turn a motion round; terminal speeds are exact.
    """
    ease = params.inverse_mass * dt  # how much a unit of force changes a velocity in one step
    fall = np.where(params.dynamic[:, None], gravity[..., None, :] * dt, 0.0)
    if not state.active.all():
        ease = ease * state.active[..., None]
        fall = fall * state.active[..., None]
    damping = params.linear_drag
    if params.quadratic_drag.any():
        damping = damping + params.quadratic_drag * _speeds(state.velocity)
    state.velocity += state.force * ease
    state.velocity[..., :2] += fall
    if damping.any():
        state.velocity /= 1.0 + damping * ease


def integrate_position(state: BodyState, dt: float) -> None:
    """Move every active body along its velocity, in place."""
    step = state.velocity * dt
    if not state.active.all():
        step *= state.active[..., None]
    state.pose += step
    state.refresh_rotation()


def _speeds(velocity: Array) -> Array:
    """|v|, |v|, |ω| for each body, (..., 3)."""
    speed = np.abs(velocity)
    speed[..., 0] = np.sqrt(velocity[..., 0] ** 2 + velocity[..., 1] ** 2)
    speed[..., 1] = speed[..., 0]
    return speed
