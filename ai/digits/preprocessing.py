"""Preprocessing of drawings for a network, as the makers of MNIST preprocessed theirs.

LeCun et al. 1998, section III.A: black and white digits were shrunk into a box of 20×20 pixels, keeping their
aspect, grey where a pixel is partly covered, and set into 28×28 by their centre of mass. Here pens differ more
than there, so strokes are brought to the width they have in MNIST.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final, NamedTuple

import numpy as np
import numpy.typing as npt

from ai.digits.strokes import Stroke, as_points, draw_strokes, spaced

SIDE: Final = 28  # pixels along what a network reads
BOX: Final = 20  # and along the box in its middle that ink has to fit
CENTRE: Final = 14.5  # from the image's edge: the middle of pixel 14
STROKE_WIDTH: Final = 2.4  # pixels: the mean of MNIST's training images, as `stroke_width` measures them
CELLS: Final = 5  # along a pixel: the grid on which strokes are measured and changed
MARGIN: Final = 2  # pixels of it around the box, room for strokes that grow
SPACING: Final = 1.5  # cells from one point of a stroke to the next: more of them change nothing that can be seen
MOST_POINTS: Final = 250  # of all strokes together: digits have fewer, and a scribble must not take long
MEASURABLE: Final = 18  # pixels: ink with no longer side has strokes too few pixels wide to be measured
LARGEST_GROWTH: Final = 2.0  # how far ink is enlarged once its strokes are thinner: a dot stays a dot

Image = npt.NDArray[np.float32]


class Stages(NamedTuple):
    """Stages of a drawing's preprocessing: 2-D float32 images in 0 to 1."""

    fitted: Image  # (20, 20), the part that has ink
    thinned: Image  # (20, 20), strokes as wide as in MNIST
    centred: Image  # (28, 28)


def preprocess(canvas: npt.ArrayLike) -> Image:
    """Return what a network reads of a canvas: (28, 28) float32 in 0 to 1, zeros if nothing is drawn.

    The canvas is 2-D, of any size and number type, ink bright. Raises ValueError for other shapes.
    """
    return stages(canvas).centred


def preprocess_strokes(strokes: Sequence[Stroke]) -> Image:
    """Return what a network reads of strokes, each a list of points (x, y), y down, whatever pen drew them."""
    ink = redrawn(strokes)
    if not ink.any():
        return np.zeros((SIDE, SIDE), np.float32)
    return _placed(ink, CELLS)


def redrawn(strokes: Sequence[Stroke]) -> Image:
    """Return strokes as large as the box, on its fine grid, with a pen as wide as MNIST's."""
    points, size = as_points(strokes), (BOX + 2 * MARGIN) * CELLS
    if not points:
        return np.zeros((size, size), np.float32)
    everything = np.concatenate(points)
    low, high = everything.min(axis=0), everything.max(axis=0)
    room = BOX - STROKE_WIDTH
    scale = CELLS * room / max(float((high - low).max()), room / LARGEST_GROWTH)
    way = scale * sum(float(np.hypot(*np.diff(stroke, axis=0).T).sum()) for stroke in points)
    spacing = max(SPACING, way / MOST_POINTS)
    placed = [spaced((stroke - (low + high) / 2) * scale + size / 2, spacing) for stroke in points]
    return draw_strokes(placed, (size, size), STROKE_WIDTH * CELLS)


def stages(canvas: npt.ArrayLike, *, width: bool = True) -> Stages:
    """Return a canvas at each stage.

    Strokes stay as wide as they are without `width`, and in a scan of too few pixels to measure them.

    What is not a number is no ink; where ink exceeds 1, the brightest counts as 1.
    """
    drawn = _clean(canvas)
    box = _box(drawn)
    if box is None:
        empty = np.zeros((BOX, BOX), np.float32)
        return Stages(empty, empty, np.zeros((SIDE, SIDE), np.float32))
    cropped = drawn[box]

    # On a fine grid around the middle of the box.
    middle = (cropped.shape[0] / 2, cropped.shape[1] / 2)
    pitch = max(cropped.shape) / (BOX * CELLS)
    ink = _resample(cropped, middle, pitch, (BOX + 2 * MARGIN) * CELLS)
    middle = (len(ink) / 2, len(ink) / 2)
    fitted = _resample(ink, middle, CELLS, BOX)
    cells = float(CELLS)  # along a pixel of the result
    if width and max(cropped.shape) >= MEASURABLE:
        ink, growth = _with_stroke_width(_covered(ink, drawn.max()))
        cells /= growth
        middle = _middle_of(_box(ink))
    thinned = _resample(ink, middle, cells, BOX)
    return Stages(fitted, thinned, _placed(ink, cells))


def _clean(canvas: npt.ArrayLike) -> Image:
    array = np.asarray(canvas)
    if array.ndim != 2:
        raise ValueError(f"a canvas has two axes, not {array.ndim}")
    with np.errstate(over="ignore"):
        drawn = array.astype(np.float32)
    peak = drawn.max(initial=1.0)
    if not math.isfinite(peak):
        peak = drawn.max(initial=1.0, where=np.isfinite(drawn))
        drawn = np.nan_to_num(drawn, nan=0.0, posinf=peak, neginf=0.0)
    clean: Image = np.clip(drawn / peak if peak > 1 else drawn, 0.0, 1.0)
    return clean


