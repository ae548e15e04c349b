"""Semi-implicit Euler: velocity first, then position with the new velocity."""

from __future__ import annotations

import numpy as np

from engine.state import BodyParams, BodyState, Span
from engine.vector import Array


def integrate_velocity(state: BodyState, params: BodyParams, bodies: Span, gravity: Array, dt: float) -> None:
    """Let gravity (2,) or (batch, 2), gathered forces and drag change the velocities of `bodies` in place.

    Drag is the force -(linear + quadratic·|v|)·v, for translation and rotation apart. It is taken implicitly
    in v, so that no coefficient, however large, can turn a motion round; terminal speeds are exact.
    """
    velocity = state.velocity[:, bodies]
    ease = params.inverse_mass[bodies] * dt  # how much a unit of force changes a velocity in one step
    fall = np.where(params.dynamic[bodies, None], np.asarray(gravity)[..., None, :] * dt, 0.0)
    active = state.active[:, bodies, None]
    if not active.all():
        ease, fall = ease * active, fall * active
    damping = params.linear_drag[bodies]
    if params.quadratic_drag[bodies].any():
        damping = damping + params.quadratic_drag[bodies] * _speeds(velocity)
    velocity += state.force[:, bodies] * ease
    velocity[..., :2] += fall
    if damping.any():
        velocity /= 1.0 + damping * ease
    state.velocity[:, bodies] = velocity


def integrate_position(state: BodyState, bodies: Span, dt: float) -> None:
    """Move `bodies`, if active, along their velocities, in place."""
    step = state.velocity[:, bodies] * dt
    active = state.active[:, bodies, None]
    if not active.all():
        step *= active
    state.pose[:, bodies] += step


def _speeds(velocity: Array) -> Array:
    """|v|, |v|, |ω| for each body, (..., 3)."""
    speed = np.abs(velocity)
    speed[..., 0] = np.sqrt(velocity[..., 0] ** 2 + velocity[..., 1] ** 2)
    speed[..., 1] = speed[..., 0]
    return speed
