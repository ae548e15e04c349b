"""Strokes of a pen, as lists of points, drawn onto a canvas."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

import numpy as np
import numpy.typing as npt

Stroke = npt.ArrayLike  # (n, 2): x to the right, y down, in pixels from the canvas's upper left corner
Canvas = npt.NDArray[np.float32]
Points = npt.NDArray[np.float64]
_SMALL: Final = 8.0  # pixels beyond the pen's width that a piece may take and count as short
_CELLS: Final = 2**14  # pixels that are worked upon at a time: they stay in a core's cache


def as_points(strokes: Sequence[Stroke]) -> list[Points]:
    """Return each stroke as (n, 2) finite points, those with none left out; raises ValueError for other shapes."""
    cleaned = []
    for stroke in strokes:
        points = np.asarray(stroke, np.float64)
        if points.size and (points.ndim != 2 or points.shape[1] != 2):
            raise ValueError(f"a stroke is a list of (x, y), not an array of shape {points.shape}")
        points = points[np.isfinite(points).all(axis=-1)] if points.size else points
        if len(points):
            cleaned.append(points)
    return cleaned


def spaced(points: Points, spacing: float) -> Points:
    """Return a stroke without points that follow another within so much of the way; both ends stay."""
    way = np.cumsum(np.hypot(*np.diff(points, axis=0, prepend=points[:1]).T))
    kept = np.diff(np.floor(way / spacing), prepend=-1.0) > 0
    kept[-1] = True
    return points[kept]


def draw_strokes(strokes: Sequence[Stroke], shape: tuple[int, int], width: float) -> Canvas:
    """Return a canvas of shape (height, width), 0 to 1, drawn upon with a round pen `width` pixels wide."""
    canvas = np.zeros(shape, np.float32)
    if lines := as_points(strokes):
        starts = np.concatenate([points[: max(1, len(points) - 1)] for points in lines])
        ends = np.concatenate([points[min(1, len(points) - 1) :] for points in lines])
        draw_segments(canvas, starts, ends, np.full(len(starts), width))
    return canvas


def draw_segments(canvas: Canvas, starts: npt.ArrayLike, ends: npt.ArrayLike, widths: npt.ArrayLike) -> None:
    """Draw straight pieces (n, 2) in place, each with a round pen (n,) wide.

    A pixel is as bright as the pen covers it, to a good approximation.
    """
    starts, ends, widths = (np.asarray(given, np.float64) for given in (starts, ends, widths))
    sizes = np.abs(ends - starts).max(axis=1, initial=0.0) + widths + 2
    for index in np.flatnonzero(sizes > 2 * widths + _SMALL):
        _draw_long(canvas, starts[index], ends[index], float(widths[index]))
    short = np.flatnonzero(sizes <= 2 * widths + _SMALL)
    at_a_time = max(1, int(_CELLS // max(1.0, sizes[short].max(initial=0.0) ** 2)))
    for first in range(0, len(short), at_a_time):
        some = short[first : first + at_a_time]
        _draw_short(canvas, starts[some], ends[some], widths[some])


def _draw_short(canvas: Canvas, starts: Points, ends: Points, widths: Points) -> None:
    """Draw pieces in windows of one size, for what an array operation costs is mostly its call."""
    height, width = canvas.shape
    corners = np.floor(np.minimum(starts, ends) - widths[:, None] / 2 - 1)
    side = int(np.ceil((np.maximum(starts, ends) + widths[:, None] / 2 + 1 - corners).max()))
    inside = ((corners > -side) & (corners < (width, height))).all(axis=1)
    starts, ends, corners, widths = starts[inside], ends[inside], corners[inside], widths[inside]
    rows, columns = min(side, height), min(side, width)
    corners = np.clip(corners, 0, (width - columns, height - rows))  # windows at an edge are moved inwards
    pixels = np.arange(side, dtype=np.float32) + 0.5
    (across, down), (dx, dy) = (starts - corners).astype(np.float32).T, (ends - starts).astype(np.float32).T
    covers = _cover(
        pixels[:columns] - across[:, None, None],
        pixels[:rows, None] - down[:, None, None],
        dx[:, None, None],
        dy[:, None, None],
        widths.astype(np.float32)[:, None, None],
    )
    for (left, top), cover in zip(corners.astype(int).tolist(), covers, strict=True):
        part = canvas[top : top + rows, left : left + columns]
        np.maximum(part, cover, out=part)


def _draw_long(canvas: Canvas, start: Points, end: Points, width: float) -> None:
    (x0, y0), (x1, y1) = start, end
    reach = width / 2 + 1
    left, right = _clipped(min(x0, x1) - reach, max(x0, x1) + reach, canvas.shape[1])
    top, bottom = _clipped(min(y0, y1) - reach, max(y0, y1) + reach, canvas.shape[0])
    if left >= right or top >= bottom:
        return
    across, down = np.arange(left, right) + 0.5 - x0, (np.arange(top, bottom) + 0.5 - y0)[:, None]
    part = canvas[top:bottom, left:right]
    np.maximum(part, _cover(across, down, x1 - x0, y1 - y0, width), out=part, casting="same_kind")


def _cover(across: Any, down: Any, dx: Any, dy: Any, width: Any) -> Any:
    """Return how much of pixels at a place from a piece's start is covered; (dx, dy) leads to its end."""
    square = np.maximum(dx * dx + dy * dy, 1e-12)
    along = across * (dx / square) + down * (dy / square)
    np.clip(along, 0.0, 1.0, out=along)
    distance = np.square(across - along * dx)
    distance += np.square(down - along * dy)
    np.sqrt(distance, out=distance)
    np.subtract(width / 2 + 0.5, distance, out=distance)
    return np.clip(distance, 0.0, np.minimum(1.0, width), out=distance)


def _clipped(low: float, high: float, size: int) -> tuple[int, int]:
    return max(0, int(np.clip(np.floor(low), 0, size))), int(np.clip(np.ceil(high), 0, size))