def _box(image: Image) -> tuple[slice, slice] | None:
    """Return the rows and columns that have ink, if any."""
    ink = image > 0.25 * image.max(initial=0.0)
    rows, columns = np.flatnonzero(ink.any(axis=1)), np.flatnonzero(ink.any(axis=0))
    if not len(rows):
        return None
    return slice(int(rows[0]), int(rows[-1]) + 1), slice(int(columns[0]), int(columns[-1]) + 1)


def _middle_of(box: tuple[slice, slice] | None) -> tuple[float, float]:
    assert box is not None, "there is ink"
    rows, columns = box
    return (rows.start + rows.stop) / 2, (columns.start + columns.stop) / 2


def _placed(ink: Image, cells: float) -> Image:
    """Return (28, 28) around the centre of mass, at so many cells to a pixel."""
    down, across = _centre_of_mass(ink)
    middle = (down + (SIDE / 2 - CENTRE) * cells, across + (SIDE / 2 - CENTRE) * cells)
    return _resample(ink, middle, cells, SIDE)


def _resample(image: Image, middle: tuple[float, float], pitch: float, count: int) -> Image:
    """Return (count, count) cells, each `pitch` pixels of `image` wide, around a point in it; nothing lies outside."""
    down, across = (_weights(size, at, pitch, count) for size, at in zip(image.shape, middle, strict=True))
    cells: Image = np.clip(down @ image @ across.T, 0.0, 1.0)
    return cells


def _weights(size: int, middle: float, pitch: float, count: int) -> Image:
    """Return how much each of `size` pixels counts for each cell, (count, size).

    Large cells average what they cover, exactly. Small ones interpolate by cubic convolution (Keys 1981).
    """
    edges = middle + (np.arange(count + 1) - count / 2) * pitch
    pixels = np.arange(size)
    if pitch >= 1:
        covered = np.clip(edges[:, None] - pixels, 0.0, 1.0)
        return np.asarray(np.diff(covered, axis=0) / pitch, np.float32)
    x = np.abs((edges[:-1] + pitch / 2)[:, None] - (pixels + 0.5))
    near, far = (1.5 * x - 2.5) * x * x + 1, ((2.5 - 0.5 * x) * x - 4) * x + 2
    weights: Image = np.where(x < 1, near, np.where(x < 2, far, 0.0)).astype(np.float32)
    return weights


def _covered(ink: Image, full: float) -> npt.NDArray[np.bool_]:
    """Return the cells that ink covers by half; of lines so thin that they nowhere fill a cell, all they touch."""
    peak = ink.max()
    covered: npt.NDArray[np.bool_] = ink > peak * (0.45 if peak > 0.9 * full else 0.25)
    return covered


def _with_stroke_width(ink: npt.NDArray[np.bool_]) -> tuple[Image, float]:
    """Return ink whose strokes are as wide as MNIST's once it is enlarged by a factor, and the factor.

    The factor makes what the pen's tip went along fit the box again.
    """
    width = stroke_width(ink) / CELLS
    growth = min(LARGEST_GROWTH, (BOX - STROKE_WIDTH) / max(BOX - width, 1.0))
    step = (STROKE_WIDTH / growth - width) / 2 * CELLS
    reach = math.ceil(abs(step)) + 1
    if step > 0:
        changed = np.clip(1 + step - distance(ink, reach), 0.0, 1.0)
    else:
        changed = np.clip(distance(~ink, reach) + step, 0.0, 1.0)
    return (changed, growth) if changed.any() else (ink.astype(np.float32), 1.0)


def stroke_width(ink: npt.NDArray[np.bool_]) -> float:
    """Return how wide the pen is, in pixels, that drew some ink as one stroke with round ends.

    Such a stroke has area A = l w + π w²/4 and perimeter P = 2 l + π w; this is solved for w.
    """
    image = np.pad(ink, 1).astype(np.float32)
    down, across = image[2:, 1:-1] - image[:-2, 1:-1], image[1:-1, 2:] - image[1:-1, :-2]
    perimeter = 0.5 * float(np.sqrt(down * down + across * across).sum())
    area = float(image.sum())
    return (perimeter - math.sqrt(max(0.0, perimeter**2 - 4 * math.pi * area))) / math.pi


def distance(ink: npt.NDArray[np.bool_], reach: int) -> Image:
    """Return how far each pixel's middle is from that of the nearest with ink; beyond `reach` it may be more.

    Exact and Euclidean, an axis at a time (Felzenszwalb & Huttenlocher 2012, by search instead of envelopes).
    """
    along = np.arange(ink.shape[1], dtype=np.float32)
    before = np.maximum.accumulate(np.where(ink, along, -np.float32(1e6)), axis=1)
    after = np.minimum.accumulate(np.where(ink, along, np.float32(1e6))[:, ::-1], axis=1)[:, ::-1]
    nearest = np.square(np.minimum(along - before, after - along))
    squares = nearest.copy()
    for step in range(1, min(reach, len(ink) - 1) + 1):
        further = nearest + np.float32(step * step)
        np.minimum(squares[step:], further[:-step], out=squares[step:])
        np.minimum(squares[:-step], further[step:], out=squares[:-step])
    root: Image = np.sqrt(squares)
    return root


def _centre_of_mass(ink: Image) -> tuple[float, float]:
    """Return the centre of mass of ink as (down, across), from the image's edges."""
    rows, columns = ink.sum(axis=1), ink.sum(axis=0)
    middles = np.arange(len(ink)) + 0.5
    return float(rows @ middles / rows.sum()), float(columns @ middles / columns.sum())
