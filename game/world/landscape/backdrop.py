"""The whole landscape in one object: build it once per size, draw it each frame."""

from __future__ import annotations

import math
from collections.abc import Sequence
from copy import deepcopy
from functools import lru_cache, partial
from typing import Final, NamedTuple

import numpy as np
import pygame

from game.drawing.canvas import Canvas
from game.drawing.paint import PIECE
from game.drawing.paint_cache import InPieces, Steps
from game.drawing.tokens import NIGHT0, VIEW_SIZE
from game.world.camera import MOST_LINES, POINTS_PER_METRE, Camera, View
from game.world.landscape.sheet import WorldPicture
from game.world.landscape.sky import NearStars, page_of, paint_earth, paint_sky
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
_PLAIN_CHANCE: Final = 3
_FEWEST: Final = 90.0  # lines of a rough picture, at least
_PLAIN_DETAIL: Final = 1.5  # resolution at which the plain is painted for a camera that comes near


class Backdrop:
    """Sky, Earth, stars, ridges and plain for a view of `size` pixels.

    A page of 16:9 at the lower edge has the land and its sky; a wider view has more of both, a higher one more sky.
    The same generator state gives the same landscape. It can be drawn only at the size that it was built for;
    build another for another size.
    """

    def __init__(self, size: tuple[int, int], rng: np.random.Generator, look: Theme = MOON) -> None:
        self.size = size
        width, self._height = page_of(size)
        self._aside, self._above = (size[0] - width) // 2, size[1] - self._height  # beside the page, and above it
        self._unit = self._height / 720
        self._chances, self._look = rng.spawn(4 + len(RIDGES)), look
        self._far = InPieces(partial(_paint_far, size, self._chances, look))
        self._plains: dict[tuple[float, bool], InPieces[_Plain]] = {}

    @property
    def whole(self) -> bool:
        """Whether all of it that was painted so far is painted in full."""
        return self._far.whole and all(plain.whole for plain in self._plains.values())

    def draw(self, canvas: Canvas, camera: Camera, alpha: float = 1.0, earth: tuple[float, float] = EARTH) -> None:
        """Fill the view; `earth` is where the Earth's middle stands, in points."""
        self.paint(canvas.surface, camera.view(canvas.scale, alpha).filling(canvas), earth)

    def paint(self, surface: pygame.Surface, view: View | None = None, earth: tuple[float, float] = EARTH) -> None:
        """Fill a surface of this backdrop's size, as seen in a view; without one, as at rest.

        Distant layers keep their size at any zoom. They move up and down with the horizon, and sideways by a small
        share of the camera's movement (parallax).
        """
        view = (view or View(self._unit, origin=(self._aside, self._above))).of_land
        across = -view.centre[0] * POINTS_PER_METRE * view.scale
        horizon = view.pixel(0.0, HORIZON_HEIGHT)[1]
        down = round(horizon - self._above - PLAIN_HORIZON * self._height)
        far, (plain, corner, solid) = self._far.picture, self._plain(view)
        seen = surface.get_clip()
        behind = pygame.Rect(0, 0, self.size[0], math.ceil(view.pixel(0.0, solid)[1]) + 1)
        # The plain hides the rest, but for the least bit where it is scaled.
        surface.fill(NIGHT0, (0, behind.bottom, self.size[0], max(0, self.size[1] - behind.bottom)))
        surface.set_clip(behind.clip(seen))
        surface.blit(far.sky, (0, down))
        if down > 0:  # no sky was painted there, but it is as dark as its top rows
            surface.blit(far.sky, (0, 0), (0, 0, self.size[0], down))
        if self._look.stars:
            far.stars.draw(surface, (across, down))
        if self._look.earth:
            self._draw_earth(surface, (far.air, far.disc), earth, across, down)
        margin = MARGIN * self.size[0]
        for sheet, top, depth in far.ridges:
            place = round(across * depth - margin), self._above + top + down
            surface.blit(sheet, place, special_flags=pygame.BLEND_PREMULTIPLIED)
        surface.set_clip(seen)
        plain.draw(surface, view, corner)

    def _plain(self, view: View) -> _Plain:
        """Return the plain, begun when it is first needed at a resolution."""
        detail = min(view.closest, _PLAIN_DETAIL) or 1.0
        kind = detail, bool(view.closest)
        if kind not in self._plains:
            chance = self._chances[_PLAIN_CHANCE]
            paint = partial(_paint_plain, self.size, chance, self._look, detail, wide=bool(view.closest))
            self._plains[kind] = InPieces(paint)
        return self._plains[kind].picture

    def _draw_earth(
        self,
        surface: pygame.Surface,
        pictures: tuple[pygame.Surface, pygame.Surface],
        earth: tuple[float, float],
        across: float,
        down: int,
    ) -> None:
        x = self._aside + round(earth[0] * self._unit + across * _EARTH_DEPTH)
        y = self._above + round(earth[1] * self._unit) + down
        for sprite, flags in zip(pictures, (pygame.BLEND_RGB_ADD, 0), strict=True):
            surface.blit(sprite, (x - sprite.get_width() // 2, y - sprite.get_height() // 2), special_flags=flags)


class _Far(NamedTuple):
    """What keeps its size at any zoom; each ridge, premultiplied, with the row of its top edge, and its depth."""

    sky: pygame.Surface
    stars: NearStars
    disc: pygame.Surface
    air: pygame.Surface
    ridges: list[tuple[pygame.Surface, int, float]]


class _Plain(NamedTuple):
    """The plain, the place of its top left corner in metres, and the height below which it hides all behind it."""

    picture: WorldPicture
    corner: tuple[float, float]
    solid: float


def _paint_far(size: tuple[int, int], chances: Sequence[np.random.Generator], look: Theme, share: float) -> Steps[_Far]:
    """Paint all that keeps its size at any zoom, at a share of its resolution."""
    sky, stars, earth, _, *ranges = deepcopy(list(chances))
    height = page_of(size)[1]
    fine = _lines(height, share) / height
    small = round(share * size[0]), round(share * size[1])
    near_stars = NearStars(size, stars)
    yield PIECE // 2
    disc, air = yield from paint_earth(EARTH_RADIUS * fine * height / 720, earth)
    ridges = []
    for ridge, own in zip(RIDGES, ranges, strict=True):
        sheet, top = yield from paint_ridge(
            (round(fine * size[0]), round(fine * height)), ridge, own, look, 5 if share == 1 else 2
        )
        ridges.append((_scaled(sheet.premul_alpha_ip(), 1 / fine), round(top / fine), ridge.depth))
        yield PIECE // 2
    night = yield from paint_sky(small, sky, look, stars=share == 1)
    if share != 1:  # smoothly as far as eyes see it, and on from there without
        night = pygame.transform.smoothscale(night, (-(-size[0] // 2), -(-size[1] // 2)))
        night = pygame.transform.scale(night, size)
    return _Far(night, near_stars, _scaled(disc, 1 / fine), _scaled(air, 1 / fine), ridges)


def _paint_plain(
    size: tuple[int, int], chance: np.random.Generator, look: Theme, detail: float, share: float, *, wide: bool
) -> Steps[_Plain]:
    """Paint the plain, as `wide` as a camera may go, at a share of its resolution."""
    height = page_of(size)[1]
    lines = round(detail * _lines(height, share))
    painted, rest, margin = round(lines * size[0] / height), View(lines / 720), WIDE_MARGIN if wide else MARGIN
    picture, top, foot = yield from paint_plain((painted, lines), deepcopy(chance), look, margin, stones=share == 1)
    yield PIECE
    across = VIEW_SIZE[0] * size[0] / page_of(size)[0]  # points
    left = (VIEW_SIZE[0] - across) / 2 - margin * across
    corner, solid = rest.metres([(left, top / rest.scale), (0.0, foot / rest.scale)]).tolist()
    return _Plain(WorldPicture(picture, rest.pixels_per_metre), tuple(corner), solid[1])


def _lines(height: int, share: float) -> float:
    """Return how many lines of land to paint for a page of that height, at a share of its resolution."""
    return max(_FEWEST, share * min(height, MOST_LINES))


def _scaled(picture: pygame.Surface, times: float) -> pygame.Surface:
    if abs(times - 1) < 1e-6:
        return picture
    return pygame.transform.smoothscale(picture, [max(1, round(times * side)) for side in picture.get_size()])


@lru_cache(maxsize=3)
def landscape(size: tuple[int, int], look: str) -> Backdrop:
    """Return the game's landscape at that size under a theme; all scenes share it."""
    return Backdrop(size, np.random.default_rng(_MOON), LOOKS[look])
