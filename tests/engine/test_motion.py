"""Motion without contact, against closed forms."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine import DT, Circle, Polygon, World
from tests.support.worlds import advance

G = 1.62


def test_free_fall_is_semi_implicit_euler_exactly_and_the_parabola_nearly():
    world = World(gravity=(0.0, -G))
    body = world.add(Circle(0.5), (3.0, 100.0))
    advance(world, 300)
    time = 300 * DT
    assert body.velocity[0, 1] == pytest.approx(-G * time, rel=1e-12)
    assert body.position[0, 1] == pytest.approx(100 - G * DT**2 * 300 * 301 / 2, rel=1e-12)
    assert body.position[0, 1] == pytest.approx(100 - G * time**2 / 2, abs=G * time * DT / 2 + 1e-9)
    assert body.position[0, 0] == 3.0


def test_gravity_may_differ_between_worlds_and_change():
    world = World(batch=3)
    body = world.add(Circle(1.0), (0, 0))
    world.gravity = np.array([[0.0, -1.0], [0.0, -2.0], [3.0, 0.0]])
    advance(world, 60)
    assert body.velocity == pytest.approx(world.gravity)
    world.gravity = (0.0, -1.0)
    advance(world, 60)
    assert body.velocity == pytest.approx(np.array([[0.0, -2.0], [0.0, -3.0], [3.0, -1.0]]))


def test_terminal_speeds_of_a_fall_and_of_a_spin():
    for linear, quadratic in ((0.8, 0.3), (0.0, 0.3), (500.0, 0.0)):
        world = World(gravity=(0.0, -9.81))
        drag = {"linear_drag": linear, "quadratic_drag": quadratic}
        falling = world.add(Circle(0.5), (0, 0), mass=2.0, **drag)
        drag = {"angular_drag": linear, "angular_quadratic_drag": quadratic, "linear_drag": 9.0}
        spinning = world.add(Circle(0.5), (9, 0), mass=2.0, **drag)
        falling.angular_velocity = 1.0
        for _ in range(1200):
            spinning.apply_torque(1.5)
            world.step()
        assert falling.angular_velocity[0] == 1.0
        speed, spin = -falling.velocity[0, 1], spinning.angular_velocity[0]
        assert linear * speed + quadratic * speed**2 == pytest.approx(2.0 * 9.81, rel=1e-7), (linear, quadratic)
        assert linear * spin + quadratic * spin**2 == pytest.approx(1.5, rel=1e-7), (linear, quadratic)


def test_drag_slows_a_motion_along_it():
    for drag, speed, tolerance in (
        ({"linear_drag": 0.5}, 10 * np.exp(-0.25 * 4.0), 3e-3),
        ({"quadratic_drag": 0.4}, 10 / (1 + 10 * 0.2 * 4.0), 2e-2),
    ):
        world = World(gravity=(0.0, 0.0))
        body = world.add(Circle(0.5), (0, 0), mass=2.0, **drag)
        body.velocity = (6.0, 8.0)
        advance(world, 240)
        assert np.hypot(*body.velocity[0]) == pytest.approx(speed, rel=tolerance)
        assert body.velocity[0, 0] / body.velocity[0, 1] == pytest.approx(0.75)


@given(st.floats(0, 1e6), st.floats(0, 1e6), st.floats(-100, 100))
@settings(max_examples=30, deadline=None)
def test_no_drag_can_turn_a_motion_round(linear, quadratic, speed):
    world = World(gravity=(0.0, 0.0))
    body = world.add(Circle(0.5), (0, 0), linear_drag=linear, quadratic_drag=quadratic, angular_drag=linear)
    body.set(velocity=(speed, 0.0), angular_velocity=speed)
    advance(world, 3)
    assert 0 <= body.velocity[0, 0] * np.sign(speed) <= abs(speed)
    assert 0 <= body.angular_velocity[0] * np.sign(speed) <= abs(speed)


def test_a_spin_without_torque_keeps_its_speed_and_forces_do_not_move_a_static_body():
    world = World(gravity=(0.0, -G))
    body = world.add(Polygon([(0, 0), (2, 0), (0.3, 0.7)]), (0, 0))
    fixed = world.add(Polygon.box(1, 1), (9, 0), static=True)
    body.angular_velocity = 2.5
    fixed.apply_force((100.0, 0.0), (3.0, 4.0))
    advance(world, 300)
    assert body.angular_velocity[0] == 2.5
    assert body.angle[0] == pytest.approx(2.5 * 5.0)
    assert body.position[0, 0] == 0.0
    assert fixed.position.tolist() == [[9.0, 0.0]]
    assert not fixed.velocity.any()
    assert fixed.mass == fixed.inertia == np.inf


def test_forces_add_up_last_for_one_step_and_turn_off_the_centre():
    world = World(gravity=(0.0, 0.0), batch=2)
    body = world.add(Polygon.box(2.0, 1.0), (5.0, 1.0), mass=3.0)
    for _ in range(30):
        body.apply_force((0.0, 6.0), point=body.position + np.array([0.5, 0.0]))
        world.step()
    assert body.velocity == pytest.approx(np.array([[0.0, 1.0]] * 2))
    assert body.angular_velocity == pytest.approx(0.5 * 6.0 * 0.5 / (3.0 * (4 + 1) / 12))
    body.set(velocity=(0.0, 0.0), angular_velocity=0.0)
    body.apply_force((1.0, 0.0))
    body.apply_force([[1.0, 0.0], [5.0, 0.0]])
    body.apply_torque([1.0, -1.0])
    advance(world, 2)
    assert body.velocity[:, 0] == pytest.approx(np.array([2.0, 6.0]) / 3.0 * DT)
    assert body.angular_velocity == pytest.approx(np.array([1.0, -1.0]) / body.inertia * DT)
