"""The whole landscape in one object: build it once per size, draw it each frame."""

from __future__ import annotations

from collections.abc import Sequence
from copy import copy, deepcopy
from functools import lru_cache
from typing import Final

import numpy as np
import pygame

from game.drawing.canvas import Canvas
from game.drawing.tokens import NIGHT0, VIEW_SIZE
from game.world.camera import POINTS_PER_METRE, Camera, View
from game.world.landscape.earth import paint_earth
from game.world.landscape.sheet import WorldPicture
from game.world.landscape.sky import NearStars, page_of, paint_sky
from game.world.landscape.terrain import (
    HORIZON_HEIGHT,
    MARGIN,
    PLAIN_HORIZON,
    RIDGES,
    WIDE_MARGIN,
    paint_plain,
    paint_ridge,
)
from game.world.landscape.themes import LOOKS, MOON, Theme

EARTH: Final = (312.0, 152.0)  # points
EARTH_RADIUS: Final = 43.0
_EARTH_DEPTH: Final = 0.008
_MOON: Final = 5
_PLAIN_DETAIL: Final = 1.5  # resolution at which the plain is painted for a camera that comes near


class Backdrop:
    """Sky, Earth, stars, ridges and plain for a view of `size` pixels.

    A page of 16:9 at the lower edge has the land and its sky; a wider view has more of both, a higher one more sky.
    The same generator state gives the same landscape. It can be drawn only at the size that it was built for;
    build another for another size.
    """

    def __init__(self, size: tuple[int, int], rng: np.random.Generator, reduced_motion: bool = False) -> None:
        self.size = size
        width, self._height = page_of(size)
        self._aside, self._above = (size[0] - width) // 2, size[1] - self._height  # beside the page, and above it
        self._unit = self._height / 720
        sky, stars, earth, self._plain_chance, *ranges = rng.spawn(4 + len(RIDGES))
        self._sky = paint_sky(size, sky)
        self._stars = NearStars(size, stars, still=reduced_motion)
        self._disc, self._air = paint_earth(EARTH_RADIUS * self._unit, earth)
        land = size[0], self._height
        self._ridges = [
            (*paint_ridge(land, ridge, own), ridge.depth) for ridge, own in zip(RIDGES, ranges, strict=True)
        ]
        self._plains: dict[float, tuple[WorldPicture, tuple[float, float]]] = {}
        self._look = MOON

    def under(self, look: Theme) -> Backdrop:
        """Return the same land under another theme: another world, or other light."""
        other = copy(self)
        other._look, other._plains = look, {}
        other._sky = look.on_sky(self._sky)
        other._ridges = [(look.on_land(sheet), top, depth) for sheet, top, depth in self._ridges]
        return other

    def draw(
        self, canvas: Canvas, camera: Camera, time: float, alpha: float = 1.0, earth: tuple[float, float] = EARTH
    ) -> None:
        """Fill the view. `time` in seconds moves the stars' twinkling and nothing else.

        `earth` is where the Earth's middle stands, in points.
        """
        self.paint(canvas.surface, camera.view(canvas.scale, alpha).filling(canvas), time, earth, canvas.words)

    def paint(
        self,
        surface: pygame.Surface,
        view: View | None = None,
        time: float = 0.0,
        earth: tuple[float, float] = EARTH,
        words: Sequence[pygame.Rect] = (),
    ) -> None:
        """Fill a surface of this backdrop's size, as seen in a view; without one, as at rest.

        No star is drawn inside `words`, in pixels: it would be read as a dot, or as a speck on a panel.

        Distant layers keep their size at any zoom. They move up and down with the horizon, and sideways by a small
        share of the camera's movement (parallax).
        """
        view = view or View(self._unit, origin=(self._aside, self._above))
        across = -view.centre[0] * POINTS_PER_METRE * view.scale
        horizon = float(view.pixels((0.0, HORIZON_HEIGHT))[1])
        down = round(horizon - self._above - PLAIN_HORIZON * self._height)
        surface.blit(self._sky, (0, down))
        if down > 0:  # no sky was painted there, but it is as dark as its top rows
            surface.blit(self._sky, (0, 0), (0, 0, self.size[0], down))
        elif down < 0:  # behind the plain, which may be the least bit translucent
            surface.fill(NIGHT0, (0, self.size[1] + down, self.size[0], -down))
        if self._look.stars:
            self._stars.draw(surface, (across, down), time, words)
        if self._look.earth:
            self._draw_earth(surface, earth, across, down)
        margin = MARGIN * self.size[0]
        for sheet, top, depth in self._ridges:
            surface.blit(sheet, (round(across * depth - margin), self._above + top + down))
        plain, corner = self._plain(view)
        plain.draw(surface, view, corner)

    def _plain(self, view: View) -> tuple[WorldPicture, tuple[float, float]]:
        """Return the plain and the place of its top left corner in the world; paint it when first needed at a size."""
        detail = min(view.closest, _PLAIN_DETAIL) or 1.0
        if detail not in self._plains:
            width, height = round(self.size[0] * detail), round(self._height * detail)
            rest = View(height / 720)
            margin = WIDE_MARGIN if view.closest else MARGIN
            picture, top = paint_plain((width, height), deepcopy(self._plain_chance), margin)
            if self._look is not MOON:
                picture = self._look.on_land(picture)
            wide = VIEW_SIZE[0] * self.size[0] / (self.size[0] - 2 * self._aside)  # points
            left = (VIEW_SIZE[0] - wide) / 2 - margin * wide
            x, y = rest.metres((left, top / rest.scale)).tolist()
            self._plains[detail] = WorldPicture(picture, rest.pixels_per_metre), (x, y)
        return self._plains[detail]

    def _draw_earth(self, surface: pygame.Surface, earth: tuple[float, float], across: float, down: int) -> None:
        x = self._aside + round(earth[0] * self._unit + across * _EARTH_DEPTH)
        y = self._above + round(earth[1] * self._unit) + down
        for sprite, flags in ((self._air, pygame.BLEND_RGB_ADD), (self._disc, 0)):
            surface.blit(sprite, (x - sprite.get_width() // 2, y - sprite.get_height() // 2), special_flags=flags)


def landscape(size: tuple[int, int], reduced_motion: bool, look: str = "moon") -> Backdrop:
    """Return the game's landscape at that size under a theme; all scenes share it."""
    return _paint_landscape(size, reduced_motion, look)  # positional: equal calls share a cache entry


@lru_cache(maxsize=3)
def _paint_landscape(size: tuple[int, int], reduced_motion: bool, look: str) -> Backdrop:
    if look != "moon":
        return landscape(size, reduced_motion).under(LOOKS[look])
    return Backdrop(size, np.random.default_rng(_MOON), reduced_motion)
