"""Collision of two polygons in plain floats: `collide`, operation for operation, for one pair.

`lone_contacts` says why. Whoever wants to know what a formula is for reads it in `collide`.
"""

from __future__ import annotations

from math import inf, sqrt
from typing import NamedTuple

import numpy as np

from engine.collide import REFERENCE_BIAS
from engine.contacts import MARGIN
from engine.vector import Array

Corner = tuple[float, float]
Edge = tuple[float, float, float, float]  # in a body's frame: where it starts, and its outward normal


class Face(NamedTuple):
    """An edge of a placed polygon, its outward normal, and how far along that it lies."""

    start_x: float
    start_y: float
    end_x: float
    end_y: float
    x: float
    y: float
    far: float


class Touch(NamedTuple):
    """Manifold of one pair, as a row of `collide.Manifold`."""

    pair: int
    normal: Corner
    points: tuple[Corner, Corner]
    depth: Corner
    valid: tuple[bool, bool]
    feature: tuple[int, int]


def edges_of(start: Array, normal: Array) -> list[Edge]:
    """Return a polygon's corners, and the normals of the edges that begin there, without those that pad the table."""
    return list(dict.fromkeys(tuple(edge) for edge in np.concatenate([start, normal], axis=1).tolist()))


def placed(edges: list[Edge], x: float, y: float, cos: float, sin: float) -> list[Face]:
    """Return the faces of a polygon in the world."""
    corners = [(right * cos - up * sin + x, right * sin + up * cos + y) for right, up, _, _ in edges]
    ends = [*corners[1:], corners[0]]
    faces = []
    for (start_x, start_y), (end_x, end_y), (_, _, right, up) in zip(corners, ends, edges, strict=True):
        out_x, out_y = right * cos - up * sin, right * sin + up * cos
        faces.append(Face(start_x, start_y, end_x, end_y, out_x, out_y, out_x * start_x + out_y * start_y))
    return faces


def _deepest_face(faces: list[Face], others: list[Face]) -> tuple[float, int]:
    """`collide.deepest_face`; a gap wider than the margin may be any such."""
    widest, deepest = -inf, 0
    corners = [(face.start_x, face.start_y) for face in others]
    for number, (_, _, _, _, out_x, out_y, far) in enumerate(faces):
        gap = min([x * out_x + y * out_y for x, y in corners]) - far
        if gap > widest:
            widest, deepest = gap, number
            if gap > MARGIN:
                break
    return widest, deepest


def touch_of(pair: int, a: list[Face], b: list[Face]) -> Touch | None:
    """`collide.collide_polygons` for one pair; None if it has no point."""
    gap_b, face_b = _deepest_face(b, a)
    if gap_b > MARGIN:
        return None
    gap_a, face_a = _deepest_face(a, b)
    if gap_a > MARGIN:
        return None
    flip = gap_b > gap_a + REFERENCE_BIAS
    reference, face, other = (b, face_b, a) if flip else (a, face_a, b)
    start_x, start_y, end_x, end_y, x, y, _ = reference[face]
    opposed = [each.x * x + each.y * y for each in other]
    incident = opposed.index(min(opposed))
    from_x, from_y, to_x, to_y, _, _, _ = other[incident]

    edge_x, edge_y = end_x - start_x, end_y - start_y
    length = sqrt(edge_x * edge_x + edge_y * edge_y)
    along_x, along_y = edge_x / length, edge_y / length
    first = (from_x - start_x) * along_x + (from_y - start_y) * along_y
    last = (to_x - start_x) * along_x + (to_y - start_y) * along_y
    span = last - first
    if abs(span) < 1e-12:
        span = 1e-12
    low, high = min(first, last), max(first, last)
    points, depths = [], []
    for side in (0.0, edge_x * along_x + edge_y * along_y):
        share = (min(max(side, low), high) - first) / span
        corner_x, corner_y = from_x + (to_x - from_x) * share, from_y + (to_y - from_y) * share
        depth = -((corner_x - start_x) * x + (corner_y - start_y) * y)
        depths.append(depth)
        points.append((corner_x + x * (depth / 2), corner_y + y * (depth / 2)))
    valid = (depths[0] >= -MARGIN, depths[1] >= -MARGIN)
    if not any(valid):
        return None
    number = ((flip * 64 + face) * 64 + incident) * 2
    normal = (-x, -y) if flip else (x, y)
    return Touch(pair, normal, (points[0], points[1]), (depths[0], depths[1]), valid, (number + 1, number + 2))
