"""Numerics of a chart: limits, grid lines, thinning, smoothing and anti-aliased rasterisation.

All arrays; no surfaces. Columns and rows are pixels of the plot, counted from its top left pixel's middle.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, Final

import numpy as np
import numpy.typing as npt

Numbers = npt.NDArray[np.floating[Any]]
Limits = tuple[float, float]

_WILD: Final = 300.0  # a range this many times wider than the interquartile range is cut
_WITHIN: Final = 10.0  # interquartile ranges on either side to which it is cut
_MOST_LINES: Final = 4
_STEPS: Final = (1.0, 2.0, 2.5, 5.0, 10.0)
_STEEP: Final = 3.0  # slope in rows per column above which a line grows no thicker, or it would end in spikes
_FAR: Final = -1e6  # a row outside the plot
_ROUNDING: Final = 1e-9
_THOUSANDS: Final = ((1e6, "M"), (1e3, "k"))


def compact(value: float, digits: int = 3) -> str:
    """Write a number in about five characters: 0.0210, 118, 12.3k, 1.2e30, –."""
    if not math.isfinite(value):
        return "–"
    size = abs(value)
    if size and (size < 10.0 ** (1 - digits) / 10 or size >= 1e9):
        text = f"{value:.1e}".replace("e+0", "e").replace("e+", "e").replace("e-0", "e-")
    else:
        text = _in_thousands(value, digits)
    return text.replace("-", "−")


def _in_thousands(value: float, digits: int) -> str:
    for unit, letter in _THOUSANDS:
        if abs(value) >= 10 * unit:
            return f"{value / unit:#.{digits}g}".rstrip(".") + letter
    if abs(value) >= 10 ** (digits - 1):
        return f"{value:.0f}"
    return f"{value:#.{digits}g}" if value else "0"


def round_number(value: float) -> str:
    """Write a round number, such as a grid line's, as briefly as possible."""
    if abs(value) >= 1e9 or 0 < abs(value) < 1e-4:
        return compact(value).replace(".0e", "e")
    for unit, letter in _THOUSANDS:
        if abs(value) >= 10 * unit:
            return f"{value / unit:.4g}{letter}".replace("-", "−")
    return f"{value:.6g}".replace("-", "−")


def robust_range(values: Numbers) -> Limits | None:
    """Return the range of values without extreme outliers, or None if there are no values.

    If a few values have exploded, so that all others would look like one flat line, the range leaves these out.
    """
    if not len(values):
        return None
    low, high = float(values.min()), float(values.max())
    first, third = (float(one) for one in np.quantile(values, (0.25, 0.75)))
    middle = third - first
    if middle > 0 and high / _WILD - low / _WILD > middle:
        return max(low, first - _WITHIN * middle), min(high, third + _WITHIN * middle)
    return low, high


def grid(low: float, high: float) -> Numbers:
    """Return two to four grid lines: evenly spaced round numbers that enclose low to high."""
    low, high = max(low, -1e300), min(high, 1e300)
    if high / 2 - low / 2 <= 1e-9 * max(abs(low), abs(high)):
        around = max(abs(low), abs(high)) / 10 or 1.0
        low, high = low - around, high + around
    wide = (high - low) / (_MOST_LINES - 1)
    power = 10.0 ** math.floor(math.log10(wide))
    for step in (power * factor for factor in (*_STEPS, 20.0, 50.0)):
        first, last = math.floor(low / step + _ROUNDING), math.ceil(high / step - _ROUNDING)
        if last - first < _MOST_LINES:
            break
    return np.arange(first, last + 1) * step


def steady_grid(span: Limits, before: Numbers | None) -> Numbers:
    """Return grid lines for a range; keep the previous ones while the range fits and fills them well."""
    lines = grid(*span)
    if before is None or span[0] < before[0] or span[1] > before[-1]:
        return lines
    return lines if lines[-1] - lines[0] < 0.6 * (before[-1] - before[0]) else before


