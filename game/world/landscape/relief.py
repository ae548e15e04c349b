"""Height map of the ground for decoration: many heights in one fast look-up."""

from __future__ import annotations

from functools import lru_cache
from typing import Final

import numpy as np

from ai.environment import Doubles
from ai.lander.environment import LanderEnv
from ai.lander.ground import Ground

_REACH: Final = 32.0  # metres to both sides
_STEP: Final = 0.1


class Relief:
    """Height map of one environment's ground, with a moving pad at its current place."""

    def __init__(self, env: LanderEnv) -> None:
        self._env = env
        self._heights = _heights(env.ground)

    def height(self, x: Doubles) -> Doubles:
        """Return the height in metres of the ground or pad under x (k,); x is rounded to a tenth of a metre."""
        if self._env.conditions.moves:  # such a world has one pad on a plain, and nothing else
            x = x - float(self._env.pad_shift[0])
        places = np.rint((x + _REACH) / _STEP).astype(np.intp)
        heights: Doubles = self._heights[places.clip(0, len(self._heights) - 1)]
        return heights

    def deck(self, x: float) -> tuple[float, float] | None:
        """Return the edges of the pad under x, or None where there is none."""
        shift = float(self._env.pad_shift[0])
        return next(
            (
                (pad.left + shift, pad.right + shift)
                for pad in self._env.ground.pads
                if pad.left <= x - shift <= pad.right
            ),
            None,
        )


@lru_cache(maxsize=8)
def _heights(ground: Ground) -> Doubles:
    return ground.height(np.arange(-_REACH, _REACH, _STEP))
