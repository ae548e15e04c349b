"""Pictures fixed in the world, painted once and drawn at any zoom."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Final

import pygame

from game.drawing.paint_cache import busy, spend
from game.world.camera import View

_STRIDE, _ROWS = 64, 16  # pixels of the picture: a scaled part begins and ends at multiples of these
_SPARE: Final = 12  # pixels that the scaled part reaches beyond the view, at least
_PATIENT: Final = 2.0  # times its usual error that a large picture may have while others take the frame's time
_LARGE: Final = 60_000  # pixels, scaled
_PAINTED: Final = 16  # pixels that are scaled in the time in which one is painted
_RIM_LEFT: Final = (1, 0, 2)  # pixels of the rim that are left out on one side: its middle moves the other way


class WorldPicture:
    """A picture painted at `per_metre` pixels per metre.

    `soft` is the relative error that its width may have, half of it at either end. The colours of a picture with clear
    parts are multiplied by their alpha, here and for good: so it is blended a quarter faster, and scaled without rims.

    Scaling the part in view takes a millisecond; painting it anew takes a hundred times that. The last scaled part is
    reused until it does not fill the view any more, or its error would exceed `soft`; where several pictures are due
    in one frame, some wait for the next.
    """

    def __init__(self, picture: pygame.Surface, per_metre: float, soft: float = 1 / 300) -> None:
        self.per_metre, self._soft = per_metre, soft
        clear = bool(picture.get_flags() & pygame.SRCALPHA)
        self.picture, self._flags = (picture.premul_alpha_ip(), pygame.BLEND_PREMULTIPLIED) if clear else (picture, 0)
        self._crop = (0, 0, 0)  # first and last column, and last row, of the scaled part
        self._scaled = self.picture

    def draw(self, surface: pygame.Surface, view: View, corner: tuple[float, float], flags: int = 0) -> None:
        """Draw the picture with its top left corner at a place in the world, in metres."""
        flags = flags or self._flags
        ratio = view.pixels_per_metre / self.per_metre
        x, y = view.pixels(corner).tolist()
        width, height = self.picture.get_size()
        left, right = max(0.0, -x / ratio), min(width, (surface.get_width() - x) / ratio)  # what is seen of it
        low = min(height, (surface.get_height() - y) / ratio)
        if left >= right or low <= 0:
            return
        if abs(ratio - 1) < 1e-6:
            surface.blit(self.picture, (round(x), round(y)), special_flags=flags)
            return
        if not self._fills(left, right, low, ratio):
            self._scale(
                max(0, math.floor((left - _SPARE) / _STRIDE) * _STRIDE),
                min(width, math.ceil((right + _SPARE) / _STRIDE) * _STRIDE),
                min(height, math.ceil((low + _SPARE) / _ROWS) * _ROWS),
                ratio,
            )
        middle = x + (self._crop[0] + self._crop[1]) / 2 * ratio
        surface.blit(self._scaled, (round(middle - self._scaled.get_width() / 2), round(y)), special_flags=flags)

    def _fills(self, left: float, right: float, low: float, ratio: float) -> bool:
        """Whether the last scaled part has all that is seen, and is still good enough."""
        start, stop, rows = self._crop
        if start >= stop:
            return False
        width, height = self._scaled.get_size()
        wide = (stop - start) * ratio
        aside, below = max(0.0, wide - width) / 2 / ratio, max(0.0, rows - height / ratio)  # what it is too small by
        if (start and start + aside > left) or (stop < self.picture.get_width() and stop - aside < right):
            return False
        if rows < self.picture.get_height() and rows - below < low:
            return False
        patience = _PATIENT if width * height > _LARGE and busy() else 1.0
        return abs(round(wide) - width) <= self._soft * patience * wide

    def _scale(self, start: int, stop: int, rows: int, ratio: float) -> None:
        """Scale the part from one column to another, down to a row."""
        self._crop = (start, stop, rows)
        size = (max(1, round((stop - start) * ratio)), max(1, round(rows * ratio)))
        self._scaled = pygame.transform.smoothscale(self.picture.subsurface((start, 0, stop - start, rows)), size)
        spend(size[0] * size[1] // _PAINTED)


def fitted(
    paint: Callable[[tuple[int, int]], pygame.Surface], ratio: float, middle: tuple[float, float]
) -> tuple[pygame.Surface, tuple[int, int]]:
    """Return a small square picture scaled by `ratio`, and the corner that puts its middle at a place, in pixels.

    `paint` returns the picture with its middle moved right and down by 0 or 1 half pixels, and a clear rim of two
    pixels. For smooth slow motion, the variant nearest to the place is chosen: among the half pixels or, where the
    picture is scaled, among how much of its rim to leave out.
    """
    scaled = abs(ratio - 1) > 1e-6
    side = paint((0, 0)).get_width() - 2 * scaled
    length = max(1, round(side * ratio)) if scaled else side
    choices = ((0, 0.0), (1, ratio), (2, -ratio)) if scaled else ((0, 0.0), (1, 0.5))  # and how far that moves it
    picked, corner = [], []
    for place in middle:
        start = place - length / 2
        _, choice, whole = min(
            (abs(round(start - moved) + moved - start), choice, round(start - moved)) for choice, moved in choices
        )
        picked.append(choice)
        corner.append(whole)
    if not scaled:
        return paint((picked[0], picked[1])), (corner[0], corner[1])
    left, top = (_RIM_LEFT[choice] for choice in picked)
    part = paint((0, 0)).subsurface((left, top, side, side))
    return pygame.transform.smoothscale(part, (length, length)), (corner[0], corner[1])
