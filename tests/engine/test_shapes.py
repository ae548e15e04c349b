"""Area, centroid and inertia against closed forms; what is not a shape is refused."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine import Circle, Polygon, World
from engine.shapes import mass_properties

finite = st.floats(-20, 20)


@given(st.floats(0.1, 10), st.floats(0.1, 10), finite, finite, st.floats(-7, 7))
def test_box(width, height, x, y, angle):
    box = Polygon.box(width, height, (x, y), angle)
    assert box.area == pytest.approx(width * height, rel=1e-6)
    assert box.centroid == pytest.approx(np.array([x, y]), abs=1e-6)
    assert box.second_moment == pytest.approx(width * height * (width**2 + height**2) / 12, rel=1e-4)
    assert box.bounding_radius == pytest.approx(np.hypot(width, height) / 2)


def test_regular_polygon():
    for corners in (3, 4, 5, 8, 40):
        angle, turn = np.arange(corners) * 2 * np.pi / corners, 2 * np.pi / corners
        shape = Polygon(2.0 * np.stack([np.cos(angle), np.sin(angle)], axis=1))
        area = corners * 4 * np.sin(turn) / 2
        assert shape.area == pytest.approx(area)
        assert shape.centroid == pytest.approx(np.zeros(2), abs=1e-12)
        assert shape.second_moment == pytest.approx(area * 4 * (2 + np.cos(turn)) / 6)


def test_circle():
    shape = Circle(2.0, (1.0, -1.0))
    assert shape.area == pytest.approx(4 * np.pi)
    assert shape.centroid.tolist() == [1.0, -1.0]
    assert shape.second_moment == pytest.approx(8 * np.pi)
    assert shape.moved(np.array([1.0, 2.0])) == Circle(2.0, (2.0, 1.0))


def test_either_winding_gives_the_same_polygon():
    corners = [(0, 0), (2, 0), (2, 1), (0.5, 1.5)]
    forth, back = Polygon(corners), Polygon(corners[::-1])
    assert forth.area == back.area > 0
    for shape in (forth, back):
        middles = (shape.vertices + np.roll(shape.vertices, -1, axis=0)) / 2
        outwards = ((middles - shape.centroid) * shape.normals).sum(axis=1)
        assert (outwards > 0).all()
        assert np.linalg.norm(shape.normals, axis=1) == pytest.approx(1.0)


def test_what_is_no_convex_polygon_or_circle_is_refused():
    for corners, reason in [
        ([(0, 0), (1, 0)], "three"),
        ([(0, 0), (1, 0), (2, np.nan)], "finite"),
        ([(0, 0, 0), (1, 0, 0), (0, 1, 0)], "corners"),
        ([(0, 0), (1, 0), (2, 0)], "in line"),
        ([(0, 0), (1, 0), (2, 0), (1, 1)], "in line"),
        ([(0, 0), (0, 0), (1, 0), (0, 1)], "distinct"),
        ([(0, 0), (2, 0), (0.5, 0.5), (0, 2)], "convex"),
        ([(np.cos(a), np.sin(a)) for a in np.arange(5) * 4 * np.pi / 5], "cross"),
    ]:
        with pytest.raises(ValueError, match=reason):
            Polygon(corners)
    for radius, centre in [(0, (0, 0)), (-1, (0, 0)), (np.inf, (0, 0)), (1, (np.nan, 0))]:
        with pytest.raises(ValueError, match="radius above 0"):
            Circle(radius, centre)


def test_a_body_of_several_shapes_by_the_parallel_axis_theorem():
    parts = [Polygon.box(2.0, 1.0), Circle(0.5, (3.0, 0.0))]
    areas = np.array([2.0, np.pi / 4])
    middle = areas[1] * 3.0 / areas.sum()
    moments = np.array([2.0 * 5 / 12, np.pi * 0.5**4 / 2])
    centre, spread = mass_properties(parts)
    assert centre == pytest.approx(np.array([middle, 0.0]))
    assert spread * areas.sum() == pytest.approx((moments + areas * (np.array([0.0, 3.0]) - middle) ** 2).sum())

    world = World()
    body = world.add(parts, (10.0, 0.0), mass=4.0)
    assert body.mass == pytest.approx(4.0)
    assert body.inertia == pytest.approx(4.0 * spread)
    assert world.shapes[0].centroid == pytest.approx(np.array([-middle, 0.0]))


def test_centre_of_mass_and_inertia_may_be_given():
    world = World()
    low = world.add(Polygon.box(1.0, 1.0), (0, 0), mass=2.0, centre_of_mass=(0.0, -0.3))
    assert low.inertia == pytest.approx(2.0 * (1 / 6 + 0.09))
    assert world.shapes[0].centroid == pytest.approx(np.array([0.0, 0.3]))
    assert world.add(Circle(1.0), (5, 0), mass=2.0, inertia=7.0).inertia == pytest.approx(7.0)
