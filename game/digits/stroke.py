"""Pen stroke: a smooth curve through the pen's positions, thicker where the pen was slow."""

from __future__ import annotations

import math
from typing import Final

import numpy as np
import numpy.typing as npt

PEN_WIDTH: Final = 28.0  # points, of a pen that moves at a middling speed
_SLOW, _FAST = 1.12, 0.72  # times that width
_FASTEST: Final = 40.0  # points from one event to the next
_EASE: Final = 0.2
_CHORD: Final = 7.0  # points: longer segments between two events are curved
_CORNER: Final = 0.3  # cosine of a turn from which it counts as a corner, and stays sharp

Point = tuple[float, float]


class Stroke:
    """Stroke that grows point by point; positions in points from the pad's upper left corner, at full precision.

    Attributes:
        path: the curve, as closely spaced points; it passes through every added point.
        widths: width of the pen at each point of the path.
        settled: index up to which the path is final.

    """

    def __init__(self, start: Point) -> None:
        self._added = [start]
        self._pressure = 0.9
        self.path: list[Point] = [start]
        self.widths = [PEN_WIDTH * self._pressure]
        self.settled = 0
        self._points: npt.NDArray[np.float64] | None = None

    @property
    def points(self) -> npt.NDArray[np.float64]:
        """The path as an array (n, 2). Cached: do not modify."""
        if self._points is None:
            self._points = np.array(self.path)
        return self._points

    def add(self, point: Point) -> bool:
        """Add a point: joined straight at first, curved once the next is known. Return False if it equals the last."""
        last = self._added[-1]
        if point == last:
            return False
        self._points = None
        if len(self._added) > 1:
            del self.path[self.settled + 1 :], self.widths[self.settled + 1 :]
            before = self._added[-3] if len(self._added) > 2 else None
            self._extend(_curve(before, self._added[-2], last, point))
            self.settled = len(self.path) - 1
        self._added.append(point)
        speed = min(math.dist(last, point) / _FASTEST, 1.0)
        self._pressure += _EASE * (_SLOW + (_FAST - _SLOW) * speed - self._pressure)
        self._extend([point])
        return True

    def _extend(self, points: list[Point]) -> None:
        start, end = self.widths[-1], PEN_WIDTH * self._pressure
        self.path += points
        self.widths += [start + (end - start) * (number + 1) / len(points) for number in range(len(points))]


def _curve(before: Point | None, start: Point, end: Point, after: Point) -> list[Point]:
    """Return points on the way from start to end, the end included: a cubic Hermite spline.

    Its tangents halve the turns at both ends and are as long as the chord, so it never swings out far.
    """
    chord = math.dist(start, end)
    if chord < _CHORD:
        return [end]
    along = ((end[0] - start[0]) / chord, (end[1] - start[1]) / chord)
    first = _tangent(_direction(before, start), along) if before else along
    last = _tangent(along, _direction(end, after))
    count = math.ceil(chord / _CHORD) + 1
    points = []
    for number in range(1, count):
        t = number / count
        weights = (1 + 2 * t) * (1 - t) ** 2, t * t * (3 - 2 * t), chord * t * (1 - t) ** 2, chord * t * t * (t - 1)
        x, y = (sum(map(float.__mul__, weights, axis)) for axis in zip(start, end, first, last, strict=True))
        points.append((x, y))
    return [*points, end]


def _direction(start: Point, end: Point) -> Point:
    length = math.dist(start, end) or 1.0
    return ((end[0] - start[0]) / length, (end[1] - start[1]) / length)


def _tangent(arriving: Point, leaving: Point) -> Point:
    """Return the direction halfway between two; at a corner there is none, and each side ends straight."""
    if arriving[0] * leaving[0] + arriving[1] * leaving[1] < _CORNER:
        return (0.0, 0.0)
    return _direction((0.0, 0.0), (arriving[0] + leaving[0], arriving[1] + leaving[1]))
