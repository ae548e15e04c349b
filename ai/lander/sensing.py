"""Sensing: the nine numbers that a pilot observes, those of its surroundings, and edges of the area that are near."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final, Literal

import numpy as np

from ai.environment import Doubles, Floats
from ai.lander.rules import NUM_FEATURES, OBSERVATION_SCALE, Outcome

if TYPE_CHECKING:
    from ai.lander.environment import LanderEnv

# Metres sideways beyond which networks were never trained: with several pads, farther ones are shown at this.
_FAR: Final = 16.0
# What is around a lander besides the pad: its name, and the factor that scales it as observations are scaled.
_SCALED: Final[dict[str, float]] = {
    "time left": 0.1,  # seconds, 20 at the most
    "pad width": 0.3,  # metres
    "gravity": 0.2,  # m/s²
    "thrust": 0.1,  # of the main engine for each kilogram, m/s²
    "wind": 2.0,  # its push on each kilogram now, m/s² to the right
    "wind soon": 2.0,  # the same, on average over the next two seconds
    "mean wind": 2.0,  # the same, without gusts
    "main engine": 1.0,  # 1 if it works now, 0 if it is dead
    "dead in": 0.25,  # seconds until it fails, 8 at the most; 0 while it is dead
    "back in": 0.25,  # seconds until it works again, 8 at the most; 0 while it works
    "fuel left": 0.25,  # seconds of main engine, 8 at the most
    "pad velocity": 0.5,  # m/s to the right
    "pad acceleration": 1.0,  # m/s² to the right
    "air": 10.0,  # drag for each squared m/s, kg/m
    "touch speed": 0.5,  # fastest allowed, m/s
}
SURROUNDINGS: Final = tuple(_SCALED)
SURROUNDINGS_SCALE: Final = np.array(list(_SCALED.values()))
# Multiply surroundings by this to swap left and right.
SURROUNDINGS_MIRROR: Final = np.array(
    [-1 if "wind" in name or name in ("pad velocity", "pad acceleration") else 1 for name in SURROUNDINGS],
    dtype=np.float32,
)
LONG, _AHEAD, _SOON = 20.0, 8.0, 2.0  # seconds: what is farther off than the first two is shown as they are
NEAR: Final = 10.0  # metres within which an edge of the area is announced


def sensed(
    offset: Doubles, velocity: Doubles, sin: Doubles, cos: Doubles, spin: Doubles, feet_down: Any, *, pads: int = 1
) -> Floats:
    """Return the observations (n, 9) of n states over a ground with so many pads.

    Args:
        offset: metres from standing on the middle of the pad, (n, 2).
        velocity: m/s relative to the pad, (n, 2).
        sin, cos: of the angle, (n,).
        spin: rad/s, (n,).
        feet_down: whether the left and the right foot stand on the pad, (n, 2).
        pads: how many pads a lander may choose from.

    """
    numbers = np.empty((len(offset), NUM_FEATURES))
    numbers[:, 0:2] = offset
    numbers[:, 2:4] = velocity
    numbers[:, 4] = sin
    numbers[:, 5] = cos
    numbers[:, 6] = spin
    numbers[:, 7:9] = feet_down
    if pads > 1:
        numbers[:, 0].clip(-_FAR, _FAR, out=numbers[:, 0])
    numbers *= OBSERVATION_SCALE
    return numbers.astype(np.float32)


def surroundings(env: LanderEnv, pad: Any) -> Floats:
    """Return what is around each lander, (n, k): `SURROUNDINGS` names the numbers, scaled by `SURROUNDINGS_SCALE`.

    A failure of the engine is announced: it is seen to come. `pad` is one number, or one for each slot.
    """
    conditions, params, time = env.conditions, env.params, env.time
    numbers = np.zeros((env.num_envs, len(SURROUNDINGS)))
    numbers[:, 0] = np.minimum(env.limits.time - time, LONG)
    numbers[:, 1] = env.ground.widths[pad]
    numbers[:, 2] = -env.world.gravity[..., 1]
    numbers[:, 3] = params.main_thrust / params.mass
    if conditions.pushes:
        soon = (conditions.impulse(time + _SOON) - conditions.impulse(time)) / _SOON
        for column, push in ((4, conditions.push(time)), (5, soon), (6, conditions.wind)):
            numbers[:, column] = push
        numbers[:, 4:7] /= params.mass
    numbers[:, 7] = 1.0
    numbers[:, 8] = numbers[:, 10] = _AHEAD
    if conditions.fails:
        start, end = conditions.outage
        works = numbers[:, 7] = conditions.main_works(time)
        numbers[:, 8] = np.where(time < end, np.clip(start - time, 0.0, _AHEAD), _AHEAD)
        numbers[:, 9] = np.where(works, 0.0, np.minimum(end - time, _AHEAD))
        numbers[:, 10] = np.clip(conditions.tank - env.fuel, 0.0, _AHEAD)
    if conditions.moves:
        shift, numbers[:, 11] = conditions.shift(time)
        numbers[:, 12] = -((2 * np.pi / conditions.swing_period) ** 2) * shift
    numbers[:, 13] = params.quadratic_drag
    numbers[:, 14] = env.limits.touch_speed
    numbers *= SURROUNDINGS_SCALE
    return numbers.astype(np.float32)


@dataclass(frozen=True)
class Edge:
    """An edge near a lander: its `place` is a metre mark across, or up for the one above; `away` is in metres."""

    side: Literal["left", "right", "above"]
    place: float
    away: float
    ahead: bool  # whether the lander moves towards it


def near_edges(env: LanderEnv, slot: int = 0) -> list[Edge]:
    """Return the edges of the area within `NEAR` of a lander in flight, the nearest first."""
    if env.outcome[slot] != Outcome.FLYING:
        return []
    (x, y), (across, up), limits = env.position[slot].tolist(), env.velocity[slot].tolist(), env.limits
    wide, ceiling = limits.half_width, limits.ceiling
    edges = (
        Edge("left", -wide, max(0.0, x + wide), across < 0),
        Edge("right", wide, max(0.0, wide - x), across > 0),
        Edge("above", ceiling, max(0.0, ceiling - y), up > 0),
    )
    return sorted((edge for edge in edges if edge.away < NEAR), key=lambda edge: edge.away)
