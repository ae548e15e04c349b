"""What rests stays: stacks, pyramids, heaps."""

import numpy as np
import pytest

from engine import Circle, Polygon, World
from tests.support.worlds import advance


def ground(gravity=9.81, batch=1):
    world = World(gravity=(0.0, -gravity), batch=batch)
    world.add(Polygon.box(60.0, 1.0), (0.0, -0.5), static=True)
    return world


def moon_and_earth():
    """A batch of two: what stands must stand on both."""
    world = ground(batch=2)
    world.gravity = np.array([[0.0, -1.62], [0.0, -9.81]])
    return world


def run(world, seconds):
    advance(world, round(seconds * 60))


def overlap(world):
    return float(np.where(world.contacts.valid, world.contacts.depth, 0.0).max())


def assert_stands(world, start, drift, speed=1e-3):
    """Nothing has left its place, and nothing moves faster than `speed`."""
    moved = world.state.pose - start
    assert abs(moved).max() < drift
    assert abs(world.state.velocity).max() < speed
    assert overlap(world) < 0.01


def test_a_body_at_rest_stays_at_rest():
    world = moon_and_earth()
    world.add(Polygon.box(1.0, 1.0), (0.0, 0.499))
    world.add(Circle(0.5), (3.0, 0.499))
    world.add([Polygon.box(1.0, 0.2), Polygon.box(0.2, 1.0, (0.0, 0.6))], (6.0, 0.35))
    run(world, 2)
    place = world.state.pose.copy()
    run(world, 10)
    assert world.state.pose == pytest.approx(place, abs=1e-9)
    assert abs(world.state.velocity).max() < 1e-9


STACKS = {  # x, row and mass of its boxes
    "ten boxes": [(0.0, row, 1.0) for row in range(10)],
    "a pyramid": [(1.1 * (i - (4 - row) / 2), row, 1.0) for row in range(5) for i in range(5 - row)],
    "a heavy box on a light one": [(0.0, 0, 1.0), (0.0, 1, 20.0)],
}


def test_what_is_stacked_stands_for_ten_seconds(subtests):
    for name, boxes in STACKS.items():
        with subtests.test(name):
            world = moon_and_earth()
            for x, row, mass in boxes:
                world.add(Polygon.box(1.0, 1.0), (x, 0.5 + row), mass=mass, friction=0.5)
            start = world.state.pose.copy()
            run(world, 10)
            assert_stands(world, start, drift=0.06)
            if name == "ten boxes":
                assert abs(world.state.pose[..., [0, 2]]).max() < 1e-3


@pytest.mark.slow
def test_more_manifolds_than_a_word_has_bits():
    # A plank under eighty balls: each needs a colour of its own, or some would not be held up.
    world = ground()
    world.add(Polygon.box(34.0, 0.4), (0.0, 0.2), mass=50.0)
    for i in range(80):
        world.add(Circle(0.18), (0.4 * (i - 39.5), 0.58), mass=0.2)
    run(world, 0.5)
    assert world.contacts.colour.max() > 64
    assert world.state.pose[0, 2:, 1].min() > 0.56
