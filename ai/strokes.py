"""Strokes of a pen, as lists of points, drawn onto a canvas."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
import numpy.typing as npt

Stroke = npt.ArrayLike  # (n, 2): x to the right, y down, in pixels from the canvas's upper left corner
Canvas = npt.NDArray[np.float32]


def as_points(strokes: Sequence[Stroke]) -> list[npt.NDArray[np.float64]]:
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


def draw_strokes(strokes: Sequence[Stroke], shape: tuple[int, int], width: float) -> Canvas:
    """Return a canvas of shape (height, width), 0 to 1, drawn upon with a round pen `width` pixels wide."""
    canvas = np.zeros(shape, np.float32)
    for points in as_points(strokes):
        for start, end in pairwise(points):
            draw_segment(canvas, start, end, width)
        if len(points) == 1:
            draw_segment(canvas, points[0], points[0], width)
    return canvas


def draw_segment(canvas: Canvas, start: npt.ArrayLike, end: npt.ArrayLike, width: float) -> None:
    """Draw one straight piece in place; a pixel is as bright as the pen covers it, to a good approximation."""
    (x0, y0), (x1, y1) = np.asarray(start, np.float64), np.asarray(end, np.float64)
    reach = width / 2 + 1
    left, right = _clipped(min(x0, x1) - reach, max(x0, x1) + reach, canvas.shape[1])
    top, bottom = _clipped(min(y0, y1) - reach, max(y0, y1) + reach, canvas.shape[0])
    if left >= right or top >= bottom:
        return
    across = np.arange(left, right) + 0.5 - x0
    down = (np.arange(top, bottom) + 0.5 - y0)[:, None]
    dx, dy = x1 - x0, y1 - y0
    along = np.clip((across * dx + down * dy) / max(dx * dx + dy * dy, 1e-12), 0.0, 1.0)
    distance = np.hypot(across - along * dx, down - along * dy)
    part = canvas[top:bottom, left:right]
    np.maximum(part, np.clip(width / 2 + 0.5 - distance, 0.0, min(1.0, width)), out=part, casting="same_kind")


def _clipped(low: float, high: float, size: int) -> tuple[int, int]:
    return max(0, int(np.clip(np.floor(low), 0, size))), int(np.clip(np.ceil(high), 0, size))
