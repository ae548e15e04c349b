"""Arcs of a thin ring, drawn large once, scaled down and cached."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Final

import pygame

from game.drawing.canvas import Canvas, Point
from game.drawing.tokens import Colour

_FACTOR: Final = 4
_PARTS: Final = 200  # of a whole turn: as fine as can be seen


def draw_arc(
    canvas: Canvas, centre: Point, radius: float, share: float, colour: Colour, width: float = 2.0, alpha: float = 1.0
) -> None:
    """Draw the share 0 to 1 of a ring, clockwise from its top; `radius` and `width` are points."""
    parts = round(_PARTS * min(max(share, 0.0), 1.0))
    if not parts:
        return
    pixels = round(4 * radius * canvas.scale) / 4
    picture = _arc(pixels, max(1.0, round(4 * width * canvas.scale) / 4), parts, colour)
    picture.set_alpha(round(255 * alpha))
    half = picture.get_width() // 2
    canvas.surface.blit(picture, (canvas.px(centre[0]) - half, canvas.px(centre[1]) - half))


def on_ring(centre: Point, radius: float, share: float) -> Point:
    """Return the place on a ring that many turns clockwise from its top."""
    turn = 2 * math.pi * share
    return centre[0] + radius * math.sin(turn), centre[1] - radius * math.cos(turn)


@lru_cache(maxsize=1024)
def _arc(radius: float, width: float, parts: int, colour: Colour) -> pygame.Surface:
    """Return an arc with its middle in the middle of the picture; lengths in pixels."""
    half = math.ceil(radius + width) + 1
    sheet = pygame.Surface((2 * half * _FACTOR, 2 * half * _FACTOR), pygame.SRCALPHA)
    sheet.fill((*colour, 0))  # transparent in its own colour, so that scaling down does not darken the edge
    middle = half * _FACTOR
    outer, inner = _FACTOR * (radius + width / 2), _FACTOR * (radius - width / 2)
    turns = [2 * math.pi * number / _PARTS for number in range(parts + 1)]
    rim = [(middle + outer * math.sin(turn), middle - outer * math.cos(turn)) for turn in turns]
    rim += [(middle + inner * math.sin(turn), middle - inner * math.cos(turn)) for turn in reversed(turns)]
    pygame.draw.polygon(sheet, colour, rim)
    return pygame.transform.smoothscale(sheet, (2 * half, 2 * half))
