"""One small lander in a chapter's picture: it flies in the real environment, drawn in a box of the screen."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Final

import numpy as np
import pygame

from ai.lander.environment import LanderEnv
from game.drawing.canvas import Canvas
from game.drawing.tokens import VIEW_SIZE
from game.flight.poses import Poses
from game.world import lander as art
from game.world.camera import POINTS_PER_METRE, View
from game.world.craft import draw_craft

_IGNITE: Final = 0.34  # share of the way to full or no thrust that a flame covers per step


def view_in(box: pygame.FRect, middle: tuple[float, float], metres: float, scale: float) -> View:
    """Return the view that shows `metres` of width in a box, in points, with `middle` in the middle of the box."""
    zoom = box.width / metres / POINTS_PER_METRE
    per_metre = POINTS_PER_METRE * zoom
    aside, below = box.centerx - VIEW_SIZE[0] / 2, box.centery - VIEW_SIZE[1] / 2
    return View(scale, (middle[0] - aside / per_metre, middle[1] + below / per_metre), zoom)


@contextmanager
def inside(canvas: Canvas, box: pygame.FRect) -> Iterator[None]:
    """Draw nothing outside a box, in points; a context manager."""
    before = canvas.surface.get_clip()
    canvas.surface.set_clip(canvas.rect(*box).clip(before))
    try:
        yield
    finally:
        canvas.surface.set_clip(before)


class DrawnLander:
    """Picture of a single lander in its environment; call `follow` after every physics step."""

    def __init__(self, env: LanderEnv, *, network: bool = True) -> None:
        self._env, self._network = env, network
        self.begin()

    def begin(self) -> None:
        """Show the lander where it is now, its engines off."""
        self._poses = Poses(self._env)
        self._thrust, self._flicker = np.zeros(3), 0

    def follow(self) -> None:
        """Take the lander's new pose, and ease its flames."""
        fired = int(self._env.fired[0])
        wanted = np.array([fired >= 3, fired % 3 == 2, fired % 3 == 1], float)
        self._thrust += _IGNITE * (wanted - self._thrust)
        self._flicker += 1
        self._poses.take()

    def draw(self, canvas: Canvas, view: View, alpha: float) -> None:
        """Draw it between its last two poses."""
        draw_craft(
            canvas, view, art.LANDER, self._poses.at(alpha)[0], self._thrust, float(self._network), self._flicker
        )
