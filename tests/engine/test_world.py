"""What a world promises besides physics: handles, masks, groups, refusals."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from engine import Circle, Polygon, World
from tests.support.worlds import advance

BOX = Polygon.box(1.0, 1.0)


def floor(batch=1, **settings):
    world = World(gravity=(0.0, -9.81), batch=batch)
    world.add(Polygon.box(20.0, 1.0), (0.0, -0.5), static=True, **settings)
    return world


def test_an_empty_world_one_of_static_bodies_and_a_single_body():
    world, fixed = World(), floor()
    fixed.add(BOX, (0, 0), static=True)
    for each in (world, fixed):
        advance(each, 3)
        assert each.contacts is None
    body = world.add([BOX, Polygon.box(1.0, 1.0, (0.3, 0.0)), Circle(0.5)], (0, 5))
    advance(world, 60)
    assert world.contacts is None, "shapes of one body do not meet"
    assert body.velocity[0, 1] == pytest.approx(-1.62)


def test_setters_reach_the_worlds_of_a_mask():
    world = floor(batch=3)
    body = world.add(BOX, (0, 2))
    body.set(position=(1.0, 5.0), angle=0.5, mask=np.array([True, False, False]))
    body.set(velocity=[[1.0, 1.0], [2.0, 2.0]], angular_velocity=[3.0, 4.0], mask=np.array([False, True, True]))
    assert body.position.tolist() == [[1.0, 5.0], [0.0, 2.0], [0.0, 2.0]]
    assert body.angle.tolist() == [0.5, 0.0, 0.0]
    assert body.velocity.tolist() == [[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]]
    assert body.angular_velocity.tolist() == [0.0, 3.0, 4.0]
    assert world.state.cos[:, body.index] == pytest.approx(np.cos([0.5, 0.0, 0.0]))


def test_a_static_body_moved_by_hand_is_met_where_it_is():
    world = World(gravity=(0.0, -9.81), batch=2)
    plate = world.add(Polygon.box(4.0, 1.0), (0.0, -0.5), static=True)
    box = world.add(BOX, (0.0, 0.5))
    advance(world, 10)
    plate.set(position=(0.0, -3.5), angle=0.0, mask=np.array([False, True]))
    advance(world, 120)
    assert box.position[:, 1] == pytest.approx([0.5, -2.5], abs=0.01)


def test_bodies_of_one_group_pass_through_each_other():
    for groups, meet in (((0, 0), True), ((1, 1), False), ((1, 2), True), ((0, 1), True)):
        world = World(gravity=(0.0, 0.0))
        left, right = (world.add(Circle(0.5), (x, 0), group=group) for x, group in zip((-2, 2), groups, strict=True))
        left.velocity, right.velocity = (4.0, 0.0), (-4.0, 0.0)
        advance(world, 60)
        assert (left.position[0, 0] > right.position[0, 0]) == (not meet), groups


def test_an_inactive_body_neither_moves_nor_touches():
    world = floor(batch=2)
    under = world.add(BOX, (0, 0.5))
    over = world.add(BOX, (0, 1.5))
    over.set(velocity=(1.0, 0.0))
    over.active = [True, False]
    under.active = [False, True]
    advance(world, 120)
    assert over.active.tolist() == [True, False]
    assert over.position[1].tolist() == [0.0, 1.5]
    assert over.velocity[1].tolist() == [1.0, 0.0]
    assert over.position[0, 1] == pytest.approx(0.5, abs=0.01)
    assert under.position[0].tolist() == [0.0, 0.5]
    assert under.position[1] == pytest.approx([0.0, 0.5], abs=0.01)


def test_a_world_gone_to_nan_harms_no_other():
    def toys(batch):
        world = floor(batch)
        world.add(BOX, (0, 0.6))
        world.add(Circle(0.5), (0.2, 1.8))
        return world

    three, one = toys(3), toys(1)
    three.state.pose[0, 1, 0] = three.state.velocity[2, 2, 0] = np.nan
    advance(three, 90)
    advance(one, 90)
    assert three.state.pose[1].tobytes() == one.state.pose[0].tobytes()
    assert np.isnan(three.state.pose[[0, 2]]).any(axis=(1, 2)).all()


def test_what_makes_no_sense_is_refused(subtests):
    settings: Any
    for settings, reason in [
        ({"mass": 0.0}, "positive and finite"),
        ({"mass": np.nan}, "positive and finite"),
        ({"mass": -1.0}, "positive and finite"),
        ({"inertia": 0.0}, "inertia"),
        ({"linear_drag": -1.0}, "linear_drag"),
        ({"angular_quadratic_drag": np.nan}, "quadratic_drag"),
        ({"friction": -0.1}, "friction"),
        ({"restitution": 1.5}, "restitution"),
        ({"position": (0.0, np.nan)}, "position"),
        ({"friction": np.nan}, "friction"),
        ({"mass": 1e-320}, "inverse_mass"),
    ]:
        with subtests.test(settings=settings, reason=reason):
            world = World()
            with pytest.raises(ValueError, match=reason):
                world.add(BOX, **{"position": (0, 0), **settings})
            assert world.bodies == []
            assert world.state.pose.shape == (1, 0, 3)


def test_no_setter_takes_what_makes_no_sense():
    world = World(batch=2)
    body = world.add(BOX, (0, 0), linear_drag=1.0)
    advance(world, 1)
    before = {name: value.copy() for name, value in vars(world.state).items()}
    nan, some, params = np.nan, np.array([False, True]), world.params
    cases = {
        "position": lambda: setattr(body, "position", (0.0, nan)),
        "angle": lambda: setattr(body, "angle", [0.0, np.inf]),
        "velocity": lambda: body.set(position=(1.0, 1.0), velocity=(nan, 0.0), mask=some),
        "force": lambda: body.apply_force((nan, 0.0)),
        "point": lambda: body.apply_force((1.0, 0.0), (nan, 0.0)),
        "torque": lambda: body.apply_torque(-np.inf),
        "gravity must be finite": lambda: setattr(world, "gravity", (0.0, nan)),
        "gravity must be of shape": lambda: setattr(world, "gravity", np.zeros((3, 2))),
        "iterations": lambda: World(iterations=0),
        "at least one shape": lambda: World().add([], (0, 0)),
        "batch": lambda: World(batch=0),
        "inverse_mass": lambda: replace(params, inverse_mass=np.array([[nan, nan, 1.0]])),
        "linear_drag": lambda: replace(params, linear_drag=np.array([[-1.0, 0.0, 0.0]])),
        "quadratic_drag must be of shape": lambda: replace(params, quadratic_drag=np.zeros((2, 2, 3))),
        "restitution": lambda: replace(params, restitution=np.array([1.5])),
        "of 1 bodies in 2 worlds": lambda: setattr(
            world, "params", replace(params, quadratic_drag=np.zeros((3, 1, 3)))
        ),
        "read-only": lambda: params.friction.fill(nan),
    }
    for reason, change in cases.items():
        with pytest.raises(ValueError, match=reason):
            change()
    for name in ("position", "angle", "velocity", "angular_velocity", "active"):
        with pytest.raises(ValueError, match="read-only"):
            getattr(body, name)[0] = 0.0
    for name, value in before.items():
        assert np.array_equal(value, getattr(world.state, name)), name


def test_a_parameter_replaced_between_steps_holds_from_the_next_one():
    world = World(gravity=(0.0, 0.0))
    slow, other = world.add(Circle(0.5), (0, 0)), world.add(Circle(0.5), (9, 0))
    slow.velocity = other.velocity = (4.0, 0.0)
    advance(world, 1)
    drag = np.array([[1e9, 1e9, 0.0], [0.0, 0.0, 0.0]])
    world.params = replace(world.params, quadratic_drag=drag)
    advance(world, 1)
    assert slow.velocity[0, 0] == pytest.approx(0.0, abs=1e-3)
    assert other.velocity[0, 0] == 4.0
    pair = World(gravity=(0.0, 0.0), batch=2)
    for x in (0.0, 4.0, 8.0):
        pair.add(BOX, (x, 0.0), static=x == 4.0).velocity = (0.0, 2.0) if x != 4.0 else (0.0, 0.0)
    pair.params = replace(pair.params, quadratic_drag=np.zeros((2, 3, 3)))
    advance(pair, 1)
    pair.params.quadratic_drag[1, 2] = 1e9  # an air of each world's own may be written into
    advance(pair, 1)
    assert pair.state.velocity[:, [0, 2], 1] == pytest.approx(np.array([[2.0, 2.0], [2.0, 0.0]]), abs=1e-3)
