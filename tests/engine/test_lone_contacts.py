"""Contacts of one body in plain floats: the same steps, bit for bit, as in arrays."""

from itertools import pairwise

import numpy as np

from engine import Circle, Polygon, World

STATE = ("pose", "velocity", "force", "cos", "sin")
HULL = Polygon([(-0.62, -0.45), (0.62, -0.45), (0.72, 0.05), (0.42, 0.75), (-0.42, 0.75), (-0.72, 0.05)])


def craft(start):
    """A craft of three shapes above a pad among ragged segments, a wedge, and a block that lets it through."""
    world = World(sleeping=False)
    for i, (left, right) in enumerate(pairwise([1.0, 0.4, 1.3, 1.0, 0.7, 1.6])):
        x = 4.0 * i - 10
        world.add(Polygon([(x, -1), (x + 4, -1), (x + 4, right), (x, left)]), (0, 0), static=True, friction=0.7)
    world.add(Polygon.box(6.0, 0.6), (0.0, 1.3), static=True)
    world.add(Polygon([(-1.0, 0.0), (1.0, 0.0), (0.0, 2.0)]), (6.0, 0.8), 0.2, static=True, restitution=0.5)
    world.add(Polygon.box(3.0, 3.0), (-6.0, 1.0), static=True, group=1)
    feet = [Polygon.box(0.4, 0.12, (side * 0.85, -0.9)) for side in (-1, 1)]
    body = world.add([HULL, *feet], (0.0, 4.0), mass=1000.0, restitution=0.4, friction=0.5, linear_drag=3.0, group=1)
    body.set(**start)
    return world


def assert_same(world, twin):
    for name in STATE:
        assert getattr(world.state, name).tobytes() == getattr(twin.state, name).tobytes(), name
    mine, theirs = world.contacts, twin.contacts
    assert (mine is None) == (theirs is None)
    if mine is None:
        return
    for name in ("world", "pair", "body", "friction", "restitution", "impulse", "approach", "age"):
        assert np.array_equal(getattr(mine, name), getattr(theirs, name)), name
    for name in ("normal", "points", "depth", "valid", "feature"):
        assert np.array_equal(getattr(mine.manifold, name), getattr(theirs.manifold, name)), name
    assert mine.colour_ends == theirs.colour_ends


def test_a_craft_that_falls_bounces_slides_and_lies_does_so_as_in_arrays(subtests):
    for seed in range(8):
        with subtests.test(seed=seed):
            rng = np.random.default_rng(seed)
            start = {
                "position": rng.uniform((-4, 3), (4, 4)), "angle": rng.uniform(-3, 3),
                "velocity": rng.uniform(-1.5, 1.5, 2), "angular_velocity": rng.uniform(-2, 2),
            }  # fmt: skip
            world, twin = craft(start), craft(start)
            twin.in_floats = False
            touched = 0
            for step in range(360):
                if step % 60 == 0:
                    push = rng.uniform(-1500, 1500, 2)
                for each in (world, twin):
                    if step % 60 < 10:
                        each.bodies[-1].apply_force(push, each.bodies[-1].position + np.array([0.2, 0.1]))
                    if step == 200:  # the pad goes, and a wall comes
                        each.bodies[5].active = False
                        each.bodies[6].position = (2.0, 1.5)
                    if step == 300:
                        each.bodies[5].active = True
                    each.step()
                assert_same(world, twin)
                touched += twin.contacts is not None
            assert touched > 20


def test_points_that_nearly_coincide_share_no_push_in_floats_either():
    rng = np.random.default_rng(1)
    needle = Polygon([(-0.001, -0.5), (0.001, -0.5), (0.001, 0.5), (-0.001, 0.5)])
    for _ in range(10):
        twins = []
        start = {"position": (rng.uniform(-1, 1), 0.55), "angle": rng.uniform(-0.1, 0.1), "velocity": (0.3, -1.0)}
        for in_floats in (True, False):
            world = World(sleeping=False)
            world.in_floats = in_floats
            world.add(Polygon.box(8.0, 1.0), (0.0, -0.5), static=True)
            world.add(needle, (0.0, 1.0)).set(**start)
            twins.append(world)
        for _ in range(80):
            for world in twins:
                world.step()
            assert_same(*twins)


def test_impulses_pass_from_floats_to_arrays_and_back():
    world, twin = (craft({"position": (0.1, 2.6)}) for _ in range(2))
    twin.in_floats = False
    for step in range(240):
        world.in_floats = step % 7 < 4
        if step == 150:
            memory = world.detector.memory()
            world.detector.recall_memory(memory)
        world.step()
        twin.step()
        assert_same(world, twin)
    assert len(world.contacts) == 2


def test_what_stands_on_a_lift_or_meets_a_circle_is_left_to_arrays():
    for shape, velocity in ((Polygon.box(4.0, 1.0), (0.5, 0.2)), (Circle(1.0), (0.0, 0.0))):
        worlds = []
        for in_floats in (True, False):
            world = World(sleeping=False)
            world.in_floats = in_floats
            world.add(shape, (0.0, 0.0), static=True).set(velocity=velocity)
            world.add(Polygon.box(1.0, 1.0), (0.2, 1.8), 0.1)
            worlds.append(world)
        for _ in range(120):
            for world in worlds:
                world.step()
            assert_same(*worlds)
        assert worlds[0].contacts is not None or velocity == (0.0, 0.0)
