"""Separating Axis Theorem: pure functions from pairs of shapes and their poses to contact manifolds.

Two convex shapes are apart if and only if some axis parts their shadows, and for polygons it is enough to try the
normals of their faces (edges). Of all axes, the one with the least overlap gives the contact normal. The face it
belongs to is the reference; the other shape's most opposed face, the incident one, clipped to the sides of the
reference, gives up to two contact points.

           B   incident
           q1 ________ q0            normal: from A to B
     _______|________|_______        depth: how far a point lies below the reference face
            x        x   reference   point x: half-way between the two surfaces
           A
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from engine.shapes import Circle, PlacedPolygons, Polygon, Shape, ShapeTable
from engine.state import BodyState
from engine.vector import Array, Bools, Ints, dot, length

# Two parallel faces are equally good references; a small bias keeps the choice from flickering; metres.
REFERENCE_BIAS = 5e-4
MOST_FACES = 1 << 20  # of a polygon, in the number that names two faces


@dataclass
class Manifold:
    """Contacts of n pairs of shapes. A pair has none, one or two points."""

    normal: Array  # (n, 2) unit vector from A to B
    points: Array  # (n, 2, 2) world positions of up to two points
    depth: Array  # (n, 2) metres of overlap, positive where the shapes touch
    valid: Bools  # (n, 2) which points are there
    feature: Ints  # (n, 2) the faces that made each point: the same number, the same contact as a step before


def collide(a: Shape, pose_a: Array, b: Shape, pose_b: Array, margin: float = 0.0) -> Manifold:
    """Contacts of shape `a` with shape `b`; poses are (x, y, angle), (3,) or (n, 3).

    Points that are up to `margin` metres apart count as touching, with a depth below 0.
    """
    if isinstance(a, Circle) and isinstance(b, Polygon):
        turned = collide(b, pose_b, a, pose_a, margin)
        turned.normal *= -1
        return turned
    poses = np.broadcast_arrays(*(np.atleast_2d(np.asarray(pose, dtype=float)) for pose in (pose_a, pose_b)))
    state = BodyState.at_rest(np.stack(poses, axis=1))
    table, world = ShapeTable([a, b], [0, 1], np.ones(2, dtype=bool)), np.arange(len(state.pose))
    return collide_pairs(table, state, world, np.tile([0, 1], (len(world), 1)), margin)


def collide_pairs(shapes: ShapeTable, state: BodyState, world: Ints, pair: Ints, margin: float) -> Manifold:
    """Contacts of pairs of shapes, `pair` (n, 2), in their worlds (n,), whatever kinds of shape they are.

    Of a polygon and a circle, the polygon has to come first.
    """
    circles = shapes.is_circle[pair].sum(axis=1)
    kinds, parts = [np.flatnonzero(circles == kind) for kind in (0, 1, 2)], []
    for kind, rows in enumerate(kinds):
        if not len(rows):
            continue
        here, (a, b) = world[rows], pair[rows].T
        if kind == 0:
            placed = shapes.placed(state, np.concatenate([here, here]), np.concatenate([a, b]))
            parts.append(collide_polygons(placed, margin))
            continue
        centre, radius = shapes.centres(state, here, b), shapes.radius[b]
        if kind == 1:
            parts.append(collide_polygon_circle(shapes.placed(state, here, a), centre, radius, margin))
        else:
            parts.append(collide_circles(shapes.centres(state, here, a), shapes.radius[a], centre, radius, margin))
    if len(parts) == 1:
        return parts[0]
    order = np.argsort(np.concatenate(kinds))
    tables = zip(*(vars(part).values() for part in parts), strict=True)
    return Manifold(*(np.concatenate(table)[order] for table in tables))


def collide_polygons(ab: PlacedPolygons, margin: float) -> Manifold:
    """Contacts of n pairs of convex polygons; `ab` has the n polygons A, and after them the n polygons B.

    Faces of A are tried against corners of B, and faces of B against corners of A, in one go.
    """
    count = len(ab.start) // 2
    rows = np.arange(count)
    gap, face = deepest_face(ab, np.concatenate([ab.start[count:], ab.start[:count]]))
    gap_a, gap_b = gap[:count], gap[count:]
    flip = gap_b > gap_a + REFERENCE_BIAS  # B holds the reference face
    reference, incident = np.where(flip, rows + count, rows), np.where(flip, rows, rows + count)
    reference_face = face[reference]
    start, end, out = (table[reference, reference_face] for table in ab)
    incident_face = dot(ab.normal[incident], out[:, None]).argmin(axis=1)  # the most opposed
    corners = _clip(start, end, ab.start[incident, incident_face], ab.end[incident, incident_face])
    depth = -dot(corners - start[:, None], out[:, None])
    normal = np.where(flip[:, None], -out, out)
    number = (flip * MOST_FACES + reference_face) * MOST_FACES + incident_face
    return Manifold(
        normal=normal,
        points=corners + out[:, None] * (depth / 2)[..., None],
        depth=depth,
        valid=(np.maximum(gap_a, gap_b) <= margin)[:, None] & (depth >= -margin),
        feature=number[:, None] * 2 + np.arange(1, 3),
    )


def collide_polygon_circle(a: PlacedPolygons, centre: Array, radius: Array, margin: float) -> Manifold:
    """Contacts of n convex polygons with n circles, `centre` (n, 2) and `radius` (n,).

    A centre that lies inside the polygon, or on its surface, is pushed out along the normal of the nearest face.
    """
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
    """Gap along the best separating axis, (n,) metres, below 0 for an overlap; and the face whose normal that is, (n,).

    A face's gap is its distance to the deepest of the `corners` (n, corners, 2) of the other polygon.
    """
    x, y = np.moveaxis(corners[:, :, None], (3, 1), (0, 1))  # each (corners, n, 1)
    # Corners first, in memory too: a minimum along the last axis would be several times slower.
    along = np.multiply(x, a.normal[..., 0], order="C")
    along += np.multiply(y, a.normal[..., 1], order="C")
    gaps = along.min(axis=0) - dot(a.normal, a.start)
    face = gaps.argmax(axis=1)
    return gaps[np.arange(len(face)), face], face


def _clip(start: Array, end: Array, incident_start: Array, incident_end: Array) -> Array:
    """Both ends, (n, 2, 2), of the part of the incident edge that lies beside the reference edge.

    All is measured along the reference edge; ● are the ends of the part:

        incident     first ─────●━━━━━━━━━━●──── last
        reference               0 ──────── width
    """
    edge = end - start
    tangent = edge / length(edge)[:, None]
    first, last, width = dot(incident_start - start, tangent), dot(incident_end - start, tangent), dot(edge, tangent)
    ends = np.stack([np.zeros_like(width), width], axis=1)
    ends = np.minimum(np.maximum(ends, np.minimum(first, last)[:, None]), np.maximum(first, last)[:, None])
    whole = last - first
    whole = np.where(np.abs(whole) < 1e-12, 1e-12, whole)
    share = (ends - first[:, None]) / whole[:, None]  # of the incident edge, from its start
    return incident_start[:, None] + (incident_end - incident_start)[:, None] * share[..., None]


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
