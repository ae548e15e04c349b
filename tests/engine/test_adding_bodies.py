"""Bodies that are added, and parameters that are replaced: what is remembered of others stays."""

from dataclasses import replace

import numpy as np
import pytest

from engine import Circle, Polygon, World
from tests.engine.test_batch import STATE
from tests.support.worlds import advance

BOX = Polygon.box(1.0, 1.0)


def tower(height=10, **settings):
    world = World(gravity=(0.0, -9.81), **settings)
    world.add(Polygon.box(60.0, 1.0), (0.0, -0.5), static=True)
    for row in range(height):
        world.add(BOX, (0.0, 0.5 + row), friction=0.5)
    return world


@pytest.mark.parametrize("shape", [BOX, Circle(0.5), [BOX, Circle(0.3, (0.0, 1.0))], Polygon([(0, 0), (1, 0), (0, 1)])])
def test_a_tower_stands_while_a_body_is_added_in_each_step(shape):
    world, plain = tower(sleeping=False), tower(sleeping=False)
    advance(world, 60)
    advance(plain, 60)
    for number in range(60):
        world.add(shape, (20.0 + 3.0 * number, 1.0), static=number % 2 == 0)
        world.step()
        plain.step()
    for name in STATE:
        assert np.array_equal(getattr(world.state, name)[:, :11], getattr(plain.state, name)), name


@pytest.mark.parametrize("name", ["inverse_mass", "linear_drag", "quadratic_drag", "restitution", "friction", "group"])
def test_a_table_set_to_what_it_is_changes_nothing(name):
    world, plain = advance(tower(), 60), advance(tower(), 60)
    for _ in range(30):
        world.params = replace(world.params, **{name: getattr(world.params, name).copy()})
        world.step()
        plain.step()
    assert np.array_equal(world.state.pose, plain.state.pose)
    assert np.array_equal(world.asleep, plain.asleep)


def test_the_same_pairs_may_meet_however_bodies_came_in():
    shapes = [[BOX, Circle(0.3)], Circle(0.5), Polygon.box(2, 1), [Circle(0.2), Circle(0.2, (1, 0)), BOX], BOX]
    at_once, one_by_one = World(), World()
    for number, shape in enumerate(shapes):
        for world in (at_once, one_by_one):
            world.add(shape, (9.0 * number, 0.0), static=number == 2, group=number % 3 * (number > 2))
        one_by_one.step()
    assert sorted(map(sorted, at_once.pairs.tolist())) == sorted(map(sorted, one_by_one.pairs.tolist()))
    circles = one_by_one.shape_table.is_circle[one_by_one.pairs]
    assert not (circles[:, 0] & ~circles[:, 1]).any(), "of a polygon and a circle, the polygon comes first"


def test_another_group_holds_from_the_next_step_on():
    world = advance(tower(2), 120)
    group = world.params.group.copy()
    group[:2] = 1  # floor and lowest box
    world.params = replace(world.params, group=group)
    advance(world, 60)
    assert world.bodies[1].position[0, 1] < -2.0


def test_what_is_refused_sets_nothing():
    world = tower(1)
    floor, box = world.bodies
    before = [table.copy() for table in (world.state.pose, world.state.velocity)]
    for given in (
        {"position": (1.0, 2.0), "velocity": (1.0, 2.0, 3.0)},
        {"position": (1.0, 2.0), "angle": (1.0, 2.0)},
        {"angle": 1.0, "angular_velocity": np.nan},
        {"position": (1.0, 2.0), "velocity": "fast"},
        {"position": (1.0, 2.0), "velocity": (1.0, 2.0), "mask": np.ones(3, dtype=bool)},
    ):
        for body in (floor, box):
            with pytest.raises((ValueError, IndexError)):
                body.set(**given)
    assert np.array_equal(world.state.pose, before[0])
    assert np.array_equal(world.state.velocity, before[1])
    advance(world, 60)
    assert box.position[0, 1] == pytest.approx(0.5, abs=0.01)


@pytest.mark.parametrize("away", [0.0, 1e3, 1e6])
def test_far_from_its_origin_a_shape_has_the_same_area_centroid_and_inertia(away):
    corners = np.array([(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (0.5, 1.5)])
    near = Polygon(corners)
    for offset in ((away, 0.0), (-away, away), (0.3 * away, -away)):
        for shape in (Polygon(corners + offset), Polygon(corners[::-1] + offset), near.moved(np.array(offset))):
            assert shape.area == pytest.approx(near.area, rel=1e-8)
            assert shape.second_moment == pytest.approx(near.second_moment, rel=1e-8)
            assert shape.centroid - offset == pytest.approx(near.centroid, abs=1e-9 * max(away, 1.0))
            assert World().add(shape, (0.0, 0.0)).inertia == pytest.approx(near.second_moment / near.area, rel=1e-8)
    both = [Polygon(corners + away), Circle(0.5, (away + 2.0, away))]
    alone = [near, Circle(0.5, (2.0, 0.0))]
    inertia = [World().add(shapes, (0.0, 0.0)).inertia for shapes in (both, alone)]
    assert inertia[0] == pytest.approx(inertia[1], rel=1e-7)
