"""Manifolds by hand, and against brute force."""

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine import Circle, Polygon, collide

BOX = Polygon.box(2.0, 2.0)
DISC = Circle(1.0)


def pose(x, y, angle=0.0):
    return np.array([x, y, angle])


def corners(shape, at):
    cos, sin = np.cos(at[2]), np.sin(at[2])
    return shape.vertices @ np.array([[cos, sin], [-sin, cos]]) + at[:2]


def signed_distance(shape, at, point):
    """How far `point` lies outside the shape, below 0 inside."""
    if isinstance(shape, Circle):
        return np.hypot(*(point - at[:2])) - shape.radius
    start = corners(shape, at)
    end = np.roll(start, -1, axis=0)
    edge = end - start
    normal = np.stack([edge[:, 1], -edge[:, 0]], axis=1) / np.hypot(*edge.T)[:, None]
    heights = ((point - start) * normal).sum(axis=1)
    if (heights <= 0).all():
        return heights.max()
    along = np.clip(((point - start) * edge).sum(axis=1) / (edge**2).sum(axis=1), 0, 1)
    return np.hypot(*(start + edge * along[:, None] - point).T).min()


def polygon_gap(a, at_a, b, at_b):
    """Distance of two polygons by brute force over corners and edge crossings; below 0 if they overlap."""
    one, two = corners(a, at_a), corners(b, at_b)
    inside = min(*(signed_distance(b, at_b, p) for p in one), *(signed_distance(a, at_a, p) for p in two))
    for (p, q), (r, s) in itertools.product(
        zip(one, np.roll(one, -1, axis=0), strict=True), zip(two, np.roll(two, -1, axis=0), strict=True)
    ):
        d, e = q - p, s - r
        turn = d[0] * e[1] - d[1] * e[0]
        if abs(turn) > 1e-12:
            t = ((r - p)[0] * e[1] - (r - p)[1] * e[0]) / turn
            u = ((r - p)[0] * d[1] - (r - p)[1] * d[0]) / turn
            if 0 < t < 1 and 0 < u < 1:
                return min(inside, -1e-15)
    return inside


def convex(seed):
    random = np.random.default_rng(seed)
    angle = np.sort(random.uniform(0, 2 * np.pi, random.integers(3, 8)))
    gaps = np.diff(np.append(angle, angle[0] + 2 * np.pi))
    if gaps.max() > 3.0 or gaps.min() < 0.1:
        return convex(seed + 10**7)
    return Polygon(np.stack([np.cos(angle), np.sin(angle)], axis=1) * random.uniform(0.5, 1.5, 2))


def test_boxes_have_two_points_or_one_on_a_corner():
    manifold = collide(BOX, pose(0, 0), BOX, pose(0.5, 1.9))
    assert manifold.normal[0] == pytest.approx(np.array([0.0, 1.0]))
    assert manifold.depth[0] == pytest.approx(np.array([0.1, 0.1]))
    assert manifold.valid[0].all()
    assert sorted(manifold.points[0].tolist()) == [pytest.approx([-0.5, 0.95]), pytest.approx([1.0, 0.95])]
    tilted = collide(BOX, pose(0, 0), BOX, pose(0, 1.9, 0.02))
    assert tilted.valid[0].all()
    assert np.ptp(tilted.depth[0]) == pytest.approx(2 * np.sin(0.02), rel=0.02)
    corner = collide(BOX, pose(0, 0), BOX, pose(0.2, 0.9 + np.sqrt(2), np.pi / 4))
    assert corner.valid[0].sum() == 1
    assert corner.points[0][corner.valid[0]][0] == pytest.approx(np.array([0.2, 0.95]))
    assert corner.depth[0][corner.valid[0]] == pytest.approx([0.1])


