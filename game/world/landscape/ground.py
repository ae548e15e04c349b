"""Ground of a flight: hills and knolls in front of the plain, and the pads."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import lru_cache
from itertools import pairwise
from typing import Final

import numpy as np

from ai.environment import Doubles
from ai.lander.ground import Ground, Pad, half_plane
from game.drawing.canvas import Canvas
from game.drawing.paint import PIECE, Picture, Sheet, bell, slopes
from game.drawing.paint_cache import InPieces, Steps, idle
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
_FOLD: Final = 0.045  # metres: folds are so soft that they need not be computed at more places
_BAND: Final = 64  # rows that are painted together
_RIM: Final = 0.05  # metres beside rock that are painted in its colour, though clear
_STAKE: Final = 5.0  # points
_LIP: Final = 0.3  # metres that a knoll is lower than its pad


def draw_ground(canvas: Canvas, view: View, ground: Ground, shift: float = 0.0) -> None:
    """Draw hills, if any, and pads, `shift` metres to the right."""
    if ground.hills or ground.roofs:
        sheet, corner = _hills(ground, _detail(view)).picture
        sheet.draw(canvas.surface, view, corner)
    several = len(ground.pads) > 1
    for pad in ground.pads:
        if pad.bare:
            _draw_flat_spot(canvas, view, pad)
            continue
        floor = pad.top - _LIP if several else ground.base
        draw_pad(canvas, view, (pad.x + shift, pad.top), pad.width, floor)


def _draw_flat_spot(canvas: Canvas, view: View, pad: Pad) -> None:
    """Mark level rock that can be landed on without a pad: a fine line with a stake at both ends."""
    left, right = view.points(((pad.left, pad.top), (pad.right, pad.top))).tolist()
    canvas.line(left, right, INK, 1.0, 0.55)
    for x, y in (left, right):
        canvas.line((x, y), (x, y - _STAKE), INK, 1.0, 0.55)


@lru_cache(maxsize=2)  # of the present flight, and of the next where it is known
def _hills(ground: Ground, pixels_per_metre: float) -> InPieces[tuple[WorldPicture, tuple[float, float]]]:
    return InPieces(lambda share: paint_hills(ground, share * pixels_per_metre))


def _detail(view: View) -> float:
    """Return the pixels per metre at which to paint hills that are seen in a view."""
    return round((_DETAIL if view.closest else 1.0) * view.painted_per_metre, 3)


def begin_hills(ground: Ground, view: View) -> None:
    """Begin to paint the hills of a ground that will be seen soon, once all that is seen now is whole."""
    if (ground.hills or ground.roofs) and idle():
        _hills(ground, _detail(view))


def paint_hills(ground: Ground, pixels_per_metre: float) -> Steps[tuple[WorldPicture, tuple[float, float]]]:
    """Paint hills and roofs; return their picture, and the place of its top left corner in metres."""
    across = np.arange(-_REACH, _REACH, 1 / pixels_per_metre)
    crest = hills_height(ground, across).astype(np.float32)
    top = float(max([crest.max(), *(y for roof in ground.roofs for _, y in roof)])) + 0.1
    heights = top - np.arange(0.0, top - ground.base + _FOOT, 1 / pixels_per_metre, dtype=np.float32)[:, None]
    shape, rng = (len(heights), len(across)), np.random.default_rng(round(1000 * top))
    yield len(across)
    cells = max(2.0, (top - ground.base + _FOOT) / 1.1), 2 * _REACH / 1.6
    folds = yield from slopes(shape, rng, cells, 4, 0.5, max(1, round(pixels_per_metre * _FOLD)))
    sheet, lit = Sheet(shape, rng), _Light(across, crest, pixels_per_metre)
    foot = _FOOT * np.clip((crest - ground.base) / 0.8, 0, 1) ** 0.6  # none where there is no hill
    for rows in (slice(start, min(start + _BAND, shape[0])) for start in range(0, shape[0], _BAND)):
        height = heights[rows]
        rise, faded = (height - ground.base) / (top - ground.base), height - ground.base
        for columns in _filled(ground, across, crest, height, round(_RIM * pixels_per_metre)):
            hung, above = _hung(ground, across[columns], height)
            under = crest[columns]
            below = np.where(hung > 0, above, under - height)  # metres under the surface
            lean = [np.clip(0.6 * pixels_per_metre * fold.part(rows, columns), -1, 1) for fold in folds]
            fade = np.clip(1 + faded / np.maximum(foot[columns], 0.02), 0, 1)
            cover = np.clip(below * pixels_per_metre + 0.5, 0, 1) * (under > ground.base + 0.01) * fade * np.sqrt(fade)
            cover = np.maximum(cover, np.clip(hung * pixels_per_metre + 0.5, 0, 1))
            sheet.put(rows.start, columns.start, lit.on(columns, rise, below, lean), cover)
            yield below.size
        yield 1
    yield PIECE
    return WorldPicture(sheet.done(), pixels_per_metre), (-_REACH, top)


def _filled(ground: Ground, x: Doubles, crest: Picture, height: Picture, rim: int) -> Iterator[slice]:
    """Return the columns in which there is rock in rows at such heights, and a rim of pixels beside it.

    Where a picture is scaled, the colour of clear pixels beside its edge shows.
    """
    low, high = float(height[-1, 0] - _RIM), float(height[0, 0] + _RIM)
    rock = (crest > low) & (crest > ground.base)
    for roof in ground.roofs:
        if min(y for _, y in roof) < high and max(y for _, y in roof) > low:
            rock |= (x > min(x for x, _ in roof)) & (x < max(x for x, _ in roof))
    edges = np.flatnonzero(np.diff(rock, prepend=False, append=False))
    done = 0
    for start, stop in edges.reshape(-1, 2).tolist():
        done, end = max(done, start - rim), min(stop + rim, len(x))
        while done < end:
            yield slice(done, min(done + PIECE // _BAND, end))
            done = min(done + PIECE // _BAND, end)


class _Light:
    """Colour of rock in the low sun, column by column."""

    def __init__(self, x: Doubles, crest: Picture, pixels_per_metre: float) -> None:
        self._sunward, near = _sunlight(x.astype(np.float32))
        slope = np.gradient(crest, x).clip(-_STEEPEST, _STEEPEST).astype(np.float32) * self._sunward
        self._slope = 0.9 * _softened(slope, _SOFT * pixels_per_metre)
        self._facing = np.clip(0.45 + 1.1 * slope, 0.10, 1.4) * (0.18 + 0.72 * near)
        self._ahead = np.sqrt(1 - self._sunward**2)

    def on(self, columns: slice, rise: Picture, below: Picture, lean: Sequence[Picture]) -> list[Picture]:
        """Return the colour of some columns.

        Args:
            columns: which ones.
            rise: height of each row, from 0 at the plain to 1 at the highest rock, (rows, 1).
            below: metres under the surface, (rows, columns).
            lean: how far small folds face up and lean to the right, each about -1 to 1.

        """
        # Where the sun is straight ahead, folds are lit from above instead of from a side.
        lit = lean[1] * self._sunward[columns] + lean[0] * self._ahead[columns] + self._slope[columns]
        shade = 1 + 0.30 * np.clip(lit, -1.2, 1.2)
        inward = np.exp(np.minimum(below * np.float32(-1 / 0.30), 0))
        narrow = inward * inward * inward
        rim = (0.6 * narrow * narrow + 0.22 * inward) * self._facing[columns]
        high = 0.35 + 0.65 * np.clip(rise, 0, 1)
        return [
            shade * (foot + high * (crest - foot)) + rim * (np.float32(0.62) * warm)
            for foot, crest, warm in zip(_FOOT_COLOUR, _CREST_COLOUR, _WARM, strict=True)
        ]


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


def _softened(row: Picture, width: float) -> Picture:
    """Return a row (k,) blurred over `width` pixels, so that a hill's corners show only at its edge."""
    blur = np.hanning(2 * round(width) + 1)
    soft: Picture = np.convolve(np.pad(row, len(blur) // 2, "edge"), blur / blur.sum(), "valid").astype(np.float32)
    return soft
