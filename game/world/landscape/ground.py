"""Ground of a flight: hills and knolls in front of the plain, and the pads."""

from __future__ import annotations

from functools import lru_cache
from itertools import pairwise
from typing import Final

import numpy as np

from ai.common.environment import Doubles
from ai.lander.ground import Ground, Pad, half_plane
from game.drawing.canvas import Canvas
from game.drawing.paint import Picture, bell, clouds, layer
from game.drawing.tokens import INK
from game.world.camera import LAND_REACH, WORLD_WIDTH, View
from game.world.landscape.pad import draw_pad
from game.world.landscape.sheet import WorldPicture
from game.world.landscape.sky import SUN

_REACH: Final = LAND_REACH  # metres to both sides that are painted
_DETAIL: Final = 0.75  # of what the closest view would need: slopes are soft
_FOOT: Final = 0.55  # metres below the plain's line over which a hill fades into it
_CREST_COLOUR: Final = np.array((44, 42, 64), np.float32)
_FOOT_COLOUR: Final = np.array((20, 22, 38), np.float32)
_WARM: Final = np.array((255, 150, 96), np.float32)
_SOFT: Final = 1.1  # metres over which a hill's slope changes, below its edge
_STEEPEST: Final = 3.0  # metres a metre: a wall is in no other light than a steep slope
_STAKE: Final = 5.0  # points
_LIP: Final = 0.3  # metres that a knoll is lower than its pad


def draw_ground(canvas: Canvas, view: View, ground: Ground, time: float, shift: float = 0.0) -> None:
    """Draw hills, if any, and pads, `shift` metres to the right."""
    if ground.hills or ground.roofs:
        sheet, corner = paint_hills(ground, round((_DETAIL if view.closest else 1.0) * view.painted_per_metre, 3))
        sheet.draw(canvas.surface, view, corner)
    several = len(ground.pads) > 1
    for pad in ground.pads:
        if pad.bare:
            _draw_flat_spot(canvas, view, pad)
            continue
        floor = pad.top - _LIP if several else ground.base
        draw_pad(canvas, view, (pad.x + shift, pad.top), pad.width, time, floor)


def _draw_flat_spot(canvas: Canvas, view: View, pad: Pad) -> None:
    """Mark level rock that can be landed on without a pad: a fine line with a stake at both ends."""
    left, right = view.points(((pad.left, pad.top), (pad.right, pad.top))).tolist()
    canvas.line(left, right, INK, 1.0, 0.55)
    for x, y in (left, right):
        canvas.line((x, y), (x, y - _STAKE), INK, 1.0, 0.55)


@lru_cache(maxsize=2)
def paint_hills(ground: Ground, pixels_per_metre: float) -> tuple[WorldPicture, tuple[float, float]]:
    """Return the picture of hills and roofs, and the place of its top left corner in metres."""
    crest_x = np.arange(-_REACH, _REACH, 1 / pixels_per_metre)
    crest = hills_height(ground, crest_x).astype(np.float32)
    top = float(max([crest.max(), *(y for roof in ground.roofs for _, y in roof)])) + 0.1
    rows = top - np.arange(0.0, top - ground.base + _FOOT, 1 / pixels_per_metre, dtype=np.float32)[:, None]
    below = crest - rows  # metres under the surface
    hung, above = _hung(ground, crest_x, rows)
    below = np.where(hung > 0, above, below)
    rng = np.random.default_rng(round(1000 * top))
    rise = np.clip((rows - ground.base) / (top - ground.base), 0, 1)[..., None]
    colour = _FOOT_COLOUR + (0.35 + 0.65 * rise) * (_CREST_COLOUR - _FOOT_COLOUR)
    sunward, near = _sunlight(crest_x.astype(np.float32))
    slope = np.gradient(crest, crest_x).clip(-_STEEPEST, _STEEPEST).astype(np.float32) * sunward
    across, down = _folds(below.shape, pixels_per_metre, rng)
    # Where the sun is straight ahead, folds are lit from above instead of from a side.
    lean = across * sunward + down * np.sqrt(1 - sunward**2)
    shade = 1 + 0.30 * np.clip(lean + 0.9 * _softened(slope, _SOFT * pixels_per_metre), -1.2, 1.2)
    inward = np.exp(np.minimum(below / -0.30, 0))
    narrow = inward * inward * inward
    rim = 0.6 * narrow * narrow + 0.22 * inward
    facing = np.clip(0.45 + 1.1 * slope, 0.10, 1.4) * (0.18 + 0.72 * near)
    picture = colour.astype(np.float32) * shade[..., None] + (rim * facing)[..., None] * (0.62 * _WARM)
    foot = _FOOT * np.clip((crest - ground.base) / 0.8, 0, 1) ** 0.6  # none where there is no hill
    cover = np.clip(below * pixels_per_metre + 0.5, 0, 1) * (crest > ground.base + 0.01)
    cover = cover * np.clip(1 + (rows - ground.base) / np.maximum(foot, 0.02), 0, 1) ** 1.5
    cover = np.maximum(cover, np.clip(hung * pixels_per_metre + 0.5, 0, 1))
    return WorldPicture(layer(picture, cover.astype(np.float32), rng), pixels_per_metre), (-_REACH, top)


