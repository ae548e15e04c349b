"""Sensing: the nine numbers that a pilot observes, as a function of a lander's state."""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from ai.common.environment import Doubles, Floats
from ai.lander.rules import NUM_FEATURES, OBSERVATION_SCALE

# Metres sideways beyond which networks were never trained: with several pads, farther ones are shown at this.
_FAR: Final = 16.0


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
    if pads > 1:
        numbers[:, 0].clip(-_FAR, _FAR, out=numbers[:, 0])
    numbers *= OBSERVATION_SCALE
    return numbers.astype(np.float32)
