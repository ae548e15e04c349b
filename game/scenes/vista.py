"""What is seen behind the menu: the game's own moon, and a lander that hovers over its pad."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from game.clock import STEP
from game.render import Camera
from game.ui.canvas import Canvas
from game.world.backdrop import landscape
from game.world.pad import draw_pad
from game.world.stage import STAND, draw_craft

_PAD: Final = (9.0, 1.6)
_PAD_WIDTH: Final = 6.0
_HEIGHT: Final = 5.4
_EARTH: Final = (824.0, 168.0)
_IDLE: Final = np.array([0.0, 0.0, 0.0])


class Vista:
    """The view behind the menu; while it is `still`, the lander stands on its pad and nothing moves."""

    def __init__(self) -> None:
        self.still = False
        self._camera = Camera()
        self._time = 0.0

    def update(self) -> None:
        """Let 1/60 s pass."""
        if not self.still:
            self._time += STEP

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Fill the view."""
        time = 0.0 if self.still else self._time + alpha * STEP
        view = self._camera.view(canvas.scale)
        landscape(canvas.surface.get_size(), self.still).draw(canvas, self._camera, time, earth=_EARTH)
        draw_pad(canvas, view, _PAD, _PAD_WIDTH, time)
        pose, thrust = self._pose(time)
        draw_craft(canvas, view, pose, thrust, 1.0, int(time * 60))

    def _pose(self, time: float) -> tuple[np.ndarray, np.ndarray]:
        x, y = _PAD
        if self.still:
            return np.array([x, y + STAND, 0.0]), _IDLE
        sway, bob = math.sin(0.5 * time), math.sin(0.8 * time)
        lean = -0.05 * math.cos(0.5 * time)
        main = 0.72 - 0.14 * bob
        return np.array([x + 0.7 * sway, y + _HEIGHT + 0.35 * bob, lean]), np.array([main, 0.0, 0.0])
