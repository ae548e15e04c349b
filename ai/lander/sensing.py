"""Sensing: the nine numbers that a pilot observes, as a function of a lander's state, and those of its surroundings."""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from ai.common.environment import Doubles, Floats
from ai.lander.craft import Craft
from ai.lander.rules import NUM_FEATURES, OBSERVATION_SCALE, Limits

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
# The ground's height at places beside a lander, above the pad's top in metres times the factor below.
_BESIDE: Final = (-5.0, -2.5, 0.0, 2.5, 5.0)  # metres
_HEIGHT: Final = 0.3
_BEYOND: Final = np.linspace(5.0, 15.0, 11)  # metres: the highest of these is a crest that may be in the way
_PLACES: Final = np.concatenate([-_BEYOND[::-1], _BESIDE, _BEYOND])
TERRAIN: Final = (
    "crest left", "ground far left", "ground left", "ground below", "ground right", "ground far right", "crest right"
)  # fmt: skip
AROUND: Final = (*SURROUNDINGS, *TERRAIN)
LONG, _AHEAD, _SOON = 20.0, 8.0, 2.0  # seconds: what is farther off than the first two is shown as they are


def sensed(
    offset: Doubles, velocity: Doubles, sin: Doubles, cos: Doubles, spin: Doubles, contacts: Any, *, pads: int = 1
) -> Floats:
    """Return the observations (n, 9) of n states.

    Args:
        offset: metres from standing on the middle of the pad, (n, 2).
        velocity: m/s relative to the pad, (n, 2).
        sin, cos: of the angle, (n,).
        spin: rad/s, (n,).
        contacts: whether the left and the right foot stand on the pad, (n, 2).
        pads: how many pads the ground has.

    """
    numbers = np.empty((len(offset), NUM_FEATURES))
    numbers[:, 0:2] = offset
    numbers[:, 2:4] = velocity
    numbers[:, 4] = sin
    numbers[:, 5] = cos
    numbers[:, 6] = spin
    numbers[:, 7:9] = contacts
    return scaled(numbers, pads)


def scaled(numbers: Doubles, pads: int) -> Floats:
    """Return the observations of numbers (n, 9) in SI units, which are changed, over a ground with so many pads."""
    if pads > 1:
        numbers[:, 0].clip(-_FAR, _FAR, out=numbers[:, 0])
    numbers *= OBSERVATION_SCALE
    return numbers.astype(np.float32)


def surroundings(craft: Craft, limits: Limits, pad: Any) -> Floats:
    """Return what is around each lander, (n, k): `SURROUNDINGS` names the numbers, scaled by `SURROUNDINGS_SCALE`.

    A failure of the engine is announced: it is seen to come. `pad` is one number, or one for each slot.
    """
    conditions, params, time = craft.conditions, craft.params, craft.time
    numbers = np.zeros((craft.num_envs, len(SURROUNDINGS)))
    numbers[:, 0] = np.minimum(limits.time - time, LONG)
    numbers[:, 1] = craft.ground.widths[pad]
    numbers[:, 2] = -craft.world.gravity[..., 1]
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
        numbers[:, 10] = np.clip(conditions.tank - craft.fuel, 0.0, _AHEAD)
    if conditions.moves:
        numbers[:, 11], numbers[:, 12] = craft.pad_velocity, craft.pad_acceleration
    numbers[:, 13] = params.quadratic_drag
    numbers[:, 14] = limits.touch_speed
    numbers *= SURROUNDINGS_SCALE
    return numbers.astype(np.float32)


def terrain(craft: Craft, pad: Any) -> Floats:
    """Return the ground's height beside each lander, (n, 7): `TERRAIN` names the places. Pads count where they rest."""
    heights = _in_order(craft.ground.height_near(craft.position[:, :1] + _PLACES))
    above = heights - np.reshape(craft.ground.middles[pad, 1], (-1, 1))
    return (_HEIGHT * above).astype(np.float32)


def _in_order(heights: Doubles) -> Doubles:
    """Return what `TERRAIN` names, (n, 7), of the ground's heights at `_PLACES`."""
    left, beside, right = np.split(heights, (len(_BEYOND), len(_BEYOND) + len(_BESIDE)), axis=1)
    return np.column_stack([left.max(axis=1), beside, right.max(axis=1)])
