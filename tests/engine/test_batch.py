"""A world is the same, bit for bit, alone and among a thousand."""

from itertools import pairwise

import numpy as np
import pytest

from engine import Circle, Polygon, World, memory_of_worlds
from tests.support.worlds import advance

STATE = ("pose", "velocity", "cos", "sin")


def landers(batch, restitution=0.4):
    """A craft of three shapes above a pad between ragged ground segments: mostly air, sometimes a touch."""
    world = World(batch=batch)
    heights = [1.0, 0.4, 1.3, 1.0, 0.7, 1.6]
    for i, (left, right) in enumerate(pairwise(heights)):
        x = 4.0 * i - 10
        world.add(Polygon([(x, -1), (x + 4, -1), (x + 4, right), (x, left)]), (0, 0), static=True)
    world.add(Polygon.box(6.0, 0.6), (0.0, 1.3), static=True)
    hull = Polygon([(-0.62, -0.45), (0.62, -0.45), (0.72, 0.05), (0.42, 0.75), (-0.42, 0.75), (-0.72, 0.05)])
    feet = [Polygon.box(0.4, 0.12, (side * 0.85, -0.9)) for side in (-1, 1)]
    world.add([hull, *feet], (0.0, 4.0), mass=1000.0, restitution=restitution, friction=0.5, linear_drag=3.0)
    return world


def toys(batch):
    """Circles and polygons of all sorts in a walled box."""
    world = World(gravity=(0.3, -9.81), batch=batch, sleeping=False)
    world.add(Polygon.box(8.0, 1.0), (0.0, -0.5), static=True, friction=0.4)
    for side in (-1, 1):
        world.add(Polygon.box(1.0, 12.0), (side * 4.0, 5.0), static=True)
    for i in range(4):
        world.add(Circle(0.3 + 0.05 * i), (i - 1.5, 1.0), mass=1.0 + i, restitution=0.6, angular_drag=0.1)
        world.add(Polygon.box(0.5 + 0.1 * i, 0.4), (i - 1.5, 2.2), mass=1, friction=0.3, quadratic_drag=0.02)
    world.add(Polygon([(-0.4, -0.3), (0.5, -0.3), (0.0, 0.6)]), (0.0, 4.0), mass=2.0, restitution=0.2)
    world.add([Circle(0.3, (-0.4, 0.0)), Circle(0.3, (0.4, 0.0)), Polygon.box(0.8, 0.2)], (1.5, 4), mass=1.5)
    return world


def throw(world, seed):
    """Put every moving body somewhere of its own in each world."""
    random = np.random.default_rng(seed)
    for body in world.bodies:
        if not body.static:
            body.set(
                position=body.position + random.uniform(-0.3, 0.3, (world.batch, 2)),
                angle=random.uniform(-3, 3, world.batch),
                velocity=random.uniform(-4, 4, (world.batch, 2)),
                angular_velocity=random.uniform(-3, 3, world.batch),
            )


def like(world, make, rows):
    """The same start as some rows of `world`, in a world of their own."""
    alone = make(len(rows))
    for mine, theirs in zip(alone.bodies, world.bodies, strict=True):
        mine.set(
            position=theirs.position[rows],
            angle=theirs.angle[rows],
            velocity=theirs.velocity[rows],
            angular_velocity=theirs.angular_velocity[rows],
        )
    return alone


def assert_same(world, alone, rows):
    for name in STATE:
        ours, theirs = getattr(world.state, name)[rows], getattr(alone.state, name)
        assert ours.tobytes() == theirs.tobytes(), name
    if alone.contacts and len(rows) == 1:
        mine = np.flatnonzero(world.contacts.world == rows[0])
        for name in ("shape", "impulse", "approach"):
            assert np.array_equal(getattr(world.contacts, name)[mine], getattr(alone.contacts, name)), name


BATCHES = [(landers, 1000, 160), (toys, 1000, 24), (landers, 3, 200), (toys, 5, 40)]


@pytest.mark.parametrize(("make", "batch", "steps"), BATCHES)
def test_every_world_of_a_batch_equals_itself_alone_at_each_step(make, batch, steps):
    many = make(batch)
    throw(many, seed=batch)
    chosen = [0, 17, 421, 999] if batch > 20 else range(batch)
    few = {row: like(many, make, [row]) for row in chosen}
    touched = 0
    for step in range(steps):
        many.step()
        for row, alone in few.items():
            alone.step()
            touched += alone.contacts is not None
            if batch < 20 or step == steps - 1:
                assert_same(many, alone, [row])
    assert touched > steps / 8


def test_what_is_set_in_one_world_leaves_the_impulses_of_others_alone():
    pair, alone = World(gravity=(0, -9.81), batch=2), World(gravity=(0, -9.81))
    for world in (pair, alone):
        world.add(Polygon.box(20, 1), (0, -0.5), static=True)
        for row in range(4):
            world.add(Polygon.box(1, 1), (0.1 * row, 0.5 + row), friction=0.5)
        advance(world, 10)
    for _ in range(20):
        pair.bodies[1].set(position=(0.0, 0.5), mask=np.array([True, False]))
        pair.step()
        alone.step()
        assert_same(pair, alone, [1])


def test_worlds_go_on_from_their_memory_in_any_order_and_number():
    world = toys(3)
    throw(world, 4)
    advance(world, 60)
    rows = np.array([2, 0, 2, 1])
    twin = toys(4)
    for name, value in vars(world.state).items():
        setattr(twin.state, name, value[rows].copy())
    twin.recall(memory_of_worlds(world.memory(), rows))
    for _ in range(30):
        world.step()
        twin.step()
    assert twin.state.pose.tobytes() == world.state.pose[rows].tobytes()
