"""Terrain of the moon: hazy ridges, each lit along its crest, and the plain in the foreground."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Final

import numpy as np
import pygame

from game.drawing.paint import Picture, bell, clouds, layer, mix, profile, shine
from game.drawing.tokens import DUSK, NIGHT0, NIGHT1, VIEW_SIZE, Colour
from game.world.camera import LAND_REACH, POINTS_PER_METRE, VIEW_BOTTOM, WORLD_WIDTH
from game.world.landscape.sky import SUN, page_of

# The row at which the plain ends, as a share of the view's height.
PLAIN_HORIZON: Final = 0.856
HORIZON_HEIGHT: Final = VIEW_BOTTOM + (1 - PLAIN_HORIZON) * VIEW_SIZE[1] / POINTS_PER_METRE  # metres
# How much wider than the view the land is to either side, so that it can move sideways; and the plain, where a
# camera goes about.
MARGIN: Final = 0.04
WIDE_MARGIN: Final = (LAND_REACH + 5.0) / WORLD_WIDTH - 0.5  # and as far as a camera that eases outwards overshoots
# Shares of the view's height that the plain goes on below it: where a camera rests, and where it goes far away.
_FOOT, _WIDE_FOOT = 0.03, 0.085
_WARM: Final = np.array((255, 150, 96), np.float32)


@dataclass(frozen=True)
class Ridge:
    """One range of hills; heights are shares of the view, `depth` how far it moves with the foreground."""

    crest: float
    relief: float
    humps: float
    top: Colour
    foot: Colour
    depth: float
    rim: float
    valley: float
    rough: float = 0.4


RIDGES: Final = (
    Ridge(0.740, 0.105, 3.3, (47, 43, 68), (84, 64, 82), 0.04, 0.62, 0.75),
    Ridge(0.797, 0.075, 4.4, (33, 33, 55), (54, 47, 70), 0.07, 0.46, 0.55),
    Ridge(0.838, 0.038, 6.3, (21, 23, 42), (34, 34, 55), 0.11, 0.34, 0.30),
)


def paint_ridge(size: tuple[int, int], ridge: Ridge, rng: np.random.Generator) -> tuple[pygame.Surface, int]:
    """Return a ridge as a layer wider than the view by its margins, and the row of its top edge."""
    view_width, height = size
    width = round(view_width * (1 + 2 * MARGIN))
    wave = profile(width, rng, ridge.humps * view_width / page_of(size)[0], octaves=7, gain=ridge.rough)
    valley = bell(width, (SUN[0] + MARGIN) * view_width, 0.24 * view_width)  # so that the dawn stays visible
    crest = height * (ridge.crest - ridge.relief * (wave * (1 - 0.6 * valley) + 0.25 - ridge.valley * valley))
    top, bottom = int(crest.min()) - 2, round(height * (PLAIN_HORIZON + 0.045))
    below = np.arange(top, bottom, dtype=np.float32)[:, None] + 0.5 - crest
    cover = np.clip(below + 0.5, 0, 1)
    depth = np.clip(below, 0, None)
    sunward, near = _sunlight(width, view_width)
    haze = np.clip((np.arange(top, bottom) - crest.mean()) / (bottom - crest.mean()), 0, 1).astype(np.float32)
    shade = _relief(below + crest - _smooth(crest), height, rng) * sunward
    slope = np.gradient(crest) * sunward
    facing = np.clip(0.55 + 1.6 * slope, 0.08, 1.6)
    unit = height / 720
    rim = np.exp(-depth / (1.5 * unit)) * 0.75 + np.exp(-depth / (9 * unit)) * 0.25
    tone = 1 + (0.26 - 0.17 * haze[:, None]) * shade
    picture = np.zeros((*tone.shape, 3), np.float32)
    shine(picture, tone, ridge.top)
    shine(picture, tone * haze[:, None] ** 1.3, np.subtract(ridge.foot, ridge.top))
    warmth = ridge.rim * rim * facing * (0.16 + 0.84 * near) + 0.10 * near * haze[:, None]
    shine(picture, warmth + 0.07 * near * np.clip(shade, 0, 1), _WARM)
    return layer(picture, cover, rng), top


def _sunlight(width: int, view_width: int, margin: float = MARGIN) -> tuple[Picture, Picture]:
    """Return for each column the sun's side, -1 left to 1 right, and how near its glow is, 0 to 1."""
    sun = (SUN[0] + margin) * view_width
    away = np.arange(width, dtype=np.float32) - sun
    return -np.tanh(away / (0.08 * view_width)), bell(width, sun, 0.30 * view_width)


