"""Slopes, sliding, rolling, conveyor belts: Coulomb's law in closed form."""

import numpy as np
import pytest

from engine import Circle, Polygon, World
from tests.support.worlds import advance

G = 9.81


def slope(tilt, friction, shape=None, batch=1):
    """A box (or `shape`) resting on a long incline that falls to the left; and the unit vector downhill."""
    shape = shape or Polygon.box(1.0, 0.5)
    world = World(gravity=(0.0, -G), batch=batch)
    world.add(Polygon.box(200.0, 1.0), (0.0, 0.0), tilt, static=True, friction=friction)
    up = np.array([-np.sin(tilt), np.cos(tilt)])
    height = 0.5 + (shape.radius if isinstance(shape, Circle) else 0.25)
    body = world.add(shape, up * height, tilt, mass=3.0, friction=friction)
    return world, body, -np.array([np.cos(tilt), np.sin(tilt)])


def test_a_box_slides_if_and_only_if_tan_tilt_exceeds_mu():
    for friction, share in ((0.2, 0.95), (0.5, 0.6), (0.8, 0.95), (0.2, 1.4), (0.5, 1.05), (0.8, 1.05)):
        tilt = np.arctan(friction * share)
        world, body, downhill = slope(tilt, friction)
        advance(world, 60)
        early = body.velocity[0] @ downhill
        advance(world, 60)
        late = body.velocity[0] @ downhill
        if share < 1:
            assert max(abs(late), abs(body.angular_velocity[0])) < 1e-6, (friction, share)
        else:
            acceleration = G * (np.sin(tilt) - friction * np.cos(tilt))
            assert late - early == pytest.approx(acceleration, rel=1e-3), (friction, share)


def test_a_disc_rolls_down_at_two_thirds():
    tilt = 0.3
    world, body, downhill = slope(tilt, 0.8, Circle(0.5))
    advance(world, 60)
    early = body.velocity[0] @ downhill
    advance(world, 60)
    speed = body.velocity[0] @ downhill
    assert speed - early == pytest.approx(2 / 3 * G * np.sin(tilt), rel=1e-3)
    assert body.angular_velocity[0] * 0.5 == pytest.approx(speed, rel=1e-3)


def test_a_sliding_box_stops_after_v_squared_over_two_mu_g():
    world = World(gravity=(0.0, -G))
    world.add(Polygon.box(100.0, 1.0), (0.0, -0.5), static=True)
    body = world.add(Polygon.box(1.0, 0.5), (0.0, 0.25), friction=0.4)
    world.step()
    body.velocity = (5.0, 0.0)
    advance(world, 180)
    assert body.velocity[0] == pytest.approx(np.zeros(2), abs=1e-9)
    assert body.position[0, 0] == pytest.approx(25 / (2 * 0.4 * G), rel=0.03)


def test_friction_never_leaves_its_cone():
    world = World(gravity=(0.0, -G), batch=20)
    random = np.random.default_rng(2)
    world.add(Polygon.box(100.0, 1.0), (0.0, -0.5), static=True, friction=0.5)
    for i in range(4):
        world.add(Polygon.box(1.0, 0.6), (0.2 * i, 0.4 + 0.7 * i), friction=0.5)
    for body in world.bodies[1:]:
        body.set(velocity=random.uniform(-3, 3, (20, 2)), angular_velocity=random.uniform(-2, 2, 20))
    touched = 0
    for _ in range(200):
        world.step()
        if world.contacts:
            push, rub = world.contacts.impulse[:, :2], np.abs(world.contacts.impulse[:, 2])
            assert (push >= 0).all()
            assert not push[~world.contacts.valid].any()
            assert (rub <= world.contacts.friction * push.sum(axis=1) + 1e-12).all()
            touched += len(world.contacts)
    assert touched > 5000


def test_a_moving_static_body_carries_a_box_along():
    world = World(gravity=(0.0, -G), batch=2)
    lift = world.add(Polygon.box(6.0, 1.0), (0.0, -0.5), static=True, friction=0.8)
    box = world.add(Polygon.box(1.0, 1.0), (0.0, 0.5), mass=2.0)
    lift.velocity = [[1.0, 0.5], [0.0, 0.0]]
    advance(world, 120)
    assert lift.position == pytest.approx(np.array([[2.0, 0.5], [0.0, -0.5]]))
    assert box.velocity == pytest.approx(np.array([[1.0, 0.5], [0.0, 0.0]]), abs=1e-6)
    assert box.position[0] == pytest.approx(np.array([2.0, 1.5]), abs=0.15)
    lift.velocity = (0.0, 0.0)
    advance(world, 60)
    assert box.velocity == pytest.approx(np.zeros((2, 2)), abs=1e-6)


def test_two_frictions_make_their_geometric_mean_and_of_two_restitutions_the_larger_holds():
    for pair, friction, bounce in [
        ((0.2, 0.8), 0.4, 0.8),
        ((0.3, None), 0.3, 0.3),
        ((None, 0.3), 0.3, 0.3),
        ((None, None), 0.5, 0.0),
        ((0, 1), 0, 1),
    ]:
        world = World(gravity=(0.0, -G))
        world.add(Polygon.box(100.0, 1.0), (0.0, -0.5), static=True, friction=pair[0], restitution=pair[0])
        world.add(Polygon.box(1.0, 0.5), (0.0, 0.25), friction=pair[1], restitution=pair[1])
        world.step()
        assert world.contacts.friction == pytest.approx([friction]), pair
        assert world.contacts.restitution == pytest.approx([bounce]), pair
