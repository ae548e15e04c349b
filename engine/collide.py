"""Separating Axis Theorem: pure functions from two shapes and their poses to a contact manifold.

Two convex shapes are apart if and only if some axis parts their shadows, and for polygons it is enough to
try the face normals. Of all axes, the one with the least overlap gives the contact normal; the other shape's
most opposed face, clipped to the sides of the reference face, gives up to two contact points.

              incident
           q1 ________ q0            normal: from A to B
     _______|________|_______        depth: how far a point lies below the reference face
            x        x   reference   point: half-way between the two surfaces
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from engine.shapes import Circle, Polygon, Shape
from engine.vector import Array, Bools, Ints, dot, length, rotate

# Two parallel faces are equally good references; a small bias keeps the choice from flickering.
REFERENCE_BIAS = 5e-4
# Pairs whose corners are all compared at once: as many as fit the cache.
_BLOCK = 512
_PARTS = ("normal", "points", "depth", "valid", "feature")


@dataclass
class Manifold:
    """Contacts of n pairs of shapes. A pair has none, one or two points."""

    normal: Array  # (n, 2) unit vector from A to B
    points: Array  # (n, 2, 2) world positions of up to two points
    depth: Array  # (n, 2) metres of overlap, positive where the shapes touch
    valid: Bools  # (n, 2) which points are there
    feature: Ints  # (n, 2) the faces that made each point: the same number, the same contact as a step before

    @classmethod
    def empty(cls, count: int) -> Manifold:
        """Return the manifold of `count` pairs that do not touch."""
        return cls(
            np.zeros((count, 2)),
            np.zeros((count, 2, 2)),
            np.zeros((count, 2)),
            np.zeros((count, 2), dtype=bool),
            np.zeros((count, 2), dtype=np.intp),
        )

    def rows(self, rows: Ints) -> Manifold:
        """Return the manifold of these pairs alone."""
        return Manifold(self.normal[rows], self.points[rows], self.depth[rows], self.valid[rows], self.feature[rows])

    @classmethod
    def join(cls, first: Manifold, second: Manifold) -> Manifold:
        """Return the pairs of two manifolds, one after the other."""
        return cls(*(np.concatenate([getattr(first, name), getattr(second, name)]) for name in _PARTS))

    def put(self, rows: Ints, other: Manifold) -> None:
        """Overwrite these pairs with those of `other`."""
        for name in _PARTS:
            getattr(self, name)[rows] = getattr(other, name)


class PlacedPolygons(NamedTuple):
    """n polygons in the world: where each edge starts and ends, and its outward normal, (n, corners, 2)."""

    start: Array
    end: Array
    normal: Array


def collide(a: Shape, pose_a: Array, b: Shape, pose_b: Array, margin: float = 0.0) -> Manifold:
    """Contacts of shape `a` with shape `b`; poses are (x, y, angle), (3,) or (n, 3).

    Points that are up to `margin` metres apart count as touching, with a depth below 0.
    """
    poses = (np.atleast_2d(np.asarray(pose, dtype=float)) for pose in (pose_a, pose_b))
    pose_a, pose_b = np.broadcast_arrays(*poses)
    if isinstance(a, Circle) and isinstance(b, Circle):
        return collide_circles(
            _centre(a, pose_a),
            np.full(len(pose_a), a.radius),
            _centre(b, pose_b),
            np.full(len(pose_b), b.radius),
            margin,
        )
    if isinstance(a, Polygon) and isinstance(b, Circle):
        return collide_polygon_circle(_place(a, pose_a), _centre(b, pose_b), np.full(len(pose_b), b.radius), margin)
    if isinstance(a, Circle) and isinstance(b, Polygon):
        turned = collide(b, pose_b, a, pose_a, margin)
        turned.normal *= -1
        return turned
    assert isinstance(a, Polygon)
    assert isinstance(b, Polygon)
    return collide_polygons(_place(a, pose_a), _place(b, pose_b), margin)


def collide_polygons(a: PlacedPolygons, b: PlacedPolygons, margin: float) -> Manifold:
    """Contacts of n pairs of convex polygons."""
    gap_a, face_a = deepest_face(a, b.start)
    gap_b, face_b = deepest_face(b, a.start)
    touching = np.maximum(gap_a, gap_b) <= margin
    flip = gap_b > gap_a + REFERENCE_BIAS  # B holds the reference face
    rows = np.arange(len(flip))
    swap = flip[:, None]
    start = np.where(swap, b.start[rows, face_b], a.start[rows, face_a])
    end = np.where(swap, b.end[rows, face_b], a.end[rows, face_a])
    normal = np.where(swap, b.normal[rows, face_b], a.normal[rows, face_a])
    incident_a, incident_b = _most_opposed(a, normal), _most_opposed(b, normal)
    incident_start = np.where(swap, a.start[rows, incident_a], b.start[rows, incident_b])
    incident_end = np.where(swap, a.end[rows, incident_a], b.end[rows, incident_b])

    corners = _clip(start, end, incident_start, incident_end)
    depth = -dot(corners - start[:, None], normal[:, None])
    points = corners + normal[:, None] * (depth / 2)[..., None]
    reference, incident = np.where(flip, face_b, face_a), np.where(flip, incident_a, incident_b)
    number = (flip * 64 + reference) * 64 + incident
    return Manifold(
        normal=np.where(swap, -normal, normal),
        points=points,
        depth=depth,
        valid=touching[:, None] & (depth >= -margin),
        feature=number[:, None] * 2 + np.arange(1, 3),
    )


def collide_polygon_circle(a: PlacedPolygons, centre: Array, radius: Array, margin: float) -> Manifold:
    """Contacts of n convex polygons with n circles, `centre` (n, 2) and `radius` (n,)."""
    rows = np.arange(len(centre))
    gaps = dot(a.normal, centre[:, None] - a.start)
    face = gaps.argmax(axis=1)
    start, end, normal = a.start[rows, face], a.end[rows, face], a.normal[rows, face]
    gap = dot(normal, centre - start)
    edge = end - start
    along = np.clip(dot(centre - start, edge) / dot(edge, edge), 0.0, 1.0)
    nearest = start + edge * along[:, None]
    away = centre - nearest
    distance = length(away)
    # Outside and past the end of the face, a corner is nearest, and the normal points from it.
    from_corner = (gap > 1e-9) & (distance > 1e-9)
    normal = np.where(from_corner[:, None], away / np.maximum(distance, 1e-9)[:, None], normal)
    gap = np.where(from_corner, distance, gap)
    return _single(normal, centre - normal * (radius + gap)[:, None] / 2, radius - gap, margin)


def collide_circles(centre_a: Array, radius_a: Array, centre_b: Array, radius_b: Array, margin: float) -> Manifold:
    """Contacts of n pairs of circles, centres (n, 2) and radii (n,)."""
    away = centre_b - centre_a
    distance = length(away)
    safe = np.maximum(distance, 1e-9)[:, None]
    normal = np.where(distance[:, None] > 1e-9, away / safe, np.array([0.0, 1.0]))
    depth = radius_a + radius_b - distance
    return _single(normal, centre_a + normal * (radius_a - depth / 2)[:, None], depth, margin)


def deepest_face(a: PlacedPolygons, corners: Array) -> tuple[Array, Ints]:
    """Largest gap between a face of `a` and all `corners`, (n,), below 0 for an overlap; and which face."""
    gaps = np.empty(a.normal.shape[:2])
    for first in range(0, len(gaps), _BLOCK):
        rows = slice(first, first + _BLOCK)
        gaps[rows] = _lowest(a.normal[rows], corners[rows])
    gaps -= dot(a.normal, a.start)
    face = gaps.argmax(axis=1)
    return gaps[np.arange(len(face)), face], face


def _lowest(normal: Array, corners: Array) -> Array:
    """Return the position of the lowest corner (n, k, 2) along each normal (n, faces, 2): (n, faces)."""
    x, y = np.moveaxis(corners[:, :, None], (3, 1), (0, 1))
    # Corners first, in memory too: a minimum along the last axis would be several times slower.
    along = np.multiply(x, normal[..., 0], order="C")
    along += np.multiply(y, normal[..., 1], order="C")
    lowest: Array = along.min(axis=0)
    return lowest


def _most_opposed(polygon: PlacedPolygons, normal: Array) -> Ints:
    """Return the face of each polygon whose normal is most opposed to `normal` (n, 2): (n,)."""
    faces: Ints = dot(polygon.normal, normal[:, None]).argmin(axis=1)
    return faces


def _clip(start: Array, end: Array, incident_start: Array, incident_end: Array) -> Array:
    """Both ends of the incident edge, cut to lie above the reference edge, (n, 2, 2)."""
    edge = end - start
    tangent = edge / length(edge)[:, None]
    first, last = dot(incident_start - start, tangent), dot(incident_end - start, tangent)
    span = last - first
    span = np.where(np.abs(span) < 1e-12, 1e-12, span)
    sides = np.stack([np.zeros_like(first), dot(edge, tangent)], axis=1)
    low, high = np.minimum(first, last), np.maximum(first, last)
    bounded = np.minimum(np.maximum(sides, low[:, None]), high[:, None])
    along = (bounded - first[:, None]) / span[:, None]
    return incident_start[:, None] + (incident_end - incident_start)[:, None] * along[..., None]


def _single(normal: Array, point: Array, depth: Array, margin: float) -> Manifold:
    """Return manifolds of one point each; the second point stays empty."""
    count = len(depth)
    valid = np.zeros((count, 2), dtype=bool)
    valid[:, 0] = depth >= -margin
    return Manifold(
        normal=normal,
        points=np.repeat(point[:, None], 2, axis=1),
        depth=np.stack([depth, np.full(count, -1.0)], axis=1),
        valid=valid,
        feature=np.broadcast_to(np.arange(1, 3), (count, 2)),
    )


def _centre(circle: Circle, pose: Array) -> Array:
    return rotate(circle.centroid, np.cos(pose[:, 2]), np.sin(pose[:, 2])) + pose[:, :2]


def _place(polygon: Polygon, pose: Array) -> PlacedPolygons:
    cos, sin = np.cos(pose[:, 2, None]), np.sin(pose[:, 2, None])
    start = rotate(polygon.vertices[None], cos, sin) + pose[:, None, :2]
    return PlacedPolygons(start, np.roll(start, -1, axis=1), rotate(polygon.normals[None], cos, sin))
