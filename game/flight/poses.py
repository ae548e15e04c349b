"""Poses of landers between two steps, for drawing."""

from __future__ import annotations

import numpy as np

from ai.environment import Bools, Doubles
from ai.lander.environment import LanderEnv


class Poses:
    """Last two poses x, y, angle of every lander, for interpolation when drawing."""

    def __init__(self, env: LanderEnv) -> None:
        self._env = env
        self.now = self._read()
        self.before = self.now

    def take(self, jumped: Bools | None = None) -> None:
        """Store the poses after a step; the slots of `jumped` were reset, and are not interpolated."""
        self.before, self.now = self.now, self._read()
        if jumped is not None and jumped.any():
            self.before = np.where(jumped[:, None], self.now, self.before)

    def at(self, alpha: float) -> Doubles:
        """Return poses (n, 3), interpolated between the last two steps by `alpha`, 0 to 1."""
        poses: Doubles = self.before + alpha * (self.now - self.before)
        return poses

    def _read(self) -> Doubles:
        return np.concatenate([self._env.position, self._env.angle[:, None]], axis=1)