def _hung(ground: Ground, x: Doubles, rows: Picture) -> tuple[Picture, Picture]:
    """Return how far each pixel is inside a roof, less than 0 outside, and how far below its top, in metres."""
    inside = np.full((len(rows), len(x)), -1.0, np.float32)
    below_top = inside.copy()
    for roof in ground.roofs:
        edges = [half_plane(a, b) for a, b in pairwise((*roof, roof[0]))]
        span = slice(*np.searchsorted(x, (min(x for x, _ in roof), max(x for x, _ in roof))).tolist())
        away = np.stack([(nx * x[span] + ny * rows - far).astype(np.float32) for nx, ny, far in edges])
        upper = np.stack([(far - nx * x[span]) / ny for nx, ny, far in edges if ny > 0.1]).min(axis=0)
        deep = -away.max(axis=0)
        below_top[:, span] = np.where(deep > 0, upper - rows, below_top[:, span])
        inside[:, span] = np.maximum(inside[:, span], deep)
    return inside, below_top


def hills_height(ground: Ground, x: Doubles) -> Doubles:
    """Return the height of the hills at x (k,), in metres, without the pads on them."""
    height = np.full(x.shape, ground.base)
    for hill in ground.hills:
        across, up = np.array(hill).T
        height = np.maximum(height, np.interp(x, across, up))
    return height


def _sunlight(x: Picture) -> tuple[Picture, Picture]:
    """Return for each column the sun's side, -1 left to 1 right, and how near its glow is, 0 to 1."""
    middle = (SUN[0] - 0.5) * WORLD_WIDTH
    width = len(x)
    return -np.tanh((x - middle) / 3.0), bell(width, float(np.interp(middle, x, np.arange(width))), 0.30 * width)


def _folds(shape: tuple[int, int], pixels_per_metre: float, rng: np.random.Generator) -> tuple[Picture, Picture]:
    """Return how far small folds lean to the right, and how far they face up, each about -1 to 1."""
    rows, columns = shape
    cells = (max(2.0, rows / pixels_per_metre / 1.1), columns / pixels_per_metre / 1.6)
    bumps = clouds(shape, rng, cells, octaves=4, gain=0.5)
    across, down = (np.clip(0.6 * pixels_per_metre * np.gradient(bumps, axis=axis), -1, 1) for axis in (1, 0))
    return across, down


def _softened(row: Picture, width: float) -> Picture:
    """Return a row (k,) blurred over `width` pixels, so that a hill's corners show only at its edge."""
    blur = np.hanning(2 * round(width) + 1)
    soft: Picture = np.convolve(np.pad(row, len(blur) // 2, "edge"), blur / blur.sum(), "valid").astype(np.float32)
    return soft
