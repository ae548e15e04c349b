"""Craft: its shapes in a world of the engine over a ground, and what pushes it in a physics step."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from ai.environment import Doubles
from ai.lander.ground import Ground
from ai.lander.rules import FOOT_CENTRE, FOOT_SIZE, HULL, LanderParams
from engine import DT, Body, Polygon, World

if TYPE_CHECKING:
    from ai.lander.environment import LanderEnv

_ALONG: Final = np.linspace(0.0, 1.0, 32, endpoint=False)[:, None, None]  # of every edge of the craft


def parts() -> list[Polygon]:
    """Return the shapes of the craft, its centre of mass at the origin: hull, left foot, right foot."""
    x, y = FOOT_CENTRE
    return [Polygon(HULL), Polygon.box(*FOOT_SIZE, (-x, y)), Polygon.box(*FOOT_SIZE, (x, y))]


def build(num_envs: int, params: LanderParams, ground: Ground) -> tuple[World, Body, slice]:
    """Return so many worlds with one craft in each, that craft, and the pads among the bodies."""
    surface: dict[str, Any] = {"restitution": params.restitution, "friction": params.friction}
    world = World(gravity=(0.0, -params.gravity), batch=num_envs, iterations=5, sleeping=False)
    craft = world.add(
        parts(),
        (0.0, params.pad_top + params.stand),
        mass=params.mass,
        inertia=params.inertia,
        centre_of_mass=(0.0, 0.0),
        linear_drag=params.linear_drag,
        quadratic_drag=params.quadratic_drag,
        angular_drag=params.angular_drag,
        angular_quadratic_drag=params.angular_quadratic_drag,
        **surface,
    )
    pads = ground.build(world, **surface)
    return world, craft, slice(pads[0].index, pads[-1].index + 1)


def push(env: LanderEnv, main: Doubles, side: Doubles) -> None:
    """Push every craft by these shares of thrust, (n,), and by the wind, and move pads that move to where they are."""
    params, state, body = env.params, env.world.state, env.lander.index
    up, aside = params.main_thrust * main, params.side_thrust * side
    cos, sin = state.cos[:, body], state.sin[:, body]
    state.force[:, body, 0] = aside * cos - up * sin
    state.force[:, body, 1] = aside * sin + up * cos
    state.force[:, body, 2] = -aside * params.side_arm
    if env.conditions.pushes:
        state.force[:, body, 0] += env.conditions.push(env.time)
    if env.conditions.moves:
        move_pads(env, env.time)


def move_pads(env: LanderEnv, time: Doubles) -> None:
    """Set position and velocity of moving pads as of a time (n,), so that a step carries what stands on them."""
    state, bodies = env.world.state, env.pad_bodies
    shift, velocity = env.conditions.shift(time)
    state.pose[:, bodies, 0] = env.ground.middles[:, 0] + shift[:, None]
    state.velocity[:, bodies, 0] = velocity[:, None]
    env.world.forget_boxes(bodies)


def carry_pads(env: LanderEnv, time: Doubles) -> None:
    """Put moving pads where the step of a world that began at a time (n,) leaves them."""
    if env.conditions.moves:
        move_pads(env, time)
        state, bodies = env.world.state, env.pad_bodies
        state.pose[:, bodies, 0] += state.velocity[:, bodies, 0] * DT


def _outline() -> Doubles:
    """Return points around the craft, metres from its centre of mass, (k, 2): every corner, and some between."""
    corners = (part.vertices for part in parts())
    return np.concatenate([(part + _ALONG * (np.roll(part, -1, axis=0) - part)).reshape(-1, 2) for part in corners])


_OUTLINE: Final = _outline()


def lowest(ground: Ground, x: float, angle: float) -> float:
    """Return the least height, in metres, at which a craft at `x` that leans by `angle` clears the ground.

    Pads that move count where they are at rest.
    """
    cos, sin = math.cos(angle), math.sin(angle)
    across, up = (_OUTLINE @ np.array([[cos, sin], [-sin, cos]])).T
    return float((ground.height(x + across) - up).max())