def trace(x: Numbers, y: Numbers, end: float, columns: int, radius: int) -> Numbers:
    """Return the smoothed value in each pixel column, (columns,), of x from 0 to `end`; NaN beyond the data.

    A local linear fit over `radius` columns to either side (Fan and Gijbels 1996): unlike an average it does
    not lag, and it does not bend at the ends. Values between two points lie on the line between them.
    """
    column = np.rint(x * ((columns - 1) / end)).astype(np.intp)
    count = np.bincount(column, minlength=columns).astype(float)
    total = np.bincount(column, y, minlength=columns).astype(float)
    filled = np.flatnonzero(count)
    if not len(filled):
        return np.full(columns, np.nan)
    smooth = _local_line(count, total, min(radius, (columns - 1) // 2))[filled]
    smooth = np.clip(smooth, y.min(), y.max())
    return np.interp(np.arange(columns), filled, smooth, left=np.nan, right=np.nan)


def _local_line(count: Numbers, total: Numbers, radius: int) -> Numbers:
    """Return the local linear fit at each column, near columns weighing most; undefined for columns without data."""
    away = np.arange(-radius, radius + 1, dtype=float)
    weight = (1 - (away / (radius + 1)) ** 2) ** 2
    if not radius:
        return total / np.maximum(count, 1.0)
    s0, s1, s2 = (np.convolve(count, weight * away**power, mode="same") for power in range(3))
    t0, t1 = (np.convolve(total, weight * away**power, mode="same") for power in range(2))
    spread = s0 * s2 - s1 * s1
    mean = t0 / np.maximum(s0, 1e-300)
    fit: Numbers = np.where(spread > 1e-6 * s0 * s0, (s2 * t0 - s1 * t1) / np.where(spread > 0, spread, 1.0), mean)
    return fit


def stroke(heights: Numbers, rows: int, width: float, dash: Sequence[float] = ()) -> tuple[int, Numbers]:
    """Return the first row of a line, and its coverage of each pixel from there, (height, columns) in 0 to 1.

    `heights` (columns,) are rows, NaN for no line; `width` and `dash` (on, off, ...) are in pixels.
    Rows outside 0 to `rows` are cut off.
    """
    known = np.isfinite(heights)
    if not known.any():
        return 0, np.zeros((0, len(heights)), np.float32)
    middle = np.where(known, heights, _FAR).astype(np.float32)
    between = (middle[1:] + middle[:-1]) / 2  # a line leaves a column halfway to its neighbour
    joined = known[1:] & known[:-1]
    left, right = middle.copy(), middle.copy()
    np.copyto(left[1:], between, where=joined)
    np.copyto(right[:-1], between, where=joined)
    low, high = np.minimum(np.minimum(left, right), middle), np.maximum(np.maximum(left, right), middle)
    rise = high - low
    slope = np.minimum(rise, _STEEP)
    thick = width * np.sqrt(1 + slope**2)  # measured vertically, a steep line is thicker
    ramp = np.maximum(slope, 1.0)
    most = np.minimum(thick / ramp, 1.0) * (_dashes(middle, dash) if dash else 1.0)
    reach = (np.maximum(rise, 1.0) + thick) / 2
    centre = (low + high) / 2
    first = max(0, math.floor((centre - reach)[known].min()))
    last = min(rows, math.ceil((centre + reach)[known].max()) + 1)
    cover = np.arange(first, max(first, last), dtype=np.float32)[:, None] - centre
    np.abs(cover, out=cover)
    cover *= -1 / ramp
    cover += reach / ramp
    return first, np.clip(cover, 0.0, most, out=cover)


def _dashes(heights: Numbers, dash: Sequence[float]) -> Numbers:
    """Return how far each column lies within a dash, 0 to 1, measured along the line."""
    lengths = np.ones(len(heights))
    lengths[1:] = np.sqrt(1 + np.minimum((heights[1:] - heights[:-1]) ** 2, 1e4))
    along = np.cumsum(lengths) % sum(dash)
    within = np.zeros(len(along))
    start = 0.0
    for on, off in zip(dash[::2], dash[1::2], strict=True):
        reach = np.minimum(along - start, start + on - along) + 0.5
        within = np.maximum(within, np.clip(reach, 0.0, 1.0))
        start += on + off
    return within


def specks(columns: Numbers, heights: Numbers, size: tuple[int, int], radius: float) -> Numbers:
    """Return the coverage of each pixel by dots, (rows, columns) in 0 to 1; `size` is (columns, rows)."""
    reach = math.ceil(radius + 0.5)
    near = np.arange(-reach, reach + 1)
    across, down = (each.ravel() for each in np.meshgrid(near, near))
    column, row = np.rint(columns).astype(np.intp)[:, None] + across, np.rint(heights).astype(np.intp)[:, None] + down
    cover = np.clip(radius + 0.5 - np.hypot(column - columns[:, None], row - heights[:, None]), 0.0, 1.0)
    inside = (column >= 0) & (column < size[0]) & (row >= 0) & (row < size[1])
    flat = np.bincount((row * size[0] + column)[inside], cover[inside], minlength=size[0] * size[1]).astype(np.float32)
    return np.minimum(flat, 1.0).reshape(size[1], size[0])
