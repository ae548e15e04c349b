"""The whole landscape in one object: build it once per size, draw it each frame."""

from __future__ import annotations

from functools import lru_cache
from typing import Final

import numpy as np
import pygame

from game.render import Camera
from game.ui.canvas import Canvas
from game.world.earth import paint_earth
from game.world.sky import NearStars, paint_sky
from game.world.terrain import MARGIN, RIDGES, paint_plain, paint_ridge

EARTH: Final = (312.0, 152.0)  # points
EARTH_RADIUS: Final = 43.0
_EARTH_DEPTH: Final = 0.04
_MOON: Final = 5


class Backdrop:
    """Sky, Earth, stars, ridges and plain for a view of `size` pixels.

    The same generator state gives the same landscape. Drawing at another size than it was built for is an
    error: build another.
    """

    def __init__(self, size: tuple[int, int], rng: np.random.Generator, reduced_motion: bool = False) -> None:
        self.size = size
        sky, stars, earth, plain, *ranges = rng.spawn(4 + len(RIDGES))
        self._sky = paint_sky(size, sky)
        self._stars = NearStars(size, stars, still=reduced_motion)
        self._disc, self._air = paint_earth(EARTH_RADIUS * size[1] / 720, earth)
        self._layers = [
            (*paint_ridge(size, ridge, own), ridge.depth) for ridge, own in zip(RIDGES, ranges, strict=True)
        ]
        self._layers.append((*paint_plain(size, plain), 1.0))

    def draw(
        self, canvas: Canvas, camera: Camera, time: float, alpha: float = 1.0, earth: tuple[float, float] = EARTH
    ) -> None:
        """Fill the view. `time` in seconds moves the stars' twinkling and nothing else.

        `earth` is where the Earth's middle stands, in points.
        """
        self.paint(canvas.surface, camera.view(canvas.scale, alpha).shift, time, earth)

    def paint(
        self,
        surface: pygame.Surface,
        shift: tuple[float, float] = (0.0, 0.0),
        time: float = 0.0,
        earth: tuple[float, float] = EARTH,
    ) -> None:
        """Fill a surface of this backdrop's size, the near world moved by `shift` pixels."""
        across, down = shift
        surface.blit(self._sky, (0, 0))
        self._stars.draw(surface, (across, down), time)
        self._draw_earth(surface, earth, across, down)
        margin = MARGIN * self.size[0]
        for sheet, top, depth in self._layers:
            surface.blit(sheet, (round(across * depth - margin), round(top + down * depth)))

    def _draw_earth(self, surface: pygame.Surface, earth: tuple[float, float], across: float, down: float) -> None:
        unit = self.size[1] / 720
        x = round(earth[0] * unit + across * _EARTH_DEPTH)
        y = round(earth[1] * unit + down * _EARTH_DEPTH)
        for sprite, flags in ((self._air, pygame.BLEND_RGB_ADD), (self._disc, 0)):
            surface.blit(sprite, (x - sprite.get_width() // 2, y - sprite.get_height() // 2), special_flags=flags)


@lru_cache(maxsize=2)
def landscape(size: tuple[int, int], reduced_motion: bool) -> Backdrop:
    """Return the game's own moon at that size, shared by every scene that shows it."""
    return Backdrop(size, np.random.default_rng(_MOON), reduced_motion)
