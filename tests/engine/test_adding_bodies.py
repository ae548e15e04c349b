"""Bodies that are added, and parameters that are replaced: what is remembered of others stays."""

import time
from dataclasses import replace

import numpy as np
import pytest

from engine import Circle, Polygon, World, collide
from tests.engine.test_batch import STATE
from tests.support.worlds import advance

BOX = Polygon.box(1.0, 1.0)


def tower(height=10, **settings):
    world = World(gravity=(0.0, -9.81), **settings)
    world.add(Polygon.box(60.0, 1.0), (0.0, -0.5), static=True)
    for row in range(height):
        world.add(BOX, (0.0, 0.5 + row), friction=0.5)
    return world


@pytest.mark.parametrize("sleeping", [True, False])
@pytest.mark.parametrize("shape", [BOX, Circle(0.5), [BOX, Circle(0.3, (0.0, 1.0))], Polygon([(0, 0), (1, 0), (0, 1)])])
def test_a_tower_stands_while_a_body_is_added_in_each_step(sleeping, shape):
    world, plain = tower(sleeping=sleeping), tower(sleeping=sleeping)
    advance(world, 60)
    advance(plain, 60)
    for number in range(60):
        world.add(shape, (20.0 + 3.0 * number, 1.0), static=number % 2 == 0)
        world.step()
        plain.step()
    for name in STATE:
        assert np.array_equal(getattr(world.state, name)[:, :11], getattr(plain.state, name)), name
    assert world.asleep[:, 1:11].all() == sleeping


def test_contacts_name_their_pairs_of_shapes_after_a_body_is_added():
    world = advance(tower(2), 10)
    before = world.contacts.shape.tolist()
    for shape in (BOX, Circle(0.5)):
        world.add(shape, (8.0, 3.0))
        assert world.contacts.shape.tolist() == before == [[1, 0], [1, 2]] or before == [[1, 0], [2, 1]]
        assert world.shape_table.body[world.contacts.shape].tolist() == world.contacts.body.tolist()
    advance(world, 60)
    assert world.shape_table.body[world.contacts.shape].tolist() == world.contacts.body.tolist()


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


@pytest.mark.parametrize("name", ["inverse_mass", "linear_drag", "quadratic_drag", "restitution", "friction", "group"])
def test_a_table_set_to_what_it_is_changes_nothing(name):
    world, plain = advance(tower(), 60), advance(tower(), 60)
    for _ in range(30):
        world.params = replace(world.params, **{name: getattr(world.params, name).copy()})
        world.step()
        plain.step()
    assert np.array_equal(world.state.pose, plain.state.pose)
    assert np.array_equal(world.asleep, plain.asleep)


def test_what_a_changed_parameter_is_not_of_goes_on():
    world = tower()
    aside = world.add(BOX, (5.0, 0.5))
    plain = tower()
    plain.add(BOX, (5.0, 0.5))
    for each in (world, plain):
        advance(each, 120)
    for number in range(60):
        drag = world.params.linear_drag.copy()
        drag[aside.index] = 0.01 * number
        world.params = replace(world.params, linear_drag=drag)
        world.step()
        plain.step()
        assert world.asleep[0, 1:11].all()
    assert not world.asleep[0, aside.index]
    assert np.array_equal(world.state.pose, plain.state.pose)
    with pytest.raises(ValueError, match="friction must be"):
        world.params = replace(world.params, friction=-np.ones(12))
    assert world.asleep[0, 1:11].all()


def test_another_group_holds_from_the_next_step_on():
    world = advance(tower(2), 120)
    group = world.params.group.copy()
    group[:2] = 1  # floor and lowest box
    world.params = replace(world.params, group=group)
    advance(world, 60)
    assert world.bodies[1].position[0, 1] < -2.0


def test_one_more_among_four_hundred_costs_about_as_much_as_among_ten():
    def spent(count):
        times = []
        world = World()
        for number in range(count):
            world.add(BOX, (3.0 * number, 0.0))
        world.step()
        for number in range(25):
            start = time.process_time()
            world.add(BOX, (3.0 * number, 50.0))
            world.shape_table  # noqa: B018 - makes what the next step needs
            times.append(time.process_time() - start)
        return float(np.median(times))

    assert spent(400) < 12 * spent(10), "made anew, all pairs of four hundred took 150 times as long"


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


@pytest.mark.slow
def test_each_face_of_a_polygon_of_many_corners_has_a_number_of_its_own():
    for corners in (64, 65, 80, 300):
        turn = np.arange(corners) * 2 * np.pi / corners
        gon = Polygon(np.stack([np.cos(turn), np.sin(turn)], axis=1))
        poses = [np.array([0.0, 1.49, -each]) for each in turn + np.pi / corners]
        names = [tuple(collide(Polygon.box(9.0, 1.0), np.zeros(3), gon, pose).feature[0].tolist()) for pose in poses]
        turned = [tuple(collide(gon, pose, Polygon.box(9.0, 1.0), np.zeros(3)).feature[0].tolist()) for pose in poses]
        assert len(set(names)) == len(set(turned)) == corners


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
