"""Free flight in plain floats: the same steps as a world's own, as long as nothing is near."""

import numpy as np
import pytest

from engine import DT, Circle, FreeFlight, Polygon, World


def falling(rng, top=0.0, **settings):
    """A world with a block that falls, turning, towards a floor and a slope that leans, and what it falls with."""
    world = World((0.1, -3.0), **settings)
    x, y, angle, vx, vy, spin = rng.uniform((-6, 5, -3, -3, -3, -2), (6, 12, 3, 3, 1, 2))
    drag = {"linear_drag": 0.02, "quadratic_drag": 0.05, "angular_drag": 0.2, "angular_quadratic_drag": 0.1}
    block = world.add([Polygon.box(1.0, 0.6), Polygon.box(0.3, 0.5, (0.8, 0.1))], (x, y), angle, mass=2.0, **drag)
    block.set(velocity=(vx, vy), angular_velocity=spin)
    world.add(Polygon.box(40.0, 1.0), (0.0, top - 0.5), static=True)
    world.add(Polygon([(-2.0, 0.0), (2.0, 0.0), (0.0, 3.0)]), (1.0, top), 0.4, static=True)
    return world, block


def test_free_flight_is_the_same_bit_for_bit_until_just_before_something_touches():
    rng = np.random.default_rng(3)
    for _ in range(20):
        seed = int(rng.integers(1000))
        (world, block), (twin, other) = (falling(np.random.default_rng(seed)) for _ in range(2))
        flight, flown = FreeFlight(world, block.index), 0
        while not flight.near():
            push = rng.uniform(-4.0, 4.0, 3)
            flight.step(push[0], push[1], push[2], DT)
            other.apply_force(push[:2])
            other.apply_torque(push[2])
            twin.step()
            assert twin.contacts is None
            assert (flight.x, flight.y, flight.angle) == (*other.position[0], other.angle[0])
            assert (flight.vx, flight.vy, flight.spin) == (*other.velocity[0], other.angular_velocity[0])
            flown += 1
        assert flown > 20
        flight.give()
        world.step()
        twin.step()
        assert twin.contacts is not None  # it was not near before it had to be
        for name in ("pose", "velocity", "cos", "sin"):
            assert getattr(world.state, name).tobytes() == getattr(twin.state, name).tobytes()


def test_what_sways_is_near_wherever_it_may_be():
    world, block = falling(np.random.default_rng(0))
    world.add(Polygon.box(1.0, 6.0), (8.0, 3.0), static=True)
    near = []
    for sway in (0.0, 1.0):
        block.set(position=(6.0, 4.0), angle=0.0)
        near.append(FreeFlight(world, block.index, sway).near())
    assert near == [False, True]


def test_fixed_bodies_that_were_put_elsewhere_are_found_there():
    world, block = falling(np.random.default_rng(0))
    wall = world.add(Polygon.box(1.0, 6.0), (20.0, 3.0), static=True)
    block.set(position=(6.0, 4.0))
    flight = FreeFlight(world, block.index)
    assert not flight.near()
    wall.position = (6.0, 4.0)
    flight.forget()
    assert flight.near()
    wall.active = False
    flight.forget()
    assert not flight.near()


def test_circles_are_refused():
    world, block = falling(np.random.default_rng(0))
    world.add(Circle(1.0), (5.0, 0.0), static=True)
    with pytest.raises(ValueError, match="polygons"):
        FreeFlight(world, block.index)
