"""Terrain of the moon: hazy ridges, each lit along its crest, and the plain in the foreground."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
import pygame

from game.drawing.paint import PIECE, Picture, Sheet, bell, blocks, clouds, mix, profile, slopes
from game.drawing.paint_cache import Steps
from game.drawing.tokens import DUSK, NIGHT0, NIGHT1, VIEW_SIZE, Colour
from game.world.camera import LAND_REACH, POINTS_PER_METRE, VIEW_BOTTOM, WORLD_WIDTH
from game.world.landscape.sky import SUN, page_of
from game.world.landscape.themes import Theme

# The row at which the plain ends, as a share of the view's height.
PLAIN_HORIZON: Final = 0.856
HORIZON_HEIGHT: Final = VIEW_BOTTOM + (1 - PLAIN_HORIZON) * VIEW_SIZE[1] / POINTS_PER_METRE  # metres
# How much wider than the view the land is to either side, so that it can move sideways; and the plain, where a
# camera goes about.
MARGIN: Final = 0.04
WIDE_MARGIN: Final = (LAND_REACH + 5.0) / WORLD_WIDTH - 0.5  # and as far as a camera that eases outwards overshoots
# Shares of the view's height that the plain goes on below it: where a camera rests, and where it goes far away.
_FOOT, _WIDE_FOOT = 0.03, 0.085
_FIELD: Final = 512  # side of the surface that the plain's texture is taken from
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


def paint_ridge(
    size: tuple[int, int], ridge: Ridge, rng: np.random.Generator, look: Theme, octaves: int = 5
) -> Steps[tuple[pygame.Surface, int]]:
    """Paint a ridge as a layer wider than the view by its margins; return it, and the row of its top edge.

    Of the noise of its folds, a rough picture has the first `octaves`.
    """
    view_width, height = size
    width = round(view_width * (1 + 2 * MARGIN))
    wave = profile(width, rng, ridge.humps * view_width / page_of(size)[0], octaves=7, gain=ridge.rough)
    valley = bell(width, (SUN[0] + MARGIN) * view_width, 0.24 * view_width)  # so that the dawn stays visible
    crest = height * (ridge.crest - ridge.relief * (wave * (1 - 0.6 * valley) + 0.25 - ridge.valley * valley))
    top, bottom = int(crest.min()) - 2, round(height * (PLAIN_HORIZON + 0.045))
    below = np.arange(top, bottom, dtype=np.float32)[:, None] + np.float32(0.5)
    sunward, near = _sunlight(width, view_width)
    haze = np.clip((np.arange(top, bottom) - crest.mean()) / (bottom - crest.mean()), 0, 1).astype(np.float32)[:, None]
    shape, unit = (bottom - top, width), height / 720
    # The same noise at any resolution: what is rough for a moment must not change its shape when it is whole.
    cells = (bottom - float(crest.min())) / unit / 64, (1 + 2 * MARGIN) * view_width / unit / 78
    _, lean = yield from slopes(shape, rng, cells, octaves, 0.46, max(1, round(unit)))
    folds, smooth = np.empty(shape, np.float32), _smooth(crest)
    for rows in blocks(shape):
        folds[rows] = np.clip(lean.part(rows, slice(0, width)) * np.float32(20 * unit), -1, 1)
        yield folds[rows].size // 4
    facing = np.clip(0.55 + 1.6 * np.gradient(crest) * sunward, 0.08, 1.6)
    rise = haze**1.3
    sheet = Sheet(shape, rng)
    yield PIECE // 2
    for rows in blocks(shape):
        depth = np.maximum(below[rows] - crest, 0)
        shade = _folded(folds, below[rows] - smooth) * sunward
        rim = np.exp(depth / np.float32(-1.5 * unit)) * 0.75 + np.exp(depth / np.float32(-9 * unit)) * 0.25
        tone = 1 + (0.26 - 0.17 * haze[rows]) * shade
        warmth = ridge.rim * rim * (facing * (0.16 + 0.84 * near)) + 0.10 * near * haze[rows]
        warmth += 0.07 * near * np.maximum(shade, 0)
        picture = [
            tone * (np.float32(high) + np.float32(low - high) * rise[rows]) + warm * warmth
            for high, low, warm in zip(ridge.top, ridge.foot, _WARM, strict=True)
        ]
        sheet.put(rows.start, 0, look.on_land(picture), np.clip(below[rows] + np.float32(0.5) - crest, 0, 1))
        yield depth.size
    return sheet.done(), top


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


def _folded(lean: Picture, depth: Picture) -> Picture:
    """Return how far slopes lean to the right, about -1 to 1, at rows of a ridge; their folds follow the crest."""
    rows, columns = lean.shape
    across = np.arange(columns, dtype=np.int32) + np.maximum(np.float32(0.7) * depth, 0).astype(np.int32)
    across -= np.where(across >= columns - 1, np.int32(columns - 1), np.int32(0))
    folds: Picture = lean[np.clip(depth, 0, rows - 1).astype(np.intp), across]
    return folds


def paint_plain(
    size: tuple[int, int], rng: np.random.Generator, look: Theme, margin: float = MARGIN, *, stones: bool = True
) -> Steps[tuple[pygame.Surface, int, int]]:
    """Paint the plain with its craters and, unless it is rough, `stones`, wider than the view by its margins.

    Return it, the row of its top edge, and the row below which nothing behind it is seen.
    """
    view_width, height = size
    width, page_width = round(view_width * (1 + 2 * margin)), page_of(size)[0]
    wide = (1 + 2 * margin) * view_width / page_width  # pages
    edge = height * (PLAIN_HORIZON + 0.006 * profile(width, rng, 6.5 * wide, octaves=6))
    top = int(edge.min()) - 2
    bottom = height + round((_FOOT if margin == MARGIN else _WIDE_FOOT) * height)
    down = np.arange(top, bottom, dtype=np.float32)[:, None] + np.float32(0.5)
    near = np.clip((down - height * PLAIN_HORIZON) / (height * (1 - PLAIN_HORIZON)), 0, 1.6).astype(np.float32)
    sunward, glow = _sunlight(width, view_width, margin)
    # A rough picture goes without the finest noise, which comes last, and takes longest.
    bumps = yield from _plain_noise(near[:, 0], width, page_width, rng, 5 if stones else 3)
    for _ in range(round(48 * wide)):
        yield _sink_crater(bumps, near[:, 0], page_width, rng)
    far, close = mix(NIGHT1, DUSK, 0.55), mix(NIGHT0, NIGHT1, 0.25)
    deep = np.clip(near * 1.15, 0, 1) ** 0.55
    flare = 0.10 + 0.42 * glow
    sheet = Sheet(bumps.shape, rng)
    yield PIECE // 2
    for rows in blocks(bumps.shape):
        lit = np.diff(bumps[rows], axis=1, append=bumps[rows, -1:])
        lit = np.clip(lit * (np.float32(height / 720) * sunward), -1, 1)
        tone, sheen = 1 + np.float32(0.62) * lit, np.exp(-near[rows] / 0.30) * (0.20 * glow)
        depth = np.maximum(down[rows] - edge, 0)
        warmth = sheen * (1 + 0.9 * lit) + np.maximum(lit, 0) * (0.055 * (0.3 + glow))
        warmth += np.exp(depth * np.float32(-720 / (1.3 * height))) * flare
        picture = [
            tone * (np.float32(first) + np.float32(last - first) * deep[rows]) + warm * warmth
            for first, last, warm in zip(far, close, _WARM, strict=True)
        ]
        sheet.put(rows.start, 0, look.on_land(picture), np.clip(down[rows] - edge + np.float32(0.5), 0, 1))
        yield depth.size
    surface = sheet.done()
    if stones:
        yield from _scatter_stones(surface, near[:, 0], sunward, glow, page_width, rng, look)
    return surface, top, math.ceil(edge.max()) + 1


def _plain_noise(near: Picture, width: int, page_width: int, rng: np.random.Generator, octaves: int) -> Steps[Picture]:
    """Paint the texture of a rolling surface seen at a low angle: fine far away, coarse in front."""
    field = yield from clouds(
        (_FIELD, _FIELD), np.random.default_rng(int(rng.integers(2**31))), (30, 30), octaves, 0.62
    )
    side = _FIELD
    scale = np.float32(0.16) + near
    columns = (np.arange(width, dtype=np.float32) - width / 2) * np.float32(0.574 * 1280 / page_width)
    down = np.floor(210 * np.log(scale) + 500).astype(np.intp) % side
    bumps = np.empty((len(near), width), np.float32)
    for rows in blocks(bumps.shape):
        across = np.floor(columns / scale[rows, None]).astype(np.int32)
        across = (across + side // 2) & (side - 1)  # the field repeats; its side is a power of two
        bumps[rows] = field[down[rows, None], across] * (1.1 * (0.35 + 0.65 * near[rows, None]))
        yield across.size // 2
    return bumps


def _sink_crater(bumps: Picture, near: Picture, page_width: int, rng: np.random.Generator) -> int:
    """Sink a crater into the plain somewhere; return how many pixels that changes."""
    rows, columns = bumps.shape
    row = int(rng.random() ** 0.8 * rows)
    scale = 0.16 + near[row]
    radius = page_width * (0.004 + 0.030 * rng.random() ** 3.2) * scale
    aspect = 0.20 + 0.06 * scale
    x = rng.uniform(0, columns)
    left, right = max(0, int(x - 2 * radius)), min(columns, int(x + 2 * radius) + 1)
    above, below = max(0, int(row - 2 * radius * aspect)), min(rows, int(row + 2 * radius * aspect) + 1)
    if right - left < 3 or below - above < 2:
        return 0
    across = ((np.arange(left, right) - x)[None, :] / radius).astype(np.float32)
    down = ((np.arange(above, below) - row)[:, None] / (radius * aspect)).astype(np.float32)
    distance = np.sqrt(across * across + down * down)
    bowl = np.where(distance < 1, distance**2 - 1, 0) * 0.55 + 0.24 * np.exp(-(((distance - 1.02) / 0.24) ** 2))
    bumps[above:below, left:right] += (bowl * radius * 0.85).astype(np.float32)
    return int(distance.size)


def _scatter_stones(
    surface: pygame.Surface,
    near: Picture,
    sunward: Picture,
    glow: Picture,
    page_width: int,
    rng: np.random.Generator,
    look: Theme,
) -> Steps[None]:
    """Paint stones and their shadows onto the plain."""
    columns, rows = surface.get_size()
    unit = page_width / 1280
    pixels = pygame.surfarray.pixels3d(surface).swapaxes(0, 1)
    for _ in range(round(139 * columns / page_width)):
        row, column = int(rng.uniform(0.10, 1) ** 0.9 * rows), int(rng.uniform(0, columns))
        radius = unit * (0.16 + near[min(row, rows - 1)]) * (1.0 + 3.6 * rng.random() ** 5)
        half = int(radius * 4) + 1
        if radius < 0.75 or not (half < column < columns - half and half < row < rows - half):
            continue
        axis = np.arange(-half, half + 1, dtype=np.float32)
        x, y = axis[None, :] / radius, axis[:, None] / (radius * 0.72)
        side = float(np.sign(sunward[column]))
        patch = pixels[row - half : row + half + 1, column - half : column + half + 1]
        shadow = np.exp(-(((x + side * 1.3) / 1.5) ** 2)) * np.exp(-(((y - 0.75) / 0.42) ** 2))
        painted = patch * (1 - np.float32(0.55) * shadow)[..., None]
        inside = np.clip((1 - np.sqrt(x * x + y * y)) * radius + 0.5, 0, 1)
        facing = np.clip(0.42 + 0.55 * x * side - 0.35 * y, 0.05, 1)
        lit = np.array((46, 46, 66), np.float32) + glow[column] * 0.42 * _WARM * 0.5
        stone = np.stack(look.on_land([facing * part for part in lit]), axis=-1)
        painted += inside[..., None] * (stone - painted)
        patch[:] = np.clip(painted + 0.5, 0, 255).astype(np.uint8)
        yield 4 * shadow.size
