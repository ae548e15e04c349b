"""Engine flames: additive sprites, painted once for each angle, thrust and flicker."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Final

import numpy as np
import pygame

from ai.environment import Doubles
from game.drawing.paint import light
from game.drawing.tokens import Colour

LEVELS: Final = 8
FLICKERS: Final = 5
_FINE: Final = 40.0  # pixels per metre at which fire is painted, to be turned and scaled: it has no sharp edges


@dataclass(frozen=True, eq=False)  # one of a kind each, and so a quick key
class Plume:
    """Appearance of a flame, from its core outwards; lengths in metres at full thrust."""

    length: float
    width: float
    heart: Colour
    body: Colour
    edge: Colour


HUMAN_PLUME: Final = Plume(2.5, 0.235, (255, 244, 216), (255, 166, 66), (222, 74, 22))
NET_PLUME: Final = Plume(2.5, 0.235, (240, 250, 255), (128, 204, 255), (44, 96, 214))
JET: Final = Plume(0.95, 0.085, (236, 242, 255), (150, 178, 226), (70, 92, 150))


def plume(
    kind: Plume, pixels_per_metre: float, angle: float, thrust: float, flicker: int
) -> tuple[pygame.Surface, tuple[float, float]] | None:
    """Return the picture of a flame along `angle` (radians; 0 is straight down), and the nozzle's place in it.

    `thrust` is 0 to 1. Returns None where there is no flame at all.
    """
    level = math.ceil(min(thrust, 1.0) * LEVELS - 0.25)
    if level <= 0:
        return None
    fire, (x, y) = _turned(kind, level, flicker % FLICKERS, round(2 * math.degrees(angle)) % 720)
    # To turn it small and then scale it takes a third of the time of both at once, in a large window a sixth.
    width, height = (max(1, round(side * pixels_per_metre / _FINE)) for side in fire.get_size())
    scaled = pygame.transform.smoothscale(fire, (width, height))
    return scaled, (x * width / fire.get_width(), y * height / fire.get_height())


@lru_cache(maxsize=256)
def _turned(kind: Plume, level: int, flicker: int, half_degrees: int) -> tuple[pygame.Surface, tuple[float, float]]:
    """Return a flame, not yet scaled, at an angle in half degrees, and the nozzle's place in it."""
    upright, (left, top) = _paint(kind, _FINE, 0, level, flicker)
    fire = pygame.transform.rotozoom(upright, half_degrees / 2, 1.0)
    right, down = left - upright.get_width() / 2, top - upright.get_height() / 2
    cos, sin = math.cos(math.radians(half_degrees / 2)), math.sin(math.radians(half_degrees / 2))
    return fire, (fire.get_width() / 2 + right * cos + down * sin, fire.get_height() / 2 - right * sin + down * cos)


def plumes(
    kind: Plume, pixels_per_metre: float, angles: Doubles, nozzles: Doubles, flicker: int
) -> list[tuple[pygame.Surface, tuple[int, int]]]:
    """Return the flames of a swarm at full thrust, ready to be blitted: angles (n,), nozzles (n, 2) in pixels."""
    degrees = np.rint(np.degrees(angles) / 6).astype(int) * 6 % 360
    fires = []
    for number, (turn, (x, y)) in enumerate(zip(degrees.tolist(), np.rint(nozzles).astype(int).tolist(), strict=True)):
        fire, (left, top) = _paint(kind, pixels_per_metre, turn, LEVELS, (flicker + number) % 2)
        fires.append((fire, (x - left, y - top)))
    return fires


@lru_cache(maxsize=1024)
def _paint(
    kind: Plume, pixels_per_metre: float, degrees: int, level: int, flicker: int
) -> tuple[pygame.Surface, tuple[int, int]]:
    strength = level / LEVELS
    sway = 1 + 0.09 * math.sin(2.4 * flicker + 1)
    length = kind.length * (0.22 + 0.78 * strength) * sway * pixels_per_metre
    width = kind.width * (0.72 + 0.28 * strength) * pixels_per_metre
    turn = math.radians(degrees)
    down = (math.sin(turn), math.cos(turn))  # in pixels, y down
    pad = 2.2 * width + 2
    left, right = min(0, down[0] * length) - pad, max(0, down[0] * length) + pad
    above, below = min(0, down[1] * length) - pad, max(0, down[1] * length) + pad
    x = np.arange(math.floor(left), math.ceil(right) + 1, dtype=np.float32)[None, :]
    y = np.arange(math.floor(above), math.ceil(below) + 1, dtype=np.float32)[:, None]
    along = (x * down[0] + y * down[1]) / length
    across = np.abs(x * down[1] - y * down[0]) / width
    inside = np.clip(along, 0, 1)
    girth = (0.80 + 0.55 * inside) * (1 - inside) ** 0.62 + 0.02
    offset = across / girth
    open_end = np.clip(along * length / 2 + 0.8, 0, 1) * (along < 1)
    diamonds = 1 + 0.20 * np.cos(inside * 19 - 0.9 * flicker) * (1 - inside)
    heart = np.exp(-((offset / 0.48) ** 2)) * (1 - inside) ** 1.5 * diamonds
    body = np.exp(-((offset / 0.82) ** 4)) * (1 - inside) ** 0.8
    edge = np.exp(-((offset / 1.12) ** 2)) * (1 - inside) ** 1.1
    glow = [
        share[..., None] * np.array(c, np.float32)
        for share, c in ((0.75 * heart, kind.heart), (0.62 * body, kind.body), (0.42 * edge, kind.edge))
    ]
    picture = (glow[0] + glow[1] + glow[2]) * (open_end * (0.55 + 0.45 * strength))[..., None]
    return light(picture), (-math.floor(left), -math.floor(above))
