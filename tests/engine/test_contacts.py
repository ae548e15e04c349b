"""What a step takes over from the last one: which points are the same, and which take the place of others."""

from dataclasses import replace
from itertools import product

import numpy as np

from engine import Circle, Polygon, World, collide
from engine.contacts import Contacts
from tests.support.worlds import advance

BOX = Polygon.box(2.0, 2.0)
QUARTER = np.pi / 2
A, B, C, D = (0.0, 0.0), (0.15, 0.0), (0.0, 0.01), (0.15, 0.01)  # C is near A, and D near B
UP, ASIDE = (0.0, 1.0), (1.0, 0.0)


def features(angle_a=0.0, b=(0.2, 1.9, 0.0)):
    manifold = collide(BOX, np.array([0.0, 0.0, angle_a]), BOX, np.array(b))
    assert manifold.valid.any()
    return manifold.feature[0].tolist()


def test_a_point_is_the_same_as_long_as_the_same_faces_make_it():
    first = features()
    assert len(set(first)) == 2
    assert features(b=(0.3, 1.95, 0.01)) == first
    assert features(b=(0.9, 1.95, 0.0)) == first
    others = [features(QUARTER), features(b=(0.2, 1.9, QUARTER)), features(b=(0.2, -1.9, 0.0)), features(b=(1.9, 0, 0))]
    # On its corner, the lower box meets a face of the upper one, which then is the reference.
    others.append(features(np.pi / 4, b=(0.0, 1.0 + np.sqrt(2) - 0.05, 0.0)))
    several = [number for pair in (first, *others) for number in pair]
    assert len(set(several)) == len(several)
    assert len(set(collide(Circle(1.0), np.zeros(3), Circle(1.0), np.array([0, 1.9, 0])).feature[0])) == 2


def contacts(points, feature, impulse=(0.0, 0.0, 0.0), normal=UP, pair=3, world=1):
    """One contact; a point that is None is not there."""
    return Contacts(
        normal=np.array([normal]),
        points=np.array([[point or (9.0, 9.0) for point in points]]),
        depth=np.zeros((1, 2)),
        valid=np.array([[point is not None for point in points]]),
        feature=np.array([feature]),
        world=np.array([world]),
        shape=np.array([[0, pair]]),
        body=np.array([[0, 1]]),
        friction=np.ones(1),
        restitution=np.zeros(1),
        impulse=np.array([impulse], dtype=float),
        approach=np.zeros((1, 3)),
        colour=np.zeros(1, dtype=int),
    )


LAST = contacts((A, B), (1, 2), (5.0, 3.0, 2.0))
WITHOUT, OTHER = contacts((A, None), (1, 2), (5.0, 0.0, 2.0)), contacts((A, B), (1, 2), (50.0, 30.0, 20.0), pair=2)
# What touched last, what touches now, the impulses it begins with, and those if points pass theirs on.
CASES = {
    "the same faces": (LAST, contacts((C, D), (1, 2)), (5, 3, 2), (5, 3, 2)),
    "the same faces, elsewhere": (LAST, contacts(((4, 0), (5, 0)), (1, 2)), (5, 3, 2), (5, 3, 2)),
    "other faces, in the same places": (LAST, contacts((C, D), (3, 4)), (0, 0, 0), (5, 3, 2)),
    "other faces, crosswise": (LAST, contacts((D, C), (3, 4)), (0, 0, 0), (3, 5, 2)),
    "other faces, far away": (LAST, contacts(((4, 0), (5, 0)), (3, 4)), (0, 0, 0), (0, 0, 0)),
    "other faces, aside": (LAST, contacts((C, D), (3, 4), normal=ASIDE), (0, 0, 0), (0, 0, 0)),
    "one point left": (LAST, contacts((C, None), (1, 2)), (5, 0, 2), (5, 0, 2)),
    "another point left": (LAST, contacts((None, D), (1, 2)), (0, 3, 2), (0, 3, 2)),
    "one point more": (WITHOUT, contacts((C, D), (1, 2)), (5, 0, 0), (5, 0, 2)),
    "one of other faces": (LAST, contacts((C, D), (1, 4)), (5, 0, 0), (5, 3, 2)),
    "one where the other was": (LAST, contacts((A, A), (1, 4)), (5, 0, 0), (5, 3, 2)),
    "two for one, the nearer gets it": (WITHOUT, contacts((B, C), (3, 4)), (0, 0, 0), (0, 5, 2)),
    "one for two": (LAST, contacts((D, None), (3, 4)), (0, 0, 0), (3, 0, 2)),
}


def pair_of_boxes():
    world = World(batch=2)
    world.add(BOX, (0, 0), static=True)
    for x in (0.0, 5.0, 9.0, 13.0):
        world.add(BOX, (x, 5.0))
    advance(world, 1)
    return world._narrow_phase


def test_impulses_a_step_begins_with(subtests):
    narrow = pair_of_boxes()
    for (name, (last, now, kept, passed)), pass_on in product(CASES.items(), (False, True)):
        with subtests.test(name, pass_on=pass_on):
            both = now.with_others(contacts((A, B), (1, 2), pair=5))  # which did not touch
            narrow.warm_start(both, OTHER.with_others(last), pass_on=pass_on)
            assert both.impulse.tolist() == [list(passed if pass_on else kept), [0, 0, 0]]


def test_impulses_of_other_worlds_and_pairs_are_no_ones():
    narrow = pair_of_boxes()
    for last in (contacts((A, B), (1, 2), (5, 3, 2), world=0), contacts((A, B), (1, 2), (5, 3, 2), pair=4)):
        now = contacts((A, B), (1, 2))
        narrow.warm_start(now, last, pass_on=True)
        assert now.impulse.tolist() == [[0, 0, 0]]


def test_with_other_parameters_no_impulse_is_taken_over():
    rested, fresh = (World(gravity=(0.0, -9.81), iterations=2, sleeping=False) for _ in range(2))
    for world in (rested, fresh):
        world.add(Polygon.box(30.0, 2.0), (0.0, -1.0), static=True)
        for row in range(3):
            world.add(BOX, (0.3 * row, 1.0 + 2.0 * row), friction=0.5)
    advance(rested, 60)
    slippery = replace(rested.params, friction=np.full(4, 0.1))
    rested.params = fresh.params = slippery
    for name, value in vars(rested.state).items():
        setattr(fresh.state, name, value.copy())
    for world in (rested, fresh):
        world.step()
    assert np.array_equal(rested.state.velocity, fresh.state.velocity)
    assert np.array_equal(rested.contacts.impulse, fresh.contacts.impulse)
