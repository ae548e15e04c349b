"""Glow along the edges of the area while a craft is near them."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Final

import numpy as np
import pygame

from ai.lander.environment import LanderEnv
from ai.lander.sensing import NEAR, near_edges
from game.drawing.canvas import Canvas
from game.drawing.paint import light
from game.drawing.tokens import Colour
from game.world.camera import GROUND_LINE, View

_DEEP: Final = 4.0  # metres that the glow reaches into the area
_ACROSS: Final = 60.0  # metres to both sides, beyond any view: of the edge above
_LEVELS: Final = 12  # steps of its strength, so that few pictures are ever made
_STRENGTH: Final = 0.8
_PICTURE: Final = (48, 64)  # pixels, stretched


def draw_edges(canvas: Canvas, view: View, env: LanderEnv, colour: Colour) -> None:
    """Draw a glow and a hairline along every edge of the area near the craft, brighter the nearer it is."""
    for edge in near_edges(env):
        level = math.ceil(_LEVELS * (1 - edge.away / NEAR))
        if not level:
            continue
        ceiling = env.limits.ceiling
        inward = {"left": 1.0, "right": -1.0, "above": -1.0}[edge.side] * _DEEP
        if edge.side == "above":
            corners = (-_ACROSS, edge.place), (_ACROSS, edge.place + inward)
        else:
            corners = (edge.place, ceiling), (edge.place + inward, GROUND_LINE)
        (x0, y0), (x1, y1) = (view.pixel(*corner) for corner in corners)
        box = pygame.Rect(round(min(x0, x1)), round(y0), max(1, round(abs(x1 - x0))), max(1, round(y1 - y0)))
        wide, high = canvas.surface.get_size()
        seen = box.clip((0, box.top, wide, box.height) if edge.side == "above" else (box.left, 0, box.width, high))
        if seen.width and seen.height:
            glow = pygame.transform.scale(_glow(edge.side, level, colour), seen.size)
            canvas.surface.blit(glow, seen, special_flags=pygame.BLEND_RGB_ADD)
        end = (_ACROSS, ceiling) if edge.side == "above" else (edge.place, GROUND_LINE)
        (ax, ay), (bx, by) = (view.point(*place) for place in (corners[0], end))
        canvas.line((ax, ay), (bx, by), colour, alpha=0.5 * level / _LEVELS)


@lru_cache(maxsize=3 * _LEVELS)
def _glow(side: str, level: int, colour: Colour) -> pygame.Surface:
    """Return light that fades inward from one side; `level` is its strength in twelfths."""
    across, down = _PICTURE
    fade = np.linspace(1.0, 0.0, down if side == "above" else across, dtype=np.float32) ** 2.2
    shine = np.repeat(fade[:, None], across, axis=1) if side == "above" else np.repeat(fade[None, :], down, axis=0)
    if side == "right":
        shine = shine[:, ::-1]
    strength = _STRENGTH * level / _LEVELS
    return light(np.ascontiguousarray(shine * strength)[..., None] * np.array(colour, np.float32))