def _smooth(line: Picture) -> Picture:
    """Return a line without its small bumps."""
    span = max(3, len(line) // 24)
    window = np.hanning(span).astype(np.float32)
    padded = np.pad(line, span // 2, mode="edge")
    return np.convolve(padded, window / window.sum(), mode="same")[span // 2 : span // 2 + len(line)]


def _relief(depth: Picture, height: int, rng: np.random.Generator) -> Picture:
    """Return how far slopes lean to the right, about -1 to 1; their folds follow the crest."""
    rows, columns = depth.shape
    unit = height / 720
    bumps = clouds((rows, columns), rng, (rows / unit / 64, columns / unit / 78), octaves=5, gain=0.46)
    sheared = (np.arange(columns)[None, :] + np.clip(0.7 * depth, 0, None)) % (columns - 1)
    lean = np.clip(np.gradient(bumps, axis=1) * (20 * unit), -1, 1)
    folds: Picture = lean[np.clip(depth, 0, rows - 1).astype(np.intp), sheared.astype(np.intp)]
    return folds


def paint_plain(size: tuple[int, int], rng: np.random.Generator, margin: float = MARGIN) -> tuple[pygame.Surface, int]:
    """Return the plain with its craters and stones, wider than the view by its margins, and the row of its top."""
    view_width, height = size
    width, page_width = round(view_width * (1 + 2 * margin)), page_of(size)[0]
    edge = height * (PLAIN_HORIZON + 0.006 * profile(width, rng, 6.5 * width / page_width, octaves=6))
    top = int(edge.min()) - 2
    bottom = height + round((_FOOT if margin == MARGIN else _WIDE_FOOT) * height)
    rows = np.arange(top, bottom, dtype=np.float32)[:, None] + 0.5
    near = np.clip((rows - height * PLAIN_HORIZON) / (height * (1 - PLAIN_HORIZON)), 0, 1.6)
    sunward, glow = _sunlight(width, view_width, margin)
    bumps = _plain_noise(near[:, 0], width, page_width, rng) * 0.5
    for _ in range(round(48 * width / page_width)):
        _sink_crater(bumps, near[:, 0], page_width, rng)
    lean = np.diff(bumps, axis=1, append=bumps[:, -1:]) * (height / 720) * -1.0 * -sunward
    far, close = mix(NIGHT1, DUSK, 0.55), mix(NIGHT0, NIGHT1, 0.25)
    lit = np.clip(lean, -1, 1)
    tone = 1 + 0.62 * lit
    picture = np.zeros((*tone.shape, 3), np.float32)
    shine(picture, tone, far)
    shine(picture, tone * np.clip(near * 1.15, 0, 1) ** 0.55, np.subtract(close, far))
    sheen = glow * np.exp(-near / 0.30)
    shine(picture, 0.20 * sheen * (1 + 0.9 * lit) + 0.055 * np.clip(lit, 0, 1) * (0.3 + glow), _WARM)
    depth = rows - edge
    rim = np.exp(-np.clip(depth, 0, None) / (1.3 * height / 720)) * (0.10 + 0.42 * glow)
    shine(picture, rim, _WARM)
    _scatter_stones(picture, near[:, 0], sunward, glow, page_width, rng)
    return layer(picture, np.clip(depth + 0.5, 0, 1), rng), top


def _plain_noise(near: Picture, width: int, page_width: int, rng: np.random.Generator) -> Picture:
    """Return the texture of a rolling surface seen at a low angle: fine far away, coarse in front."""
    field = _hummocks(int(rng.integers(2**31)))
    side = len(field)
    scale = 0.16 + near
    across = ((np.arange(width) - width / 2)[None, :] * (0.574 * 1280 / page_width / scale[:, None]) + side / 2) % side
    down = (210 * np.log(scale) + 500) % side
    seen: Picture = field[down.astype(np.intp)[:, None], across.astype(np.intp)]
    return seen * (0.35 + 0.65 * near)[:, None]


@lru_cache(maxsize=2)
def _hummocks(seed: int) -> Picture:
    """Return a rolling surface seen from above; cached, as the same plain is painted for near and far cameras."""
    return clouds((512, 512), np.random.default_rng(seed), (30, 30), octaves=5, gain=0.62) * 2.2


def _sink_crater(bumps: Picture, near: Picture, page_width: int, rng: np.random.Generator) -> None:
    rows, columns = bumps.shape
    row = int(rng.random() ** 0.8 * rows)
    scale = 0.16 + near[row]
    radius = page_width * (0.004 + 0.030 * rng.random() ** 3.2) * scale
    aspect = 0.20 + 0.06 * scale
    x = rng.uniform(0, columns)
    left, right = max(0, int(x - 2 * radius)), min(columns, int(x + 2 * radius) + 1)
    above, below = max(0, int(row - 2 * radius * aspect)), min(rows, int(row + 2 * radius * aspect) + 1)
    if right - left < 3 or below - above < 2:
        return
    across = (np.arange(left, right) - x)[None, :] / radius
    down = (np.arange(above, below) - row)[:, None] / (radius * aspect)
    distance = np.hypot(across, down)
    bowl = np.where(distance < 1, distance**2 - 1, 0) * 0.55 + 0.24 * np.exp(-(((distance - 1.02) / 0.24) ** 2))
    bumps[above:below, left:right] += (bowl * radius * 0.85).astype(np.float32)


def _scatter_stones(
    picture: Picture, near: Picture, sunward: Picture, glow: Picture, page_width: int, rng: np.random.Generator
) -> None:
    rows, columns = picture.shape[:2]
    unit = page_width / 1280
    for _ in range(round(139 * columns / page_width)):
        row, column = int(rng.uniform(0.10, 1) ** 0.9 * rows), int(rng.uniform(0, columns))
        radius = unit * (0.16 + near[min(row, rows - 1)]) * (1.0 + 3.6 * rng.random() ** 5)
        half = int(radius * 4) + 1
        if radius < 0.75 or not (half < column < columns - half and half < row < rows - half):
            continue
        axis = np.arange(-half, half + 1, dtype=np.float32)
        x, y = axis[None, :] / radius, axis[:, None] / (radius * 0.72)
        side = float(np.sign(sunward[column]))
        patch = picture[row - half : row + half + 1, column - half : column + half + 1]
        shadow = np.exp(-(((x + side * 1.3) / 1.5) ** 2) - ((y - 0.75) / 0.42) ** 2)
        patch *= (1 - 0.55 * shadow)[..., None]
        inside = np.clip((1 - np.hypot(x, y)) * radius + 0.5, 0, 1)
        facing = np.clip(0.42 + 0.55 * x * side - 0.35 * y, 0.05, 1)
        stone = facing[..., None] * (np.array((46, 46, 66), np.float32) + glow[column] * 0.42 * _WARM * 0.5)
        patch += inside[..., None] * (stone - patch)
