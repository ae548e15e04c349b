"""The shape of the ground as decoration needs it: many heights at once, quickly."""

from __future__ import annotations

from functools import lru_cache
from typing import Final

import numpy as np

from ai.common.environment import Doubles
from ai.lander.environment import LanderEnv
from ai.lander.ground import Ground

_REACH: Final = 32.0  # metres to both sides
_STEP: Final = 0.1


class Relief:
    """Heights of the ground under one environment, its moving pad where that is now."""

    def __init__(self, env: LanderEnv) -> None:
        self._env = env
        self._heights = _heights(env.ground)

    def height(self, x: Doubles) -> Doubles:
        """Height in metres of what lies under x (k,), to the nearest tenth of a metre aside."""
        if self._env.conditions.moves:  # and nothing else is there: one pad on a plain
            x = x - float(self._env.pad_shift[0])
        places = np.rint((x + _REACH) / _STEP).astype(np.intp)
        heights: Doubles = self._heights[places.clip(0, len(self._heights) - 1)]
        return heights

    def deck(self, x: float) -> tuple[float, float] | None:
        """Return the edges of the pad under x, or None where there is none."""
        shift = float(self._env.pad_shift[0])
        return next(
            ((pad.left + shift, pad.right + shift) for pad in self._env.ground.pads
             if pad.left <= x - shift <= pad.right),
            None,
        )  # fmt: skip


@lru_cache(maxsize=8)
def _heights(ground: Ground) -> Doubles:
    return ground.height(np.arange(-_REACH, _REACH, _STEP))