def test_discs_have_one_point_and_always_a_normal():
    for a, b, at, normal, depth, point in [
        (BOX, DISC, (0.3, 1.9), (0, 1), 0.1, (0.3, 0.95)),
        (BOX, DISC, (0.7, 0.1), (1, 0), 1.3, (0.35, 0.1)),  # its centre inside
        (BOX, DISC, (0.1, 1.0), (0, 1), 1.0, (0.1, 0.5)),  # its centre on the face
        (BOX, DISC, (1.6, 1.6), (0.5**0.5, 0.5**0.5), 1 - 0.6 * 2**0.5, None),  # past a corner
        (DISC, Circle(0.5), (0.0, 1.3), (0, 1), 0.2, (0.0, 0.9)),
        (DISC, DISC, (0.0, 0.0), (0, 1), 2.0, None),
    ]:
        manifold = collide(a, pose(0, 0), b, pose(*at))
        assert manifold.valid[0].tolist() == [True, False], at
        assert manifold.normal[0] == pytest.approx(np.array(normal, float)), at
        assert manifold.depth[0, 0] == pytest.approx(depth), at
        assert point is None or manifold.points[0, 0] == pytest.approx(np.array(point)), at
    for a in (BOX, DISC):
        assert not collide(a, pose(0, 0), DISC, pose(1.8, 1.8)).valid.any()


def test_the_margin_lets_a_gap_count():
    for a, b, gap in [(BOX, BOX, 2.01), (BOX, DISC, 2.01), (DISC, DISC, 2.01)]:
        assert not collide(a, pose(0, 0), b, pose(0, gap)).valid.any()
        near = collide(a, pose(0, 0), b, pose(0, gap), margin=0.02)
        assert near.valid[0, 0]
        assert near.depth[0, 0] == pytest.approx(-0.01)


@given(st.integers(0, 10**6), st.floats(-2.5, 2.5), st.floats(-2.5, 2.5), st.floats(-3, 3), st.floats(-3, 3))
@settings(max_examples=100, deadline=None)
def test_polygons_are_apart_if_and_only_if_brute_force_says_so(seed, x, y, turn_a, turn_b):
    a, b = convex(seed), convex(seed + 1)
    at_a, at_b = pose(0, 0, turn_a), pose(x, y, turn_b)
    gap = polygon_gap(a, at_a, b, at_b)
    there, back = collide(a, at_a, b, at_b), collide(b, at_b, a, at_a)
    if abs(gap) > 1e-9:
        assert there.valid.any() == back.valid.any() == (gap < 0)
    if there.valid.any():
        check_manifold(a, at_a, b, at_b, there)
        assert back.depth[back.valid].max() == pytest.approx(there.depth[there.valid].max(), abs=6e-4)


@given(st.integers(0, 10**6), st.floats(-2.5, 2.5), st.floats(-2.5, 2.5), st.floats(-3, 3), st.floats(0.1, 1))
@settings(max_examples=60, deadline=None)
def test_a_polygon_and_a_disc_are_apart_if_and_only_if_brute_force_says_so(seed, x, y, turn, radius):
    a, b = convex(seed), Circle(radius)
    at_a, at_b = pose(0, 0, turn), pose(x, y)
    gap = signed_distance(a, at_a, at_b[:2]) - radius
    there, back = collide(a, at_a, b, at_b), collide(b, at_b, a, at_a)
    if abs(gap) > 1e-9:
        assert there.valid.any() == (gap < 0)
    assert np.array_equal(there.normal, -back.normal)
    assert np.array_equal(there.depth, back.depth)
    assert np.array_equal(there.points, back.points)
    if there.valid.any():
        assert there.depth[0, 0] == pytest.approx(-gap, abs=1e-9)
        check_manifold(a, at_a, b, at_b, there)


def check_manifold(a, at_a, b, at_b, manifold):
    normal = manifold.normal[0]
    deepest = manifold.depth[0][manifold.valid[0]].max()
    assert np.hypot(*normal) == pytest.approx(1.0)
    for point in manifold.points[0][manifold.valid[0]]:
        assert signed_distance(a, at_a, point) <= 1e-6 + deepest / 2
        assert signed_distance(b, at_b, point) <= 1e-6 + deepest / 2
    # Moved apart along the normal by the depth they no longer overlap, and by less they still do: the least way out.
    apart = at_b + np.append(normal * (deepest + 1e-3), 0.0)
    still = at_b + np.append(normal * (deepest - 1e-3), 0.0)
    assert not collide(a, at_a, b, apart).valid.any()
    if deepest > 1e-3:
        assert collide(a, at_a, b, still).valid.any()
